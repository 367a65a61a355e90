// SPDX-License-Identifier: BSD-3-Clause
// The order of one plan call, as published.

#include "planning/baselines/ego/ego_plan.h"

#include <optional>

namespace touchdown::planning {

namespace {

constexpr double kNearest = 0.2;  // target, that counts as one [m]

const EgoOptions& Checked(const EgoOptions& options) {
  Validate(options);
  return options;
}

bool Finite(const EgoRequest& r) {
  return r.ends.start.p.allFinite() && r.ends.start.v.allFinite() && r.ends.start.a.allFinite() &&
         r.ends.p_end.allFinite() && r.ends.v_end.allFinite();
}

}  // namespace

EgoPlan::EgoPlan(const EgoOptions& options, std::uint64_t seed)
    : options_(Checked(options)), random_(seed), rebound_(options), refinement_(options) {}

EgoPlanResult EgoPlan::Run(const EgoGrid& grid, const EgoRequest& request) {
  EgoPlanResult result;
  const auto fail = [&](EgoStatus status) {
    result.status = status;
    ++failures_;
    return result;
  };
  if (!Finite(request)) return fail(EgoStatus::kInvalidInput);
  if (!grid.Inside(request.ends.start.p)) return fail(EgoStatus::kOutsideMap);
  if ((request.ends.start.p - request.ends.p_end).norm() < kNearest) {
    return fail(EgoStatus::kCloseToGoal);
  }

  std::optional<SampledPath> path;
  if (request.guess == EgoGuess::kWarm && request.previous != nullptr) {
    path = WarmPath(*request.previous, request.t0, request.ends, options_);
  }
  if (!path) {
    EgoRandom* random = request.guess == EgoGuess::kRandom ? &random_ : nullptr;
    path = PolynomialPath(request.ends, options_, random, failures_);
  }
  if (!path) return fail(EgoStatus::kNoInitialPath);

  ControlPoints q = FitBspline(*path);
  double interval = path->interval;
  const EgoStatus rebound = rebound_.Run(grid, interval, &q);
  result.counts = rebound_.counts();
  if (rebound != EgoStatus::kPlanned) return fail(rebound);

  const LimitExcess excess = CheckLimits(q, interval, options_);
  if (!excess.feasible) {
    result.refined = true;
    const EgoStatus refined = refinement_.Run(grid, excess.ratio, *path, &interval, &q);
    result.refine_iterations = refinement_.iterations();
    if (refined != EgoStatus::kPlanned) return fail(refined);
  }
  failures_ = 0;
  result.curve = UniformBspline(q, interval, request.t0);
  result.status = EgoStatus::kPlanned;
  return result;
}

}  // namespace touchdown::planning
