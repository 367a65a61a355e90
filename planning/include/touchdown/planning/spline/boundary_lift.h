// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "touchdown/planning/spline/endpoint.h"
#include "touchdown/planning/spline/uniform_bspline.h"
#include "touchdown/solvers/problem/affine_lift.h"

namespace touchdown::planning {

/// Control points of the spline with `segments` segments of length `duration` that meets both end
/// states exactly. Between them it follows the quintic Hermite polynomial. For the first guess, and
/// for braking and climbing trajectories.
ControlPoints HermiteControlPoints(const SplineState& start, const SplineState& end, int segments,
                                   double duration);

/// The same for as many segments as `points` (at least 7 columns) has room for. Does not allocate.
void HermiteControlPoints(const SplineState& start, const SplineState& end, double duration,
                          Eigen::Ref<ControlPoints> points);

/// The weights of the end values (p0, h v0, h^2 a0, P, h V, h^2 A) in one control point.
struct BoundaryWeights {
  using Column = std::array<Eigen::Vector3d, 6>;
  std::array<double, 6> of;
};

/// Exact elimination of both ends, with the boundary lift (docs/formulation.md):
///   Q_0..Q_2 from (p0, v0, a0),  Q_i = quintic_i + y_i between,
///   Q_{N-3}..Q_{N-1} from (P, V, delta).
/// If the end acceleration is free, delta is the last reduced block. If it is fixed,
/// delta = -h^2 A / 6 with the pad's own acceleration A. The pad's snap is not predicted. So with a
/// fixed end acceleration second derivatives with respect to a free h lack its share.
/// As LiftOffset it gives the offsets and their derivatives with respect to the interval. The
/// arrival time t0 + M h moves with the interval. Reads the pad prediction at every call.
class BoundaryLift : public solvers::LiftOffset {
 public:
  /// Throws std::invalid_argument unless segments >= 4.
  BoundaryLift(int segments, bool free_end_acceleration);

  /// The pad prediction must outlive every later call of At, which before Set gives NaN.
  void Set(const SplineState& start, double t0, const estimation::PadPrediction& pad,
           const EndpointTarget& target);

  /// Structure of the elimination. Its `offset` is left null: the owner sets it to this object.
  solvers::AffineLift Structure() const;

  void At(double h, double* l, double* dl, double* d2l) const noexcept override;

 private:
  int segments_;
  bool free_end_acceleration_;
  std::vector<BoundaryWeights> weights_;  // [control point]
  SplineState start_;
  double t0_ = 0.0;
  const estimation::PadPrediction* pad_ = &estimation::UnknownPad();
  EndpointTarget target_;
};

}  // namespace touchdown::planning
