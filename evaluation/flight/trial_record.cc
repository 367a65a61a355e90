// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/flight/trial_record.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace touchdown::evaluation {
namespace {

bool Same(double a, double b) { return a == b || (!std::isfinite(a) && !std::isfinite(b)); }

bool Same(const planning::UniformBspline& a, const planning::UniformBspline& b) {
  return a.t0() == b.t0() && a.interval() == b.interval() && a.segments() == b.segments() &&
         a.control_points() == b.control_points();
}

bool Same(const planning::Certificate& a, const planning::Certificate& b) {
  return a.passed() == b.passed() && a.endpoint_required == b.endpoint_required &&
         Same(a.endpoint_position_residual, b.endpoint_position_residual) &&
         Same(a.endpoint_velocity_residual, b.endpoint_velocity_residual) &&
         Same(a.speed_bound, b.speed_bound) && Same(a.acceleration_bound, b.acceleration_bound) &&
         Same(a.body_rate_bound, b.body_rate_bound) && a.earlier == b.earlier &&
         a.limits_kept == b.limits_kept && a.recovering == b.recovering && a.clear == b.clear &&
         Same(a.clearance, b.clearance) && a.escaping == b.escaping &&
         a.stops_in_observed_space == b.stops_in_observed_space;
}

}  // namespace

ReplanOutcome OutcomeOf(const planning::ReplanResult& result) {
  ReplanOutcome outcome;
  outcome.status = result.status;
  outcome.reason = result.reason;
  outcome.from_odometry = result.from_odometry;
  outcome.curve = result.curve;
  outcome.certificate = result.certificate;
  outcome.guide_paths.assign(result.guide_paths.begin(), result.guide_paths.end());
  outcome.pairs = result.pairs;
  outcome.solves = result.solves;
  outcome.rebinds = result.rebinds;
  outcome.iterations = result.solver.iterations;
  outcome.cost = result.solver.cost;
  for (const solvers::TermCost& term : result.solver.cost_by_term) {
    if (term.cost != 0.0) outcome.cost_by_term.push_back(term);
  }
  outcome.work = result.work;
  return outcome;
}

bool Same(const ReplanOutcome& a, const ReplanOutcome& b) {
  const auto same_cost = [](const solvers::TermCost& x, const solvers::TermCost& y) {
    return x.name == y.name && Same(x.cost, y.cost);
  };
  return a.status == b.status && a.reason == b.reason && a.from_odometry == b.from_odometry &&
         Same(a.curve, b.curve) && Same(a.certificate, b.certificate) &&
         a.guide_paths == b.guide_paths && a.pairs == b.pairs && a.solves == b.solves &&
         a.rebinds == b.rebinds && a.iterations == b.iterations && Same(a.cost, b.cost) &&
         a.work == b.work &&
         std::equal(a.cost_by_term.begin(), a.cost_by_term.end(), b.cost_by_term.begin(),
                    b.cost_by_term.end(), same_cost);
}

}  // namespace touchdown::evaluation
