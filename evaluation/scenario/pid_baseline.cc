// SPDX-License-Identifier: BSD-3-Clause
// The PID baseline by its keys.
#include "planning/baselines/pid/pid_follower.h"
#include "touchdown/evaluation/scenario/planner_entry.h"

namespace touchdown::evaluation {
namespace {

using planning::PidGains;

const std::vector<OptionKey<PidGains>>& PidKeys() {
  static const std::vector<OptionKey<PidGains>> keys = {
      {"pid.proportional",
       [](PidGains& g) -> double& { return g.proportional; },
       {0, 10, true, "1/s"},
       "planner pid: velocity per horizontal position error"},
      {"pid.integral",
       [](PidGains& g) -> double& { return g.integral; },
       {0, 10, false, "1/s^2"},
       "planner pid: velocity per integral of that error"},
      {"pid.derivative",
       [](PidGains& g) -> double& { return g.derivative; },
       {0, 10, false, ""},
       "planner pid: velocity per velocity relative to the pad"},
      {"pid.integral_limit",
       [](PidGains& g) -> double& { return g.integral_limit; },
       {0, 10, false, "m/s"},
       "planner pid: most that the integral adds"},
      {"pid.integral_zone",
       [](PidGains& g) -> double& { return g.integral_zone; },
       {0, 100, false, "m"},
       "planner pid: farther from the pad the integral stands still"},
      {"pid.height",
       [](PidGains& g) -> double& { return g.height; },
       {0, 10, true, "1/s"},
       "planner pid: vertical velocity per error of the height"},
      {"pid.response",
       [](PidGains& g) -> double& { return g.response; },
       {0.05, 10, false, "s"},
       "planner pid: time constant with which a velocity is taken up"},
  };
  return keys;
}

}  // namespace

PlannerEntry PidPlanner() {
  PlannerEntry entry;
  entry.name = "pid";
  entry.summary = "PID law that tracks the pad, then descends; knows no obstacles";
  entry.avoids = false;
  entry.rate = planning::PidFollower::kRate;
  entry.parameters = ParametersOf(PidKeys());
  entry.make = [](const PlannerSetup& setup) {
    PidGains gains;
    Set(setup, PidKeys(), &gains);
    return std::make_unique<planning::PidFollower>(gains, setup.limits);
  };
  return entry;
}

}  // namespace touchdown::evaluation
