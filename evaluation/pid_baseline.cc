// SPDX-License-Identifier: BSD-3-Clause
// The PID baseline by its keys.
#include "touchdown/evaluation/planner_entry.h"
#include "touchdown/planning/pid/pid_follower.h"

namespace touchdown::evaluation {

PlannerEntry PidPlanner() {
  const planning::PidGains gains;
  PlannerEntry entry;
  entry.name = "pid";
  entry.summary = "PID law that tracks the pad, then descends; knows no obstacles";
  entry.avoids = false;
  entry.rate = planning::PidFollower::kRate;
  entry.parameters = {
      {"pid.proportional",
       gains.proportional,
       {0, 10, true, "1/s"},
       "planner pid: velocity per horizontal position error"},
      {"pid.integral",
       gains.integral,
       {0, 10, false, "1/s^2"},
       "planner pid: velocity per integral of that error"},
      {"pid.derivative",
       gains.derivative,
       {0, 10, false, ""},
       "planner pid: velocity per velocity relative to the pad"},
      {"pid.integral_limit",
       gains.integral_limit,
       {0, 10, false, "m/s"},
       "planner pid: most that the integral adds"},
      {"pid.integral_zone",
       gains.integral_zone,
       {0, 100, false, "m"},
       "planner pid: farther from the pad the integral stands still"},
      {"pid.height",
       gains.height,
       {0, 10, true, "1/s"},
       "planner pid: vertical velocity per error of the height"},
      {"pid.response",
       gains.response,
       {0.05, 10, false, "s"},
       "planner pid: time constant with which a velocity is taken up"},
  };
  entry.make = [](const PlannerSetup& setup) {
    planning::PidGains given;
    given.proportional = setup.Get("pid.proportional");
    given.integral = setup.Get("pid.integral");
    given.derivative = setup.Get("pid.derivative");
    given.integral_limit = setup.Get("pid.integral_limit");
    given.integral_zone = setup.Get("pid.integral_zone");
    given.height = setup.Get("pid.height");
    given.response = setup.Get("pid.response");
    return std::make_unique<planning::PidFollower>(given, setup.limits);
  };
  return entry;
}

}  // namespace touchdown::evaluation
