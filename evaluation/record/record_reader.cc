// SPDX-License-Identifier: BSD-3-Clause
// A record is data from outside. Every number is checked before a planner gets it.
#include "evaluation/record/record_reader.h"

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>

#include <sstream>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/result_file.h"
#include "evaluation/base/table_rows.h"
#include "evaluation/flight/onboard_setup.h"
#include "evaluation/record/record.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/vehicle/vehicle_file.h"

namespace touchdown::evaluation {
namespace {

constexpr std::uintmax_t kMostBytesOfRecord = 512 << 20;
constexpr int kMostPoints = 10000;           // of a spline
constexpr int kMostAttempts = 1000;          // of a step
constexpr double kLongest = 1000.0;          // plan [s]
constexpr int kMostCells = 1024;             // of a run: a window's longest side
constexpr std::int64_t kFarthest = 1 << 24;  // cell index

std::string Version() { return std::to_string(kRecordVersion); }

// A table with exactly one row a plan.
template <typename Read>
void ReadEach(TableRows rows, std::vector<RecordPlan>* plans, const Read& read) {
  for (RecordPlan& plan : *plans) {
    if (!rows.Next()) rows.Refuse("lacks replanning steps");
    rows.Integer(&plan - plans->data(), &plan - plans->data());
    read(rows, &plan);
  }
  if (rows.Next()) rows.Refuse("has more replanning steps than the table plan");
}

// A table with any number of rows a plan, in the order of the plans.
template <typename Read>
void ReadMany(TableRows rows, std::vector<RecordPlan>* plans, const Read& read) {
  while (rows.Next()) {
    const int plan = rows.Integer(0, static_cast<std::int64_t>(plans->size()) - 1);
    read(rows, &(*plans)[static_cast<std::size_t>(plan)]);
  }
}

struct Knots {
  double t0 = 0.0;
  double h = 0.0;
  std::vector<Eigen::Vector3d> points;

  void Add(TableRows& rows) {
    if (rows.Integer(0, kMostPoints) != static_cast<int>(points.size())) {
      rows.Refuse("holds control points out of order");
    }
    points.push_back(rows.Vector3());
    if (points.back().cwiseAbs().maxCoeff() >= planning::kFarthestPlace) {
      rows.Refuse("holds a control point a million metres away");
    }
  }
  planning::UniformBspline Curve() const {
    if (std::abs(t0) > kLongest || h * static_cast<double>(points.size()) > kLongest) {
      throw std::invalid_argument("it holds a curve that is no part of a flight");
    }
    planning::ControlPoints q(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) q.col(static_cast<Eigen::Index>(i)) = points[i];
    return {q, h, t0};
  }
};

void ReadResults(SqliteDb& db, std::vector<RecordPlan>* plans) {
  TableRows rows(
      db, "plan",
      "id, status, reason, from_odometry, t0, h, pairs, solves, rebinds, iterations, cost, "
      "work, endpoint_position_residual, endpoint_velocity_residual, speed_bound, "
      "acceleration_bound, body_rate_bound, limits_kept, recovering, clear, clearance, "
      "endpoint_required, "
      "earlier, escaping, stops_in_observed_space",
      "id");
  std::vector<Knots> knots;
  while (rows.Next()) {
    rows.Integer(static_cast<std::int64_t>(plans->size()),
                 static_cast<std::int64_t>(plans->size()));
    ReplanOutcome& r = plans->emplace_back().result;
    r.status = rows.Named(planning::ReplanStatus::kUnsafe, planning::ToString);
    r.reason = rows.Named(planning::ReplanReason::kAtGoal, planning::ToString);
    r.from_odometry = rows.Flag();
    knots.push_back({rows.Number(), 0.0, {}});
    knots.back().h = rows.Number();
    r.pairs = rows.Count();
    r.solves = rows.Count();
    r.rebinds = rows.Count();
    r.iterations = rows.Count();
    r.cost = rows.NumberOrNan();
    r.work = rows.Count();
    planning::Certificate& c = r.certificate;
    c.endpoint_position_residual = rows.NumberOrNan();
    c.endpoint_velocity_residual = rows.NumberOrNan();
    c.speed_bound = rows.NumberOrNan();
    c.acceleration_bound = rows.NumberOrNan();
    c.body_rate_bound = rows.NumberOrNan();
    c.limits_kept = rows.Flag();
    c.recovering = rows.Flag();
    c.clear = rows.Flag();
    c.clearance = rows.NumberOrNan();
    c.endpoint_required = rows.Flag();
    c.earlier = rows.Flag();
    c.escaping = rows.Flag();
    c.stops_in_observed_space = rows.Flag();
  }
  ReadMany(TableRows(db, "control_point", "plan, i, x, y, z", "plan, i"), plans,
           [&](TableRows& row, RecordPlan* plan) {
             knots[static_cast<std::size_t>(plan - plans->data())].Add(row);
           });
  for (std::size_t i = 0; i < plans->size(); ++i) (*plans)[i].result.curve = knots[i].Curve();
  ReadMany(TableRows(db, "term_cost", "plan, i, term, cost", "plan, i"), plans,
           [](TableRows& row, RecordPlan* plan) {
             auto& costs = plan->result.cost_by_term;
             const auto next = static_cast<std::int64_t>(costs.size());
             row.Integer(next, next);
             costs.push_back({row.Text(), 0.0});
             costs.back().cost = row.NumberOrNan();
           });
  ReadMany(TableRows(db, "guide_path", "plan, path, i, x, y, z", "plan, path, i"), plans,
           [](TableRows& row, RecordPlan* plan) {
             auto& paths = plan->result.guide_paths;
             const auto path =
                 static_cast<std::size_t>(row.Integer(0, static_cast<std::int64_t>(paths.size())));
             if (path == paths.size()) paths.emplace_back();
             row.Integer(static_cast<std::int64_t>(paths[path].size()),
                         static_cast<std::int64_t>(paths[path].size()));
             paths[path].push_back(row.Vector3());
           });
}

void ReadRequests(SqliteDb& db, std::vector<RecordPlan>* plans) {
  double before = 0.0;
  const auto read_input = [&before](TableRows& row, RecordPlan* plan) {
    planning::ReplanInput& input = plan->request.input;
    input.t_now = row.Time();
    if (input.t_now < before) row.Refuse("holds times that fall");
    before = input.t_now;
    input.t_start = row.Number();
    plan->request.rest_climb = row.Optional();
    input.look_from_W = row.OptionalVector3();
    estimation::VehicleState& vehicle = input.vehicle;
    vehicle.t = input.t_now;
    vehicle.p_WB = row.Vector3();
    vehicle.v_WB = row.Vector3();
    const double qw = row.Number();
    const Eigen::Vector3d q = row.Vector3();
    vehicle.q_WB = {qw, q.x(), q.y(), q.z()};
    vehicle.w_WB_B = row.Vector3();
    plan->pad.p_WP = row.Vector3();
    plan->pad.v_WP = row.Vector3();
    plan->pad.a_WP = row.Vector3();
    plan->pad.yaw = row.Number();
    plan->pad.yaw_rate = row.Number();
    input.endpoint.t_reference = row.Number();
    input.endpoint.height = row.Number();
    input.endpoint.sink_rate = row.Number();
    input.endpoint.height_floor = row.Number();
    input.endpoint.arrival_sink = row.Number();
    input.endpoint.at_rest = row.Flag();
    input.pull_W = row.Vector3();
    input.margins.own_state = row.Number();
    input.margins.attitude = row.Number();
    input.margins.tracking = row.Number();
  };
  ReadEach(TableRows(db, "replan_input",
                     "plan, t_now, t_start, rest_climb, look_x, look_y, look_z, px, py, pz, vx, "
                     "vy, vz, qw, qx, qy, qz, wx, wy, "
                     "wz, pad_px, pad_py, pad_pz, pad_vx, pad_vy, pad_vz, pad_ax, pad_ay, pad_az, "
                     "pad_yaw, pad_yaw_rate, endpoint_t_reference, endpoint_height, "
                     "endpoint_sink_rate, endpoint_height_floor, endpoint_arrival_sink, "
                     "endpoint_at_rest, pull_x, pull_y, "
                     "pull_z, margin_own_state, margin_attitude, margin_tracking",
                     "plan"),
           plans, read_input);
  const auto read_prediction = [](TableRows& row, RecordPlan* plan) {
    const bool known = row.Flag();
    estimation::PadKnowledge p;
    p.belief.motion = row.Named(estimation::PadMotion::kTurn, estimation::ToString);
    p.belief.t = row.Number();
    p.height = row.Number();
    p.noise = {row.Number(), row.Number(), row.Number(), row.Number(), row.Number()};
    if (!plan->request.rest_climb && !known) {
      row.Refuse("does not agree with the table replan_input");
    }
    if (known) plan->request.pad = p;
  };
  ReadEach(TableRows(db, "prediction",
                     "plan, known, motion, t, height, noise_position, noise_velocity, "
                     "noise_acceleration, noise_heading, noise_turn",
                     "plan"),
           plans, read_prediction);
  ReadMany(TableRows(db, "belief", "plan, i, mean, cov0, cov1, cov2, cov3, cov4", "plan, i"), plans,
           [](TableRows& row, RecordPlan* plan) {
             if (!plan->request.pad) row.Refuse("does not agree with the table prediction");
             estimation::PadBelief& belief = plan->request.pad->belief;
             const int i = row.Integer(0, 4);
             belief.mean(i) = row.Number();
             for (int k = 0; k < 5; ++k) belief.cov(i, k) = row.Number();
           });
}

void ReadStates(SqliteDb& db, std::vector<RecordPlan>* plans) {
  std::vector<std::map<std::string, Knots>> knots(plans->size());
  ReadEach(
      TableRows(db, "replanner_state",
                "plan, planned, around_unseen, looked_t, asked_t, climb, "
                "strip_t, strip_from_x, "
                "strip_from_y, strip_to_x, strip_to_y, strip_floor, current_t0, current_h, "
                "current_stop_t0, "
                "current_stop_h, next_t0, next_h, next_stop_t0, next_stop_h, "
                "current_t_stop, current_proven, current_from_unknown, next_t_stop, next_proven, "
                "next_from_unknown",
                "plan"),
      plans, [&](TableRows& row, RecordPlan* plan) {
        planning::ReplannerState& s = plan->before;
        s.planned = row.Flag();
        s.around_unseen = row.Flag();
        s.looked_t = row.Number();
        s.asked_t = row.Optional();
        s.climb = row.Optional();
        s.strip_t = row.Optional();
        s.strip_from = row.Vector2();
        s.strip_to = row.Vector2();
        s.strip_floor = row.Number();
        auto& curves = knots[static_cast<std::size_t>(plan - plans->data())];
        for (const char* curve : {"current", "current_stop", "next", "next_stop"}) {
          curves[curve].t0 = row.Number();
          curves[curve].h = row.Number();
        }
        for (planning::FlightPair* pair : {&s.current, &s.next}) {
          pair->t_stop = row.Optional().value_or(std::numeric_limits<double>::infinity());
          pair->proven = row.Flag();
          pair->from_unknown = row.Flag();
        }
      });
  ReadMany(TableRows(db, "bound_part", "plan, t_from, t_to", "plan, i"), plans,
           [](TableRows& row, RecordPlan* plan) {
             const double from = row.Number();
             plan->before.bound.push_back({from, row.Number()});
           });
  ReadMany(
      TableRows(db, "unfinished", "plan, attempt, duration, arrival_free, unseen_reach", "plan"),
      plans, [](TableRows& row, RecordPlan* plan) {
        planning::Attempt& attempt = plan->before.unfinished.emplace();
        attempt.number = row.Integer(0, kMostAttempts);
        attempt.duration = row.Number();
        attempt.arrival = row.Flag() ? planning::ArrivalMode::kFree : planning::ArrivalMode::kFixed;
        attempt.unseen_reach = row.Number();
        if (!(attempt.duration > 0.0 && attempt.duration <= kLongest))
          row.Refuse("has no duration");
        if (!(attempt.unseen_reach >= 0.0 &&
              attempt.unseen_reach <= planning::UnseenZone::kFarthest)) {
          row.Refuse("reaches too far");
        }
      });
  ReadMany(TableRows(db, "state_point", "plan, curve, i, x, y, z", "plan, curve, i"), plans,
           [&](TableRows& row, RecordPlan* plan) {
             auto& curves = knots[static_cast<std::size_t>(plan - plans->data())];
             const auto curve = curves.find(row.Text());
             if (curve == curves.end()) row.Refuse("names an unknown curve");
             curve->second.Add(row);
           });
  for (std::size_t i = 0; i < plans->size(); ++i) {
    planning::ReplannerState& s = (*plans)[i].before;
    s.current.curve = knots[i].at("current").Curve();
    s.current.stop = knots[i].at("current_stop").Curve();
    s.next.curve = knots[i].at("next").Curve();
    s.next.stop = knots[i].at("next_stop").Curve();
  }
}

void ReadMap(SqliteDb& db, std::vector<RecordPlan>* plans) {
  const auto cell = [](TableRows& row) {
    const auto one = [&row] { return row.Integer(-kFarthest, kFarthest); };
    const int x = one(), y = one();
    return planning::CellIndex(x, y, one());
  };
  ReadEach(TableRows(db, "map_window", "plan, ix, iy, iz", "plan"), plans,
           [&](TableRows& row, RecordPlan* plan) { plan->map_change.origin = cell(row); });
  ReadMany(TableRows(db, "map_change", "plan, ix, iy, iz, count, state", "rowid"), plans,
           [&](TableRows& row, RecordPlan* plan) {
             const planning::CellIndex first = cell(row);
             const int count = row.Integer(1, kMostCells);
             plan->map_change.runs.push_back(
                 {first, count, row.Named(planning::CellState::kOccupied, ToString)});
           });
}

void ReadPlanTiming(SqliteDb& db, std::vector<RecordPlan>* plans) {
  ReadEach(TableRows(db, "plan_timing", "plan, latency_s, wall_s, cpu_s", "plan"), plans,
           [](TableRows& row, RecordPlan* plan) {
             plan->latency_s = row.Number();
             plan->wall_s = row.Number();
             plan->cpu_s = row.Number();
           });
}

using Meta = std::map<std::string, std::string>;

// Every other file of the program has a manifest.
void CheckIsRecord(SqliteDb& db) {
  if (!HasManifest(db)) return;
  SqliteStatement format = db.Prepare("SELECT value FROM manifest WHERE key = 'format'");
  throw std::invalid_argument(
      fmt::format("its format is '{}', not that of a record of one flight (land --record)",
                  format.Step() ? format.Text(0) : "result"));
}

Meta ReadMeta(SqliteDb& db) {
  Meta meta;
  SqliteStatement rows = db.Prepare("SELECT key, value FROM meta");
  while (rows.Step()) meta[rows.Text(0)] = rows.Text(1);
  return meta;
}

// The grid that this build makes for the scenario must also be the recorded one.
void CheckMap(const Meta& meta, const Registries& registries, RecordedFlight* flight) {
  const Scenario& scenario = flight->scenario;
  const planning::OccupancyMap map(
      MapOptions(scenario, sim::LoadVehicleModel(VehicleMjcf(scenario)), registries));
  flight->map_resolution = map.resolution();
  flight->map_size = map.size();
  const std::string resolution = fmt::format("{}", map.resolution());
  const std::string size = fmt::format("{} {} {}", map.size().x(), map.size().y(), map.size().z());
  if (meta.at("map_resolution") != resolution || meta.at("map_size") != size) {
    throw std::invalid_argument(
        fmt::format("its map has cells of {} m in a window of {} cells, this build's {} m and {}",
                    meta.at("map_resolution"), meta.at("map_size"), resolution, size));
  }
}

// The files that the scenario names must be unchanged. Otherwise a step would be solved with
// another pad or vehicle.
void CheckOutsideFiles(const Meta& meta, const Scenario& scenario) {
  const OutsideFiles now = OutsideFilesOf(scenario);
  if (meta.at("pad_waypoints") != now.pad_waypoints) {
    throw std::invalid_argument(
        fmt::format("its pad drove past other points than pad.waypoints, {}, holds now",
                    scenario.pad.waypoints));
  }
  if (meta.at("vehicle_hash") != now.vehicle_hash) {
    throw std::invalid_argument(fmt::format(
        "its vehicle was another one than the file {} describes now", scenario.vehicle));
  }
  if (meta.at("world_hash") != now.world_hash) {
    throw std::invalid_argument("the files of its obstacles held another world than they do now");
  }
}

void CheckFormat(const Meta& meta) {
  const auto value = [&meta](const char* key) {
    const auto entry = meta.find(key);
    if (entry == meta.end()) {
      throw std::invalid_argument(fmt::format("its table meta lacks {}", key));
    }
    return entry->second;
  };
  if (value("format") != "touchdown record") {
    throw std::invalid_argument("it is no record of a landing");
  }
  if (value("version") != Version()) {
    throw std::invalid_argument(fmt::format("it is a record of version {}, this build reads {}",
                                            value("version"), Version()));
  }
  for (const char* key :
       {"scenario", "scenario_yaml", "seed", "build_hash", "revision", "map_resolution", "map_size",
        "pad_waypoints", "vehicle_hash", "world_hash", "hover", "idle_steps"}) {
    value(key);
  }
}

void CheckOverrides(const std::vector<std::string>& overrides) {
  for (const std::string& text : overrides) {
    const auto begins = [&](const char* key) { return text.rfind(key, 0) == 0; };
    if (!begins("solver.") && !begins("terms.") && !begins("planning.guides=") &&
        !begins("planning.max_work=") && !begins("planning.warm_start=")) {
      throw BadInput(
          fmt::format("--set {}: of a recorded flight only {} can be changed.", text, kReplayKeys));
    }
  }
}

void ReadPrior(SqliteDb& db, std::vector<planning::CellCube>* prior) {
  SqliteStatement row = db.Prepare("SELECT cubes FROM prior WHERE state = 'occupied'");
  while (row.Step()) {
    const std::string bytes = row.Text(0);
    std::array<std::int32_t, 4> cube;
    if (bytes.size() % sizeof cube != 0) {
      throw std::invalid_argument("its table prior holds a part of a cube");
    }
    for (std::size_t at = 0; at < bytes.size(); at += sizeof cube) {
      std::memcpy(cube.data(), bytes.data() + at, sizeof cube);
      prior->push_back({{cube[0], cube[1], cube[2]}, cube[3]});
    }
  }
}

RecordedFlight ReadAll(const std::string& path, const std::vector<std::string>& overrides,
                       const Registries& registries) {
  SqliteDb db(path, SqliteDb::Mode::kReadOnly);
  CheckIsRecord(db);
  const Meta meta = ReadMeta(db);
  CheckFormat(meta);
  RecordedFlight flight;
  flight.path = path;
  // The steps hold the whole map. The first of them has what was known beforehand.
  std::vector<std::string> all = {"seed=" + meta.at("seed"), "map.prior=none"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  flight.scenario = ParseScenario(meta.at("scenario_yaml"), meta.at("scenario"),
                                  path + " (scenario_yaml)", all, registries);
  CheckOutsideFiles(meta, flight.scenario);
  CheckMap(meta, registries, &flight);
  std::istringstream hover(meta.at("hover"));
  for (double& axis : flight.hover_W) hover >> axis;
  std::istringstream idle(meta.at("idle_steps"));
  if (!hover || !(idle >> flight.idle_steps)) {
    throw std::invalid_argument("its table meta has no usable hover, or idle_steps");
  }
  flight.build_hash = meta.at("build_hash");
  flight.revision = meta.at("revision");
  ReadResults(db, &flight.plans);
  ReadRequests(db, &flight.plans);
  ReadStates(db, &flight.plans);
  ReadMap(db, &flight.plans);
  ReadPlanTiming(db, &flight.plans);
  ReadPrior(db, &flight.prior);
  return flight;
}

}  // namespace

RecordedFlight ReadRecord(const std::string& path, const std::vector<std::string>& overrides,
                          const Registries& registries) {
  CheckOverrides(overrides);
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) {
    throw BadInput(fmt::format("{}: there is no such record.", path));
  }
  if (std::filesystem::file_size(path, unknown) > kMostBytesOfRecord) {
    throw BadInput(fmt::format("{}: it is larger than the 512 MiB that are read.", path));
  }
  return NamingFile(path, "record", [&] { return ReadAll(path, overrides, registries); });
}

}  // namespace touchdown::evaluation
