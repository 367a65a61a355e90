// SPDX-License-Identifier: BSD-3-Clause
// The machine-readable result of one trial. Fields that do not apply are null, never left out.
#include "evaluation/record/trial_json.h"

#include "estimation/base/degrees.h"
#include "evaluation/base/statistics.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_schema.h"

#include <nlohmann/json.hpp>

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json TouchdownJson(const TrialResult& result) {
  Json json = {{"error_m", nullptr},
               {"relative_velocity_mps", nullptr},
               {"tilt_deg", nullptr},
               {"tilt_over_equilibrium_deg", nullptr}};
  if (!result.landed() || !result.touchdown) return json;
  const Touchdown& t = *result.touchdown;
  json["error_m"] = t.error_m;
  json["relative_velocity_mps"] = {t.relative_velocity.x(), t.relative_velocity.y(),
                                   t.relative_velocity.z()};
  json["tilt_deg"] = t.tilt * estimation::kDegPerRad;
  json["tilt_over_equilibrium_deg"] = t.tilt_over_equilibrium * estimation::kDegPerRad;
  return json;
}

Json EstimatorJson(const std::optional<EstimatorQuality>& quality) {
  if (!quality) return nullptr;
  return {{"rmse_position_m", quality->rmse_position_m},
          {"rmse_velocity_mps", quality->rmse_velocity_mps},
          {"nees_position_mean", quality->nees_position_mean},
          {"nees_dof", 2},
          {"samples", quality->samples}};
}

Json OwnStateJson(const std::optional<OwnStateQuality>& quality) {
  if (!quality) return nullptr;
  return {{"rmse_position_m", quality->rmse_position_m},
          {"max_position_m", quality->max_position_m},
          {"rmse_velocity_mps", quality->rmse_velocity_mps},
          {"max_velocity_mps", quality->max_velocity_mps},
          {"rmse_attitude_deg", quality->rmse_attitude_rad * estimation::kDegPerRad},
          {"max_attitude_deg", quality->max_attitude_rad * estimation::kDegPerRad}};
}

Json SafetyJson(const std::optional<SafetyFigures>& safety) {
  if (!safety) return nullptr;
  return {{"uncertified_steps", safety->uncertified_steps},
          {"escaping_steps", safety->escaping_steps},
          {"escaping_hit_steps", safety->escaping_hit_steps},
          {"escaping_unknown_steps", safety->escaping_unknown_steps},
          {"narrow_steps", safety->narrow_steps},
          {"stops_flown", safety->stops_flown},
          {"map_errors", safety->map_errors},
          {"margin_mean_m", safety->margin_mean_m},
          {"margin_max_m", safety->margin_max_m},
          {"tracking_events", safety->tracking_events},
          {"tracking_max_m", safety->tracking_max_m},
          {"drift_events", safety->drift_events},
          {"drift_max_m", safety->drift_max_m},
          {"free_cells", safety->free_cells},
          {"falsely_free_cells", safety->falsely_free_cells}};
}

Json PriorJson(const std::optional<PriorFigures>& prior) {
  if (!prior) return nullptr;
  return {{"occupied_cells", prior->occupied},
          {"looked_at_cells", prior->looked_at},
          {"gone_cells", prior->gone},
          {"new_cells", prior->appeared}};
}

Json NoWayJson(const std::optional<NoWayFigures>& no_way) {
  if (!no_way) return nullptr;
  Json json = {{"since_s", no_way->since_s},
               {"looks", no_way->looks},
               {"narrowest", nullptr},
               {"needed_m", no_way->needed_m}};
  if (const auto& place = no_way->narrowest) {
    json["narrowest"] = {{"position_m", {place->p_W.x(), place->p_W.y(), place->p_W.z()}},
                         {"width_m", place->width}};
  }
  return json;
}

Json FollowingJson(const std::optional<Following>& following) {
  if (!following) return nullptr;
  return {{"mean_error_m", following->mean_error_m},
          {"max_error_m", following->max_error_m},
          {"relative_speed_mps", following->relative_speed_mps}};
}

Json WallClockJson(const TrialTiming& timing) {
  Json json;
  json["replan_latency_ms"] = QuantilesJson(timing.replan_wall_ms);
  json["replan_cpu_ms"] = QuantilesJson(timing.replan_cpu_ms);
  json["deadline_misses"] = timing.deadline_misses;
  json["deadline_misses_cpu"] = timing.deadline_misses_cpu;
  json["realtime_factor"] = timing.wall_s > 0.0 ? Json(timing.simulated_s / timing.wall_s) : Json();
  json["realtime_factor_cpu"] =
      timing.cpu_s > 0.0 ? Json(timing.simulated_s / timing.cpu_s) : Json();
  json["wall_s"] = timing.wall_s;
  json["cpu_s"] = {{"total", timing.cpu_s},
                   {"physics", timing.physics_cpu_s},
                   {"sensing", timing.sensing_cpu_s},
                   {"mapping", timing.mapping_cpu_s},
                   {"planning", timing.planning_cpu_s},
                   {"control", timing.control_cpu_s},
                   {"judging", timing.judging_cpu_s}};
  json["sensing_cpu_s"] = {{"depth_image", timing.sensing_stages.depth_image},
                           {"pad_image", timing.sensing_stages.pad_image},
                           {"pad_finding", timing.sensing_stages.pad_finding},
                           {"pad_filter", timing.sensing_stages.pad_filter},
                           {"own_state", timing.sensing_stages.own_state}};
  return json;
}

}  // namespace

Json QuantilesJson(const std::vector<double>& values) {
  return {{"median", OrNull(Quantile(values, 0.5))},
          {"p95", OrNull(Quantile(values, 0.95))},
          {"p99", OrNull(Quantile(values, 0.99))},
          {"max", OrNull(Quantile(values, 1.0))}};
}

std::optional<Eigen::Vector2d> LastErrors(const Scenario& scenario, const TrialResult& result) {
  if (scenario.descent != DescentKind::kVertical || !result.landed()) return std::nullopt;
  if (!result.mean_abs_error_x_m || !result.mean_abs_error_y_m) return std::nullopt;
  return Eigen::Vector2d(*result.mean_abs_error_x_m, *result.mean_abs_error_y_m);
}

Json LandJson(const Scenario& scenario, const TrialResult& result) {
  const std::optional<Eigen::Vector2d> last = LastErrors(scenario, result);
  Json json;
  json["landed"] = result.landed();
  json["outcome"] = ToString(result.outcome);
  json["detail"] = result.detail;
  json["time_to_land_s"] = result.landed() ? Json(result.touchdown->t) : Json();
  json["t_star_s"] = OrNull(result.t_star_s);
  json["t_star_upper_s"] = OrNull(result.t_star_upper_s);
  json["time_ratio"] = OrNull(result.time_ratio());
  json["within_limits"] = result.within_limits;
  json["touchdown"] = TouchdownJson(result);
  json["mean_abs_error_last_5s_m"] = {{"x", last ? Json(last->x()) : Json()},
                                      {"y", last ? Json(last->y()) : Json()}};
  json["following"] = FollowingJson(result.following);
  json["min_clearance_m"] = OrNull(result.min_clearance_m);
  json["simulated_s"] = result.simulated_s;
  json["effort_n2s"] = result.effort_n2s;
  json["saturation_share"] = result.saturation_share;
  json["max_speed_mps"] = result.max_speed_mps;
  json["max_acceleration_mps2"] = result.max_acceleration_mps2;
  json["replans"] = result.replans;
  json["replans_by_status"] = result.replans_by_status;
  json["replans_by_reason"] = result.replans_by_reason;
  json["replans_forbidden_by"] = result.replans_forbidden_by;
  json["gate_steps"] = result.gate_steps;
  json["first_tag_s"] = OrNull(result.first_tag_s);
  json["estimator"] = EstimatorJson(result.estimator);
  json["own_state"] = OwnStateJson(result.own_state);
  json["safety"] = SafetyJson(result.safety);
  json["map_prior"] = PriorJson(result.prior);
  json["looks"] = result.looks;
  json["no_way"] = NoWayJson(result.no_way);
  json["planner"] = scenario.planner;
  json["backend"] = scenario.solver_name();
  json["scenario"] = scenario.name;
  json["seed"] = result.seed;
  json["wall_clock"] = WallClockJson(result.timing);
  return json;
}

}  // namespace touchdown::evaluation
