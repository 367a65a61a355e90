// SPDX-License-Identifier: BSD-3-Clause
// The certificate of a plan. All checks are on the plan itself, after the solver and whatever the
// solver said.

#include "touchdown/planning/certify/certificate.h"

#include <algorithm>
#include <cmath>

#include "planning/map/voxel_traversal.h"
#include "touchdown/planning/certify/curve_check.h"

namespace touchdown::planning {

namespace {

/// The speed that the start fixes: its own, and V_1 = v0 + h a0 / 2 of the hull, which no solver can
/// change. A start just below the limit that still speeds up is beyond it by V_1.
double StartSpeed(const UniformBspline& curve) {
  const Eigen::Map<const ControlPoints> q = curve.control_points();
  return std::max(curve.AtKnot(0).v.norm(), (q.col(2) - q.col(1)).norm() / curve.interval());
}

/// Whether every segment's hull stays below the recovery profile of a start beyond the limits.
bool RecoveryProfileKept(const UniformBspline& curve, const Limits& limits) {
  const Eigen::Map<const ControlPoints> q = curve.control_points();
  const double h = curve.interval();
  const double v0 = StartSpeed(curve), a0 = curve.AtKnot(0).a.norm();
  for (int i = 0; i < curve.segments(); ++i) {
    const double t = i * h;  // the profile falls: the start of a segment is its loosest instant
    const double recovered = RecoveryProfile::kSpeedShare * limits.acceleration *
                             std::max(0.0, t - RecoveryProfile::kLag);
    const double v_allowed = std::max(limits.speed, v0 - recovered);
    // The acceleration may fade over the time that the recovery of the speed takes.
    const double a_allowed =
        std::max(limits.acceleration, a0 * (1.0 - RecoveryProfile::kAccelerationDecay * t));
    const SplineState from = curve.AtKnot(i), to = curve.AtKnot(i + 1);
    const double speed =
        std::max({from.v.norm(), to.v.norm(), (q.col(i + 2) - q.col(i + 1)).norm() / h});
    const double acceleration = std::max(from.a.norm(), to.a.norm());
    if (speed > v_allowed + kLimitSlack || acceleration > a_allowed + kLimitSlack) return false;
  }
  return true;
}

/// Distance from a point to the nearest occupied cell, up to the inflation radius.
double DistanceToOccupied(const OccupancyMap& map, const Eigen::Vector3d& p_W) {
  const double reach = map.options().inflation_radius;
  const double half = 0.5 * map.resolution();
  const CellIndex lo = map.CellOf(p_W.array() - reach), hi = map.CellOf(p_W.array() + reach);
  double nearest = reach;
  CellIndex cell;
  for (cell.z() = lo.z(); cell.z() <= hi.z(); ++cell.z()) {
    for (cell.y() = lo.y(); cell.y() <= hi.y(); ++cell.y()) {
      for (cell.x() = lo.x(); cell.x() <= hi.x(); ++cell.x()) {
        if (!map.IsOccupied(cell)) continue;
        const Eigen::Vector3d gap =
            ((p_W - map.CentreOf(cell)).cwiseAbs().array() - half).max(0.0).matrix();
        nearest = std::min(nearest, gap.norm());
      }
    }
  }
  return nearest;
}

// A start inside the inflated zone may leave it within this time [s] ...
constexpr double kEscapeTime = 1.5;
constexpr double kEscapeStep = 0.02;
// ... without coming back by more than this, or sinking more below the floor [m].
constexpr double kEscapeSlack = 0.02;

/// For a curve whose start is blocked: certifies that it only moves away until it is free, and is
/// free from there on. Fills `clearance` with the least distance on the way.
bool Escapes(const UniformBspline& curve, double t_from, const FreeSpace& space,
             double* clearance) {
  const Eigen::Vector3d start = curve.Position(t_from);
  double reached = DistanceToOccupied(*space.map, start);
  *clearance = reached;
  if (reached <= 0.0) return false;  // inside an obstacle: no way out can be proven
  for (double t = t_from; t <= std::min(t_from + kEscapeTime, curve.t_end()); t += kEscapeStep) {
    const Eigen::Vector3d p = curve.Position(t);
    if (!space.Blocked(p) && !std::isfinite(FirstBlockedTime(curve, t, space))) return true;
    const double distance = DistanceToOccupied(*space.map, p);
    const bool sinks = p.z() < std::min(space.floor, start.z() - kEscapeSlack);
    if (distance < reached - kEscapeSlack || (sinks && !space.OverPad(p))) return false;
    reached = std::max(reached, distance);
    *clearance = std::min(*clearance, distance);
  }
  return false;
}

}  // namespace

Certificate Certify(const UniformBspline& curve, double t_from, const SplineState* start,
                    const SplineState* wanted, const Limits& limits, const FreeSpace& space) {
  Certificate c;
  if (start) {
    const FlatState at = curve.Evaluate(t_from);
    c.start_position_residual = (at.p_WB - start->p).norm();
    c.start_velocity_residual = (at.v_WB - start->v).norm();
  }
  c.endpoint_required = wanted != nullptr;
  if (wanted) {
    const SplineState end = curve.AtKnot(curve.segments());
    c.endpoint_position_residual = (end.p - wanted->p).norm();
    c.endpoint_velocity_residual = (end.v - wanted->v).norm();
  }
  const DerivativeBounds bounds = BoundDerivatives(curve, limits.pull_W);
  c.speed_bound = bounds.speed;
  c.acceleration_bound = bounds.acceleration;
  c.body_rate_bound = bounds.body_rate;
  const bool turns = bounds.body_rate <= limits.body_rate + kLimitSlack;
  c.limits_kept = turns && bounds.speed <= limits.speed + kLimitSlack &&
                  bounds.acceleration <= limits.acceleration + kLimitSlack;
  c.recovering = !c.limits_kept && (StartSpeed(curve) > limits.speed + kLimitSlack ||
                                    curve.AtKnot(0).a.norm() > limits.acceleration + kLimitSlack);
  if (c.recovering) c.limits_kept = turns && RecoveryProfileKept(curve, limits);

  const double hit = FirstBlockedTime(curve, t_from, space);
  c.clear = !std::isfinite(hit);
  c.first_hit_t = c.clear ? 0.0 : hit;
  c.clearance = space.map->options().inflation_radius;
  if (!c.clear && space.Blocked(curve.Position(t_from))) {
    c.escaping = Escapes(curve, t_from, space, &c.clearance);
  }
  return c;
}

}  // namespace touchdown::planning
