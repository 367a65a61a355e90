// SPDX-License-Identifier: BSD-3-Clause
// Keys of tracking, planning, solving and limits.
#include <cctype>

#include "evaluation/scenario/scenario_keys.h"

namespace touchdown::evaluation::schema {

void AddTaskKeys(KeyList& keys) {
  keys.push_back(
      Choice("task", {"land", "follow", "go_to"},
             "land on the pad, stay above it, or fly to a goal; each is judged by its own rule, "
             "and over when it is done",
             TOUCHDOWN_AT(task)));
  keys.push_back(Number<Scenario>(
      "follow.time", In(0, 600, "s"),
      "task follow: done when it was above the pad for so long without a break; 0: "
      "when the time is up, if it was then 2 m from its centre in the mean",
      TOUCHDOWN_AT(follow.time)));
  keys.push_back(
      Number<Scenario>("follow.distance", Above(0, 10, "m"),
                       "task follow: above the pad is up to here from its centre, horizontally",
                       TOUCHDOWN_AT(follow.distance)));
  keys.push_back(Vector<3, Scenario>(
      "go_to.goal", In(-500, 500, "m"),
      "task go_to: where the body's origin is to be, in W, at t = 0; planning.clearance and two "
      "cells from all obstacles, and no lower than plans are",
      TOUCHDOWN_AT(go_to.goal)));
  keys.push_back(Vector<3, Scenario>("go_to.velocity", In(-10, 10, "m/s"),
                                     "task go_to: of the goal", TOUCHDOWN_AT(go_to.velocity)));
  keys.push_back(Number<Scenario>("go_to.time", In(0, 600, "s"),
                                  "task go_to: done when it was there for so long without a break",
                                  TOUCHDOWN_AT(go_to.time)));
  keys.push_back(
      Number<Scenario>("go_to.distance", Above(0, 10, "m"),
                       "task go_to: there is up to here from the goal, with its velocity to within "
                       "this per second",
                       TOUCHDOWN_AT(go_to.distance)));
}

void AddPlanningKeys(KeyList& keys) {
  keys.push_back(Word("controller", "controllers", "tracking law", TOUCHDOWN_AT(controller)));
  keys.push_back(Bool("control.disturbance",
                      "the controller geometric compensates the force and the moment that it "
                      "estimates, and plans leave room for the force; paper has no such estimate",
                      TOUCHDOWN_AT(control.disturbance)));
  keys.push_back(Choice("descent", {"vertical", "planned"},
                        "task land: vertical approaches and then sinks over the pad, "
                        "planned flies one plan to contact; planners that make none, as the "
                        "baselines, have vertical unless it is given",
                        TOUCHDOWN_AT(descent)));
  keys.push_back(Number<Scenario>(
      "mission.corridor_radius", In(0.01, 0.5, "m"),
      "a vertical descent goes on while the horizontal error is at most this at the deck, and 0.35 "
      "m more for each "
      "metre above it: 0.24 m from where contact is committed to, with every planner",
      TOUCHDOWN_AT(mission.corridor_radius)));
  keys.push_back(Word("planner", "planners", "what plans", TOUCHDOWN_AT(planner)));
  keys.push_back(Number<Scenario>("planning.rate", Above(0, 100, "Hz"), "rate of replanning",
                                  TOUCHDOWN_AT(planning.rate)));
  const ValueRange latency = In(0, 1000, "ms");
  keys.push_back({"planning.latency", "ms", latency.ToString() + " or measured",
                  "time from the question to the plan that is flown, no more than the period of "
                  "planning.rate; measured: the wall clock's, late plans are flown late",
                  [latency](Scenario& s, const YAML::Node& n, const Where& w) {
                    s.planning.latency.measured = n.IsScalar() && n.Scalar() == "measured";
                    if (s.planning.latency.measured) return;
                    if (n.IsScalar() && !n.Scalar().empty() && std::isalpha(n.Scalar()[0]) != 0) {
                      RefuseValue(w, "planning.latency",
                                  "a number in " + latency.ToString() + " or measured", n);
                    }
                    s.planning.latency.ms = ReadNumber(n, w, "planning.latency", latency);
                  },
                  [](const Scenario& s) {
                    return s.planning.latency.measured ? "measured"
                                                       : WriteNumber(s.planning.latency.ms);
                  }});
  keys.push_back(Number<Scenario>("planning.clearance", In(0.1, 1, "m"),
                                  "obstacles are grown by this in the map; planner landing: "
                                  "raised to the hull at every tilt and its margins in calm air; "
                                  "ego and ego-velocity: at least the hull's radius",
                                  TOUCHDOWN_AT(planning.clearance)));
  keys.push_back(Number<Scenario>("planning.ceiling", Above(0, 1000, "m"),
                                  "flight ceiling of the vehicle's centre above the ground; above "
                                  "the start and the height at which the pad is followed",
                                  TOUCHDOWN_AT(planning.ceiling)));
  keys.push_back(Number<Scenario>("planning.segment_length", In(0.2, 3, "m"),
                                  "planner landing: a plan's segments are no longer than this at "
                                  "limits.speed, or than it takes at 2.5 m/s",
                                  TOUCHDOWN_AT(planning.segment_length)));
  keys.push_back(
      Whole("planning.guides", 1, 8,
            "most ways around the first obstacle that a step of the landing planner tries; "
            "the cheapest plan wins",
            TOUCHDOWN_AT(planning.guides)));
  keys.push_back(Number<Scenario>("planning.max_duration", In(5, 120, "s"),
                                  "planner landing: longest plan; towards an end that is farther a "
                                  "plan ends on the way",
                                  TOUCHDOWN_AT(planning.max_duration)));
  keys.push_back(
      Whole("planning.max_work", 1000, 1000000,
            "planner landing: what a step may do at most (from rest four times that), in counted "
            "units, of which 10,000 take "
            "1.7 to 3.6 ms; if it finds no plan within that, the next step goes on from there",
            TOUCHDOWN_AT(planning.max_work)));
  keys.push_back(Choice("planning.endpoint_velocity", {"pad", "rest"},
                        "planner landing: a plan ends with the pad's predicted velocity, or stands "
                        "still (but for sinking) where the pad will be",
                        TOUCHDOWN_AT(planning.endpoint_velocity)));
  keys.push_back(Bool("planning.warm_start",
                      "planner landing: a step's first solve begins at the rest of the committed "
                      "plan, else at the curve between the ends alone",
                      TOUCHDOWN_AT(planning.warm_start)));
  keys.push_back(Text("solver.backend", "a name of `touchdown list backends`",
                      "optimiser of planner landing; planners without a choice have their own",
                      TOUCHDOWN_AT(solver.backend)));
  keys.push_back(Choice("solver.arrival", {"fixed", "free"},
                        "arrival time chosen before the solve or optimised in it; unless it is "
                        "given, free with descent planned and fixed with the others",
                        TOUCHDOWN_AT(solver.arrival)));
  keys.push_back(Choice("solver.endpoint", {"eliminated", "explicit"},
                        "both ends of a plan eliminated exactly, or equality constraints",
                        TOUCHDOWN_AT(solver.endpoint)));
  keys.push_back(Choice("solver.limits", {"soft", "hard"},
                        "limits as penalties, or as constraints at the full limit",
                        TOUCHDOWN_AT(solver.limits)));
  keys.push_back(
      Number<Scenario>("solver.gap", In(0, 0.5, ""),
                       "a solve ends so near to the optimum, as a share of the cost, with "
                       "every backend; 0: where the backend's own options say",
                       TOUCHDOWN_AT(solver.gap)));
  keys.push_back(Number<Scenario>("limits.speed", In(0.5, 20, "m/s"), "norm of the velocity",
                                  TOUCHDOWN_AT(limits.speed)));
  keys.push_back(Number<Scenario>("limits.acceleration", In(0.5, 20, "m/s^2"),
                                  "norm of the acceleration; plans keep the lesser of this and "
                                  "g tan(limits.tilt_deg)",
                                  TOUCHDOWN_AT(limits.acceleration)));
  keys.push_back(Number<Scenario>("limits.tilt_deg", In(5, 60, "deg"),
                                  "plans accelerate no more than this tilt gives in level flight; "
                                  "the controller may tilt 10 deg more",
                                  TOUCHDOWN_AT(limits.tilt_deg)));
}

}  // namespace touchdown::evaluation::schema
