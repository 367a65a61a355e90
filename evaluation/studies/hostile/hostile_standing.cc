// SPDX-License-Identifier: BSD-3-Clause
// Families in which the pad stands where it is hard to see, or far away.
#include <cmath>

#include "evaluation/studies/hostile/hostile_family.h"
#include "evaluation/studies/hostile/hostile_world.h"

namespace touchdown::evaluation {
namespace {

constexpr double kAheadOfPad = 1.3;       // least distance of walls from a pad's centre [m]
constexpr double kLongestFlight = 600.0;  // that a scenario may last [s]
constexpr double kSlowly = 0.5;           // more time for a far pad [m/s]

void StandAt(double x, double y, sim::RandomStream& draw, Scenario* s) {
  s->pad.motion = "static";
  s->pad.start << x, y;
  s->pad.heading_deg = DrawIn(draw, {-180.0, 180.0});
}

// A building around (x, y), open to one side: the walls' inner faces are half_x and half_y away. `open`: 0 to -x, to
// the start; 1 to -y; 2 to +x, away from it.
void AddPocket(double x, double y, double half_x, double half_y, double wall, double top, int open,
               Scenario* s) {
  const Span across = {y - half_y - wall, y + half_y + wall};
  const Span along = {x - half_x, x + half_x};
  if (open != 0) AddBox({x - half_x - wall, x - half_x}, across, 0.0, top, s);
  if (open != 1) AddBox(along, {y - half_y - wall, y - half_y}, 0.0, top, s);
  if (open != 2) AddBox({x + half_x, x + half_x + wall}, across, 0.0, top, s);
  AddBox(along, {y + half_y, y + half_y + wall}, 0.0, top, s);
}

}  // namespace

void MakeBelow(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  StandAt(0.0, 0.0, draw, s);
  const int posts = DrawOneOf(draw, 5);
  for (int i = 0; i < posts; ++i) {
    const double angle = DrawIn(draw, {0.0, 6.283}), far = DrawIn(draw, {2.2, 5.0});
    AddPost(far * std::cos(angle), far * std::sin(angle), DrawIn(draw, {0.1, 0.5}),
            DrawIn(draw, {1.0, kTallWall}), s);
  }
  StartAt(DrawIn(draw, {-0.8, 0.8}), DrawIn(draw, {-0.8, 0.8}),
          s->pad.deck_height + DrawIn(draw, {1.5, 5.0}), DrawIn(draw, {-180.0, 180.0}), s);
}

void MakeClearing(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double x = DrawIn(draw, {7.0, 14.0}), radius = DrawIn(draw, {1.6, 3.0});
  StandAt(x, 0.0, draw, s);
  const int around = 5 + DrawOneOf(draw, 6);
  const double first = DrawIn(draw, {0.0, 6.283});
  for (int i = 0; i < around; ++i) {
    const double angle = first + 6.283 * (i + DrawIn(draw, {-0.2, 0.2})) / around;
    const double half = 0.5 * DrawIn(draw, {0.4, 0.9}), far = radius + half * std::sqrt(2.0);
    const double px = x + far * std::cos(angle), py = far * std::sin(angle);
    AddBox({px - half, px + half}, {py - half, py + half}, 0.0, DrawIn(draw, {2.0, kTallWall}), s);
  }
  const int before = DrawOneOf(draw, 6);
  for (int i = 0; i < before; ++i) {
    AddPost(DrawIn(draw, {1.5, x - 5.0}), DrawIn(draw, {-3.0, 3.0}), DrawIn(draw, {0.3, 0.8}),
            kTallWall, s);
  }
  StartAt(0.0, DrawIn(draw, {-2.0, 2.0}), DrawIn(draw, {1.2, 3.0}), DrawIn(draw, {-45.0, 45.0}), s);
  s->planning.ceiling = kLowCeiling;
}

void MakeNiche(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double half_x = DrawIn(draw, {kAheadOfPad, 2.2}), half_y = DrawIn(draw, {kAheadOfPad, 2.2});
  const double x = DrawIn(draw, {6.0, 11.0}) + half_x, y = DrawIn(draw, {-2.0, 2.0});
  StandAt(x, y, draw, s);
  AddPocket(x, y, half_x, half_y, DrawIn(draw, {0.2, 0.5}), DrawIn(draw, {1.5, kTallWall}),
            DrawOneOf(draw, 3), s);
  StartAt(0.0, 0.0, DrawIn(draw, {1.2, 3.0}), DrawIn(draw, {-60.0, 60.0}), s);
  s->planning.ceiling = kLowCeiling;
}

void MakeGarage(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double half_x = DrawIn(draw, {1.5, 2.5}), half_y = DrawIn(draw, {1.5, 2.5});
  const double x = DrawIn(draw, {5.0, 9.0}) + half_x, y = DrawIn(draw, {-2.0, 2.0});
  StandAt(x, y, draw, s);
  const double wall = DrawIn(draw, {0.2, 0.4});
  const double base = s->pad.deck_height + DrawIn(draw, {1.5, 2.4});
  AddPocket(x, y, half_x, half_y, wall, base, DrawOneOf(draw, 3), s);
  AddBox({x - half_x - wall, x + half_x + wall}, {y - half_y - wall, y + half_y + wall}, base,
         base + DrawIn(draw, {0.2, 0.4}), s);
  StartAt(0.0, 0.0, DrawIn(draw, {1.2, 3.0}), DrawIn(draw, {-60.0, 60.0}), s);
  s->planning.ceiling = kLowCeiling;
}

// A corridor in which one flies over and under walls in turn.
void MakeLimbo(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double half = 0.5 * DrawIn(draw, {2.6, 4.0}), wall = 0.3;
  const int things = 2 + DrawOneOf(draw, 3);
  bool low = DrawChance(draw, 0.5);
  double x = DrawIn(draw, {1.8, 2.8});
  for (int i = 0; i < things; ++i, low = !low) {
    const Span along = {x, x + DrawIn(draw, {0.1, 0.4})};
    if (low) AddBox(along, {-half, half}, 0.0, DrawIn(draw, {1.4, 2.3}), s);
    if (!low) AddBox(along, {-half, half}, DrawIn(draw, {1.4, 1.9}), kTallWall, s);
    x += DrawIn(draw, {2.4, 3.5});
  }
  for (const double side : {-1.0, 1.0}) {
    const double inner = side * half, outer = side * (half + wall);
    AddWall({-2.0, x - 1.0}, {std::fmin(inner, outer), std::fmax(inner, outer)}, s);
  }
  AddWall({-2.0 - wall, -2.0}, {-half - wall, half + wall}, s);
  StartAt(0.0, DrawIn(draw, {-0.3, 0.3}), DrawIn(draw, {1.2, 2.5}), DrawIn(draw, {-20.0, 20.0}), s);
  s->planning.ceiling = kLowCeiling;
  if (DrawChance(draw, 0.5)) return LaneBeyond(x - 1.5, draw, s);
  StandAt(x + DrawIn(draw, {1.0, 3.0}), DrawIn(draw, {-1.0, 1.0}), draw, s);
}

void MakeWideWall(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double x = DrawIn(draw, {3.0, 7.0}), half = DrawIn(draw, {8.0, 40.0});
  const double aside = DrawIn(draw, {-0.5, 0.5}) * half;
  AddBox({x, x + DrawIn(draw, {0.2, 0.6})}, {aside - half, aside + half}, 0.0,
         DrawIn(draw, {2.0, 6.0}), s);
  StartAt(0.0, 0.0, DrawIn(draw, {1.2, 3.0}), DrawIn(draw, {-60.0, 60.0}), s);
  if (DrawChance(draw, 0.5)) return LaneBeyond(x + 0.6, draw, s);
  StandAt(x + DrawIn(draw, {2.5, 8.0}), DrawIn(draw, {-3.0, 3.0}), draw, s);
}

void MakeFar(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double x = DrawIn(draw, {40.0, 90.0});
  StandAt(x, DrawIn(draw, {-10.0, 10.0}), draw, s);
  s->timeout = std::fmin(kLongestFlight, s->timeout + x / kSlowly);
  const int houses = DrawOneOf(draw, 8);
  for (int i = 0; i < houses; ++i) {
    const double at = DrawIn(draw, {5.0, x - 8.0}), y = DrawIn(draw, {-8.0, 8.0});
    const double half_x = 0.5 * DrawIn(draw, {0.5, 5.0}), half_y = 0.5 * DrawIn(draw, {0.5, 8.0});
    AddBox({at - half_x, at + half_x}, {y - half_y, y + half_y}, 0.0, DrawIn(draw, {2.0, 8.0}), s);
  }
  StartAt(0.0, 0.0, DrawIn(draw, {1.2, 3.0}), DrawIn(draw, {-60.0, 60.0}), s);
}

// The start is on a floor above the pad: the way leads down beside its edge.
void MakeTwoFloors(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double base = s->pad.deck_height + DrawIn(draw, {2.0, 3.0}), top = base + 0.3;
  const double half = DrawIn(draw, {2.5, 4.0});
  StandAt(0.0, 0.0, draw, s);
  AddBox({-half, half}, {-half, half}, base, top, s);
  const double wall = 0.3;
  const int walls = DrawOneOf(draw, 3);  // below the floor: the way leads to the side that is open
  if (walls > 0) AddBox({-half, half}, {-half - wall, -half}, 0.0, base, s);
  if (walls > 1) AddBox({-half - wall, -half}, {-half, half}, 0.0, base, s);
  StartAt(DrawIn(draw, {-1.0, 1.0}), DrawIn(draw, {-1.0, 1.0}), top + DrawIn(draw, {1.0, 1.6}),
          DrawIn(draw, {-180.0, 180.0}), s);
}

void MakeSkylight(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double half = DrawIn(draw, {1.8, 3.0}), wall = 0.3;
  const double x = DrawIn(draw, {4.0, 8.0}) + half;
  const double base = s->pad.deck_height + DrawIn(draw, {1.6, 2.4}), top = base + 0.2;
  StandAt(x, 0.0, draw, s);
  for (const double side : {-1.0, 1.0}) {
    const double inner = side * half, outer = side * (half + wall);
    const Span span = {std::fmin(inner, outer), std::fmax(inner, outer)};
    AddBox({x + span.lo, x + span.hi}, {-half - wall, half + wall}, 0.0, top, s);
    AddBox({x - half, x + half}, span, 0.0, top, s);
  }
  const double hole = 0.5 * DrawIn(draw, {1.6, 2.6});
  const double hx = x + DrawIn(draw, {-1.0, 1.0}) * (half - hole),
               hy = DrawIn(draw, {-1.0, 1.0}) * (half - hole);
  AddBox({x - half, hx - hole}, {-half, half}, base, top, s);
  AddBox({hx + hole, x + half}, {-half, half}, base, top, s);
  AddBox({hx - hole, hx + hole}, {-half, hy - hole}, base, top, s);
  AddBox({hx - hole, hx + hole}, {hy + hole, half}, base, top, s);
  StartAt(0.0, DrawIn(draw, {-2.0, 2.0}), DrawIn(draw, {1.2, 3.0}), DrawIn(draw, {-60.0, 60.0}), s);
}

}  // namespace touchdown::evaluation
