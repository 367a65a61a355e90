// SPDX-License-Identifier: BSD-3-Clause
// A record's tables, written in one transaction. Column names carry units where they are not SI and
// frames where there is a choice; docs/record.md explains each.
#include "evaluation/record/record.h"

#include <fmt/format.h>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/build_info.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/record/trial_json.h"

namespace touchdown::evaluation {
namespace {

constexpr char kSchema[] = R"sql(
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE vehicle(t REAL, source TEXT, px REAL, py REAL, pz REAL, vx REAL, vy REAL, vz REAL,
  qw REAL, qx REAL, qy REAL, qz REAL, wx REAL, wy REAL, wz REAL);
CREATE TABLE pad(t REAL, source TEXT, px REAL, py REAL, pz REAL, vx REAL, vy REAL, vz REAL,
  yaw REAL, yaw_rate REAL, cov_xx REAL, cov_xy REAL, cov_yy REAL);
CREATE TABLE reference(t REAL, px REAL, py REAL, pz REAL, vx REAL, vy REAL, vz REAL,
  ax REAL, ay REAL, az REAL, yaw REAL, yaw_rate REAL);
CREATE TABLE rotor(t REAL, thrust0 REAL, thrust1 REAL, thrust2 REAL, thrust3 REAL, thrust4 REAL,
  thrust5 REAL, thrust6 REAL, thrust7 REAL);
CREATE TABLE air(t REAL, vx REAL, vy REAL, vz REAL);
CREATE TABLE disturbance(t REAL, fx REAL, fy REAL, fz REAL, mx REAL, my REAL, mz REAL,
                         thrust_gain REAL);
CREATE TABLE mode(t REAL, mode TEXT);
CREATE TABLE event(t REAL, kind TEXT, text TEXT);
CREATE TABLE plan(id INTEGER PRIMARY KEY, t_now REAL, t_start REAL, status TEXT, reason TEXT,
  from_odometry INTEGER, t0 REAL, h REAL, points INTEGER, pairs INTEGER, solves INTEGER,
  rebinds INTEGER, iterations INTEGER, cost REAL, work INTEGER, passed INTEGER, endpoint_position_residual REAL,
  endpoint_velocity_residual REAL, speed_bound REAL, acceleration_bound REAL, body_rate_bound REAL,
  limits_kept INTEGER,
  recovering INTEGER, clear INTEGER, clearance REAL, endpoint_required INTEGER, earlier INTEGER,
  escaping INTEGER, stops_in_observed_space INTEGER);
CREATE TABLE control_point(plan INTEGER, i INTEGER, x REAL, y REAL, z REAL);
CREATE TABLE term_cost(plan INTEGER, i INTEGER, term TEXT, cost REAL);
CREATE TABLE guide_path(plan INTEGER, path INTEGER, i INTEGER, x REAL, y REAL, z REAL);
CREATE TABLE map_window(plan INTEGER PRIMARY KEY, ix INTEGER, iy INTEGER, iz INTEGER);
CREATE TABLE map_change(plan INTEGER, ix INTEGER, iy INTEGER, iz INTEGER, count INTEGER,
  state TEXT);
CREATE TABLE replan_input(plan INTEGER PRIMARY KEY, t_now REAL, t_start REAL, rest_climb REAL,
  look_x REAL, look_y REAL, look_z REAL,
  px REAL, py REAL, pz REAL, vx REAL, vy REAL, vz REAL,
  qw REAL, qx REAL, qy REAL, qz REAL, wx REAL, wy REAL, wz REAL,
  pad_px REAL, pad_py REAL, pad_pz REAL, pad_vx REAL, pad_vy REAL, pad_vz REAL,
  pad_ax REAL, pad_ay REAL, pad_az REAL, pad_yaw REAL, pad_yaw_rate REAL,
  endpoint_t_reference REAL, endpoint_height REAL, endpoint_sink_rate REAL,
  endpoint_height_floor REAL, endpoint_arrival_sink REAL, endpoint_at_rest INTEGER,
  pull_x REAL, pull_y REAL, pull_z REAL,
  margin_own_state REAL, margin_attitude REAL, margin_tracking REAL);
CREATE TABLE prediction(plan INTEGER PRIMARY KEY, known INTEGER, motion TEXT, t REAL, height REAL,
  noise_position REAL, noise_velocity REAL, noise_acceleration REAL, noise_heading REAL,
  noise_turn REAL);
CREATE TABLE belief(plan INTEGER, i INTEGER, mean REAL, cov0 REAL, cov1 REAL, cov2 REAL, cov3 REAL,
  cov4 REAL, PRIMARY KEY(plan, i));
CREATE TABLE bound_part(plan INTEGER, i INTEGER, t_from REAL, t_to REAL);
CREATE TABLE unfinished(plan INTEGER PRIMARY KEY, attempt INTEGER, duration REAL, arrival_free INTEGER,
  unseen_reach REAL);
CREATE TABLE replanner_state(plan INTEGER PRIMARY KEY, planned INTEGER, around_unseen INTEGER, looked_t REAL, asked_t REAL, climb REAL, strip_t REAL,
  strip_from_x REAL, strip_from_y REAL, strip_to_x REAL, strip_to_y REAL, strip_floor REAL,
  current_t0 REAL, current_h REAL, current_stop_t0 REAL, current_stop_h REAL, next_t0 REAL,
  next_h REAL, next_stop_t0 REAL, next_stop_h REAL, current_t_stop REAL,
  current_proven INTEGER, current_from_unknown INTEGER, next_t_stop REAL, next_proven INTEGER,
  next_from_unknown INTEGER);
CREATE TABLE state_point(plan INTEGER, curve TEXT, i INTEGER, x REAL, y REAL, z REAL);
CREATE TABLE obstacle(id INTEGER PRIMARY KEY, key TEXT, kind TEXT, cx REAL, cy REAL, cz REAL,
  size_x REAL, size_y REAL, size_z REAL, radius REAL, yaw REAL);
CREATE TABLE surface(obstacle INTEGER, corners BLOB, triangles BLOB);
CREATE TABLE zone(id INTEGER PRIMARY KEY, term TEXT, shape TEXT, cx REAL, cy REAL, cz REAL,
  size_x REAL, size_y REAL, size_z REAL);
CREATE TABLE prior(state TEXT PRIMARY KEY, cubes BLOB);
CREATE TABLE timing(stage TEXT PRIMARY KEY, cpu_s REAL);
CREATE TABLE plan_timing(plan INTEGER PRIMARY KEY, latency_s REAL, wall_s REAL, cpu_s REAL);
)sql";

void WriteMeta(SqliteDb& db, const Scenario& scenario, const TrialResult& result,
               const TrialRecord& record) {
  SqliteStatement insert = db.Prepare("INSERT INTO meta VALUES(?, ?)");
  insert.Run("format", "touchdown record");
  insert.Run("version", std::to_string(kRecordVersion));
  insert.Run("scenario", scenario.name);
  insert.Run("scenario_yaml", DumpScenario(scenario));
  insert.Run("seed", std::to_string(result.seed));
  insert.Run("map_resolution", fmt::format("{}", record.map_resolution));
  const planning::CellIndex& cells = record.map_size;
  insert.Run("map_size", fmt::format("{} {} {}", cells.x(), cells.y(), cells.z()));
  insert.Run("pad_waypoints", record.outside.pad_waypoints);
  insert.Run("hover",
             fmt::format("{} {} {}", record.hover_W.x(), record.hover_W.y(), record.hover_W.z()));
  insert.Run("idle_steps", std::to_string(record.idle_steps));
  insert.Run("vehicle_hash", record.outside.vehicle_hash);
  insert.Run("world_hash", record.outside.world_hash);
  nlohmann::ordered_json json = LandJson(scenario, result);
  json.erase("wall_clock");  // wall-clock figures stand only in the tables timing and plan_timing
  insert.Run("result_json", json.dump());
  for (const auto& [key, value] : BuildManifest()) insert.Run(key, value);
}

void WriteVehicle(SqliteStatement& insert, const estimation::VehicleState& s, double t,
                  const char* source) {
  insert.Run(t, source, s.p_WB.x(), s.p_WB.y(), s.p_WB.z(), s.v_WB.x(), s.v_WB.y(), s.v_WB.z(),
             s.q_WB.w(), s.q_WB.x(), s.q_WB.y(), s.q_WB.z(), s.w_WB_B.x(), s.w_WB_B.y(),
             s.w_WB_B.z());
}

void WritePad(SqliteStatement& insert, const estimation::PadState& s, double t,
              const char* source) {
  insert.Run(t, source, s.p_WP.x(), s.p_WP.y(), s.p_WP.z(), s.v_WP.x(), s.v_WP.y(), s.v_WP.z(),
             s.yaw, s.yaw_rate, s.cov_p(0, 0), s.cov_p(0, 1), s.cov_p(1, 1));
}

void WriteSamples(SqliteDb& db, const std::vector<RecordSample>& samples) {
  SqliteStatement vehicle =
      db.Prepare("INSERT INTO vehicle VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement pad = db.Prepare("INSERT INTO pad VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement reference =
      db.Prepare("INSERT INTO reference VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement rotor = db.Prepare("INSERT INTO rotor VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement air = db.Prepare("INSERT INTO air VALUES(?, ?, ?, ?)");
  SqliteStatement disturbance =
      db.Prepare("INSERT INTO disturbance VALUES(?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement mode = db.Prepare("INSERT INTO mode VALUES(?, ?)");
  for (const RecordSample& s : samples) {
    WriteVehicle(vehicle, s.vehicle, s.t, "true");
    WriteVehicle(vehicle, s.vehicle_estimate, s.t, "estimate");
    WritePad(pad, s.pad, s.t, "true");
    if (s.pad_known) WritePad(pad, s.pad_estimate, s.t, "estimate");
    const planning::FlatState& r = s.reference;
    reference.Run(s.t, r.p_WB.x(), r.p_WB.y(), r.p_WB.z(), r.v_WB.x(), r.v_WB.y(), r.v_WB.z(),
                  r.a_WB.x(), r.a_WB.y(), r.a_WB.z(), r.yaw, r.yaw_rate);
    Eigen::Matrix<double, estimation::kMostActuators, 1> thrusts;
    thrusts.setConstant(std::numeric_limits<double>::quiet_NaN());  // no such rotor
    thrusts.head(s.rotor_thrusts.size()) = s.rotor_thrusts;
    rotor.Run(s.t, thrusts[0], thrusts[1], thrusts[2], thrusts[3], thrusts[4], thrusts[5],
              thrusts[6], thrusts[7]);
    air.Run(s.t, s.air.x(), s.air.y(), s.air.z());
    const Eigen::Vector3d& f = s.disturbance.force_W;
    const Eigen::Vector3d& m = s.disturbance.moment_B;
    disturbance.Run(s.t, f.x(), f.y(), f.z(), m.x(), m.y(), m.z(), s.disturbance.thrust_gain);
    mode.Run(s.t, s.mode);
  }
}

void WriteResult(SqliteStatement& insert, int id, const RecordPlan& row) {
  const ReplanOutcome& r = row.result;
  const planning::Certificate& c = r.certificate;
  insert.Run(id, row.request.input.t_now, row.request.input.t_start, planning::ToString(r.status),
             planning::ToString(r.reason), r.from_odometry, r.curve.t0(), r.curve.interval(),
             static_cast<int>(r.curve.control_points().cols()), r.pairs, r.solves, r.rebinds,
             r.iterations, r.cost, r.work, c.passed(), c.endpoint_position_residual,
             c.endpoint_velocity_residual, c.speed_bound, c.acceleration_bound, c.body_rate_bound,
             c.limits_kept, c.recovering, c.clear, c.clearance, c.endpoint_required, c.earlier,
             c.escaping, c.stops_in_observed_space);
}

void WriteInput(SqliteStatement& insert, int id, const RecordPlan& row) {
  const planning::ReplanInput& input = row.request.input;
  const estimation::VehicleState& v = input.vehicle;
  const estimation::PadState& pad = row.pad;
  const planning::EndpointTarget& end = input.endpoint;
  const auto look = [&input](int axis) -> std::optional<double> {
    return input.look_from_W ? std::optional<double>((*input.look_from_W)[axis]) : std::nullopt;
  };
  insert.Run(id, input.t_now, input.t_start, row.request.rest_climb, look(0), look(1), look(2),
             v.p_WB.x(), v.p_WB.y(), v.p_WB.z(), v.v_WB.x(), v.v_WB.y(), v.v_WB.z(), v.q_WB.w(),
             v.q_WB.x(), v.q_WB.y(), v.q_WB.z(), v.w_WB_B.x(), v.w_WB_B.y(), v.w_WB_B.z(),
             pad.p_WP.x(), pad.p_WP.y(), pad.p_WP.z(), pad.v_WP.x(), pad.v_WP.y(), pad.v_WP.z(),
             pad.a_WP.x(), pad.a_WP.y(), pad.a_WP.z(), pad.yaw, pad.yaw_rate, end.t_reference,
             end.height, end.sink_rate, end.height_floor, end.arrival_sink, end.at_rest,
             input.pull_W.x(), input.pull_W.y(), input.pull_W.z(), input.margins.own_state,
             input.margins.attitude, input.margins.tracking);
}

std::optional<double> FiniteOrNone(double x) {
  return std::isfinite(x) ? std::optional<double>(x) : std::nullopt;
}

void WritePoints(SqliteStatement& insert, int id, const char* curve,
                 const planning::ControlPoints& q) {
  for (int i = 0; i < q.cols(); ++i) insert.Run(id, curve, i, q(0, i), q(1, i), q(2, i));
}

// The input for asking the replanner again: one row a step, with points and matrix rows in other
// tables.
void WriteRequests(SqliteDb& db, const std::vector<RecordPlan>& plans) {
  SqliteStatement input = db.Prepare(
      "INSERT INTO replan_input VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
      "?, "
      "?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement prediction =
      db.Prepare("INSERT INTO prediction VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement belief = db.Prepare("INSERT INTO belief VALUES(?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement state = db.Prepare(
      "INSERT INTO replanner_state VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
      "?, ?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement bound = db.Prepare("INSERT INTO bound_part VALUES(?, ?, ?, ?)");
  SqliteStatement unfinished = db.Prepare("INSERT INTO unfinished VALUES(?, ?, ?, ?, ?)");
  SqliteStatement point = db.Prepare("INSERT INTO state_point VALUES(?, ?, ?, ?, ?, ?)");
  int id = 0;
  for (const RecordPlan& row : plans) {
    WriteInput(input, id, row);
    const bool known = row.request.pad.has_value();
    const estimation::PadKnowledge p = row.request.pad.value_or(estimation::PadKnowledge());
    const estimation::PadNoise& n = p.noise;
    prediction.Run(id, known, ToString(p.belief.motion), p.belief.t, p.height, n.position,
                   n.velocity, n.acceleration, n.heading, n.turn);
    const estimation::PadMatrix& c = p.belief.cov;
    for (int i = 0; known && i < c.rows(); ++i) {
      belief.Run(id, i, p.belief.mean(i), c(i, 0), c(i, 1), c(i, 2), c(i, 3), c(i, 4));
    }
    const planning::ReplannerState& s = row.before;
    for (std::size_t i = 0; i < s.bound.size(); ++i) {
      bound.Run(id, static_cast<int>(i), s.bound[i].from, s.bound[i].to);
    }
    if (s.unfinished) {
      unfinished.Run(id, s.unfinished->number, s.unfinished->duration,
                     s.unfinished->arrival == planning::ArrivalMode::kFree,
                     s.unfinished->unseen_reach);
    }
    state.Run(id, s.planned, s.around_unseen, s.looked_t, s.asked_t, s.climb, s.strip_t,
              s.strip_from.x(), s.strip_from.y(), s.strip_to.x(), s.strip_to.y(), s.strip_floor,
              s.current.curve.t0(), s.current.curve.interval(), s.current.stop.t0(),
              s.current.stop.interval(), s.next.curve.t0(), s.next.curve.interval(),
              s.next.stop.t0(), s.next.stop.interval(), FiniteOrNone(s.current.t_stop),
              s.current.proven, s.current.from_unknown, FiniteOrNone(s.next.t_stop), s.next.proven,
              s.next.from_unknown);
    WritePoints(point, id, "current", s.current.curve.control_points());
    WritePoints(point, id, "current_stop", s.current.stop.control_points());
    WritePoints(point, id, "next", s.next.curve.control_points());
    WritePoints(point, id, "next_stop", s.next.stop.control_points());
    ++id;
  }
}

void WritePlans(SqliteDb& db, const std::vector<RecordPlan>& plans) {
  SqliteStatement plan = db.Prepare(
      "INSERT INTO plan VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
      "?, ?, ?, ?, ?, ?, ?)");
  SqliteStatement point = db.Prepare("INSERT INTO control_point VALUES(?, ?, ?, ?, ?)");
  SqliteStatement cost = db.Prepare("INSERT INTO term_cost VALUES(?, ?, ?, ?)");
  SqliteStatement guide = db.Prepare("INSERT INTO guide_path VALUES(?, ?, ?, ?, ?, ?)");
  SqliteStatement window = db.Prepare("INSERT INTO map_window VALUES(?, ?, ?, ?)");
  SqliteStatement change = db.Prepare("INSERT INTO map_change VALUES(?, ?, ?, ?, ?, ?)");
  int id = 0;
  for (const RecordPlan& row : plans) {
    WriteResult(plan, id, row);
    const planning::ControlPoints& q = row.result.curve.control_points();
    for (int i = 0; i < q.cols(); ++i) point.Run(id, i, q(0, i), q(1, i), q(2, i));
    for (int i = 0; const solvers::TermCost& term : row.result.cost_by_term) {
      cost.Run(id, i++, term.name, term.cost);
    }
    const auto& paths = row.result.guide_paths;
    for (std::size_t k = 0; k < paths.size(); ++k) {
      for (std::size_t i = 0; i < paths[k].size(); ++i) {
        const Eigen::Vector3d& x = paths[k][i];
        guide.Run(id, static_cast<int>(k), static_cast<int>(i), x.x(), x.y(), x.z());
      }
    }
    const planning::CellIndex& lowest = row.map_change.origin;
    window.Run(id, lowest.x(), lowest.y(), lowest.z());
    for (const MapRun& run : row.map_change.runs) {
      change.Run(id, run.cell.x(), run.cell.y(), run.cell.z(), run.count, ToString(run.state));
    }
    ++id;
  }
}

// Little-endian, as all machines are that this runs on.
template <typename Value>
SqlBlob BytesOf(const std::vector<Value>& values) {
  return {{reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)}};
}

// As float32 and int32.
void WriteSurface(SqliteDb& db, int obstacle, const sim::TriangleMesh& surface) {
  std::vector<float> corners;
  std::vector<std::int32_t> triangles;
  for (const Eigen::Vector3d& corner : surface.corners()) {
    for (const double x : corner) corners.push_back(static_cast<float>(x));
  }
  for (const Eigen::Vector3i& of : surface.triangles()) {
    triangles.insert(triangles.end(), of.begin(), of.end());
  }
  db.Prepare("INSERT INTO surface VALUES(?, ?, ?)")
      .Run(obstacle, BytesOf(corners), BytesOf(triangles));
}

struct ObstacleWords {
  const char* kind = "mesh";
  std::optional<double> radius, yaw;
};

ObstacleWords WordsOf(const sim::Obstacle& obstacle) {
  if (const auto* box = std::get_if<sim::Box>(&obstacle)) return {"box", {}, box->yaw};
  if (const auto* cylinder = std::get_if<sim::Cylinder>(&obstacle)) {
    return {"cylinder", cylinder->radius, {}};
  }
  if (const auto* sphere = std::get_if<sim::Sphere>(&obstacle)) {
    return {"sphere", sphere->radius, {}};
  }
  return {};
}

void WriteObstacles(SqliteDb& db, const Scenario& scenario) {
  SqliteStatement insert =
      db.Prepare("INSERT INTO obstacle VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  int id = 0;
  for (const NamedObstacle& named : ObstaclesOf(scenario)) {
    const sim::Bounds bounds = sim::BoundsOf(named.obstacle);
    Eigen::Vector3d middle = 0.5 * (bounds.min + bounds.max), size = bounds.max - bounds.min;
    if (const auto* box = std::get_if<sim::Box>(&named.obstacle)) {
      middle = box->center;
      size = 2.0 * box->half_extents;
    }
    const ObstacleWords words = WordsOf(named.obstacle);
    insert.Run(id, named.key, words.kind, middle.x(), middle.y(), middle.z(), size.x(), size.y(),
               size.z(), words.radius, words.yaw);
    if (const auto* mesh = std::get_if<sim::Mesh>(&named.obstacle)) {
      WriteSurface(db, id, *mesh->surface);
    }
    ++id;
  }
}

void WriteZones(SqliteDb& db, const std::vector<planning::NamedZone>& zones) {
  SqliteStatement insert = db.Prepare("INSERT INTO zone VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)");
  int id = 0;
  for (const planning::NamedZone& named : zones) {
    const Eigen::Vector3d &c = named.zone.centre_W, &size = named.zone.size;
    insert.Run(id++, named.term, planning::ToString(named.zone.shape), c.x(), c.y(), c.z(),
               size.x(), size.y(), size.z());
  }
}

void WritePrior(SqliteDb& db, const RecordPrior& prior) {
  SqliteStatement insert = db.Prepare("INSERT INTO prior VALUES(?, ?)");
  const auto write = [&](const char* state, const auto& cubes, const auto& cube_of) {
    if (cubes.empty()) return;
    std::vector<std::int32_t> values;
    for (const auto& cube : cubes) {
      const auto [low, side] = cube_of(cube);
      values.insert(values.end(), {low.x(), low.y(), low.z(), side});
    }
    insert.Run(state, BytesOf(values));
  };
  const auto one = [](const planning::CellIndex& cell) { return planning::CellCube{cell, 1}; };
  write("occupied", prior.occupied, [](const planning::CellCube& cube) { return cube; });
  write("gone", prior.gone, one);
  write("new", prior.appeared, one);
}

void WriteTiming(SqliteDb& db, const TrialTiming& timing) {
  SqliteStatement insert = db.Prepare("INSERT INTO timing VALUES(?, ?)");
  insert.Run("physics", timing.physics_cpu_s);
  insert.Run("sensing", timing.sensing_cpu_s);
  insert.Run("sensing: depth image", timing.sensing_stages.depth_image);
  insert.Run("sensing: pad image", timing.sensing_stages.pad_image);
  insert.Run("sensing: pad finding", timing.sensing_stages.pad_finding);
  insert.Run("sensing: pad filter", timing.sensing_stages.pad_filter);
  insert.Run("sensing: own state", timing.sensing_stages.own_state);
  insert.Run("mapping", timing.mapping_cpu_s);
  insert.Run("planning", timing.planning_cpu_s);
  insert.Run("control", timing.control_cpu_s);
  insert.Run("judging", timing.judging_cpu_s);
  insert.Run("total", timing.cpu_s);
}

void WritePlanTiming(SqliteDb& db, const std::vector<RecordPlan>& plans) {
  SqliteStatement insert = db.Prepare("INSERT INTO plan_timing VALUES(?, ?, ?, ?)");
  for (int id = 0; const RecordPlan& plan : plans) {
    insert.Run(id++, plan.latency_s, plan.wall_s, plan.cpu_s);
  }
}

}  // namespace

void WriteRecord(const std::string& path, const Scenario& scenario, const TrialResult& result,
                 const TrialRecord& record) {
  AtomicFile file(path);
  {
    SqliteDb db(file.working_path(), SqliteDb::Mode::kCreate);
    // The file is removed if anything fails, so no journal is needed.
    db.Execute("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF");
    SqliteTransaction transaction(db);
    db.Execute(kSchema);
    WriteMeta(db, scenario, result, record);
    WriteSamples(db, record.samples);
    {
      SqliteStatement insert = db.Prepare("INSERT INTO event VALUES(?, ?, ?)");
      for (const RecordEvent& e : record.events) insert.Run(e.t, e.kind, e.text);
    }
    WritePlans(db, record.plans);
    WriteRequests(db, record.plans);
    WriteObstacles(db, scenario);
    WriteZones(db, record.zones);
    WritePrior(db, record.prior);
    WriteTiming(db, result.timing);
    WritePlanTiming(db, record.plans);
    transaction.Commit();
  }
  file.Commit();
}

}  // namespace touchdown::evaluation
