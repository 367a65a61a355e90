// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/base/random_stream.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// The ranges from which flights within the assumptions are drawn, and how far the others go beyond. One line for each
/// condition, in words.
struct HostileCondition {
  const char* name;    ///< as the report calls it where it is broken
  const char* keys;    ///< the scenario keys that it sets, commas between
  const char* within;  ///< range within the assumptions
  const char* beyond;  ///< range beyond; empty: always within
};
const std::vector<HostileCondition>& HostileConditions();

/// Every condition, evenly from the assumed range.
void DrawConditions(sim::RandomStream& draw, Scenario* scenario);

/// One to three conditions that go beyond, by name. None of them has a key that begins one of
/// `fixed` ("depth.drop=0.9"). Thin poles occur only in the family `poles`.
std::vector<std::string> ChooseBeyond(sim::RandomStream& draw, const std::string& family,
                                      const std::vector<std::string>& fixed);

/// Puts these out of the assumed range. Conditions of the world are the generator's: see AddNearPost and WorldRequest.
void DrawBeyond(const std::vector<std::string>& beyond, sim::RandomStream& draw,
                Scenario* scenario);

/// A post nearer to the start than the take-off volume.
void AddNearPost(sim::RandomStream& draw, Scenario* scenario);

inline constexpr char kThinPoles[] = "thin_poles";
inline constexpr char kNearObstacle[] = "near_obstacle";

}  // namespace touchdown::evaluation
