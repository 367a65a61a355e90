// SPDX-License-Identifier: BSD-3-Clause
// A term that is written in Python (touchdown.Term).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "evaluation/binding/predictions.h"
#include "touchdown/planning/problem/landing_term.h"
#include "touchdown/planning/problem/term_check.h"
#include "touchdown/solvers/problem/batch_term.h"

namespace touchdown::binding {

/// The cost of a term's calls, over all its instances since it was entered.
struct TermTime {
  long calls = 0;
  long windows = 0;  ///< that were asked for, those of differences included
  double wall_s = 0.0;
};

/// Raises TypeError if it is no instance of a touchdown.Term.
void RequireTerm(const pybind11::object& term);

/// The term of a Python object for a problem with so many blocks of this size. Every call goes to the object, but its
/// functions are called only for arrays. Raises errors of its attributes.
std::shared_ptr<solvers::Term> MakePythonTerm(const pybind11::object& term, int blocks,
                                              int block_size,
                                              std::shared_ptr<TermTime> time = nullptr);

/// The entry of a class that derives from touchdown.Term; `time` gets what the entry's terms cost.
planning::TermEntry PythonTermEntry(const pybind11::object& type,
                                    std::shared_ptr<TermTime> time = nullptr);

/// One sentence on a term whose check has a complaint; `type`: its class, None for one of the library's.
std::string WhatIsWrong(const pybind11::object& type, const std::string& term,
                        const std::string& complaint,
                        const std::vector<planning::TermCheckRow>& rows);

/// The context of a solve for its terms: touchdown's LandingContext without what is valid only during the call.
struct TermContext {
  int segments = 0;
  planning::SplineState start;
  double t0 = 0.0;
  double interval = 1.0;
  planning::EndpointTarget target;
  planning::Limits limits;
  Eigen::Vector3d pull_W = Eigen::Vector3d::Zero();
  std::shared_ptr<Prediction> pad;  ///< may be asked while the term is
};

/// A Python object that C++ may copy, keep and drop without the lock.
class Kept {
 public:
  explicit Kept(pybind11::object object);
  /// The lock is held.
  const pybind11::object& get() const { return *object_; }

 private:
  std::shared_ptr<pybind11::object> object_;
};

}  // namespace touchdown::binding
