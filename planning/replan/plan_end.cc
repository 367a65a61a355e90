// SPDX-License-Identifier: BSD-3-Clause
#include "planning/replan/plan_end.h"

#include <algorithm>
#include <cmath>

#include "planning/problem/duration_guess.h"
#include "planning/replan/spaces.h"

namespace touchdown::planning {
namespace {

constexpr double kOnTheWay = 0.5;    // of the longest plan, where the end is too far
constexpr double kLowestWait = 0.6;  // of the body over a deck below a roof [m]

EndpointTarget AtRest() {
  EndpointTarget target;
  target.height = 0.0;
  return target;
}

}  // namespace

void PlanEnd::Set(const ReplanInput& input, const SplineState& start, const Limits& limits) {
  Forget();
  pad_ = input.pad;
  target_ = input.endpoint;
  if (input.look_from_W) {
    look_from_.emplace(*input.look_from_W);
    pad_ = &*look_from_;
    target_ = AtRest();
  }
  const double t0 = input.t_start;
  const double guess = GuessDuration(start, t0, *pad_, target_, limits, 1.0);
  if (guess <= options_.max_duration || !std::isfinite(guess)) return;
  const Eigen::Vector3d end = EndStateAt(*pad_, target_, t0 + guess).state.p;
  on_the_way_.emplace(start.p + kOnTheWay * options_.max_duration / guess * (end - start.p));
  pad_ = &*on_the_way_;
  target_ = AtRest();
}

double PlanEnd::FindFree(double t_start, double T, const OccupancyMap& map) {
  const FreeSpace space = SpaceFor(options_, map);
  const double latest = std::min(options_.constants.stretch * T, options_.max_duration);
  for (double later = T; later <= latest; later *= options_.constants.end_step) {
    if (!space.Blocked(EndStateAt(*pad_, target_, t_start + later).state.p)) return later;
  }
  if (!pad_->has_deck() || target_.touches()) return T;
  target_.height = LowerUnderRoof(space, pad_->MeanAt(t_start + T).p_WP, target_.height);
  target_.height_floor = std::min(target_.height_floor, target_.height);
  return T;
}

double LowerUnderRoof(const FreeSpace& space, const Eigen::Vector3d& p_WP, double height) {
  for (double lower = height; lower >= kLowestWait; lower -= space.map->resolution()) {
    if (!space.Blocked(Eigen::Vector3d(p_WP + lower * Eigen::Vector3d::UnitZ()))) return lower;
  }
  return height;
}

}  // namespace touchdown::planning
