// SPDX-License-Identifier: BSD-3-Clause
// Keys of the world and of the trial: description, pad, vehicle, time-out and seed.
#include "evaluation/scenario/scenario_keys.h"

namespace touchdown::evaluation::schema {

void AddDescription(KeyList& keys) {
  SchemaKey<Scenario> key =
      Text("description", "a line of text",
           "what the scenario is, in words, for `touchdown list scenarios`; has no influence",
           TOUCHDOWN_AT(description));
  key.set = [take = key.set](Scenario& s, const YAML::Node& n, const Where& w) {
    take(s, n, w);
    if (s.description.find('\n') != std::string::npos) {
      RefuseValue(w, "description", "a text of one line", n);
    }
  };
  keys.push_back(std::move(key));
}

void AddPadKeys(KeyList& keys) {
  keys.push_back(Word("pad.motion", "motions",
                      "how the pad vehicle drives; docs/pad_motions.md shows each",
                      TOUCHDOWN_AT(pad.motion)));
  keys.push_back(Number<Scenario>(
      "pad.speed", In(0.01, 10, "m/s"),
      "speed along the path, of a changing one the greatest; a pad that is faster than about 0.85 "
      "limits.speed is not caught",
      TOUCHDOWN_AT(pad.speed)));
  keys.push_back(Vector<2, Scenario>("pad.start", In(-500, 500, "m"),
                                     "pad centre at the start of the path, in W",
                                     TOUCHDOWN_AT(pad.start)));
  keys.push_back(Number<Scenario>("pad.heading_deg", In(-360, 360, "deg"),
                                  "heading at the start of the path",
                                  TOUCHDOWN_AT(pad.heading_deg)));
  keys.push_back(Number<Scenario>("pad.turn_start", In(0, 200, "m"),
                                  "straight_turn: driven before the turn begins",
                                  TOUCHDOWN_AT(pad.turn_start)));
  keys.push_back(Number<Scenario>("pad.turn_deg", In(-180, 180, "deg"),
                                  "straight_turn: angle of the turn, left positive",
                                  TOUCHDOWN_AT(pad.turn_deg)));
  keys.push_back(
      Number<Scenario>("pad.turn_rate", In(-2, 2, "rad/s"),
                       "circle: turn rate, left positive; figure_eight: that of the first loop, at "
                       "its tightest; straight_turn, random: its greatest magnitude",
                       TOUCHDOWN_AT(pad.turn_rate)));
  keys.push_back(Number<Scenario>(
      "pad.go_time", In(0.5, 600, "s"),
      "stop_and_go: between stops; reversing: in each direction; half a change of speed at both "
      "ends included; a change of speed by v takes 2.25 v / pad.acceleration",
      TOUCHDOWN_AT(pad.go_time)));
  keys.push_back(
      Number<Scenario>("pad.stop_time", In(0.5, 600, "s"),
                       "stop_and_go: length of a stop, with half a change of speed at both ends",
                       TOUCHDOWN_AT(pad.stop_time)));
  keys.push_back(Number<Scenario>("pad.acceleration", In(0.05, 20, "m/s^2"),
                                  "stop_and_go, reversing, random, waypoints: of changes of speed, "
                                  "at most; random, waypoints: across the path too",
                                  TOUCHDOWN_AT(pad.acceleration)));
  keys.push_back(Number<Scenario>("pad.jerk", In(0.05, 100, "m/s^3"),
                                  "random, waypoints: greatest jerk", TOUCHDOWN_AT(pad.jerk)));
  keys.push_back(Text("pad.waypoints", "none or the path of a CSV file",
                      "waypoints: where the pad is when, in W; pad.start, pad.heading_deg and "
                      "pad.speed are not used then",
                      TOUCHDOWN_AT(pad.waypoints)));
  keys.push_back(Number<Scenario>("pad.phase", In(-100, 100, "m"),
                                  "path already travelled at t = 0, at pad.speed; waypoints: 0",
                                  TOUCHDOWN_AT(pad.phase)));
  keys.push_back(Number<Scenario>("pad.phase_spread", In(0, 100, "m"),
                                  "drawn per seed: uniform in +- this, added to pad.phase",
                                  TOUCHDOWN_AT(pad.phase_spread)));
  keys.push_back(Number<Scenario>("pad.deck_size", In(0.6, 5, "m"), "edge of the square deck",
                                  TOUCHDOWN_AT(pad.deck_size)));
  keys.push_back(Number<Scenario>("pad.deck_height", In(0.1, 3, "m"),
                                  "upper face of the deck above the ground",
                                  TOUCHDOWN_AT(pad.deck_height)));
  keys.push_back(Word("pad.prediction", "predictors", "extrapolation of the pad",
                      TOUCHDOWN_AT(pad.prediction)));
}

namespace {

// `file`, `auto` or a list of 1 and -1.
SchemaKey<Scenario> RotorSenses() {
  const std::string name = "airframe.rotor_senses";
  const std::string allowed = "file, auto or a list of 1 and -1";
  return {
      name,
      "",
      allowed,
      "imported vehicles: sign of each rotor's reaction torque about z, in the file's order; auto: "
      "neighbours turn against each other where the file's senses cannot steer",
      [=](Scenario& s, const YAML::Node& n, const Where& w) {
        s.airframe.rotor_senses.clear();
        s.airframe.alternate_senses = false;
        if (n.IsScalar() && (n.Scalar() == "file" || n.Scalar() == "auto")) {
          s.airframe.alternate_senses = n.Scalar() == "auto";
          return;
        }
        if (!n.IsSequence() || n.size() == 0) RefuseValue(w, name, allowed, n);
        for (const YAML::Node& element : n) {
          const int sense = ReadWhole(element, w, name, -1, 1);
          if (sense == 0) RefuseValue(w, name, allowed, n);
          s.airframe.rotor_senses.push_back(sense);
        }
      },
      [](const Scenario& s) {
        const std::vector<double>& senses = s.airframe.rotor_senses;
        if (senses.empty()) return std::string(s.airframe.alternate_senses ? "auto" : "file");
        std::string text;
        for (const double sense : senses) {
          text += (text.empty() ? "[" : ", ") + WriteNumber(sense);
        }
        return text + "]";
      }};
}

// Of vehicles whose MJCF file is not in the form of sim/vehicle/vehicle_file.h.
void AddAirframeKeys(KeyList& keys) {
  keys.push_back(Number<Scenario>("airframe.rotor_lag", In(0.005, 1, "s"),
                                  "imported vehicles: lag of motors that have none in the file",
                                  TOUCHDOWN_AT(airframe.rotor_lag)));
  keys.push_back(Number<Scenario>("airframe.rotor_drag", In(0, 10, "N s/m"),
                                  "imported vehicles: linear drag along x and y of the body",
                                  TOUCHDOWN_AT(airframe.rotor_drag)));
  keys.push_back(Number<Scenario>("airframe.body_drag_area", In(0, 10, "m^2"),
                                  "imported vehicles: Cd A of the quadratic drag",
                                  TOUCHDOWN_AT(airframe.body_drag_area)));
  keys.push_back(Vector<3, Scenario>(
      "airframe.hull", In(-5, 5, "m"),
      "imported vehicles: radius, bottom and top of the cylinder about the centre of mass that "
      "collides; zeros: one around the file's geoms",
      TOUCHDOWN_AT(airframe.hull)));
  keys.push_back(Vector<2, Scenario>(
      "airframe.feet", In(0, 5, "m"),
      "imported vehicles: distance of the four feet from the middle, depth of "
      "their soles below the "
      "centre of mass; zeros: 0.6 of the hull's radius, below the hull by 0.35 of that",
      TOUCHDOWN_AT(airframe.feet)));
  keys.push_back(RotorSenses());
  keys.push_back(Vector<3, Scenario>(
      "airframe.moment_max", In(0, 1000, "N m"),
      "imported vehicles: greatest moments about x, y and z of actuators that make a moment alone; "
      "zeros: the file's",
      TOUCHDOWN_AT(airframe.moment_max)));
}

}  // namespace

void AddVehicleKeys(KeyList& keys) {
  keys.push_back(Text("vehicle", "default or the path of an MJCF file",
                      "the quadrotor; docs/vehicles.md", TOUCHDOWN_AT(vehicle)));
  AddAirframeKeys(keys);
  keys.push_back(Vector<3, Scenario>("start.position", In(-500, 500, "m"),
                                     "the vehicle hovers here at t = 0, in W",
                                     TOUCHDOWN_AT(start.position)));
  keys.push_back(Vector<3, Scenario>("start.position_spread", In(0, 20, "m"),
                                     "drawn per seed: uniform in +- this, per axis",
                                     TOUCHDOWN_AT(start.position_spread)));
  keys.push_back(Number<Scenario>("start.yaw_deg", In(-360, 360, "deg"), "heading at t = 0",
                                  TOUCHDOWN_AT(start.yaw_deg)));
  keys.push_back(Bool("start.yaw_random", "draw the heading per seed from the whole circle instead",
                      TOUCHDOWN_AT(start.yaw_random)));
}

void AddTrialKeys(KeyList& keys) {
  keys.push_back(Number<Scenario>("timeout", In(1, 600, "s"), "a trial ends here at the latest",
                                  TOUCHDOWN_AT(timeout)));
  keys.push_back(
      Number<Scenario>("stand_limit", In(0, 600, "s"),
                       "a flight ends as stood when for so long it stayed within 0.5 m, a depth "
                       "image came and no new plan was made; 0: never",
                       TOUCHDOWN_AT(stand_limit)));
  keys.push_back(
      {"seed", "", "[0, 2^53], whole", "seed of every random stream",
       [](Scenario& s, const YAML::Node& n, const Where& w) { s.seed = ReadSeed(n, w, "seed"); },
       [](const Scenario& s) { return std::to_string(s.seed); }});
}

}  // namespace touchdown::evaluation::schema
