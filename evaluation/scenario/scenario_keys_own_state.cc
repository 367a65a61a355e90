// SPDX-License-Identifier: BSD-3-Clause
// Keys of the vehicle's estimate of its own state, and of the sensors for it.
#include "evaluation/scenario/scenario_keys.h"

namespace touchdown::evaluation::schema {

void AddOwnStateKeys(KeyList& keys) {
  keys.push_back(Choice("own_state", {"true", "estimated"},
                        "what the vehicle knows of its own state: all, or what a filter makes of "
                        "the sensors under own",
                        TOUCHDOWN_AT(own_state)));
  keys.push_back(Number<Scenario>("own.imu.noise", In(0, 20, ""),
                                  "factor on the noise and the biases of the IMU",
                                  TOUCHDOWN_AT(own.imu_noise)));
  keys.push_back(Number<Scenario>("own.gps.rate", In(0, 100, "Hz"),
                                  "rate of the vehicle's own GPS; 0: it has none",
                                  TOUCHDOWN_AT(own.gps.rate)));
  keys.push_back(Number<Scenario>("own.gps.sigma", In(0, 5, "m"),
                                  "standard deviation of a fix, x and y; twice as much in z",
                                  TOUCHDOWN_AT(own.gps.sigma)));
  keys.push_back(
      Number<Scenario>("own.gps.drift", In(0, 5, "m"),
                       "standard deviation of a slow error (60 s), added to own.gps.sigma",
                       TOUCHDOWN_AT(own.gps.drift)));
  keys.push_back(Number<Scenario>("own.gps.latency_ms", In(0, 400, "ms"),
                                  "from the time stamp of a fix to the filter",
                                  TOUCHDOWN_AT(own.gps.latency_ms)));
  keys.push_back(Vector<2, Scenario>("own.gps.outage", In(0, 600, "s"),
                                     "no fix comes from the first time to the second; none is "
                                     "missing if they are equal",
                                     TOUCHDOWN_AT(own.gps.outage)));
  keys.push_back(Number<Scenario>("own.odometry.rate", In(0, 200, "Hz"),
                                  "rate of a velocity in the body's axes; 0: there is none",
                                  TOUCHDOWN_AT(own.odometry.rate)));
  keys.push_back(Number<Scenario>("own.odometry.sigma", In(0, 5, "m/s"),
                                  "its standard deviation, each axis",
                                  TOUCHDOWN_AT(own.odometry.sigma)));
  keys.push_back(
      Number<Scenario>("own.odometry.drift", In(0, 5, "m/s"),
                       "standard deviation of a slow error (10 s), added to own.odometry.sigma",
                       TOUCHDOWN_AT(own.odometry.drift)));
  keys.push_back(Number<Scenario>("own.height.rate", In(0, 100, "Hz"),
                                  "rate of the barometer; 0: there is none",
                                  TOUCHDOWN_AT(own.height.rate)));
  keys.push_back(Number<Scenario>("own.height.sigma", In(0, 10, "m"), "its standard deviation",
                                  TOUCHDOWN_AT(own.height.sigma)));
  keys.push_back(Number<Scenario>("own.heading.rate", In(0, 100, "Hz"),
                                  "rate of the heading sensor; 0: there is none",
                                  TOUCHDOWN_AT(own.heading.rate)));
  keys.push_back(Number<Scenario>("own.heading.sigma_deg", In(0, 45, "deg"),
                                  "its standard deviation", TOUCHDOWN_AT(own.heading.sigma_deg)));
}

}  // namespace touchdown::evaluation::schema
