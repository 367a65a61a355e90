// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "touchdown/evaluation/scenario/registries.h"

namespace touchdown::evaluation {

/// Key and value: of a scenario ("gps.sigma", "0.5") or of a label ("sigma [m]", "0.5").
using StudyPairs = std::vector<std::pair<std::string, std::string>>;

/// Where a study flies: a scenario with some of its keys changed.
struct StudyCell {
  std::string name;                  ///< in file names and labels
  std::string title;                 ///< in the report
  std::string scenario;              ///< name or path
  StudyPairs labels;                 ///< what sets it apart from the other cells, for tables
  StudyPairs set;                    ///< keys of the scenario
  std::vector<std::string> methods;  ///< that fly in it; empty: all
  bool quick = true;                 ///< also in the short form
};

/// The planner and solver that fly.
struct StudyMethod {
  std::string name;     ///< in file names and labels
  std::string title;    ///< in the report
  StudyPairs set;       ///< keys of the scenario, after the cell's
  int trials = 100;     ///< in each cell
  int quick = 5;        ///< in each cell of the short form
  bool record = false;  ///< its first trial in every cell is flown again with a record
  std::vector<std::string> record_in;  ///< or in these cells
  /// Of the study's `backends`: a cell that the backend cannot solve is left out with a sentence.
  bool may_refuse = false;
};

/// A study as its file says (docs/evaluation_protocol.md): every method in every cell, paired seeds.
struct StudyFile {
  std::string name;    ///< stem of the file
  std::string folder;  ///< where it is: its own scenario files are looked for there first
  std::string title;
  std::string report;     ///< which report: "plain", "paper", "solvers" or "ablation"
  std::string reference;  ///< the method that the others are compared with
  std::uint64_t seed = 1;
  StudyPairs set;  ///< keys of every trial, before the cell's
  std::vector<StudyCell> cells;
  std::vector<StudyMethod> methods;
};

/// Reads a study file. `backends: {...}` in it becomes one method for each backend of `registries`.
/// @throws BadInput with file, line and key
StudyFile LoadStudyFile(const std::string& path, const Registries& registries);

}  // namespace touchdown::evaluation
