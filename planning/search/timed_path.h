// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "planning/search/grid_search.h"
#include "touchdown/planning/certify/curve_check.h"
#include "touchdown/planning/problem/bound_part.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// Of a curve between two of its times, by 24 chords [m].
double LengthOf(const UniformBspline& curve, double from, double to);

/// A path for a curve to follow: places in time along another curve, with detours past what blocks that. Times are the
/// other curve's, delayed by the detours' extra time. A curve has to be bound to the parts that the detours replace.
/// Allocates only to grow to a high-water mark.
class TimedPath {
 public:
  TimedPath();

  void Clear();

  /// On along the curve, from `from` [s] on until `to`, both in the curve's time.
  void AddCurve(const UniformBspline& curve, double from, double to);

  /// The path replaces the curve in `run`, at a constant speed. Its extra length takes its time at `speed` [m/s].
  void AddDetour(const UniformBspline& curve, const BlockedRun& run, const GuidePath& path,
                 double speed);

  bool known() const { return !places_.empty(); }
  double t0() const { return places_.front().t; }
  double t_end() const { return places_.back().t; }
  /// Extra time of the detours [s].
  double delay() const { return delay_; }

  /// Stretches that a curve has to be bound to, in the path's time.
  const BoundParts& bound() const { return bound_; }
  void Bind(const BoundPart& part) { bound_.push_back(part); }

  /// Where the path is at a time, clamped to it. @pre known().
  Eigen::Vector3d At(double t) const;

  /// At a share of its time, in [0, 1]. @pre known().
  Eigen::Vector3d AtShare(double share) const { return At(t0() + share * (t_end() - t0())); }

  /// From one time to a later one, at least two places. @pre known().
  void Sample(double from, double to, GuidePath* path) const;

  /// Beside a stretch of a curve that follows it: from where it is nearest to the stretch's start to where it is
  /// nearest to its end. If these are not in order, at the same shares of time. @pre known().
  void SampleBeside(const UniformBspline& curve, const BlockedRun& run, GuidePath* path) const;

  /// The path's time at a time of the curve that it follows: later by the detours before it.
  double TimeOf(double curve_t) const;

  /// Of the path in this part of its time [m]. @pre known().
  double LengthOf(const BoundPart& part) const;

 private:
  struct Place {
    double t;
    Eigen::Vector3d p_W;
  };

  // In the time of the curve, and how late the path is before and behind.
  struct Detour {
    double from, to;
    double late_before, late_behind;
  };

  double NearestTo(const Eigen::Vector3d& p_W) const;

  std::vector<Place> places_;  // in order of time
  BoundParts bound_;
  std::vector<Detour> detours_;
  double delay_ = 0.0;
};

}  // namespace touchdown::planning
