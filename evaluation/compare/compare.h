// SPDX-License-Identifier: BSD-3-Clause
// Solver backends on the problems that flights pose. Each is judged from outside by one merit.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/compare/solver_bench.h"
#include "touchdown/evaluation/scenario/registries.h"

namespace touchdown::evaluation {

struct CompareOptions {
  std::string from;              ///< a record, or a file of trials; empty: flights are drawn
  std::uint64_t seed = 1;        ///< of drawn flights
  std::vector<std::string> set;  ///< "solver.limits=hard": keys of the scenarios of all flights
  std::optional<int> problems;   ///< most; none: all of one flight, 20 of several
  /// Every how many solves one becomes a problem. Default: 1 for one flight; 25 for several, so that hundreds of
  /// problems come from dozens of flights.
  std::optional<int> every;
  BenchOptions bench;
};

struct CompareResult : BenchResult {
  std::vector<std::string> flights;  ///< that posed the problems: the commands that fly them
  std::optional<int> flights_there;  ///< in the file; none: they are drawn without end
  int every = 1;
  int asked = 0;  ///< solves that the flights asked for, until there were enough problems
  /// Of flights that could not be flown, or were others than their file holds.
  std::vector<std::string> notes;
};

/// Flies, and has every backend solve the problems that replanning steps pose, as they are posed: with the same terms,
/// weights, pairs and start. Counting alone decides which problems are taken. The answers of the flight's own backend
/// influence later problems.
/// A flight that cannot be flown is noted, and the next one is flown. `report(done, all)` is called after each problem,
/// with 0 for all where it is not known. Throws BadInput if a backend is unknown or named twice, if none can solve the
/// formulation, or if the flights pose no problem.
CompareResult RunCompare(const CompareOptions& options, const Registries& registries,
                         const std::function<void(int done, int all)>& report);

}  // namespace touchdown::evaluation
