// SPDX-License-Identifier: BSD-3-Clause
// Every accepted plan is looked at again by two checkers that share nothing with the certificate: the
// map's blocked cells at points 1 cm apart, and FCL's distance from these points to the obstacles
// themselves. Cells hold their obstacles, so that a plan that is clear of the inflated cells is at
// least the inflation away from every obstacle.
#include "touchdown/evaluation/replan_study.h"

#include <algorithm>
#include <cmath>

#include "touchdown/sim/true_clearance.h"

namespace touchdown::evaluation {
namespace {

using planning::ReplanResult;
using planning::UniformBspline;

constexpr double kStep = 0.01;      // between samples [m]
constexpr double kRounding = 1e-3;  // of FCL's distance and of that point [m]

/// In a blocked cell by more than the curve may leave its chords, for which the inflation makes up.
bool DeepInBlocked(const planning::OccupancyMap& map, const Eigen::Vector3d& p) {
  constexpr double s = planning::kChordSagitta;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d off((corner & 1) ? s : -s, (corner & 2) ? s : -s, (corner & 4) ? s : -s);
    if (!map.IsBlocked(Eigen::Vector3d(p + off))) return false;
  }
  return true;
}

void MeasureShape(const UniformBspline& curve, ReplanRow* row) {
  const auto& q = curve.control_points();
  row->duration = curve.duration();
  row->jerk = row->length = 0.0;
  for (int i = 0; i + 3 < q.cols(); ++i) {
    row->jerk += (q.col(i + 3) - 3.0 * q.col(i + 2) + 3.0 * q.col(i + 1) - q.col(i)).squaredNorm() /
                 std::pow(curve.interval(), 5);
  }
}

}  // namespace

void CheckPlan(const UniformBspline& curve, const ReplanScene& scene, ReplanRow* row) {
  const sim::TrueClearance truth(scene.field, PointVehicle());
  const double inflation = scene.map->options().inflation_radius;
  row->true_clearance = std::numeric_limits<double>::infinity();
  row->length = 0.0;
  bool blocked = false;
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
    const Eigen::Vector3d p = curve.Evaluate(curve.t0() + curve.duration() * i / steps).p_WB;
    row->length += (p - last).norm();
    last = p;
    if (!known(p)) continue;
    blocked = blocked || DeepInBlocked(*scene.map, p);
    estimation::VehicleState vehicle;
    vehicle.p_WB = p;
    row->true_clearance = std::min(row->true_clearance, truth.Distance(vehicle));
  }
  row->map_blocked = blocked;
  row->truly_near = row->true_clearance < inflation - kRounding;
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
      row.limits_kept = result.certificate.limits_kept;
      MeasureShape(result.curve, &row);
      row.stretch = row.duration / scene.duration;
      plan = result.curve;
    }
    if (options.check && row.planned()) CheckPlan(plan, scene, &row);
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
    if (row.map_blocked || row.truly_near) ++summary.colliding;
    if (row.map_blocked != row.truly_near) ++summary.disagreeing;
    if (!row.limits_kept) ++summary.beyond_limits;
  }
  if (summary.feasible > 0) summary.success = ClopperPearson(summary.succeeded, summary.feasible);
  summary.all = TimesOf(all);
  summary.clear = TimesOf(clear);
  summary.blocked = TimesOf(blocked);
  return summary;
}

}  // namespace touchdown::evaluation
