// SPDX-License-Identifier: BSD-3-Clause
// Functions for the generators of hostile worlds. A generator works in a frame in which the vehicle starts near the
// origin and the pad drives beyond, towards +x. The finished world is then turned.
#pragma once

#include "sim/base/random_stream.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// Obstacles that cannot be flown over, and the ceiling that prevents it [m].
inline constexpr double kTallWall = 5.0;
inline constexpr double kLowCeiling = 4.0;

/// Least distance of obstacles from the pad's path, from its centre [m].
inline constexpr double kLaneRoom = 2.2;

/// Within the assumptions no obstacle is nearer to the start, from the body's centre [m].
inline constexpr double kTakeOffRoom = 0.9;

/// Two numbers of one range.
struct Span {
  double lo = 0.0;
  double hi = 0.0;
};

/// Evenly from a range.
double DrawIn(sim::RandomStream& draw, const Span& range);
/// True with this probability.
bool DrawChance(sim::RandomStream& draw, double probability);
/// From 0 to count - 1, evenly.
int DrawOneOf(sim::RandomStream& draw, int count);

/// A box between two corners, its lower face at `base`.
void AddBox(const Span& x, const Span& y, double base, double top, Scenario* scenario);
/// A wall that is not flown over.
void AddWall(const Span& x, const Span& y, Scenario* scenario);
void AddPost(double x, double y, double diameter, double height, Scenario* scenario);

/// The vehicle hovers there, heading to +x turned left by `yaw_deg`.
void StartAt(double x, double y, double z, double yaw_deg, Scenario* scenario);

/// A closed way of the pad beyond `x`: a figure of eight, a circle, or to and fro across. A vehicle can follow its
/// speed within limits.acceleration.
void LaneBeyond(double x, sim::RandomStream& draw, Scenario* scenario);
/// To and fro along y at `x` with the middle at y = 0. The lane is `length` long, less its smooth turns. These take
/// about a quarter of it.
void StraightLane(double x, double length, sim::RandomStream& draw, Scenario* scenario);

/// Mirrors the world, turns it by any angle and shifts it by less than a cell of the map.
void TurnWorld(sim::RandomStream& draw, Scenario* scenario);

/// Distance from the vehicle's start to the nearest obstacle [m]; infinite without any.
double StartRoom(const Scenario& scenario);
/// No obstacle is in the deck's way, at any time until `horizon` [s], by the rule of the scenario check.
bool LaneIsClear(const Scenario& scenario, const Registries& registries, double horizon);

}  // namespace touchdown::evaluation
