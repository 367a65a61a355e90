// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/planning/certificate.h"
#include "touchdown/planning/free_space.h"
#include "touchdown/planning/replan_result.h"
#include "touchdown/planning/uniform_bspline.h"

namespace touchdown::planning {

/// What is flown where no new plan could be certified. Does not allocate.
class Fallback {
 public:
  Fallback(const Limits& limits, double reaction);

  /// True if the committed curve may go on from t0 [s], where the vehicle is in the state `start` of it: at
  /// rest and free, or clear for longer than braking takes and slow enough for what was observed. Fills
  /// status, curve and certificate of `result` if so.
  bool KeepsCommitted(const UniformBspline& committed, double t0, const SplineState& start,
                      const FreeSpace& space, ReplanResult* result);

  /// Out of an inflated zone first; else the climb [m] that the caller wants, if > 0; else brake; else
  /// climb. Fills status, curve and certificate; kUnsafe if nothing of it is certified.
  void ComeToRest(double t0, const SplineState& start, double climb, const FreeSpace& space,
                  ReplanResult* result) const;

  /// The start itself leads into an obstacle: arriving later does not change that.
  bool NoTimeToBrake(const SplineState& start, const FreeSpace& space);

  /// The vehicle is at rest, and so it remains on the committed curve.
  static bool Stays(const UniformBspline& committed, const SplineState& start);

 private:
  bool TryRest(double t0, const SplineState& start, const Eigen::Vector3d& shift,
               const FreeSpace& space, ReplanResult* result) const;

  Limits limits_;
  double reaction_;
  UniformBspline braking_;
};

}  // namespace touchdown::planning
