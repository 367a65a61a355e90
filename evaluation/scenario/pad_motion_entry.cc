// SPDX-License-Identifier: BSD-3-Clause
// The motions of sim/pad/pad_motion.h by name. Units become SI here.
#include "touchdown/evaluation/scenario/pad_motion_entry.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "estimation/base/degrees.h"
#include "evaluation/scenario/waypoint_file.h"
#include "sim/pad/pad_motion.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {
namespace {

using Kind = sim::PadMotionConfig::Kind;

sim::PadMotionConfig ConfigOf(Kind kind, const PadMotionSetup& setup) {
  const Scenario::Pad& pad = setup.scenario.pad;
  sim::PadMotionConfig config;
  config.kind = kind;
  config.p_start << pad.start, pad.deck_height;
  config.heading = pad.heading_deg * estimation::kRadPerDeg;
  config.speed = kind == Kind::kStatic ? 0.0 : pad.speed;
  // A straight_turn has its sense from the angle, a random drive draws it.
  const bool signed_rate = kind == Kind::kCircle || kind == Kind::kFigureEight;
  config.turn_rate = signed_rate ? pad.turn_rate : std::abs(pad.turn_rate);
  config.turn_start = pad.turn_start;
  config.turn_angle = pad.turn_deg * estimation::kRadPerDeg;
  config.go_time = pad.go_time;
  config.stop_time = pad.stop_time;
  config.acceleration = pad.acceleration;
  config.jerk = pad.jerk;
  config.seed = setup.seed;
  if (kind == Kind::kWaypoints) config.waypoints = ReadWaypointFile(pad.waypoints);
  config.phase = setup.phase;
  return config;
}

PadMotionEntry Motion(const char* name, Kind kind, const char* summary) {
  PadMotionEntry entry;
  entry.name = name;
  entry.summary = summary;
  entry.drawn = kind == Kind::kRandom;
  entry.has_phase = kind != Kind::kRandom && kind != Kind::kWaypoints;
  entry.make = [kind](const PadMotionSetup& setup) {
    try {
      return std::make_shared<sim::PadMotion>(ConfigOf(kind, setup));
    } catch (const std::invalid_argument& error) {
      const std::string text = error.what();
      if (kind != Kind::kWaypoints || text.starts_with("pad.")) throw;
      const std::string file = setup.scenario.pad.waypoints + ": ";
      throw std::invalid_argument("pad.waypoints " + (text.starts_with(file) ? text : file + text));
    }
  };
  return entry;
}

}  // namespace

std::vector<PadMotionEntry> StandardPadMotions() {
  return {
      Motion("straight_turn", Kind::kStraightTurn, "straight, one turn, straight"),
      Motion("circle", Kind::kCircle, "round and round"),
      Motion("line", Kind::kLine, "straight on"),
      Motion("static", Kind::kStatic, "stands"),
      Motion("figure_eight", Kind::kFigureEight, "two loops, by turns"),
      Motion("stop_and_go", Kind::kStopAndGo, "straight, with stops"),
      Motion("reversing", Kind::kReversing, "straight, forwards and backwards"),
      Motion("random", Kind::kRandom, "turns, speeds and stops drawn from the seed"),
      Motion("waypoints", Kind::kWaypoints, "as the file pad.waypoints says"),
  };
}

}  // namespace touchdown::evaluation
