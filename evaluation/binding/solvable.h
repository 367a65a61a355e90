// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "evaluation/binding/bind.h"
#include "touchdown/solvers/problem/view.h"

namespace touchdown::binding {

/// What a backend can be given.
class Solvable {
 public:
  explicit Solvable(const char* name) : use(name) {}
  virtual ~Solvable() = default;
  virtual const solvers::View& view() const = 0;

  InUse use;
};

/// Raises ValueError.
void RequireSize(const solvers::View& view, const Eigen::Ref<const Eigen::VectorXd>& y,
                 const char* name);

}  // namespace touchdown::binding
