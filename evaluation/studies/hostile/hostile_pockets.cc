// SPDX-License-Identifier: BSD-3-Clause
// Families in which the start is closed in: the way to the pad begins away from it, or around a corner.
#include "evaluation/studies/hostile/hostile_family.h"
#include "evaluation/studies/hostile/hostile_world.h"

namespace touchdown::evaluation {

// Inside is x in [-depth/2, depth/2], y in [-width/2, width/2]. The pad is beyond the wall at +x.
void MakeDeadEnd(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double depth = DrawIn(draw, {3.5, 7.0}), width = DrawIn(draw, {3.5, 7.0});
  const double wall = DrawIn(draw, {0.2, 0.8});
  const double x = 0.5 * depth, y = 0.5 * width;
  const int kind = DrawOneOf(draw, 3);  // open behind, open to the right, open behind with a lip
  AddWall({x, x + wall}, {-y - wall, y + wall}, s);
  AddWall({-x, x}, {y, y + wall}, s);
  if (kind == 1) {
    AddWall({-x - wall, -x}, {-y - wall, y + wall}, s);
  } else {
    AddWall({-x, x}, {-y - wall, -y}, s);
  }
  if (kind == 2) {
    const double mouth = DrawIn(draw, {1.6, 3.0});
    const double middle = DrawIn(draw, {-y + 0.5 * mouth, y - 0.5 * mouth});
    const Span lip = {-x - wall, -x};
    if (middle + 0.5 * mouth < y) AddWall(lip, {middle + 0.5 * mouth, y + wall}, s);
    if (middle - 0.5 * mouth > -y) AddWall(lip, {-y - wall, middle - 0.5 * mouth}, s);
  }
  StartAt(DrawIn(draw, {-x + 1.0, x - 1.0}), DrawIn(draw, {-y + 1.0, y - 1.0}),
          DrawIn(draw, {1.2, 3.0}), DrawIn(draw, {-20.0, 20.0}), s);
  s->planning.ceiling = kLowCeiling;
  LaneBeyond(x + wall, draw, s);
}

void MakeFacingWall(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double x = DrawIn(draw, {1.2, 2.5});
  const double thickness = DrawIn(draw, {0.1, 1.0});
  const double half = 0.5 * DrawIn(draw, {3.0, 9.0});
  const double aside = DrawIn(draw, {-0.5, 0.5}) * half;
  AddWall({x, x + thickness}, {aside - half, aside + half}, s);
  if (DrawChance(draw, 0.3)) {
    const double y = DrawIn(draw, {1.2, 2.5});
    AddWall({-DrawIn(draw, {0.0, 4.0}) - 0.1, x}, {y, y + thickness}, s);
  }
  StartAt(0.0, 0.0, DrawIn(draw, {1.2, 3.0}), DrawIn(draw, {-10.0, 10.0}), s);
  s->planning.ceiling = kLowCeiling;
  LaneBeyond(x + thickness, draw, s);
}

// The first corridor leads along +y to the origin, the second one from there along +x. The post stands
// where it is seen only from the corner.
void MakeBlindCorner(const WorldRequest& /*request*/, sim::RandomStream& draw, Scenario* s) {
  const double half = 0.5 * DrawIn(draw, {1.9, 3.4});
  const double first = DrawIn(draw, {4.0, 7.0}), second = DrawIn(draw, {4.0, 7.0});
  const double wall = DrawIn(draw, {0.2, 0.8});
  AddWall({half, second}, {-first, -half}, s);               // the inner block
  AddWall({-half - wall, second}, {half, half + wall}, s);   // ahead of the first corridor
  AddWall({-half - wall, -half}, {-first - wall, half}, s);  // its outer side
  AddWall({-half, second}, {-first - wall, -first}, s);      // behind the start
  if (DrawChance(draw, 0.5)) {
    const double diameter = DrawIn(draw, {0.1, 0.4});
    AddPost(half + DrawIn(draw, {0.3, 2.0}), -half + 0.5 * diameter + DrawIn(draw, {0.0, 0.2}),
            diameter, kTallWall, s);
  }
  const double aside = half - kTakeOffRoom;
  StartAt(DrawIn(draw, {-aside, aside}), -first + DrawIn(draw, {1.0, 1.6}),
          DrawIn(draw, {1.2, 3.0}), 90.0 + DrawIn(draw, {-20.0, 20.0}), s);
  s->planning.ceiling = kLowCeiling;
  LaneBeyond(second, draw, s);
}

}  // namespace touchdown::evaluation
