// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/base/random_stream.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// Diameters of the poles [m]: those that the planner promises to see, and thinner ones.
inline constexpr double kThinnestPole = 0.03;
inline constexpr double kPromisedPole = 0.10;
inline constexpr double kThickestPole = 0.20;

/// The input of a generator beside the scenario's conditions, which are drawn before.
struct WorldRequest {
  bool thin_poles = false;  ///< poles thinner than kPromisedPole
};

/// A kind of world. `make` adds obstacles, start, pad and ceiling to a scenario whose conditions are set.
struct HostileFamily {
  const char* name;
  const char* what;    ///< one line
  const char* ranges;  ///< of its parameters, in words
  void (*make)(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
};

/// In the order of the report.
const std::vector<HostileFamily>& HostileFamilies();
std::vector<std::string> HostileFamilyNames();
/// @throws BadInput
const HostileFamily& HostileFamilyNamed(const std::string& name);

// The generators, by file: hostile_pockets.cc, hostile_passages.cc, hostile_heights.cc, hostile_open.cc, hostile_standing.cc.
void MakeDeadEnd(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeFacingWall(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeBlindCorner(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeDoor(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeZigzag(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeWalls(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeOverhang(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeRoof(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeLowWall(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakePoles(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeNearStart(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeWideField(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeBelow(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeClearing(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeNiche(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeGarage(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeLimbo(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeWideWall(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeFar(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeTwoFloors(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);
void MakeSkylight(const WorldRequest& request, sim::RandomStream& draw, Scenario* scenario);

}  // namespace touchdown::evaluation
