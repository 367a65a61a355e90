// SPDX-License-Identifier: BSD-3-Clause
// One record, replayed with several backends: the cost of their solves and of their whole steps.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/base/machine.h"
#include "evaluation/compare/compare.h"
#include "evaluation/compare/compare_summary.h"
#include "evaluation/profile/profile.h"

namespace touchdown::evaluation {

struct BackendsOptions {
  std::string record;
  std::vector<std::string> overrides;  ///< kReplayKeys
  std::vector<std::string> backends;   ///< none: all that can solve the formulation
  /// Of solves and steps; none: the record's solver.gap, or where that is 0 1e-4 of the solves.
  std::optional<double> gap;
  int repeats = 5;
};

/// One backend on the steps of a record.
struct BackendLatency {
  /// Its solves of the problems that the record's own backend had. Each ends at a feasible point within the gap of the
  /// best known cost.
  BackendSummary solves;
  /// Whole steps with this backend in the loop, as it would fly. Each step's time is the median of
  /// its passes.
  Quantiles step_ms;
  Quantiles allocations;  ///< of a step
  int plans = 0;          ///< steps that made a new plan
};

struct BackendsProfile {
  std::string record;
  std::string scenario;
  int steps = 0;
  int repeats = 0;
  double gap = 0.0;
  CompareResult solves;
  std::vector<BackendLatency> backends;
};

/// Called with what is counted: "problems", then "backends".
using BackendsProgress = std::function<void(const char* things, int done, int all)>;

/// @throws BadInput as ReadRecord, Replay and RunCompare
BackendsProfile ProfileBackends(const BackendsOptions& options, const Registries& registries,
                                const BackendsProgress& progress);

std::string BackendsText(const BackendsProfile& profile);
nlohmann::ordered_json BackendsJson(const BackendsProfile& profile, const MachineState& machine);

}  // namespace touchdown::evaluation
