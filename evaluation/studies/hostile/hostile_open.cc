// SPDX-License-Identifier: BSD-3-Clause
// Families in the open: thin things, things close to the start, a far thing at full speed.
#include <cmath>

#include "estimation/base/degrees.h"
#include "evaluation/studies/hostile/hostile_family.h"
#include "evaluation/studies/hostile/hostile_world.h"

namespace touchdown::evaluation {
namespace {

constexpr double kPoleGap = 1.0;  // least distance of two poles [m]
constexpr int kPoleTries = 200;   // places that are looked at for all poles

bool FarFromPoles(const Eigen::Vector2d& p, const Scenario& s) {
  for (const CylinderObstacle& pole : s.cylinders) {
    if ((pole.centre - p).norm() < kPoleGap) return false;
  }
  return true;
}

}  // namespace

void MakePoles(const WorldRequest& request, sim::RandomStream& draw, Scenario* s) {
  const std::size_t poles = 8 + static_cast<std::size_t>(DrawOneOf(draw, 13));
  const Span diameters =
      request.thin_poles ? Span{kThinnestPole, kPromisedPole} : Span{kPromisedPole, kThickestPole};
  const double end = DrawIn(draw, {6.0, 9.0});
  for (int i = 0; i < kPoleTries && s->cylinders.size() < poles; ++i) {
    const Eigen::Vector2d p(DrawIn(draw, {1.5, end}), DrawIn(draw, {-3.5, 3.5}));
    const double diameter = DrawIn(draw, diameters), height = DrawIn(draw, {2.0, kTallWall});
    if (FarFromPoles(p, *s)) AddPost(p.x(), p.y(), diameter, height, s);
  }
  StartAt(0.0, DrawIn(draw, {-1.0, 1.0}), DrawIn(draw, {1.2, 3.0}), DrawIn(draw, {-30.0, 30.0}), s);
  s->planning.ceiling = kLowCeiling;
  LaneBeyond(end, draw, s);
}

void MakeNearStart(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  StartAt(0.0, 0.0, DrawIn(draw, {1.2, 3.0}), DrawIn(draw, {-180.0, 180.0}), s);
  const double first = DrawIn(draw, {0.0, 360.0});
  const int things = 2 + DrawOneOf(draw, 4);
  for (int i = 0; i < things; ++i) {
    const double bearing = (first + DrawIn(draw, {0.0, 200.0})) * estimation::kRadPerDeg;
    const double room = DrawIn(draw, {kTakeOffRoom, 1.4});
    const double half = 0.5 * DrawIn(draw, {0.1, 0.8});
    const double height = DrawChance(draw, 0.7) ? kTallWall : DrawIn(draw, {0.8, 2.5});
    const Eigen::Vector2d ahead(std::cos(bearing), std::sin(bearing));
    if (DrawChance(draw, 0.5)) {
      AddPost((room + half) * ahead.x(), (room + half) * ahead.y(), 2.0 * half, height, s);
      continue;
    }
    // Out along the bearing until the box's nearest point is so far away.
    double reach = room + half;
    const auto gap = [&](double r) {
      const Eigen::Vector2d corner = ((r * ahead).cwiseAbs().array() - half).cwiseMax(0.0).matrix();
      return corner.norm();
    };
    while (gap(reach) < room) reach += 0.01;
    const Eigen::Vector2d p = reach * ahead;
    AddBox({p.x() - half, p.x() + half}, {p.y() - half, p.y() + half}, 0.0, height, s);
  }
  s->planning.ceiling = kLowCeiling;
  LaneBeyond(2.5, draw, s);
}

void MakeWideField(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  s->limits.speed = DrawIn(draw, {3.0, 6.0});
  const double x = DrawIn(draw, {8.0, 15.0}), y = DrawIn(draw, {-0.5, 0.5});
  if (DrawChance(draw, 0.5)) {
    const double half = 0.5 * DrawIn(draw, {0.5, 4.0}), thickness = DrawIn(draw, {0.2, 2.0});
    AddWall({x, x + thickness}, {y - half, y + half}, s);
  } else {
    AddPost(x, y, DrawIn(draw, {kPromisedPole, 0.3}), kTallWall, s);
  }
  StartAt(0.0, 0.0, DrawIn(draw, {1.5, 3.0}), DrawIn(draw, {-10.0, 10.0}), s);
  s->planning.ceiling = kLowCeiling;
  LaneBeyond(x + DrawIn(draw, {3.0, 8.0}), draw, s);
}

}  // namespace touchdown::evaluation
