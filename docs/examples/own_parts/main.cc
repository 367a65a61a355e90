// SPDX-License-Identifier: BSD-3-Clause
// The whole program `touchdown` with a planner and a pad motion of one's own.
#include "lane_change.h"
#include "straight_planner.h"
#include "touchdown/evaluation/program/program.h"
#include "touchdown/evaluation/scenario/scenario.h"

using namespace touchdown;  // NOLINT: an example

evaluation::PlannerEntry Straight() {
  evaluation::PlannerEntry entry;
  entry.name = "straight";
  entry.summary = "a quintic to the pad, whatever stands between";
  entry.lands = true;
  entry.avoids = false;
  entry.parameters = {{"straight.share", 0.9, {0.1, 1.0}, "planner straight: of the limits"}};
  entry.make = [](const evaluation::PlannerSetup& setup) {
    planning::Limits limits = setup.limits;
    limits.speed *= setup.Get("straight.share");
    limits.acceleration *= setup.Get("straight.share");
    return std::make_unique<own::StraightPlanner>(limits);
  };
  return entry;
}

evaluation::PadMotionEntry LaneChange() {
  constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;
  evaluation::PadMotionEntry entry;
  entry.name = "lane_change";
  entry.summary = "straight, a turn by lane.angle_deg and back, straight";
  entry.parameters = {
      {"lane.angle_deg", 25.0, {5.0, 90.0, false, "deg"}, "lane_change: each turn"}};
  entry.make = [](const evaluation::PadMotionSetup& setup) {
    const evaluation::Scenario::Pad& pad = setup.scenario.pad;
    const own::LaneChangeTurns turns = {.after = pad.turn_start,
                                        .angle = setup.Get("lane.angle_deg") * kRadPerDeg,
                                        .curvature = std::abs(pad.turn_rate) / pad.speed,
                                        .ramp = 0.3 * pad.speed};
    return std::make_shared<sim::PathCourse>(
        own::LaneChange(pad.start, pad.heading_deg * kRadPerDeg, turns), pad.deck_height, pad.speed,
        setup.phase);
  };
  return entry;
}

int main(int argc, char** argv) {
  evaluation::Registries registries = evaluation::StandardRegistries();
  registries.planners.push_back(Straight());
  registries.pad_motions.push_back(LaneChange());
  return evaluation::RunProgram(argc, argv, registries);
}
