// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "planning/baselines/ego/initial_path.h"
#include "planning/baselines/ego/rebound.h"
#include "planning/baselines/ego/refinement.h"

namespace touchdown::planning {

/// How the first guess is made.
enum class EgoGuess {
  kWarm,        ///< from the previous curve; the polynomial where that does not suit
  kPolynomial,  ///< one quintic
  kRandom,      ///< two, through a random midpoint
};

/// One plan call.
struct EgoRequest {
  EgoEnds ends;
  EgoGuess guess = EgoGuess::kPolynomial;
  const UniformBspline* previous = nullptr;  ///< for kWarm
  double t0 = 0.0;  ///< when the plan begins, also on `previous`'s clock [s]
};

struct EgoPlanResult {
  EgoStatus status = EgoStatus::kInvalidInput;
  UniformBspline curve;  ///< from t0 on; meaningful with kPlanned
  ReboundCounts counts;
  bool refined = false;
  int refine_iterations = 0;
};

/// One plan call of the EGO-Planner baseline, from a first guess to a trajectory (Zhou et al.
/// 2021). It fits, optimises with rebounds and checks the limits. Where they are exceeded, it makes
/// a slower, refined curve. Feasible per axis and clear in its first two thirds as far as the
/// published checks see; nothing is certified. Deterministic for a seed and an order of calls. One
/// instance serves one thread.
class EgoPlan {
 public:
  /// Throws std::invalid_argument if an option is out of range. Allocates the search's lattice.
  explicit EgoPlan(const EgoOptions& options, std::uint64_t seed = 0);

  /// The outcome is in the result's status. Allocates.
  EgoPlanResult Run(const EgoGrid& grid, const EgoRequest& request);

  const EgoOptions& options() const { return options_; }
  const Rebound& rebound() const { return rebound_; }

 private:
  EgoOptions options_;
  EgoRandom random_;
  Rebound rebound_;
  Refinement refinement_;
  int failures_ = 0;  // in a row
};

}  // namespace touchdown::planning
