// SPDX-License-Identifier: BSD-3-Clause
// Ray against box and cylinder. Both are intersections of convex pieces: three slabs, or one slab
// and an infinite cylinder. So the ray is inside for one interval [enter, leave] of its parameter.
// This is the intersection of the pieces' intervals (the slab method, Kay and Kajiya, SIGGRAPH
// 1986). A capsule is the convex union of a cylinder and two balls: its interval spans theirs.

#include "sim/obstacles/ray_intersection.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace touchdown::sim {
namespace {

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

// Interval where a s^2 + 2 b s + c <= 0. For a = 0 (the ray does not move) it is everything or
// nothing.
Interval WhereNegative(double a, double b, double c) {
  if (a == 0.0) return c > 0.0 ? Interval{kInfinity, -kInfinity} : Interval{};
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return {kInfinity, -kInfinity};
  const double root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
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
  const Interval round =
      WhereNegative(direction.head<2>().squaredNorm(), origin.head<2>().dot(direction.head<2>()),
                    origin.head<2>().squaredNorm() - radius * radius);
  inside.enter = std::max(inside.enter, round.enter);
  inside.leave = std::min(inside.leave, round.leave);
  return inside.FirstCrossing();
}

double RayBall(double radius, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  return WhereNegative(direction.squaredNorm(), origin.dot(direction),
                       origin.squaredNorm() - radius * radius)
      .FirstCrossing();
}

// T. Moeller and B. Trumbore, Fast, minimum storage ray/triangle intersection, 1997.
double RayTriangle(const Triangle& triangle, const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction) {
  constexpr double kEdge = 1e-12;  // no ray slips through between two triangles
  const Eigen::Vector3d h = direction.cross(triangle.ac);
  const double det = triangle.ab.dot(h);
  if (det == 0.0) return kInfinity;
  const double inverse = 1.0 / det;
  const Eigen::Vector3d from = origin - triangle.a;
  const double u = from.dot(h) * inverse;
  if (!(u >= -kEdge && u <= 1.0 + kEdge)) return kInfinity;
  const Eigen::Vector3d q = from.cross(triangle.ab);
  const double v = direction.dot(q) * inverse;
  if (!(v >= -kEdge && u + v <= 1.0 + kEdge)) return kInfinity;
  const double s = triangle.ac.dot(q) * inverse;
  return s >= 0.0 ? s : kInfinity;
}

double RayCapsule(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius,
                  const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  Interval inside{kInfinity, -kInfinity};
  const auto join = [&inside](const Interval& piece) {
    if (!(piece.enter <= piece.leave)) return;
    inside.enter = std::min(inside.enter, piece.enter);
    inside.leave = std::max(inside.leave, piece.leave);
  };
  for (const Eigen::Vector3d& end : {a, b}) {
    const Eigen::Vector3d m = origin - end;
    join(WhereNegative(direction.squaredNorm(), m.dot(direction),
                       m.squaredNorm() - radius * radius));
  }
  // The cylinder between the ends, from the middle: across its axis a circle, along it a slab.
  const Eigen::Vector3d axis = (b - a).normalized();
  const Eigen::Vector3d m = origin - 0.5 * (a + b);
  const Eigen::Vector3d across = m - m.dot(axis) * axis;
  const Eigen::Vector3d sideways = direction - direction.dot(axis) * axis;
  Interval tube = WhereNegative(sideways.squaredNorm(), across.dot(sideways),
                                across.squaredNorm() - radius * radius);
  CutBySlab(0.5 * (b - a).norm(), m.dot(axis), direction.dot(axis), &tube);
  join(tube);
  return inside.FirstCrossing();
}

}  // namespace touchdown::sim
