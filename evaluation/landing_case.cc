// SPDX-License-Identifier: BSD-3-Clause
// Starts and goals follow the scenes EGO-Planner was measured in (start in the middle of the
// forest, velocity within 0.4 rad of the goal's direction); the goal is a pad on a coordinated turn.
// The scene is a function of (seed, index, draw): each kind of draw has its own stream.
#include "touchdown/evaluation/landing_case.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "touchdown/evaluation/field_map.h"
#include "touchdown/planning/collision_pairs.h"
#include "touchdown/planning/curve_check.h"
#include "touchdown/planning/duration_guess.h"
#include "touchdown/planning/warm_start.h"
#include "touchdown/sim/forest.h"
#include "touchdown/sim/random_stream.h"
#include "touchdown/solvers/banded_solver.h"

namespace touchdown::evaluation {
namespace {

using estimation::PadBelief;
using sim::RandomStream;

constexpr double kDeckHeight = 0.5;     // [m]
constexpr double kArrivalHeight = 0.3;  // body origin above the deck at the guessed arrival [m]
constexpr double kSinkRate = 0.3;       // approach velocity [m/s]
constexpr double kFloor = 0.3;          // for the body's origin [m]
constexpr double kCeiling = 2.8;        // below the pillars' tops: around, not over [m]
constexpr double kDetour = 1.05;        // of the duration guess
constexpr double kLongest = 12.0;       // a scene that takes longer is drawn again [s]
constexpr double kStretch = 1.15;       // of the duration, where the limits do not leave room
constexpr int kStretches = 4;
constexpr double kKeepOut = 2.0;       // no pillar around start and goal [m]
constexpr double kLater = 0.1;         // of the warm problem [s]
constexpr double kPressure = 1.6;      // weight of the pairs grows by this every round
constexpr double kVerticalCost = 2.0;  // of A*
constexpr int kRounds = 8;
constexpr int kExpansions = 200000;
constexpr int kScenes = 100;
constexpr int kIterations = 100;

Eigen::Vector3d Level(double angle, double z = 0.0) {
  return {std::cos(angle), std::sin(angle), z};
}

std::shared_ptr<const estimation::PadPrediction> Foretold(const PadBelief& belief) {
  return std::make_shared<estimation::BeliefPrediction>(belief, kDeckHeight,
                                                        estimation::PadNoise{});
}

planning::OccupancyMapOptions MapOptions(double inflation) {
  planning::OccupancyMapOptions options;
  options.size_log2 = {8, 8, 5};  // 25.6 x 25.6 x 3.2 m: all within 12 m of the start
  options.inflation_radius = inflation;
  return options;
}

planning::LandingProblemOptions MakingOptions(planning::LandingProblemOptions options) {
  options.limits_mode = planning::LimitsMode::kSoft;
  options.endpoint = planning::EndpointMode::kEliminated;
  return options;
}

planning::LandingProblemOptions HardOptions(planning::LandingProblemOptions options) {
  options = MakingOptions(std::move(options));
  options.limits_mode = planning::LimitsMode::kHard;
  return options;
}

}  // namespace

void LandingCase::Apply(planning::LandingProblem* problem) const {
  problem->SetBoundary(start, t0, *pad, target);
  problem->SetDuration(duration);
  problem->SetPairs(pairs);
  problem->SetPairWeightScale(pair_scale);
}

Eigen::VectorXd LandingCase::StartPoint(const planning::LandingProblem& problem) const {
  if (!warm) return problem.Guess();
  return problem.view().Restrict(warm->control_points().data(), warm->interval());
}

struct CaseMaker::Scene {
  planning::SplineState start;
  PadBelief pad;
  double duration = 0.0;
  planning::EndpointTarget target;
  std::unique_ptr<planning::OccupancyMap> map;
  planning::FreeSpace space;
};

CaseMaker::CaseMaker(const CaseOptions& options, int points)
    : options_(options),
      problem_(points - 3, MakingOptions(options.problem)),
      hard_(points - 3, HardOptions(options.problem)),
      backend_(solvers::MakeBandedSolver()),
      search_(kVerticalCost) {
  sim::ForestOfKind(options.forest);
  planning::OccupancyMap checks_inflation(MapOptions(options.inflation));
  backend_->Prepare(problem_.view());
  hard_.view().Resize(&limits_);
}

// An unusable scene (too long a flight) has no map.
CaseMaker::Scene CaseMaker::DrawScene(int index, int draw) const {
  const auto stream = [&](const char* what) {
    return RandomStream(options_.seed, fmt::format("compare {} {} {}", index, draw, what));
  };
  RandomStream start = stream("start");
  RandomStream pad = stream("pad");
  RandomStream world = stream("world");
  const planning::Limits& limits = options_.problem.limits;

  Scene scene;
  const double direction = start.Uniform(-std::numbers::pi, std::numbers::pi);
  const double x = start.Uniform(-8.0, 8.0);
  const double y = start.Uniform(-8.0, 8.0);
  scene.start.p = {x, y, start.Uniform(1.0, 2.0)};
  const double speed = start.Uniform(0.0, 0.7 * limits.speed);
  scene.start.v = speed * Level(direction + start.Uniform(-0.4, 0.4));
  scene.start.a = start.Uniform(0.0, 0.2 * limits.acceleration) *
                  Level(start.Uniform(-std::numbers::pi, std::numbers::pi));

  const double distance = pad.Uniform(7.0, 11.0);
  const double fastest = std::min(2.0, 0.6 * limits.speed);
  scene.pad.motion = estimation::PadMotion::kTurn;
  scene.pad.mean.head<2>() = (scene.start.p + distance * Level(direction)).head<2>();
  scene.pad.mean(2) = pad.Uniform(0.25 * fastest, fastest);
  scene.pad.mean(3) = pad.Uniform(-std::numbers::pi, std::numbers::pi);
  scene.pad.mean(4) = pad.Uniform(-0.2, 0.2);

  const auto foretold = Foretold(scene.pad);
  scene.target.height = kArrivalHeight;
  scene.target.sink_rate = kSinkRate;
  scene.target.height_floor = -1.0e3;  // sinking goes on: the end stays smooth in a free arrival
  scene.duration =
      planning::GuessDuration(scene.start, 0.0, *foretold, {0.0, kArrivalHeight}, limits, kDetour);
  if (!(scene.duration <= kLongest)) return scene;
  scene.target.t_reference = scene.duration;

  sim::ForestConfig forest = sim::ForestOfKind(options_.forest);
  const Eigen::Vector3d goal = foretold->At(scene.duration).p_WP;
  forest.keep_out = {{scene.start.p.head<2>(), kKeepOut}, {goal.head<2>(), kKeepOut}};
  const auto forest_seed = static_cast<std::uint64_t>(world.Uniform(0.0, 0x1.0p53));
  scene.map = std::make_unique<planning::OccupancyMap>(MapOptions(options_.inflation));
  scene.map->Recentre({scene.start.p.x(), scene.start.p.y(), 0.5 * forest.height});
  FillMap(sim::MakeForest(forest, forest_seed), scene.map.get());
  scene.space.map = scene.map.get();
  scene.space.floor = kFloor;
  scene.space.ceiling = kCeiling;
  return scene;
}

// Leaves the last curve in `curve`; false if it could not be made clear within the full limits:
// such a problem is one of how much to violate, which nobody flies.
bool CaseMaker::BindUntilClear(const Scene& scene, LandingCase* made,
                               planning::UniformBspline* curve) {
  std::vector<planning::BlockedRun> runs;
  std::vector<Eigen::Vector3d> guide;
  solvers::Stop stop;
  stop.max_iterations = kIterations;
  solvers::SolverResult result;
  Eigen::VectorXd y;
  for (made->rounds = 0;; ++made->rounds) {
    made->Apply(&problem_);
    if (made->rounds == 0) y = problem_.Guess();
    backend_->Solve(problem_.view(), y, stop, &result);
    if (!result.usable()) return false;
    y = result.x;
    *curve = problem_.Curve(y);
    FindBlockedRuns(*curve, made->t0, scene.space, &runs);
    if (runs.empty()) {
      made->Apply(&hard_);
      return hard_.view().Evaluate(y.data(), {}, {}, &limits_) && limits_.full.max_violation <= 0.0;
    }
    if (made->rounds == kRounds) return false;
    int bound = 0;
    for (const planning::BlockedRun& run : runs) {
      if (run.at_start || run.at_end) return false;
      const planning::SearchStatus found =
          search_.Search(scene.space, curve->Evaluate(run.t_in).p_WB,
                         curve->Evaluate(run.t_out).p_WB, kExpansions, &guide);
      if (found != planning::SearchStatus::kFound) return false;
      bound += BindPairs(*curve, run, guide, scene.space,
                         static_cast<std::size_t>(problem_.max_pairs()), &made->pairs);
    }
    if (bound == 0) return false;
    if (made->rounds > 0) made->pair_scale *= kPressure;
  }
}

// As the replanner does, a longer flight is tried where the guessed one leaves no room.
bool CaseMaker::StretchUntilClear(const Scene& scene, LandingCase* made,
                                  planning::UniformBspline* curve) {
  for (int stretch = 0; stretch <= kStretches; ++stretch, made->duration *= kStretch) {
    made->target.t_reference = made->duration;
    made->pairs.clear();
    made->pair_scale = 1.0;
    if (BindUntilClear(scene, made, curve)) return true;
  }
  return false;
}

// What the planner meets 0.1 s later: vehicle and pad where they were expected, but for noise, and
// the previous solution to start from.
LandingCase CaseMaker::Later(const Scene& scene, const LandingCase& first,
                             const planning::UniformBspline& solution, int draw) const {
  RandomStream noise(options_.seed, fmt::format("compare {} {} later", first.index, draw));
  const auto vector = [&noise](double sigma) {
    const double x = noise.Normal(sigma);
    const double y = noise.Normal(sigma);
    return Eigen::Vector3d(x, y, noise.Normal(sigma));
  };
  LandingCase later = first;
  later.t0 = first.t0 + kLater;
  const planning::FlatState at = solution.Evaluate(later.t0);
  later.start.p = at.p_WB + vector(0.02);
  later.start.v = at.v_WB + vector(0.05);
  later.start.a = at.a_WB;
  PadBelief pad = PropagateBelief(scene.pad, later.t0, estimation::PadNoise{});
  for (int i = 0; i < 5; ++i) pad.mean(i) += noise.Normal(i == 2 ? 0.05 : 0.02);
  pad.cov.setZero();
  later.pad = Foretold(pad);
  later.pad_speed = pad.mean(2);
  later.pad_rate = pad.mean(4);
  later.duration = solution.t_end() - later.t0;
  later.pairs.clear();
  later.pair_scale = 1.0;
  const planning::UniformBspline rest =
      planning::ShiftedSpline(solution, later.t0, later.duration, problem_.segments());
  planning::SplineState end =
      planning::EndStateAt(*later.pad, later.target, later.t0 + later.duration).state;
  end.a = rest.AtKnot(rest.segments()).a;  // it is free
  later.warm = planning::WithEnds(rest, later.start, end);
  return later;
}

LandingCase CaseMaker::Make(int index) {
  for (int draw = 0; draw < kScenes; ++draw) {
    const Scene scene = DrawScene(index, draw);
    if (!scene.map || scene.space.Blocked(scene.start.p)) continue;
    LandingCase made;
    made.index = index;
    made.start = scene.start;
    made.pad = Foretold(scene.pad);
    made.target = scene.target;
    made.duration = scene.duration;
    made.pad_speed = scene.pad.mean(2);
    made.pad_rate = scene.pad.mean(4);
    planning::UniformBspline curve;
    if (!StretchUntilClear(scene, &made, &curve)) continue;
    if (options_.warm) {
      made = Later(scene, made, curve, draw);
      if (!BindUntilClear(scene, &made, &curve)) continue;
    }
    made.draws = draw + 1;
    return made;
  }
  throw std::runtime_error(fmt::format(
      "problem {}: none of {} scenes of forest kind {} with an inflation of {:.4g} m could be "
      "made clear",
      index, kScenes, options_.forest, options_.inflation));
}

}  // namespace touchdown::evaluation
