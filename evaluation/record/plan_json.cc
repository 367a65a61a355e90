// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/record/plan_report.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "evaluation/record/step_json.h"
#include "evaluation/scenario/scenario_schema.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

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

Json InputJson(const SolvedStep& solved) {
  const control::ReplanRequest& request = solved.recorded.request;
  const planning::ReplanInput& input = request.input;
  Json json = {{"t_now", input.t_now},
               {"t_start", input.t_start},
               {"p_WB", VectorJson(input.vehicle.p_WB)},
               {"v_WB", VectorJson(input.vehicle.v_WB)},
               {"rest_climb_m", request.rest_climb ? Json(*request.rest_climb) : Json()},
               {"look_from_W", input.look_from_W ? VectorJson(*input.look_from_W) : Json()},
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
  json["result"]["forbidden_by"] = solved.forbidden_by;
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
