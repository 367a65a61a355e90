// SPDX-License-Identifier: BSD-3-Clause
// The replanning study in words, in JSON and as a table of all its steps.
#include "evaluation/studies/replan/replan_report.h"

#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/build_info.h"
#include "evaluation/base/result_file.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/base/statistics.h"
#include "evaluation/studies/replan/replan_growth.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr ResultFormat kFormat{"touchdown replan study", 4};

constexpr char kSchema[] = R"sql(
CREATE TABLE part(part INTEGER PRIMARY KEY, name TEXT, varied TEXT, scene_set TEXT, kind TEXT, backend TEXT, arrival TEXT,
  limits TEXT, guides INTEGER, horizon_m REAL, resolution_m REAL, inflation_m REAL,
  density_per_m2 REAL, speed_limit_mps REAL, acceleration_limit_mps2 REAL, seed INTEGER);
CREATE TABLE step(part INTEGER, scene INTEGER, step TEXT, feasible INTEGER, straight_blocked INTEGER,
  target_moved_m REAL, status TEXT, reason TEXT, solves INTEGER, pairs INTEGER, guides INTEGER,
  duration_s REAL, stretch REAL, lateness REAL, cost REAL, jerk_m2ps5 REAL, length_m REAL, beyond_limits INTEGER,
  map_blocked INTEGER, truly_near INTEGER, true_clearance_m REAL, predict_wall_ms REAL,
  check_wall_ms REAL, search_wall_ms REAL, pairs_wall_ms REAL, solve_wall_ms REAL,
  certificate_wall_ms REAL, total_wall_ms REAL, total_ms REAL, oracle_found INTEGER,
  oracle_found_by TEXT, oracle_end_blocked INTEGER, oracle_cannot_stop INTEGER,
  oracle_solves INTEGER, PRIMARY KEY(part, scene, step));
)sql";

const char* Arrival(const ReplanStudyOptions& options) {
  return options.replanner.arrival == planning::ArrivalMode::kFree ? "free" : "fixed";
}

const char* Limits(const ReplanStudyOptions& options) {
  return options.replanner.problem.limits_mode == planning::LimitsMode::kHard ? "hard" : "soft";
}

std::string TimesHead(const std::string& name) {
  return fmt::format("{:<24}{:>6}{:>10}{:>10}{:>10}{:>10}\n", name, "n", "median", "p95", "p99",
                     "max");
}

std::string LatencyText(const std::string& name, const RowTimes& times) {
  if (times.count == 0) return fmt::format("{:<24}{:>6}\n", name, 0);
  const Quantiles& q = times.ms;
  return fmt::format("{:<24}{:>6}{:>10.3f}{:>10.3f}{:>10.3f}{:>10.3f}\n", name, times.count,
                     *q.median, *q.p95, *q.p99, *q.max);
}

Json LatencyJson(const RowTimes& times) {
  if (times.count == 0) return {{"count", 0}};
  const Quantiles& q = times.ms;
  return {{"count", times.count},
          {"median", *q.median},
          {"p95", *q.p95},
          {"p99", *q.p99},
          {"max", *q.max}};
}

/// Nothing is said of plans that were not looked at.
Json OfChecked(const ReplanSummary& summary, int count) {
  return summary.checked > 0 ? Json(count) : Json();
}

std::map<std::string, int> FailuresByReason(const std::vector<ReplanRow>& rows, SceneStep step) {
  std::map<std::string, int> count;
  for (const ReplanRow& row : rows) {
    const bool plan_exists = row.oracle ? row.oracle->found : row.feasible;
    if (row.step == step && plan_exists && !row.planned()) {
      ++count[planning::ToString(row.reason)];
    }
  }
  return count;
}

std::string SceneText(const ReplanStudyPart& part) {
  const SceneOptions& scenes = part.options.scenes;
  return fmt::format("{}, set {}, {:.4g} m/s, {:.4g} m/s^2, inflation {:.4g} m", scenes.kind.name,
                     scenes.set, scenes.kind.limits.speed, scenes.kind.limits.acceleration,
                     scenes.kind.inflation);
}

std::string PlannerText(const ReplanStudyPart& part) {
  return fmt::format("{} arrival, {} limits, {}, {} guide(s), seed {}\n", Arrival(part.options),
                     Limits(part.options), part.options.replanner.backend,
                     part.options.replanner.max_guides, part.options.scenes.seed);
}

std::string Of(int good, int all) {
  if (all == 0) return "0 of 0";
  const Interval share = ClopperPearson(good, all);
  return fmt::format("{} of {} = {:.1f} [{:.1f}, {:.1f}] %", good, all, 100.0 * good / all,
                     100.0 * share.lo, 100.0 * share.hi);
}

// A search finds a way into many scenes whose end is blocked or which no vehicle can fly. So where the oracle was
// asked, its verdict comes first.
std::string FoundText(const ReplanStudyPart& part, SceneStep step, const ReplanSummary& s) {
  const std::string search =
      fmt::format("{} scenes that a search finds a way through, blocked ends among them",
                  Of(s.succeeded, s.feasible));
  if (s.asked == 0) {
    return fmt::format("  {} step: a plan in {}; {} scenes in all; no verdicts of the oracle\n",
                       ToString(step), search, s.scenes);
  }
  return fmt::format(
      "  {} step: a plan in {} scenes in which the oracle{} finds one, and in {} in which it finds "
      "none; "
      "{} scenes in all\n"
      "    where the oracle finds none, the end is blocked in {}, and {} more cannot stop in time\n"
      "    a plan in {}\n",
      ToString(step), Of(s.met, s.found), part.options.oracle ? "" : " (shipped verdicts)",
      s.missed, s.asked, s.end_blocked, s.cannot_stop, search);
}

std::string StepText(const ReplanStudyPart& part, SceneStep step) {
  const ReplanSummary s = Summarise(part.rows, step);
  if (s.scenes == 0) return {};
  std::string text = FoundText(part, step, s);
  const char* possible = s.asked > 0 ? "of those in which the oracle finds one" : "of these";
  for (const auto& [reason, count] : FailuresByReason(part.rows, step)) {
    text += fmt::format("    no plan, {}: {} x {}\n", possible, count, reason);
  }
  text += fmt::format(
      "  {} plans accepted; of {} checked at 1 cm {} collide, {} beyond a limit; checkers disagree "
      "on "
      "{}\n",
      s.accepted, s.checked, s.colliding, s.beyond_limits, s.disagreeing);
  if (s.lateness) {
    text += fmt::format(
        "  medians: arrival {:.3f} times the earliest possible, cost {:.4g}, jerk {:.4g} m^2/s^5\n",
        *s.lateness, *s.cost, *s.jerk);
  }
  text += fmt::format(
      "  share of the time: search {:.0f} %, pairs {:.0f} %, solve {:.0f} %, check {:.0f} %, "
      "certificate {:.0f} %\n",
      100.0 * s.shares.search, 100.0 * s.shares.pairs, 100.0 * s.shares.solve,
      100.0 * s.shares.check, 100.0 * s.shares.certificate);
  text += TimesHead("  thread CPU time [ms]");
  text += LatencyText("  all scenes", s.all);
  text += LatencyText("  straight way free", s.clear);
  text += LatencyText("  obstacle in the way", s.blocked);
  return text;
}

std::string SafetyText(const ReplanStudyPart& part) {
  std::string text = fmt::format("kind {}, horizon {:.4g} m, {}", SceneText(part),
                                 part.options.scenes.horizon, PlannerText(part));
  for (const SceneStep step : kSceneSteps) text += StepText(part, step);
  return text;
}

std::string GrowthText(const std::vector<const ReplanStudyPart*>& parts) {
  std::string text = fmt::format("growth of the thread CPU time [ms] of a step\nkind {}, {}",
                                 SceneText(*parts[0]), PlannerText(*parts[0]));
  std::string varied;
  std::vector<ReplanRow> rows;
  for (const ReplanStudyPart* part : parts) {
    if (part->varied != varied) text += TimesHead("  " + part->varied);
    varied = part->varied;
    text += LatencyText(fmt::format("  {:.4g}", VariedValue(varied, part->options.scenes)),
                        Summarise(part->rows).all);
    rows.insert(rows.end(), part->rows.begin(), part->rows.end());
  }
  text += TimesHead("  pairs");
  for (const PairClass& one : TimesByPairs(rows)) {
    const std::string range = one.to == 0 ? "none" : fmt::format("{} to {}", one.from, one.to);
    text += LatencyText("  " + range, one.time);
  }
  return text;
}

}  // namespace

std::string ReplanStudyText(const std::vector<ReplanStudyPart>& parts) {
  std::string text = BuildLine() + '\n';
  std::vector<const ReplanStudyPart*> growth;
  for (const ReplanStudyPart& part : parts) {
    if (part.varied.empty()) {
      text += SafetyText(part);
    } else {
      growth.push_back(&part);
    }
  }
  if (!growth.empty()) text += GrowthText(growth);
  return text;
}

namespace {

Json StepJson(const ReplanStudyPart& part, SceneStep step) {
  const ReplanSummary s = Summarise(part.rows, step);
  const auto number = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json();
  };
  Json json = {{"step", ToString(step)},
               {"scenes", s.scenes},
               {"feasible", s.feasible},
               {"succeeded", s.succeeded},
               {"success_interval_95", {s.success.lo, s.success.hi}},
               {"failures", FailuresByReason(part.rows, step)},
               {"accepted", s.accepted},
               {"checked", s.checked},
               {"colliding", OfChecked(s, s.colliding)},
               {"disagreeing", OfChecked(s, s.disagreeing)},
               {"beyond_limits", OfChecked(s, s.beyond_limits)},
               {"median_lateness", number(s.lateness)},
               {"median_cost", number(s.cost)},
               {"median_jerk_m2ps5", number(s.jerk)},
               {"share_of_time",
                {{"search", s.shares.search},
                 {"pairs", s.shares.pairs},
                 {"solve", s.shares.solve},
                 {"check", s.shares.check},
                 {"certificate", s.shares.certificate}}},
               {"time_ms",
                {{"all", LatencyJson(s.all)},
                 {"straight_free", LatencyJson(s.clear)},
                 {"straight_blocked", LatencyJson(s.blocked)}}}};
  if (s.asked > 0) {
    json["oracle"] = {{"asked", s.asked},
                      {"found", s.found},
                      {"met_by_step", s.met},
                      {"missed", s.missed},
                      {"end_blocked", s.end_blocked},
                      {"cannot_stop", s.cannot_stop}};
  }
  return json;
}

}  // namespace

Json ReplanStudyJson(const std::vector<ReplanStudyPart>& parts, const MachineState& machine) {
  Json json;
  json["parts"] = Json::array();
  for (const ReplanStudyPart& part : parts) {
    Json steps = Json::array();
    for (const SceneStep step : kSceneSteps) {
      if (Summarise(part.rows, step).scenes > 0) steps.push_back(StepJson(part, step));
    }
    json["parts"].push_back({{"part", part.part},
                             {"set", part.options.scenes.set},
                             {"varied", part.varied.empty() ? Json() : Json(part.varied)},
                             {"kind", part.options.scenes.kind.name},
                             {"backend", part.options.replanner.backend},
                             {"arrival", Arrival(part.options)},
                             {"limits", Limits(part.options)},
                             {"guides", part.options.replanner.max_guides},
                             {"horizon_m", part.options.scenes.horizon},
                             {"resolution_m", part.options.scenes.resolution},
                             {"density_per_m2", part.options.scenes.density},
                             {"seed", part.options.scenes.seed},
                             {"steps", steps}});
  }
  json["machine"] = MachineJson(machine);
  return json;
}

void WriteReplanStudy(const std::string& path, const std::vector<ReplanStudyPart>& parts,
                      const MachineState& machine) {
  ManifestFacts facts;
  AddMachine(machine, &facts);
  WriteResultFile(path, kFormat, kSchema, facts, [&](SqliteDb& db) {
    SqliteStatement insert_part =
        db.Prepare("INSERT INTO part VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    SqliteStatement insert = db.Prepare(
        "INSERT INTO step VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
        "?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const int number = static_cast<int>(i);
      const ReplanStudyOptions& o = parts[i].options;
      insert_part.Run(number, parts[i].part, parts[i].varied, o.scenes.set, o.scenes.kind.name,
                      o.replanner.backend, Arrival(o), Limits(o), o.replanner.max_guides,
                      o.scenes.horizon, o.scenes.resolution, o.scenes.kind.inflation,
                      o.scenes.density, o.scenes.kind.limits.speed,
                      o.scenes.kind.limits.acceleration, static_cast<std::int64_t>(o.scenes.seed));
      for (const ReplanRow& row : parts[i].rows) {
        const planning::StageTimes& t = row.times;
        const auto checked = [&row](auto member) {
          using Value = std::decay_t<decltype(row.check.value().*member)>;
          return row.check ? std::optional<Value>(row.check.value().*member) : std::nullopt;
        };
        const auto oracle = [&row](auto member) {
          using Value = std::decay_t<decltype(row.oracle.value().*member)>;
          return row.oracle ? std::optional<Value>(row.oracle.value().*member) : std::nullopt;
        };
        insert.Run(number, row.index, ToString(row.step), row.feasible, row.straight_blocked,
                   row.target_moved, planning::ToString(row.status), planning::ToString(row.reason),
                   row.solves, row.pairs, row.guides, row.duration, row.stretch, row.lateness,
                   row.cost, row.jerk, checked(&PlanCheck::length),
                   checked(&PlanCheck::beyond_limits), checked(&PlanCheck::map_blocked),
                   checked(&PlanCheck::truly_near), checked(&PlanCheck::true_clearance),
                   1e3 * t.predict.wall, 1e3 * t.check.wall, 1e3 * t.search.wall,
                   1e3 * t.pairs.wall, 1e3 * t.solve.wall, 1e3 * t.certificate.wall,
                   1e3 * t.total.wall, 1e3 * t.total.cpu, oracle(&OracleVerdict::found),
                   oracle(&OracleVerdict::found_by), oracle(&OracleVerdict::end_blocked),
                   oracle(&OracleVerdict::cannot_stop), oracle(&OracleVerdict::solves));
      }
    }
  });
}

}  // namespace touchdown::evaluation
