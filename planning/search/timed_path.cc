// SPDX-License-Identifier: BSD-3-Clause
#include "planning/search/timed_path.h"

#include <algorithm>
#include <limits>

namespace touchdown::planning {

namespace {

constexpr double kStep = 0.05;  // sampling of a curve [s]
constexpr std::size_t kPlacesReserve = 2048;
constexpr std::size_t kUsualParts = 64;

}  // namespace

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

TimedPath::TimedPath() {
  places_.reserve(kPlacesReserve);
  bound_.reserve(kUsualParts);
  detours_.reserve(kUsualParts);
}

void TimedPath::Clear() {
  places_.clear();
  bound_.clear();
  detours_.clear();
  delay_ = 0.0;
}

void TimedPath::AddCurve(const UniformBspline& curve, double from, double to) {
  for (double t = from; t < to; t += kStep) places_.push_back({t + delay_, curve.Position(t)});
  places_.push_back({to + delay_, curve.Position(to)});
}

void TimedPath::AddDetour(const UniformBspline& curve, const BlockedRun& run, const GuidePath& path,
                          double speed) {
  const double length = PathLength(path);
  const double late_before = delay_, from = run.t_in + delay_;
  delay_ +=
      std::max(0.0, length - touchdown::planning::LengthOf(curve, run.t_in, run.t_out)) / speed;
  const double to = run.t_out + delay_;
  double gone = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0) gone += (path[i] - path[i - 1]).norm();
    const double share = length > 0.0 ? gone / length : 0.0;
    places_.push_back({from + share * (to - from), path[i]});
  }
  bound_.push_back({from, to});
  detours_.push_back({run.t_in, run.t_out, late_before, delay_});
}

Eigen::Vector3d TimedPath::At(double t) const {
  const auto later = std::upper_bound(places_.begin(), places_.end(), t,
                                      [](double a, const Place& b) { return a < b.t; });
  if (later == places_.begin()) return places_.front().p_W;
  if (later == places_.end()) return places_.back().p_W;
  const Place& before = *(later - 1);
  const double share = (t - before.t) / (later->t - before.t);
  return before.p_W + share * (later->p_W - before.p_W);
}

void TimedPath::Sample(double from, double to, GuidePath* path) const {
  path->clear();
  path->push_back(At(from));
  for (const Place& place : places_) {
    if (place.t > from && place.t < to) path->push_back(place.p_W);
  }
  path->push_back(At(to));
}

void TimedPath::SampleBeside(const UniformBspline& curve, const BlockedRun& run,
                             GuidePath* path) const {
  double from = NearestTo(curve.Position(run.t_in)), to = NearestTo(curve.Position(run.t_out));
  if (!(from < to)) {
    const double share = (t_end() - t0()) / curve.duration();
    from = t0() + share * (run.t_in - curve.t0());
    to = t0() + share * (run.t_out - curve.t0());
  }
  Sample(from, to, path);
}

double TimedPath::TimeOf(double curve_t) const {
  double late = 0.0;
  for (const Detour& detour : detours_) {
    if (curve_t <= detour.from) break;
    const double gone = std::min(1.0, (curve_t - detour.from) / (detour.to - detour.from));
    late = detour.late_before + gone * (detour.late_behind - detour.late_before);
  }
  return curve_t + late;
}

double TimedPath::LengthOf(const BoundPart& part) const {
  Eigen::Vector3d last = At(part.from);
  double length = 0.0;
  for (const Place& place : places_) {
    if (!(place.t > part.from && place.t < part.to)) continue;
    length += (place.p_W - last).norm();
    last = place.p_W;
  }
  return length + (At(part.to) - last).norm();
}

/// When the path is nearest to a place.
double TimedPath::NearestTo(const Eigen::Vector3d& p_W) const {
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
