// SPDX-License-Identifier: BSD-3-Clause
// Every accepted plan is looked at again at points 1 cm apart: its speed and acceleration; whether it is
// in one of the map's blocked cells, which the certificate has asked along chords; and, sharing nothing with
// the certificate, FCL's distance from these points to the obstacles themselves. Cells hold their obstacles, so that a plan that is clear of the inflated cells is at
// least the inflation away from every obstacle.
#include "touchdown/evaluation/replan_study.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "touchdown/sim/true_clearance.h"

namespace touchdown::evaluation {
namespace {

using planning::ReplanResult;
using planning::UniformBspline;

constexpr double kStep = 0.01;          // between samples [m]
constexpr double kWithin = 1.0 + 1e-6;  // of a limit
constexpr double kRounding = 1e-3;      // of FCL's distance and of that point [m]

/// In a blocked cell by more than the curve may leave its chords, for which the inflation makes up.
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
                    const planning::Limits& limits) {
  PlanCheck check;
  const sim::TrueClearance truth(scene.field, PointVehicle());
  const double inflation = scene.map->options().inflation_radius;
  check.true_clearance = std::numeric_limits<double>::infinity();
  // An obstacle beyond the window's edge is not known either.
  const auto known = [&](const Eigen::Vector3d& p) {
    return scene.map->InWindow(scene.map->CellOf(p.array() - inflation)) &&
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

std::vector<ReplanRow> RunReplanStudy(const ReplanStudyOptions& options,
                                      const solvers::BackendRegistry& backends,
                                      const std::function<void(int done, int all)>& report) {
  planning::Replanner replanner(SceneReplannerOptions(options.scenes, options.replanner), backends);
  std::vector<ReplanRow> rows;
  for (int index = 0; index < options.count; ++index) {
    const ReplanScene scene = DrawReplanScene(options.scenes, index);
    ReplanRow row;
    row.index = index;
    row.feasible = scene.feasible;
    row.straight_blocked = scene.straight_blocked;
    row.target_moved = scene.target_moved;
    if (index == 0) {  // first steps pay for pages, caches and lazy set-up
      replanner.Replan(AskAt(scene, &replanner), *scene.map);
    }
    std::vector<planning::StageTimes> times;
    UniformBspline plan;
    for (int repeat = 0; repeat < options.repeats; ++repeat) {
      const planning::ReplanInput input = AskAt(scene, &replanner);
      const ReplanResult& result = replanner.Replan(input, *scene.map);
      times.push_back(result.times);
      if (repeat > 0) continue;
      row.status = result.status;
      row.reason = result.reason;
      row.solves = result.solves;
      row.pairs = result.pairs;
      row.guides = static_cast<int>(result.guide_paths.size());
      plan = result.curve;
    }
    if (row.planned()) {
      row.duration = plan.duration();
      row.stretch = plan.duration() / scene.duration;
      row.jerk = plan.SquaredJerk();
      if (options.check) row.check = CheckPlan(plan, scene, options.scenes.kind.limits);
    }
    std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end(),
                     [](const auto& a, const auto& b) { return a.total.cpu < b.total.cpu; });
    row.times = times[times.size() / 2];
    rows.push_back(row);
    report(index + 1, options.count);
  }
  return rows;
}

ReplanSummary Summarise(const std::vector<ReplanRow>& rows) {
  ReplanSummary summary;
  summary.scenes = static_cast<int>(rows.size());
  std::vector<const ReplanRow*> all, clear, blocked;
  for (const ReplanRow& row : rows) {
    all.push_back(&row);
    (row.straight_blocked ? blocked : clear).push_back(&row);
    if (row.feasible) {
      ++summary.feasible;
      if (row.planned()) ++summary.succeeded;
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
  return summary;
}

}  // namespace touchdown::evaluation
