// SPDX-License-Identifier: BSD-3-Clause
// The list of families. The words here describe what the generators draw. docs/reference/hostile_worlds.md is made from
// the same table, and a test compares.
#include "evaluation/studies/hostile/hostile_family.h"

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/suggestion.h"
#include "evaluation/scenario/scenario_value.h"

namespace touchdown::evaluation {

const std::vector<HostileFamily>& HostileFamilies() {
  static const std::vector<HostileFamily> families = {
      {"dead_end",
       "the start is in a pocket that is open behind, to one side, or behind with a lip",
       "inside 3.5 to 7 m each way; walls 0.2 to 0.8 m thick; lips leave 1.6 to 3 m", MakeDeadEnd},
      {"door",
       "the start is in a room whose only exit is a door or a slit, some with a second one behind",
       "opening 1.2 to 2.8 m; wall 0.1 to 0.6 m; 3 of 10 with a second wall 2.5 to 4 m behind",
       MakeDoor},
      {"zigzag", "a corridor with baffles from both sides in turn",
       "corridor 4 to 5.5 m; 2 to 4 baffles 2.2 to 4 m apart, 0.1 to 0.4 m thick; gaps 1.4 to 2.6 "
       "m",
       MakeZigzag},
      {"walls", "L and T walls across the way",
       "2 to 4 walls 0.1 to 0.5 m thick; arms 2 to 5 m and 1 to 3 m; 1.2 to 2.6 m between them",
       MakeWalls},
      {"blind_corner",
       "two corridors that meet at a right angle, half of them with a post behind the corner",
       "corridors 1.9 to 3.4 m wide, 4 to 7 m long; post 0.1 to 0.4 m", MakeBlindCorner},
      {"overhang",
       "bridges to pass under, beams to pass over or under, houses with an upper floor that "
       "stands out",
       "1 to 3 of them; bridges 1.5 to 2.7 m above the ground, beams 1 to 2 m, upper floors 1 to "
       "2.5 m",
       MakeOverhang},
      {"low_wall", "low walls and posts beside the pad's lane and before it",
       "0.2 to 0.8 m high; 0.32 to 2 m from the deck's edge; walls 0.5 to 4 m long, posts 0.1 to "
       "0.4 m",
       MakeLowWall},
      {"poles", "poles across the way",
       "8 to 20 poles of 10 to 20 cm, 1 m apart at least, 2 to 5 m high", MakePoles},
      {"facing_wall", "the start faces a wall, 3 of 10 with a second one at its side",
       "wall 1.2 to 2.5 m ahead, 3 to 9 m wide, 0.1 to 1 m thick", MakeFacingWall},
      {"near_start", "posts and boxes around the start, on up to 200 degrees",
       "2 to 5 of them 0.9 to 1.4 m from the body's centre", MakeNearStart},
      {"wide_field", "one far obstacle in the way of a fast vehicle",
       "limits.speed 3 to 6 m/s; 8 to 15 m ahead; a box 0.5 to 4 m wide or a pole of 10 to 30 cm",
       MakeWideField},
      {"roof", "a roof on posts above the pad's lane",
       "1.4 to 2.6 m above the deck, 2 to 4 m wide, over 40 to 100 % of the lane; posts 0.15 to "
       "0.4 m",
       MakeRoof},
      {"below", "the pad stands below the start, posts around it",
       "1.5 to 5 m above the deck, 0 to 0.8 m aside; 0 to 4 posts 2.2 to 5 m away", MakeBelow},
      {"clearing", "the pad stands in a ring of boxes, with posts before it",
       "ring of 5 to 10, 1.6 to 3 m inside; 0 to 5 posts", MakeClearing},
      {"niche", "the pad stands between three walls, open to the start, to a side or away from it",
       "walls 1.3 to 2.2 m from its centre, 1.5 to 5 m high", MakeNiche},
      {"garage", "the same with a roof", "1.5 to 2.4 m above the deck; walls 1.5 to 2.5 m away",
       MakeGarage},
      {"limbo", "a corridor with walls to fly over and under in turn",
       "2.6 to 4 m wide; 2 to 4 walls 2.4 to 3.5 m apart, 1.4 to 2.3 m high, or 1.4 to 1.9 m above "
       "the ground",
       MakeLimbo},
      {"wide_wall", "a wall wider than the map's window", "16 to 80 m wide, 2 to 6 m high",
       MakeWideWall},
      {"far", "a pad that stands far away, houses before it", "40 to 90 m; 0 to 7 houses", MakeFar},
      {"two_floors", "the start is on a floor above the pad, which stands below it",
       "floor 2 to 3 m above the deck, 5 to 8 m wide; 0 to 2 walls below", MakeTwoFloors},
      {"skylight", "the pad stands in a room with a hole in its roof",
       "room 3.6 to 6 m wide, roof 1.6 to 2.4 m above the deck, hole 1.6 to 2.6 m", MakeSkylight},
  };
  return families;
}

std::vector<std::string> HostileFamilyNames() {
  std::vector<std::string> names;
  for (const HostileFamily& family : HostileFamilies()) names.emplace_back(family.name);
  return names;
}

const HostileFamily& HostileFamilyNamed(const std::string& name) {
  for (const HostileFamily& family : HostileFamilies()) {
    if (name == family.name) return family;
  }
  throw BadInput(
      fmt::format("{}: unknown{}.", name, Instead(name, HostileFamilyNames(), "the families are")));
}

}  // namespace touchdown::evaluation
