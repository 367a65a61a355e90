// SPDX-License-Identifier: BSD-3-Clause
// Every accepted plan is checked again at points 1 cm apart:
// - its speed and acceleration;
// - the map's blocked cells, which the certificate has asked along chords;
// - FCL's distance to the obstacles themselves, which shares nothing with the certificate.
// Cells hold their obstacles. So a plan that is clear of the inflated cells is at least the inflation away from every
// obstacle.
#include "evaluation/studies/replan/replan_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/obstacles/true_clearance.h"

namespace touchdown::evaluation {
namespace {

using planning::ReplanResult;
using planning::UniformBspline;

constexpr double kStep = 0.01;          // between samples [m]
constexpr double kWithin = 1.0 + 1e-6;  // of a limit
constexpr double kRounding = 1e-3;      // of FCL's distance and of that point [m]

/// Whether a point is in a blocked cell by more than the curve may leave its chords. The inflation
/// covers that deviation.
bool DeepInBlocked(const planning::OccupancyMap& map, const Eigen::Vector3d& p) {
  constexpr double s = planning::kChordSagitta;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d off((corner & 1) ? s : -s, (corner & 2) ? s : -s, (corner & 4) ? s : -s);
    if (!map.IsBlocked(Eigen::Vector3d(p + off))) return false;
  }
  return true;
}

}  // namespace

PlanCheck CheckPlan(const UniformBspline& curve, const ReplanScene& scene,
                    const planning::Limits& limits, const KnownBall& ball) {
  PlanCheck check;
  const sim::TrueClearance truth(scene.field, PointVehicle());
  const double inflation = scene.map->options().inflation_radius;
  check.true_clearance = std::numeric_limits<double>::infinity();
  const double within = ball.radius - inflation - std::numbers::sqrt3 * scene.map->resolution();
  // An obstacle beyond the window's edge is not known either.
  const auto known = [&](const Eigen::Vector3d& p) {
    return (p - ball.centre).norm() <= within &&
           scene.map->InWindow(scene.map->CellOf(p.array() - inflation)) &&
           scene.map->InWindow(scene.map->CellOf(p.array() + inflation));
  };
  Eigen::Vector3d last = curve.Evaluate(curve.t0()).p_WB;
  // Below the largest speed a fixed time step is at most the wanted distance.
  const double fastest = std::max(1e-3, BoundDerivatives(curve).speed);
  const int steps = static_cast<int>(std::ceil(curve.duration() * fastest / kStep));
  for (int i = 0; i <= steps; ++i) {
    const planning::FlatState at = curve.Evaluate(curve.t0() + curve.duration() * i / steps);
    const Eigen::Vector3d p = at.p_WB;
    check.beyond_limits = check.beyond_limits || at.v_WB.norm() > kWithin * limits.speed ||
                          at.a_WB.norm() > kWithin * limits.acceleration;
    check.length += (p - last).norm();
    last = p;
    if (!known(p)) continue;
    check.map_blocked = check.map_blocked || DeepInBlocked(*scene.map, p);
    estimation::VehicleState vehicle;
    vehicle.p_WB = p;
    check.true_clearance = std::min(check.true_clearance, truth.Distance(vehicle));
  }
  check.truly_near = check.true_clearance < inflation - kRounding;
  return check;
}

RowTimes TimesOf(const std::vector<const ReplanRow*>& rows) {
  std::vector<double> ms;
  for (const ReplanRow* row : rows) ms.push_back(1e3 * row->times.total.cpu);
  return {static_cast<int>(ms.size()), QuantilesOf(ms)};
}

const char* ToString(SceneStep step) {
  switch (step) {
    case SceneStep::kFirst:
      return "first";
    case SceneStep::kTenth:
      return "0.1 s on";
    case SceneStep::kFifth:
      return "0.2 s on";
    case SceneStep::kGrown:
      return "0.2 s on, map grown";
  }
  return "";
}

namespace {

/// The steps of one scene after another.
class SceneRunner {
 public:
  SceneRunner(const ReplanStudyOptions& options, const solvers::BackendRegistry& backends)
      : options_(options),
        replanner_(SceneReplannerOptions(options.scenes, options.replanner), backends) {
    if (options.oracle) {
      oracle_.emplace(SceneReplannerOptions(options.scenes, options.replanner), backends);
    }
    for (const planning::TermEntry& entry : options.replanner.problem.terms) {
      if (entry.is_clearance || entry.is_limit) pressed_.push_back(entry.info.name);
      if (entry.use == planning::TermUse::kFreeArrival) time_ = &entry;
    }
  }

  void AskAll(const ReplanScene& scene, int index, std::vector<ReplanRow>* rows) {
    index_ = index;
    earliest_ = EarliestArrival(scene, options_.scenes.kind.limits);
    const planning::ReplanInput first = AskAt(scene, &replanner_);
    if (index == 0) replanner_.Replan(first, *scene.map);  // pays for pages, caches and lazy set-up
    rows->push_back(Ask(scene, SceneStep::kFirst, *scene.map, AskAt(scene, &replanner_), {}));
    if (oracle_) {
      rows->back().oracle = oracle_->Ask(scene);
    } else if (options_.verdict) {
      rows->back().oracle = options_.verdict(options_.scenes, index);
    }
    if (!options_.later) return;
    if (rows->back().planned()) {
      const planning::ReplannerState flown = replanner_.state();
      for (const SceneStep step : {SceneStep::kTenth, SceneStep::kFifth}) {
        replanner_.Restore(flown);
        const planning::ReplanInput input = Later(first, step == SceneStep::kTenth ? 0.1 : 0.2);
        rows->push_back(Ask(scene, step, *scene.map, input, {}));
      }
    }
    AskGrown(scene, rows);
  }

 private:
  /// In perfect tracking, with nothing in between.
  planning::ReplanInput Later(planning::ReplanInput input, double t) const {
    const planning::FlatState at = replanner_.Reference(t);
    input.t_now = input.t_start = t;
    input.vehicle.p_WB = at.p_WB;
    input.vehicle.v_WB = at.v_WB;
    return input;
  }

  void AskGrown(const ReplanScene& scene, std::vector<ReplanRow>* rows) {
    constexpr double kSeenFrom = 5.0;  // [m]
    planning::OccupancyMap map(scene.map->options());
    map.MoveWindow(scene.map->origin());
    LearnWithin(*scene.map, scene.start.p, kSeenFrom, &map);
    const planning::ReplanInput first = AskAt(scene, &replanner_);
    if (replanner_.Replan(first, map).status != planning::ReplanStatus::kPlanned) return;
    const planning::ReplanInput input = Later(first, 0.2);
    LearnWithin(*scene.map, input.vehicle.p_WB, kSeenFrom, &map);
    rows->push_back(Ask(scene, SceneStep::kGrown, map, input, {input.vehicle.p_WB, kSeenFrom}));
  }

  /// From the present state of the replanner.
  ReplanRow Ask(const ReplanScene& scene, SceneStep step, const planning::OccupancyMap& map,
                const planning::ReplanInput& input, const KnownBall& known) {
    ReplanRow row;
    row.index = index_;
    row.step = step;
    row.feasible = scene.feasible;
    row.straight_blocked = scene.straight_blocked;
    row.target_moved = scene.target_moved;
    const planning::ReplannerState from = replanner_.state();
    std::vector<planning::StageTimes> times;
    for (int repeat = 0; repeat < options_.repeats; ++repeat) {
      replanner_.Restore(from);
      const ReplanResult& result = replanner_.Replan(input, map);
      times.push_back(result.times);
      // All answer the same. A check between two of them would empty the caches for the next one.
      if (repeat + 1 == options_.repeats) Enter(result, scene, known, &row);
    }
    std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end(),
                     [](const auto& a, const auto& b) { return a.total.cpu < b.total.cpu; });
    row.times = times[times.size() / 2];
    return row;
  }

  void Enter(const ReplanResult& result, const ReplanScene& scene, const KnownBall& known,
             ReplanRow* row) const {
    row->status = result.status;
    row->reason = result.reason;
    row->solves = result.solves;
    row->work = result.work;
    row->pairs = result.pairs;
    row->guides = static_cast<int>(result.guide_paths.size());
    if (!row->planned()) return;
    const UniformBspline& plan = result.curve;
    row->duration = plan.duration();
    if (row->step == SceneStep::kFirst) row->stretch = plan.duration() / scene.duration;
    row->lateness = plan.t_end() / earliest_;
    row->jerk = plan.SquaredJerk();
    // A plan with a fixed arrival also pays for its time, because both kinds are compared.
    row->cost = time_ ? time_->default_weight * plan.duration() : 0.0;
    for (const solvers::TermCost& term : result.solver.cost_by_term) {
      const bool pressed = std::find(pressed_.begin(), pressed_.end(), term.name) != pressed_.end();
      if (!pressed && !(time_ && term.name == time_->info.name)) *row->cost += term.cost;
    }
    if (options_.check) {
      row->check = CheckPlan(plan, scene, options_.scenes.kind.limits, known);
    }
  }

  const ReplanStudyOptions& options_;
  planning::Replanner replanner_;
  std::optional<PlanOracle> oracle_;
  std::vector<std::string> pressed_;  // terms whose weights grow within a step
  const planning::TermEntry* time_ = nullptr;
  int index_ = 0;
  double earliest_ = 0.0;  // arrival [s]
};

template <class Value>
std::optional<double> MedianOf(const std::vector<const ReplanRow*>& rows, Value value) {
  std::vector<double> values;
  for (const ReplanRow* row : rows) {
    if ((row->*value).has_value()) values.push_back(*(row->*value));
  }
  return QuantilesOf(values).median;
}

StageShares SharesOf(const std::vector<const ReplanRow*>& rows) {
  StageShares sum;
  double total = 0.0;
  for (const ReplanRow* row : rows) {
    const planning::StageTimes& times = row->times;
    sum.search += times.search.wall;
    sum.pairs += times.pairs.wall;
    sum.solve += times.solve.wall;
    sum.check += times.check.wall;
    sum.certificate += times.certificate.wall;
    total += times.total.wall;
  }
  if (total <= 0.0) return {};
  return {sum.search / total, sum.pairs / total, sum.solve / total, sum.check / total,
          sum.certificate / total};
}

}  // namespace

std::vector<ReplanRow> RunReplanStudy(const ReplanStudyOptions& options,
                                      const solvers::BackendRegistry& backends,
                                      const std::function<void(int done, int all)>& report) {
  SceneRunner asker(options, backends);
  std::vector<ReplanRow> rows;
  for (int index = 0; index < options.count; ++index) {
    asker.AskAll(DrawReplanScene(options.scenes, index), index, &rows);
    report(index + 1, options.count);
  }
  return rows;
}

std::vector<ReplanRow> RunReplanStudy(const ReplanStudyOptions& options,
                                      const std::vector<ReplanScene>& scenes,
                                      const solvers::BackendRegistry& backends) {
  SceneRunner asker(options, backends);
  std::vector<ReplanRow> rows;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    asker.AskAll(scenes[i], static_cast<int>(i), &rows);
  }
  return rows;
}

ReplanSummary Summarise(const std::vector<ReplanRow>& rows, SceneStep step) {
  ReplanSummary summary;
  std::vector<const ReplanRow*> all, clear, blocked;
  for (const ReplanRow& row : rows) {
    if (row.step != step) continue;
    ++summary.scenes;
    all.push_back(&row);
    (row.straight_blocked ? blocked : clear).push_back(&row);
    if (row.feasible) {
      ++summary.feasible;
      if (row.planned()) ++summary.succeeded;
    }
    if (row.oracle) {
      ++summary.asked;
      if (row.oracle->found) {
        ++summary.found;
        if (row.planned()) ++summary.met;
      } else if (row.planned()) {
        ++summary.missed;
      } else if (row.oracle->end_blocked) {
        ++summary.end_blocked;
      } else if (row.oracle->cannot_stop) {
        ++summary.cannot_stop;
      }
    }
    if (!row.planned()) continue;
    ++summary.accepted;
    if (!row.check) continue;
    ++summary.checked;
    if (row.check->map_blocked || row.check->truly_near) ++summary.colliding;
    if (row.check->map_blocked != row.check->truly_near) ++summary.disagreeing;
    if (row.check->beyond_limits) ++summary.beyond_limits;
  }
  if (summary.feasible > 0) summary.success = ClopperPearson(summary.succeeded, summary.feasible);
  summary.all = TimesOf(all);
  summary.clear = TimesOf(clear);
  summary.blocked = TimesOf(blocked);
  summary.shares = SharesOf(all);
  summary.lateness = MedianOf(all, &ReplanRow::lateness);
  summary.cost = MedianOf(all, &ReplanRow::cost);
  summary.jerk = MedianOf(all, &ReplanRow::jerk);
  return summary;
}

}  // namespace touchdown::evaluation
