// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/record/step_json.h"

#include <utility>

#include <nlohmann/json.hpp>

namespace touchdown::evaluation {
namespace {

using StepJson = nlohmann::ordered_json;

StepJson RoundJson(const planning::RoundLog& round) {
  const solvers::SolverResult& solver = round.solver;
  StepJson json = {{"guide", round.guide},
                   {"pressure", round.pressure},
                   {"limit_pressure", round.limit_pressure},
                   {"status", solvers::ToString(solver.status)},
                   {"message", solver.message},
                   {"iterations", solver.iterations},
                   {"evaluations", solver.evaluations},
                   {"cost", solver.cost},
                   {"max_violation", solver.max_violation}};
  StepJson& costs = json["cost_by_term"] = StepJson::object();
  for (const solvers::TermCost& term : solver.cost_by_term) costs[term.name] = term.cost;
  StepJson& trace = json["trace"] = StepJson::array();
  for (const solvers::IterationRecord& it : solver.trace) {
    trace.push_back({{"iteration", it.iteration},
                     {"cost", it.cost},
                     {"cost_by_term", it.cost_by_term},
                     {"max_violation", it.max_violation},
                     {"gradient_max_norm", it.gradient_max_norm}});
  }
  StepJson& pairs = json["pairs"] = StepJson::array();
  for (const planning::ObstaclePair& pair : round.pairs) {
    pairs.push_back({{"control_point", pair.control_point},
                     {"p", VectorJson(pair.p)},
                     {"v", VectorJson(pair.v)}});
  }
  StepJson& blocked = json["blocked"] = StepJson::array();
  for (const planning::BlockedRun& run : round.blocked) {
    blocked.push_back({{"t_in", run.t_in},
                       {"t_out", run.t_out},
                       {"at_start", run.at_start},
                       {"at_end", run.at_end}});
  }
  json["curve"] = CurveJson(round.curve);
  return json;
}

StepJson AttemptJson(const planning::AttemptLog& attempt) {
  StepJson json = {{"duration_s", attempt.duration},
                   {"arrival", attempt.arrival == planning::ArrivalMode::kFree ? "free" : "fixed"},
                   {"segments", attempt.segments},
                   {"best", attempt.best < 0 ? StepJson() : StepJson(attempt.best)},
                   {"reason", planning::ToString(attempt.reason)},
                   {"forbidden_by", attempt.forbidden_by}};
  json["certificate"] = attempt.certificate ? CertificateJson(*attempt.certificate) : StepJson();
  StepJson& rounds = json["rounds"] = StepJson::array();
  for (const planning::RoundLog& round : attempt.rounds) rounds.push_back(RoundJson(round));
  return json;
}

}  // namespace

StepJson VectorJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

StepJson PathJson(const std::vector<Eigen::Vector3d>& points) {
  StepJson json = StepJson::array();
  for (const Eigen::Vector3d& p : points) json.push_back(VectorJson(p));
  return json;
}

StepJson CurveJson(const planning::UniformBspline& curve) {
  StepJson points = StepJson::array();
  for (int i = 0; i < curve.control_points().cols(); ++i) {
    points.push_back(VectorJson(curve.control_points().col(i)));
  }
  return {{"t0", curve.t0()}, {"h", curve.interval()}, {"control_points", std::move(points)}};
}

StepJson CertificateJson(const planning::Certificate& c) {
  return {{"passed", c.passed()},
          {"start_met", c.start_met()},
          {"endpoint_met", c.endpoint_met()},
          {"endpoint_required", c.endpoint_required},
          {"endpoint_position_residual_m", c.endpoint_position_residual},
          {"endpoint_velocity_residual_mps", c.endpoint_velocity_residual},
          {"speed_bound_mps", c.speed_bound},
          {"acceleration_bound_mps2", c.acceleration_bound},
          {"body_rate_bound_radps", c.body_rate_bound},
          {"earlier", c.earlier},
          {"limits_kept", c.limits_kept},
          {"recovering", c.recovering},
          {"clear", c.clear},
          {"clearance_m", c.clearance},
          {"escaping", c.escaping},
          {"stops_in_observed_space", c.stops_in_observed_space}};
}

StepJson AttemptsJson(const planning::ReplanLog& log) {
  StepJson attempts = StepJson::array();
  for (const planning::AttemptLog& attempt : log.attempts) {
    attempts.push_back(AttemptJson(attempt));
  }
  return attempts;
}

}  // namespace touchdown::evaluation
