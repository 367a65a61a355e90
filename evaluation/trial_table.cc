// SPDX-License-Identifier: BSD-3-Clause
// One row per trial. What depends on the clock stands in its own table, so that two runs of a sweep
// can be compared row by row.
#include "touchdown/evaluation/trial_table.h"

#include <nlohmann/json.hpp>

#include "touchdown/evaluation/result_file.h"
#include "touchdown/evaluation/scenario_schema.h"
#include "touchdown/evaluation/sqlite_db.h"
#include "touchdown/evaluation/statistics.h"
#include "touchdown/evaluation/sweep_cells.h"

namespace touchdown::evaluation {
namespace {

constexpr ResultFormat kFormat{"touchdown trials", 3};

constexpr char kSchema[] = R"sql(
CREATE TABLE trial(trial INTEGER PRIMARY KEY, seed INTEGER, landed INTEGER, outcome TEXT,
  detail TEXT, time_to_land_s REAL, touchdown_error_m REAL, relative_vx_mps REAL,
  relative_vy_mps REAL, relative_vz_mps REAL, tilt_rad REAL, tilt_over_equilibrium_rad REAL,
  mean_abs_error_x_m REAL, mean_abs_error_y_m REAL, min_clearance_m REAL, simulated_s REAL,
  effort_n2s REAL, saturation_share REAL, max_speed_mps REAL, max_acceleration_mps2 REAL,
  replans INTEGER, replans_planned INTEGER, estimator_rmse_position_m REAL,
  estimator_rmse_velocity_mps REAL, estimator_nees_position REAL, following_mean_error_m REAL,
  following_max_error_m REAL, following_relative_speed_mps REAL, own_rmse_position_m REAL,
  own_max_position_m REAL, own_rmse_velocity_mps REAL, own_max_velocity_mps REAL,
  own_rmse_attitude_rad REAL, own_max_attitude_rad REAL, t_star_s REAL, t_star_upper_s REAL,
  time_ratio REAL, within_limits INTEGER);
CREATE TABLE variation(trial INTEGER, key TEXT, value TEXT);
CREATE TABLE varied_key(key TEXT PRIMARY KEY, unit TEXT, kind TEXT);
CREATE TABLE cell(cell INTEGER PRIMARY KEY, trials INTEGER, succeeded INTEGER, rate_lo REAL,
  rate_hi REAL, time_to_land_median_s REAL, touchdown_error_median_m REAL);
CREATE TABLE cell_value(cell INTEGER, key TEXT, value TEXT);
CREATE TABLE timing(trial INTEGER PRIMARY KEY, wall_s REAL, cpu_s REAL, physics_cpu_s REAL,
  sensing_cpu_s REAL, mapping_cpu_s REAL, planning_cpu_s REAL, control_cpu_s REAL,
  judging_cpu_s REAL, replan_median_ms REAL, replan_p95_ms REAL, replan_max_ms REAL,
  deadline_misses INTEGER, depth_image_cpu_s REAL, pad_image_cpu_s REAL, pad_finding_cpu_s REAL,
  pad_filter_cpu_s REAL, own_state_cpu_s REAL);
)sql";

using OptionalReal = std::optional<double>;

void WriteTrial(SqliteStatement& insert, const SweepRow& row) {
  const TrialResult& r = row.result;
  OptionalReal time, error, vx, vy, vz, tilt, over, mean_x, mean_y;
  if (r.landed()) {
    const Touchdown& t = *r.touchdown;
    time = t.t;
    error = t.error_m;
    vx = t.relative_velocity.x();
    vy = t.relative_velocity.y();
    vz = t.relative_velocity.z();
    tilt = t.tilt;
    over = t.tilt_over_equilibrium;
    mean_x = r.mean_abs_error_x_m;
    mean_y = r.mean_abs_error_y_m;
  }
  OptionalReal rmse_position, rmse_velocity, nees;
  if (r.estimator) {
    rmse_position = r.estimator->rmse_position_m;
    rmse_velocity = r.estimator->rmse_velocity_mps;
    nees = r.estimator->nees_position_mean;
  }
  OptionalReal following_mean, following_max, following_speed;
  if (r.following) {
    following_mean = r.following->mean_error_m;
    following_max = r.following->max_error_m;
    following_speed = r.following->relative_speed_mps;
  }
  OptionalReal own_p, own_p_max, own_v, own_v_max, own_q, own_q_max;
  if (r.own_state) {
    own_p = r.own_state->rmse_position_m;
    own_p_max = r.own_state->max_position_m;
    own_v = r.own_state->rmse_velocity_mps;
    own_v_max = r.own_state->max_velocity_mps;
    own_q = r.own_state->rmse_attitude_rad;
    own_q_max = r.own_state->max_attitude_rad;
  }
  const auto planned = r.replans_by_status.find("planned");
  insert.Run(
      row.trial.index, static_cast<std::int64_t>(r.seed), r.landed(), ToString(r.outcome), r.detail,
      time, error, vx, vy, vz, tilt, over, mean_x, mean_y, r.min_clearance_m, r.simulated_s,
      r.effort_n2s, r.saturation_share, r.max_speed_mps, r.max_acceleration_mps2, r.replans,
      planned == r.replans_by_status.end() ? 0 : planned->second, rmse_position, rmse_velocity,
      nees, following_mean, following_max, following_speed, own_p, own_p_max, own_v, own_v_max,
      own_q, own_q_max, r.t_star_s, r.t_star_upper_s, r.time_ratio(), r.within_limits);
}

void WriteTiming(SqliteStatement& insert, const SweepRow& row) {
  const TrialTiming& t = row.result.timing;
  insert.Run(row.trial.index, t.wall_s, t.cpu_s, t.physics_cpu_s, t.sensing_cpu_s, t.mapping_cpu_s,
             t.planning_cpu_s, t.control_cpu_s, t.judging_cpu_s, Quantile(t.replan_wall_ms, 0.5),
             Quantile(t.replan_wall_ms, 0.95), Quantile(t.replan_wall_ms, 1.0), t.deadline_misses,
             t.sensing_stages.depth_image, t.sensing_stages.pad_image, t.sensing_stages.pad_finding,
             t.sensing_stages.pad_filter, t.sensing_stages.own_state);
}

void WriteKeys(SqliteDb& db, const std::vector<Variation>& variations) {
  SqliteStatement insert = db.Prepare("INSERT INTO varied_key VALUES(?, ?, ?)");
  for (const Variation& variation : variations) {
    insert.Run(variation.key, FindScenarioKey(variation.key)->unit,
               variation.values.empty() ? "range" : "list");
  }
}

void WriteCells(SqliteDb& db, const std::vector<SweepCell>& cells) {
  SqliteStatement insert = db.Prepare("INSERT INTO cell VALUES(?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement insert_value = db.Prepare("INSERT INTO cell_value VALUES(?, ?, ?)");
  int id = 0;
  for (const SweepCell& cell : cells) {
    insert.Run(id, cell.trials, cell.succeeded, cell.rate.lo, cell.rate.hi,
               cell.time_to_land_median_s, cell.touchdown_error_median_m);
    for (const auto& [key, value] : cell.values) insert_value.Run(id, key, value);
    ++id;
  }
}

ManifestFacts Facts(const SweepOptions& options, const std::vector<SweepRow>& rows) {
  ManifestFacts facts;
  facts.emplace_back("sweep_seed", std::to_string(options.seed));
  facts.emplace_back("trials", std::to_string(rows.size()));
  nlohmann::json variations = nlohmann::json::array();
  for (const Variation& variation : options.variations) variations.push_back(variation.text);
  facts.emplace_back("set", nlohmann::json(options.overrides).dump());
  facts.emplace_back("vary", variations.dump());
  if (!rows.empty()) {
    facts.emplace_back("scenario", rows.front().trial.scenario.name);
    facts.emplace_back("scenario_yaml", DumpScenario(rows.front().trial.scenario));
  }
  return facts;
}

}  // namespace

void WriteTrialTable(const std::string& path, const SweepOptions& options,
                     const std::vector<SweepRow>& rows) {
  WriteResultFile(path, kFormat, kSchema, Facts(options, rows), [&](SqliteDb& db) {
    SqliteStatement trial = db.Prepare(
        "INSERT INTO trial VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
        "?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    SqliteStatement variation = db.Prepare("INSERT INTO variation VALUES(?, ?, ?)");
    SqliteStatement timing = db.Prepare(
        "INSERT INTO timing VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (const SweepRow& row : rows) {
      WriteTrial(trial, row);
      for (const auto& [key, value] : row.trial.varied) variation.Run(row.trial.index, key, value);
      WriteTiming(timing, row);
    }
    WriteKeys(db, options.variations);
    WriteCells(db, SweepCells(options, rows));
  });
}

}  // namespace touchdown::evaluation
