// SPDX-License-Identifier: BSD-3-Clause
// Keys of the air, and of a vehicle that differs from the model of its onboard software:
// docs/wind.md.
#include "evaluation/scenario/scenario_keys.h"

namespace touchdown::evaluation::schema {

void AddAirKeys(KeyList& keys) {
  keys.push_back(Number<Scenario>("wind.mean", In(0, 30, "m/s"), "speed of the mean wind",
                                  TOUCHDOWN_AT(wind.mean)));
  keys.push_back(
      Number<Scenario>("wind.max", In(0, 40, "m/s"),
                       "greatest speed of the wind, where it is cut off: wind.mean and two "
                       "standard deviations of its "
                       "turbulence; at least wind.mean, or 0 for wind without turbulence",
                       TOUCHDOWN_AT(wind.max)));
  keys.push_back(
      Number<Scenario>("wind.direction_deg", In(-360, 360, "deg"),
                       "where the wind blows to, from x in W, left positive; given alone it "
                       "switches wind.direction_random off",
                       TOUCHDOWN_AT(wind.direction_deg)));
  keys.push_back(Bool("wind.direction_random",
                      "draw the direction per seed from the whole circle instead",
                      TOUCHDOWN_AT(wind.direction_random)));
  keys.push_back(Number<Scenario>("wind.gust.speed", In(0, 30, "m/s"),
                                  "a 1-cosine gust along the wind, above wind.max too; 0: none",
                                  TOUCHDOWN_AT(wind.gust.speed)));
  keys.push_back(Number<Scenario>("wind.gust.start", In(0, 600, "s"), "the first gust begins",
                                  TOUCHDOWN_AT(wind.gust.start)));
  keys.push_back(Number<Scenario>("wind.gust.duration", Above(0, 600, "s"),
                                  "total length of a gust", TOUCHDOWN_AT(wind.gust.duration)));
  keys.push_back(
      Number<Scenario>("wind.gust.period", In(0, 600, "s"),
                       "from one gust to the next, at least wind.gust.duration; 0: one only",
                       TOUCHDOWN_AT(wind.gust.period)));
  keys.push_back(Bool("air.ground_effect",
                      "rotors give more thrust close over the deck or the ground",
                      TOUCHDOWN_AT(air.ground_effect)));
  keys.push_back(Bool("air.pad_wake", "the pad vehicle drags air along behind it",
                      TOUCHDOWN_AT(air.pad_wake)));
  const auto factor = [&keys](const char* name, const char* of, auto at) {
    keys.push_back(Number<Scenario>(
        name, In(0.5, 2, ""),
        std::string("the simulated vehicle's ") + of + " over what planner and controller know",
        at));
  };
  factor("plant.mass", "mass", TOUCHDOWN_AT(plant.mass));
  factor("plant.inertia", "inertia", TOUCHDOWN_AT(plant.inertia));
  factor("plant.drag", "drag", TOUCHDOWN_AT(plant.drag));
  factor("plant.rotor_lag", "lag of the rotors", TOUCHDOWN_AT(plant.rotor_lag));
  factor("plant.thrust", "thrust", TOUCHDOWN_AT(plant.thrust));
}

}  // namespace touchdown::evaluation::schema
