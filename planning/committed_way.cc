// SPDX-License-Identifier: BSD-3-Clause
// The committed curve, sampled; where it is blocked by now, a short A* path from the last free place to the
// next, in the same time. So a wall that turns out to be longer than it seemed moves the way by its length,
// and does not ask which way to take at all.

#include "touchdown/planning/committed_way.h"

#include <algorithm>
#include <cmath>

namespace touchdown::planning {

namespace {

constexpr double kStep = 0.05;          // sampling of the curve [s]
constexpr double kLongestDetour = 2.0;  // over the straight line ...
constexpr double kDetourSlack = 1.0;    // ... and beyond that [m]

}  // namespace

CommittedWay::CommittedWay() {
  places_.reserve(1024);
  runs_.reserve(64);
  detour_.reserve(1024);
}

int CommittedWay::Follow(const UniformBspline& curve, double t_from, const FreeSpace& space,
                         int max_expansions, GridSearch* search) {
  places_.clear();
  FindBlockedRuns(curve, t_from, space, &runs_);
  if (!runs_.empty() && (runs_.front().at_start || runs_.back().at_end)) return 0;
  int spent = 0;
  double t = t_from;
  const auto add_curve_until = [&](double t_end) {
    for (; t < t_end; t += kStep) places_.push_back({t, curve.Position(t)});
    t = t_end;
  };
  for (const BlockedRun& run : runs_) {
    add_curve_until(run.t_in);
    const SearchStatus status =
        search->Search(space, curve.Position(run.t_in), curve.Position(run.t_out),
                       max_expansions - spent, &detour_);
    spent += search->expansions();
    if (status != SearchStatus::kFound || !AddDetour(curve, run)) {
      places_.clear();
      return spent;
    }
    t = run.t_out;
  }
  add_curve_until(curve.t_end());
  places_.push_back({curve.t_end(), curve.Position(curve.t_end())});
  return spent;
}

/// At a constant speed through the run's time.
bool CommittedWay::AddDetour(const UniformBspline& curve, const BlockedRun& run) {
  const double straight = (curve.Position(run.t_out) - curve.Position(run.t_in)).norm();
  const double length = PathLength(detour_);
  if (length > kLongestDetour * straight + kDetourSlack) return false;
  double gone = 0.0;
  for (std::size_t i = 0; i < detour_.size(); ++i) {
    if (i > 0) gone += (detour_[i] - detour_[i - 1]).norm();
    const double share = length > 0.0 ? gone / length : 0.0;
    places_.push_back({run.t_in + share * (run.t_out - run.t_in), detour_[i]});
  }
  return true;
}

Eigen::Vector3d CommittedWay::AtTime(double t) const {
  const auto later = std::upper_bound(places_.begin(), places_.end(), t,
                                      [](double a, const Place& b) { return a < b.t; });
  if (later == places_.begin()) return places_.front().p_W;
  if (later == places_.end()) return places_.back().p_W;
  const Place& before = *(later - 1);
  const double share = (t - before.t) / (later->t - before.t);
  return before.p_W + share * (later->p_W - before.p_W);
}

void CommittedWay::Sample(double from, double to, GuidePath* guide) const {
  const double t_from = TimeOf(from), t_to = TimeOf(to);
  guide->clear();
  guide->push_back(AtTime(t_from));
  for (const Place& place : places_) {
    if (place.t > t_from && place.t < t_to) guide->push_back(place.p_W);
  }
  guide->push_back(AtTime(t_to));
}

}  // namespace touchdown::planning
