// SPDX-License-Identifier: BSD-3-Clause
// Ray against box and cylinder. Both are intersections of convex pieces (three slabs; one slab and
// an infinite cylinder), so the ray is inside for one interval [enter, leave] of its parameter: the
// intersection of the pieces' intervals (the slab method, Kay and Kajiya, SIGGRAPH 1986).

#include "touchdown/sim/ray_intersection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchdown::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Interval {
  double enter = -kInfinity;
  double leave = kInfinity;

  double FirstCrossing() const {
    if (!(enter <= leave) || leave < 0.0) return kInfinity;
    return enter >= 0.0 ? enter : leave;
  }
};

// Cuts the interval to where |origin + s direction| <= half_extent along one axis.
void CutBySlab(double half_extent, double origin, double direction, Interval* interval) {
  if (direction == 0.0) {
    if (std::abs(origin) > half_extent) interval->leave = -kInfinity;
    return;
  }
  const double inverse = 1.0 / direction;
  const double near = -(origin + std::copysign(half_extent, direction)) * inverse;
  const double far = (std::copysign(half_extent, direction) - origin) * inverse;
  interval->enter = std::max(interval->enter, near);
  interval->leave = std::min(interval->leave, far);
}

}  // namespace

double RayBox(const Eigen::Vector3d& half_extents, const Eigen::Vector3d& origin,
              const Eigen::Vector3d& direction) {
  Interval inside;
  for (int axis = 0; axis < 3; ++axis) {
    CutBySlab(half_extents[axis], origin[axis], direction[axis], &inside);
  }
  return inside.FirstCrossing();
}

double RayCylinder(double radius, double half_height, const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction) {
  Interval inside;
  CutBySlab(half_height, origin.z(), direction.z(), &inside);
  // a s^2 + 2 b s + c <= 0 where the ray is within the infinite cylinder.
  const double a = direction.head<2>().squaredNorm();
  const double b = origin.head<2>().dot(direction.head<2>());
  const double c = origin.head<2>().squaredNorm() - radius * radius;
  if (a == 0.0) {
    if (c > 0.0) return kInfinity;
  } else {
    const double discriminant = b * b - a * c;
    if (discriminant < 0.0) return kInfinity;
    const double root = std::sqrt(discriminant);
    inside.enter = std::max(inside.enter, (-b - root) / a);
    inside.leave = std::min(inside.leave, (-b + root) / a);
  }
  return inside.FirstCrossing();
}

}  // namespace touchdown::sim
