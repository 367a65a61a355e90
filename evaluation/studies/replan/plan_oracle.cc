// SPDX-License-Identifier: BSD-3-Clause
// A way gives a curve in time; its control points are bound to the free space around it. Then: solve, bind anew where
// it is blocked, press harder, until the curve has a certificate. Some ways are paths of A*, short and wide, with
// earlier ways closed. Others are from a search in position and speed, which fit a fast start.
#include "evaluation/studies/replan/plan_oracle.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "evaluation/judge/motion_search.h"
#include "planning/replan/pair_binder.h"
#include "planning/replan/prepared_problems.h"
#include "planning/search/grid_search.h"
#include "touchdown/planning/certify/stored_stop.h"
#include "touchdown/planning/problem/landing_problem.h"
#include "touchdown/planning/spline/rest_trajectory.h"

namespace touchdown::evaluation {
namespace {

using Eigen::Vector3d;
using planning::UniformBspline;

constexpr double kFirstArrivalRatio = 1.03;  // arrival that is tried, over the earliest possible
constexpr double kLater = 1.09;              // of an arrival to the next
constexpr int kArrivals = 16;                // up to 3.7 times the earliest possible
constexpr int kWays = 6;                     // around obstacles, of each sort of path
constexpr int kRounds = 12;                  // of binding
constexpr double kPressure = 2.0;            // growth of the pairs' weight in each
constexpr double kLimitPressure = 4.0;
constexpr int kLimitRounds = 5;
constexpr int kPathExpansions = 300000;
constexpr int kLocalExpansions = 20000;
/// Of the longest segment of a plan. Its verdicts are on file: they do not follow the planner's own numbers.
constexpr double kSegmentShares[] = {0.67, 0.45, 1.0};

planning::ReplannerOptions OwnFormulation(planning::ReplannerOptions options) {
  options.backend = "banded";
  options.arrival = planning::ArrivalMode::kFixed;
  options.problem.limits_mode = planning::LimitsMode::kSoft;
  options.problem.endpoint = planning::EndpointMode::kEliminated;
  return options;
}

/// Places of a path at a constant speed, from 0 to `time` [s].
TimedMotion InTime(const planning::GuidePath& path, double time) {
  const double length = std::max(planning::PathLength(path), 1e-9);
  TimedMotion way;
  double gone = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0) gone += (path[i] - path[i - 1]).norm();
    way.push_back({time * gone / length, path[i]});
  }
  return way;
}

Vector3d PlaceAt(const TimedMotion& way, double t) {
  const auto after = std::upper_bound(way.begin(), way.end(), t,
                                      [](double a, const TimedPlace& b) { return a < b.t; });
  if (after == way.begin()) return way.front().p;
  if (after == way.end()) return way.back().p;
  const TimedPlace& before = *(after - 1);
  const double share = (t - before.t) / std::max(1e-9, after->t - before.t);
  return before.p + share * (after->p - before.p);
}

}  // namespace

class PlanOracle::Impl {
 public:
  Impl(const planning::ReplannerOptions& options, const solvers::BackendRegistry& backends)
      : options_(OwnFormulation(options)),
        problems_(options_, backends),
        binder_(options_.problem) {}

  OracleAnswer Ask(const ReplanScene& scene);

 private:
  bool TryPaths(const char* name, double tight_cost);
  bool TryMotions();
  bool TryWay(const TimedMotion& way, double T, const char* name);
  bool Polish(const TimedMotion& way, int segments, double T);
  bool Bind(const UniformBspline& curve, bool first, const planning::GuidePath& guide);
  planning::Certificate Judge(planning::FlightPair* pair) const;

  const planning::ReplannerOptions options_;
  planning::PreparedProblems problems_;
  planning::PairBinder binder_;
  planning::GridSearch local_{2.0, 1.5, 4.0};

  // Of the scene under way.
  const ReplanScene* scene_ = nullptr;
  planning::FreeSpace space_;
  planning::HullSpace hull_;
  std::vector<double> arrivals_;  // at which the end is free [s]
  std::vector<planning::BlockedRun> runs_;
  std::vector<planning::ObstaclePair> pairs_;
  OracleAnswer answer_;
};

OracleAnswer PlanOracle::Impl::Ask(const ReplanScene& scene) {
  scene_ = &scene;
  answer_ = {};
  space_ = {};
  space_.map = scene.map.get();
  space_.floor = options_.floor_height;
  space_.ceiling = options_.ceiling_height;
  hull_ = {};
  hull_.space = &space_;
  hull_.hull_radius = options_.hull_radius;
  hull_.pad = scene.end.get();
  hull_.deck_half_size = options_.deck_half_size;
  hull_.foot_depth = options_.contact_height;
  arrivals_.clear();
  double T =
      kFirstArrivalRatio * std::max(EarliestArrival(scene, options_.limits), options_.min_duration);
  for (int i = 0; i < kArrivals && T < options_.max_duration; ++i, T *= kLater) {
    const Vector3d end = planning::EndStateAt(*scene.end, scene.endpoint, T).state.p;
    if (!space_.Blocked(end)) arrivals_.push_back(T);
  }
  answer_.end_blocked = arrivals_.empty();
  answer_.cannot_stop = std::isfinite(planning::FirstBlockedTime(
      planning::MakeRestTrajectory(scene.start, 0.0, Vector3d::Zero(), options_.limits), 0.0,
      space_));
  if (answer_.end_blocked) return answer_;
  if (!TryPaths("path", 1.0) && !TryPaths("wide path", 8.0)) TryMotions();
  return answer_;
}

/// The ways of earlier paths are closed one after the other, each at the first obstacle in the straight way, then at the last.
bool PlanOracle::Impl::TryPaths(const char* name, double tight_cost) {
  planning::GridSearch search(tight_cost > 1.0 ? 2.0 : 1.0, 1.0, tight_cost);
  // Moving ends have paths of their own. A way hardly changes from one arrival to the next.
  const bool stands = scene_->end->At(0.0).v_WP.norm() < 1e-9;
  for (const bool at_last : {false, true}) {
    std::vector<planning::GuidePath> paths;
    std::vector<planning::Barrier> barriers;
    for (std::size_t i = 0; i < arrivals_.size(); i += 3) {
      const double T = arrivals_[i];
      const planning::SplineState end =
          planning::EndStateAt(*scene_->end, scene_->endpoint, T).state;
      if (i == 0 || !stands) {
        paths.clear();
        barriers.clear();
        const UniformBspline straight(planning::HermiteControlPoints(scene_->start, end, 12, T),
                                      T / 12, 0.0);
        planning::FindBlockedRuns(straight, 0.0, space_, &runs_);
        const std::vector<planning::BlockedRun> blocked = runs_;
        for (int k = 0; k < kWays; ++k) {
          planning::GuidePath path;
          if (search.Search(space_, scene_->start.p, end.p, kPathExpansions, &path, barriers) !=
              planning::SearchStatus::kFound) {
            break;
          }
          paths.push_back(path);
          if (blocked.empty()) break;
          const planning::BlockedRun& run = at_last ? blocked.back() : blocked.front();
          const auto barrier =
              planning::ClosePath(path, straight.Evaluate(0.5 * (run.t_in + run.t_out)));
          if (!barrier) break;
          barriers.push_back(*barrier);
        }
      }
      for (const planning::GuidePath& path : paths) {
        for (std::size_t j = i; j < std::min(i + 3, arrivals_.size()); ++j) {
          if (TryWay(InTime(path, arrivals_[j]), arrivals_[j], name)) return true;
        }
      }
    }
  }
  return false;
}

bool PlanOracle::Impl::TryMotions() {
  for (const double share : {0.8, 0.6, 0.95}) {
    for (const double step : {0.3, 0.2, 0.45}) {
      MotionSearchOptions options;
      options.share = share;
      options.step = step;
      const std::optional<TimedMotion> way = SearchMotion(
          scene_->start, *scene_->end, scene_->endpoint, options_.limits, space_, options);
      if (!way) continue;
      for (const double stretch : {1.0, 1.05, 1.12, 1.2}) {
        TimedMotion slower = *way;
        for (TimedPlace& place : slower) place.t *= stretch;
        if (TryWay(slower, slower.back().t, "motion")) return true;
      }
    }
  }
  return false;
}

bool PlanOracle::Impl::TryWay(const TimedMotion& way, double T, const char* name) {
  int last = 0;
  for (const double share : kSegmentShares) {
    const int segments = planning::SegmentsFor(T, options_.limits, share, options_.segment_length);
    if (segments == last) continue;
    last = segments;
    ++answer_.tries;
    if (!Polish(way, segments, T)) continue;
    answer_.found = true;
    answer_.found_by = name;
    return true;
  }
  return false;
}

planning::Certificate PlanOracle::Impl::Judge(planning::FlightPair* pair) const {
  const planning::SplineState wanted =
      planning::EndStateAt(*scene_->end, scene_->endpoint, pair->curve.t_end()).state;
  planning::Certificate certificate =
      planning::Certify(pair->curve, 0.0, &scene_->start, &wanted, options_.limits, space_);
  if (certificate.limits_kept && (certificate.clear || certificate.escaping)) {
    const planning::PairProof proof = planning::ProvePair(
        0.0, options_.reaction, planning::PairEnd::kRestOrContact, options_.limits, hull_, pair);
    planning::Enter(proof, &certificate);
  }
  return certificate;
}

/// From a way in time to a plan.
bool PlanOracle::Impl::Polish(const TimedMotion& way, int segments, double T) {
  planning::PreparedProblem& prepared = problems_.At(segments, planning::ArrivalMode::kFixed);
  planning::LandingProblem& problem = *prepared.problem;
  problem.SetBoundary(scene_->start, 0.0, *scene_->end, scene_->endpoint);
  problem.SetDuration(T);
  problem.SetPrevious(nullptr);
  planning::ControlPoints points(3, segments + 3);
  planning::GuidePath guide;
  for (int i = 0; i < segments + 3; ++i) points.col(i) = PlaceAt(way, (i - 1) * T / segments);
  for (int i = 0; i <= 4 * segments; ++i) guide.push_back(PlaceAt(way, i * T / (4 * segments)));
  planning::FlightPair pair;
  pair.curve = UniformBspline(points, T / segments, 0.0);
  problem.WarmGuess(pair.curve, &prepared.start.y);
  binder_.Begin(segments + 3);
  runs_.assign(1, {0.0, T, false, false});
  double pressure = 1.0, limits = 1.0;
  int limit_rounds = 0;
  for (int round = 0; round < kRounds; ++round) {
    if (!Bind(pair.curve, round == 0, guide)) return false;
    problem.SetPairs(pairs_);
    problem.SetPairWeightScale(pressure);
    for (;;) {
      problem.SetLimitWeightScale(limits);
      solvers::Stop stop;
      stop.max_iterations = options_.max_iterations;
      stop.confirm = false;
      prepared.backend->Solve(problem.view(), prepared.start, stop, &prepared.solver);
      ++answer_.solves;
      if (!prepared.solver.usable()) return false;
      prepared.start.y = prepared.solver.x;
      problem.Curve(prepared.start.y, &pair.curve);
      planning::FindBlockedRuns(pair.curve, 0.0, space_, &runs_);
      if (!runs_.empty() && !(runs_.size() == 1 && runs_.front().at_start)) break;
      const planning::Certificate certificate = Judge(&pair);
      if (certificate.passed()) {
        answer_.plan = pair.curve;
        return true;
      }
      if (certificate.limits_kept || ++limit_rounds > kLimitRounds) return false;
      limits *= kLimitPressure;
    }
    pressure *= kPressure;
  }
  return false;
}

/// First the whole way, then the blocked parts.
bool PlanOracle::Impl::Bind(const UniformBspline& curve, bool first,
                            const planning::GuidePath& guide) {
  binder_.Start(curve);
  for (const planning::BlockedRun& run : runs_) {
    if (first) {
      binder_.Follow(curve, run, guide, space_);
      continue;
    }
    if (run.at_start || run.at_end) continue;
    planning::GuidePath around;
    const planning::SearchStatus status = local_.Search(
        space_, curve.Position(run.t_in), curve.Position(run.t_out), kLocalExpansions, &around);
    if (status != planning::SearchStatus::kFound) return false;
    binder_.AddCorner(curve, run, around, space_);
    binder_.Follow(curve, run, around, space_);
  }
  binder_.Bind(space_, &pairs_);
  return true;
}

PlanOracle::PlanOracle(const planning::ReplannerOptions& options,
                       const solvers::BackendRegistry& backends)
    : impl_(std::make_unique<Impl>(options, backends)) {}
PlanOracle::~PlanOracle() = default;
OracleAnswer PlanOracle::Ask(const ReplanScene& scene) { return impl_->Ask(scene); }

}  // namespace touchdown::evaluation
