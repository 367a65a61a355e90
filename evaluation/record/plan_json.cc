// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/record/plan_report.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "evaluation/scenario/scenario_schema.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

Json VectorJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json PathJson(const std::vector<Eigen::Vector3d>& points) {
  Json json = Json::array();
  for (const Eigen::Vector3d& p : points) json.push_back(VectorJson(p));
  return json;
}

Json CurveJson(const planning::UniformBspline& curve) {
  Json points = Json::array();
  for (int i = 0; i < curve.control_points().cols(); ++i) {
    points.push_back(VectorJson(curve.control_points().col(i)));
  }
  return {{"t0", curve.t0()}, {"h", curve.interval()}, {"control_points", std::move(points)}};
}

Json OutcomeJson(const ReplanOutcome& r) {
  return {{"status", planning::ToString(r.status)},
          {"reason", planning::ToString(r.reason)},
          {"from_odometry", r.from_odometry},
          {"pairs", r.pairs},
          {"solves", r.solves},
          {"rebinds", r.rebinds},
          {"iterations", r.iterations},
          {"cost", r.cost},
          {"work", r.work},
          {"certificate", CertificateJson(r.certificate)},
          {"curve", CurveJson(r.curve)}};
}

Json RoundJson(const planning::RoundLog& round) {
  const solvers::SolverResult& solver = round.solver;
  Json json = {{"guide", round.guide},
               {"pressure", round.pressure},
               {"limit_pressure", round.limit_pressure},
               {"status", solvers::ToString(solver.status)},
               {"message", solver.message},
               {"iterations", solver.iterations},
               {"evaluations", solver.evaluations},
               {"cost", solver.cost},
               {"max_violation", solver.max_violation}};
  Json& costs = json["cost_by_term"] = Json::object();
  for (const solvers::TermCost& term : solver.cost_by_term) costs[term.name] = term.cost;
  Json& trace = json["trace"] = Json::array();
  for (const solvers::IterationRecord& it : solver.trace) {
    trace.push_back({{"iteration", it.iteration},
                     {"cost", it.cost},
                     {"cost_by_term", it.cost_by_term},
                     {"max_violation", it.max_violation},
                     {"gradient_max_norm", it.gradient_max_norm}});
  }
  Json& pairs = json["pairs"] = Json::array();
  for (const planning::ObstaclePair& pair : round.pairs) {
    pairs.push_back({{"control_point", pair.control_point},
                     {"p", VectorJson(pair.p)},
                     {"v", VectorJson(pair.v)}});
  }
  Json& blocked = json["blocked"] = Json::array();
  for (const planning::BlockedRun& run : round.blocked) {
    blocked.push_back({{"t_in", run.t_in},
                       {"t_out", run.t_out},
                       {"at_start", run.at_start},
                       {"at_end", run.at_end}});
  }
  json["curve"] = CurveJson(round.curve);
  return json;
}

Json AttemptJson(const planning::AttemptLog& attempt) {
  Json json = {{"duration_s", attempt.duration},
               {"arrival", attempt.arrival == planning::ArrivalMode::kFree ? "free" : "fixed"},
               {"segments", attempt.segments},
               {"best", attempt.best < 0 ? Json() : Json(attempt.best)},
               {"reason", planning::ToString(attempt.reason)}};
  json["certificate"] = attempt.certificate ? CertificateJson(*attempt.certificate) : Json();
  Json& rounds = json["rounds"] = Json::array();
  for (const planning::RoundLog& round : attempt.rounds) rounds.push_back(RoundJson(round));
  return json;
}

Json InputJson(const SolvedStep& solved) {
  const control::ReplanRequest& request = solved.recorded.request;
  const planning::ReplanInput& input = request.input;
  Json json = {{"t_now", input.t_now},
               {"t_start", input.t_start},
               {"p_WB", VectorJson(input.vehicle.p_WB)},
               {"v_WB", VectorJson(input.vehicle.v_WB)},
               {"rest_climb_m", request.rest_climb ? Json(*request.rest_climb) : Json()},
               {"prediction", request.pad ? solved.scenario.pad.prediction : "none"}};
  json["endpoint"] = {{"height_m", input.endpoint.height},
                      {"sink_rate_mps", input.endpoint.sink_rate},
                      {"height_floor_m", input.endpoint.height_floor},
                      {"arrival_sink_mps", input.endpoint.arrival_sink}};
  Json& pad = json["pad"] = Json::array();
  double t = solved.t_pad;
  for (const estimation::PadState& state : solved.pad) {
    pad.push_back({{"t", t}, {"p_WP", VectorJson(state.p_WP)}, {"v_WP", VectorJson(state.v_WP)}});
    t += SolvedStep::kPadStep;
  }
  json["committed"] = CurveJson(solved.recorded.before.next.curve);
  json["limits"] = {{"speed_mps", solved.limits.speed},
                    {"acceleration_mps2", solved.limits.acceleration}};
  return json;
}

}  // namespace

Json CertificateJson(const planning::Certificate& c) {
  return {{"passed", c.passed()},
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

Json AttemptsJson(const planning::ReplanLog& log) {
  Json attempts = Json::array();
  for (const planning::AttemptLog& attempt : log.attempts) {
    attempts.push_back(AttemptJson(attempt));
  }
  return attempts;
}

Json PlanJson(const SolvedStep& solved, bool drawn) {
  Json json;
  json["source"] = solved.source;
  json["scenario"] = solved.scenario.name;
  json["planner"] = solved.scenario.planner;
  json["backend"] = solved.scenario.solver.backend;
  json["replan"] = solved.step;
  json["input"] = InputJson(solved);
  json["terms"] = solved.terms;
  json["attempts"] = AttemptsJson(solved.log);
  Json& paths = json["guide_paths"] = Json::array();
  for (const auto& path : solved.outcome.guide_paths) paths.push_back(PathJson(path));
  json["result"] = OutcomeJson(solved.outcome);
  const planning::FlightPair& committed = solved.recorded.before.next;
  const bool stops = solved.outcome.certificate.earlier && std::isfinite(committed.t_stop);
  json["result"]["stop"] =
      stops ? Json({{"t_stop", committed.t_stop}, {"curve", CurveJson(committed.stop)}}) : Json();
  json["unseen_W"] = solved.unseen_W ? VectorJson(*solved.unseen_W) : Json();
  json["same_as_record"] = solved.same ? Json(*solved.same) : Json();
  Json& stages = json["wall_clock"]["stages"] = Json::object();
  const auto add = [&stages](const planning::StageTimes::Span& span) {
    stages[span.stage] = {{"cpu_ms", 1e3 * span.cpu}, {"wall_ms", 1e3 * span.wall}};
  };
  for (const planning::StageTimes::Span* stage : solved.times.Stages()) add(*stage);
  add(solved.times.total);
  Json& zones = json["zones"] = Json::array();
  for (const planning::NamedZone& named : solved.zones) {
    zones.push_back({{"term", named.term},
                     {"shape", planning::ToString(named.zone.shape)},
                     {"centre_W", VectorJson(named.zone.centre_W)},
                     {"size_m", VectorJson(named.zone.size)}});
  }
  if (!drawn) return json;
  Json& cells = json["occupied"] = Json::array();
  for (const planning::CellIndex& cell : solved.occupied) {
    cells.push_back({cell.x(), cell.y(), cell.z()});
  }
  Json& prior = json["prior"] = Json::array();
  for (const planning::CellCube& cube : solved.prior) {
    prior.push_back({cube.low.x(), cube.low.y(), cube.low.z(), cube.side});
  }
  json["resolution"] = solved.resolution;
  return json;
}

}  // namespace touchdown::evaluation
