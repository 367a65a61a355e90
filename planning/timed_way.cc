// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/planning/timed_way.h"

#include <algorithm>
#include <limits>

namespace touchdown::planning {

namespace {

constexpr double kStep = 0.05;  // sampling of a curve [s]
constexpr std::size_t kUsualPlaces = 2048;
constexpr std::size_t kUsualParts = 64;

double LengthOf(const UniformBspline& curve, double from, double to) {
  constexpr int kChords = 24;
  double length = 0.0;
  Eigen::Vector3d last = curve.Position(from);
  for (int i = 1; i <= kChords; ++i) {
    const Eigen::Vector3d p = curve.Position(from + i * (to - from) / kChords);
    length += (p - last).norm();
    last = p;
  }
  return length;
}

}  // namespace

TimedWay::TimedWay() {
  places_.reserve(kUsualPlaces);
  bound_.reserve(kUsualParts);
}

void TimedWay::Clear() {
  places_.clear();
  bound_.clear();
  delay_ = 0.0;
}

void TimedWay::AddCurve(const UniformBspline& curve, double from, double to) {
  for (double t = from; t < to; t += kStep) places_.push_back({t + delay_, curve.Position(t)});
  places_.push_back({to + delay_, curve.Position(to)});
}

void TimedWay::AddDetour(const UniformBspline& curve, const BlockedRun& run, const GuidePath& path,
                         double speed) {
  const double length = PathLength(path);
  const double from = run.t_in + delay_;
  delay_ += std::max(0.0, length - LengthOf(curve, run.t_in, run.t_out)) / speed;
  const double to = run.t_out + delay_;
  double gone = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0) gone += (path[i] - path[i - 1]).norm();
    const double share = length > 0.0 ? gone / length : 0.0;
    places_.push_back({from + share * (to - from), path[i]});
  }
  bound_.push_back({from, to});
}

Eigen::Vector3d TimedWay::At(double t) const {
  const auto later = std::upper_bound(places_.begin(), places_.end(), t,
                                      [](double a, const Place& b) { return a < b.t; });
  if (later == places_.begin()) return places_.front().p_W;
  if (later == places_.end()) return places_.back().p_W;
  const Place& before = *(later - 1);
  const double share = (t - before.t) / (later->t - before.t);
  return before.p_W + share * (later->p_W - before.p_W);
}

void TimedWay::Sample(double from, double to, GuidePath* path) const {
  path->clear();
  path->push_back(At(from));
  for (const Place& place : places_) {
    if (place.t > from && place.t < to) path->push_back(place.p_W);
  }
  path->push_back(At(to));
}

bool TimedWay::SampleBetween(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W,
                             GuidePath* path) const {
  const double from = NearestTo(from_W), to = NearestTo(to_W);
  if (!(from < to)) return false;
  Sample(from, to, path);
  return true;
}

/// When the way is nearest to a place.
double TimedWay::NearestTo(const Eigen::Vector3d& p_W) const {
  double t = t0(), nearest2 = (p_W - places_.front().p_W).squaredNorm();
  for (std::size_t i = 1; i < places_.size(); ++i) {
    const Place &a = places_[i - 1], &b = places_[i];
    const Eigen::Vector3d side = b.p_W - a.p_W;
    const double length2 = side.squaredNorm();
    const double share =
        length2 > 0.0 ? std::clamp((p_W - a.p_W).dot(side) / length2, 0.0, 1.0) : 0.0;
    const double distance2 = (a.p_W + share * side - p_W).squaredNorm();
    if (distance2 >= nearest2) continue;
    nearest2 = distance2;
    t = a.t + share * (b.t - a.t);
  }
  return t;
}

}  // namespace touchdown::planning
