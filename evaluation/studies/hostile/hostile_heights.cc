// SPDX-License-Identifier: BSD-3-Clause
// Families in which obstacles do not reach from the ground to the ceiling.
#include <cmath>

#include "evaluation/studies/hostile/hostile_family.h"
#include "evaluation/studies/hostile/hostile_world.h"

namespace touchdown::evaluation {
namespace {

constexpr double kBridgeHalf = 8.0;  // half length of what spans the way [m]
constexpr double kNearestLow =
    0.32;  // low things from the deck's edge: less is on the deck's way [m]

// A low wall or post beside the straight lane at x, `gap` from the deck's edge, to the side `side`.
void AddLowThing(double x, double length, double half_deck, double side, sim::RandomStream& draw,
                 Scenario* s) {
  const double gap = DrawIn(draw, {kNearestLow, 2.0}), height = DrawIn(draw, {0.2, 0.8});
  const double y = DrawIn(draw, {-0.4, 0.4}) * length;
  const double near = half_deck + gap;
  if (DrawChance(draw, 0.5)) {
    const double diameter = DrawIn(draw, {0.1, 0.4});
    AddPost(x + side * (near + 0.5 * diameter), y, diameter, height, s);
    return;
  }
  const double thickness = DrawIn(draw, {0.1, 0.4}), half = 0.5 * DrawIn(draw, {0.5, 4.0});
  const double inner = x + side * near, outer = inner + side * thickness;
  AddBox({std::fmin(inner, outer), std::fmax(inner, outer)}, {y - half, y + half}, 0.0, height, s);
}

}  // namespace

void MakeOverhang(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const int things = 1 + DrawOneOf(draw, 3);
  double x = DrawIn(draw, {1.8, 3.5});
  for (int i = 0; i < things; ++i) {
    const double along = DrawIn(draw, {0.3, 3.0});
    const int kind = DrawOneOf(draw, 3);
    const Span span = {-kBridgeHalf, kBridgeHalf};
    if (kind == 0) AddBox({x, x + along}, span, DrawIn(draw, {1.5, 2.7}), kTallWall, s);
    if (kind == 1) {
      const double base = DrawIn(draw, {1.0, 2.0});
      AddBox({x, x + along}, span, base, base + DrawIn(draw, {0.2, 0.6}), s);
    }
    if (kind == 2) {
      const double half = 0.5 * DrawIn(draw, {2.0, 4.0}), y = DrawIn(draw, {-2.0, 2.0});
      const double out = DrawIn(draw, {0.5, 1.5});
      AddWall({x + out, x + out + along}, {y - half, y + half}, s);
      AddBox({x, x + out}, {y - half, y + half}, DrawIn(draw, {1.0, 2.5}), kTallWall, s);
      x += out;
    }
    x += along + DrawIn(draw, {2.0, 3.5});
  }
  StartAt(0.0, DrawIn(draw, {-1.0, 1.0}), DrawIn(draw, {1.2, 3.0}), DrawIn(draw, {-30.0, 30.0}), s);
  s->planning.ceiling = kLowCeiling;
  LaneBeyond(x - 2.0, draw, s);
}

void MakeRoof(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double x = DrawIn(draw, {5.0, 9.0}), length = DrawIn(draw, {8.0, 14.0});
  StraightLane(x, length, draw, s);
  const double base = s->pad.deck_height + DrawIn(draw, {1.4, 2.6});
  const double half_width = 0.5 * DrawIn(draw, {2.0, 4.0});
  const double half_length = 0.5 * length * DrawIn(draw, {0.4, 1.0}) + 0.5 * s->pad.deck_size;
  const double y = DrawIn(draw, {-1.0, 1.0}) * std::fmax(0.0, 0.5 * length - half_length);
  AddBox({x - half_width, x + half_width}, {y - half_length, y + half_length}, base,
         base + DrawIn(draw, {0.2, 0.5}), s);
  // Posts stand outside of the roof's edge where that is over the deck's own way.
  const double diameter = DrawIn(draw, {0.15, 0.4});
  const double aside = std::fmax(half_width, 1.3) + 0.5 * diameter;
  const int pairs = 2 + DrawOneOf(draw, 2);
  for (int i = 0; i < pairs; ++i) {
    const double at = y - half_length + 2.0 * half_length * i / (pairs - 1);
    AddPost(x - aside, at, diameter, base, s);
    AddPost(x + aside, at, diameter, base, s);
  }
  StartAt(0.0, DrawIn(draw, {-2.0, 2.0}), DrawIn(draw, {1.2, 3.5}), DrawIn(draw, {-45.0, 45.0}), s);
}

void MakeLowWall(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double x = DrawIn(draw, {4.5, 8.0}), length = DrawIn(draw, {8.0, 14.0});
  StraightLane(x, length, draw, s);
  const double half_deck = 0.5 * s->pad.deck_size;
  for (const double side : {-1.0, 1.0}) {
    const int things = 1 + DrawOneOf(draw, 4);
    for (int i = 0; i < things; ++i) AddLowThing(x, length, half_deck, side, draw, s);
  }
  if (DrawChance(draw, 0.5)) {  // before the lane
    const double at = DrawIn(draw, {1.5, x - 3.5 + 0.6}), y = DrawIn(draw, {-2.0, 2.0});
    const double half = 0.5 * DrawIn(draw, {1.0, 6.0});
    AddBox({at, at + DrawIn(draw, {0.1, 0.4})}, {y - half, y + half}, 0.0, DrawIn(draw, {0.2, 0.8}),
           s);
  }
  StartAt(0.0, DrawIn(draw, {-3.0, 3.0}), DrawIn(draw, {1.8, 3.0}), DrawIn(draw, {-45.0, 45.0}), s);
}

}  // namespace touchdown::evaluation
