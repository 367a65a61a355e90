// SPDX-License-Identifier: BSD-3-Clause
// Families in which the way leads through gaps between walls that cannot be flown over.
#include <algorithm>

#include "evaluation/studies/hostile/hostile_family.h"
#include "evaluation/studies/hostile/hostile_world.h"

namespace touchdown::evaluation {
namespace {

constexpr double kRoomWall = 0.3;  // around a room or along a corridor [m]

// A wall across x with one opening.
void AddDoorWall(double x, double thickness, double half_width, double middle, double opening,
                 Scenario* s) {
  AddWall({x, x + thickness}, {middle + 0.5 * opening, half_width + kRoomWall}, s);
  AddWall({x, x + thickness}, {-half_width - kRoomWall, middle - 0.5 * opening}, s);
}

}  // namespace

void MakeDoor(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double half_width = 0.5 * DrawIn(draw, {5.0, 9.0});
  const double x = DrawIn(draw, {2.0, 5.0}), behind = -DrawIn(draw, {1.5, 4.0});
  const double thickness = DrawIn(draw, {0.1, 0.6}), opening = DrawIn(draw, {1.2, 2.8});
  const double reach = half_width - 0.5 * opening - 0.1;
  double end = x + thickness;
  AddDoorWall(x, thickness, half_width, DrawIn(draw, {-reach, reach}), opening, s);
  if (DrawChance(draw, 0.3)) {
    const double second = end + DrawIn(draw, {2.5, 4.0});
    AddDoorWall(second, thickness, half_width, DrawIn(draw, {-reach, reach}), opening, s);
    end = second + thickness;
  }
  AddWall({behind - kRoomWall, end}, {half_width, half_width + kRoomWall}, s);
  AddWall({behind - kRoomWall, end}, {-half_width - kRoomWall, -half_width}, s);
  AddWall({behind - kRoomWall, behind}, {-half_width, half_width}, s);
  StartAt(0.0, DrawIn(draw, {-0.5, 0.5}) * half_width, DrawIn(draw, {1.2, 3.0}),
          DrawIn(draw, {-60.0, 60.0}), s);
  s->planning.ceiling = kLowCeiling;
  LaneBeyond(end, draw, s);
}

void MakeZigzag(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double half = 0.5 * DrawIn(draw, {4.0, 5.5});
  const double gap = DrawIn(draw, {1.4, 2.6}), spacing = DrawIn(draw, {2.2, 4.0});
  const double thickness = DrawIn(draw, {0.1, 0.4});
  const int baffles = 2 + DrawOneOf(draw, 3);
  double side = DrawChance(draw, 0.5) ? 1.0 : -1.0;
  double x = DrawIn(draw, {1.5, 3.0});
  for (int i = 0; i < baffles; ++i, x += spacing, side = -side) {
    const Span across = side > 0.0 ? Span{-half + gap, half} : Span{-half, half - gap};
    AddWall({x, x + thickness}, across, s);
  }
  const double end = x - spacing + thickness + 1.0, behind = -DrawIn(draw, {1.2, 3.0});
  AddWall({behind, end}, {half, half + kRoomWall}, s);
  AddWall({behind, end}, {-half - kRoomWall, -half}, s);
  AddWall({behind - kRoomWall, behind}, {-half - kRoomWall, half + kRoomWall}, s);
  StartAt(0.0, DrawIn(draw, {-0.4, 0.4}) * half, DrawIn(draw, {1.2, 3.0}),
          DrawIn(draw, {-30.0, 30.0}), s);
  s->planning.ceiling = kLowCeiling;
  LaneBeyond(end, draw, s);
}

// One behind the other, each in a strip of its own, so that none closes the way of another.
void MakeWalls(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const int walls = 2 + DrawOneOf(draw, 3);
  double x = DrawIn(draw, {1.5, 3.0});
  for (int i = 0; i < walls; ++i) {
    const double thickness = DrawIn(draw, {0.1, 0.5});
    const double across = DrawIn(draw, {2.0, 5.0}), along = DrawIn(draw, {1.0, 3.0});
    const double y = DrawIn(draw, {-3.0, 3.0}) - 0.5 * across;
    const bool ahead = DrawChance(draw, 0.5);  // the second arm leads away from the start
    const bool tee = DrawChance(draw, 0.5);    // from the middle of the first, else from its end
    const double first = ahead ? x : x + along;
    const double foot =
        tee ? y + 0.5 * (across - thickness) : (DrawChance(draw, 0.5) ? y : y + across - thickness);
    AddWall({first, first + thickness}, {y, y + across}, s);
    const Span arm = ahead ? Span{first + thickness, first + thickness + along} : Span{x, first};
    AddWall(arm, {foot, foot + thickness}, s);
    x += along + thickness + DrawIn(draw, {1.2, 2.6});
  }
  StartAt(0.0, 0.0, DrawIn(draw, {1.2, 3.0}), DrawIn(draw, {-45.0, 45.0}), s);
  s->planning.ceiling = kLowCeiling;
  LaneBeyond(x - 1.2, draw, s);
}

}  // namespace touchdown::evaluation
