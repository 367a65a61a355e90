// SPDX-License-Identifier: BSD-3-Clause
// Starts and goals follow the scenes EGO-Planner was measured in (start in the middle of the
// forest, velocity within 0.4 rad of the goal's direction); the goal is a pad on a coordinated turn.
// The scene is a function of (seed, index, draw): each kind of draw has its own stream. Which draw is
// taken, and how long its flight is, is decided at the same sizes whatever is asked for.
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
constexpr double kReach = 12.0;        // start to goal along x and y: inside the map [m]
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
  options.size_log2 = {8, 8, 5};  // 25.6 x 25.6 x 3.2 m around the start
  options.inflation_radius = inflation;
  return options;
}

planning::LandingProblemOptions MakingOptions(planning::LandingProblemOptions options) {
  options.arrival = planning::ArrivalMode::kFixed;
  options.limits_mode = planning::LimitsMode::kSoft;
  options.endpoint = planning::EndpointMode::kEliminated;
  return options;
}

planning::LandingProblemOptions HardOptions(planning::LandingProblemOptions options) {
  options = MakingOptions(std::move(options));
  options.limits_mode = planning::LimitsMode::kHard;
  return options;
}

// The shifted previous plan, with the ends of the new problem.
planning::UniformBspline WarmStart(const LandingCase& later,
                                   const planning::UniformBspline& previous, int segments) {
  const planning::UniformBspline rest =
      planning::ShiftedSpline(previous, later.t0, later.duration, segments);
  planning::SplineState end =
      planning::EndStateAt(*later.pad, later.target, later.t0 + later.duration).state;
  end.a = rest.AtKnot(rest.segments()).a;  // it is free
  return planning::WithEnds(rest, later.start, end);
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
  std::uint64_t forest_seed = 0;
  double duration = 0.0;
  planning::EndpointTarget target;
  std::unique_ptr<planning::OccupancyMap> map;
  planning::FreeSpace space;
};

CaseMaker::Binder::Binder(const CaseOptions& options, int points)
    : problem(points - 3, MakingOptions(options.problem)),
      hard(points - 3, HardOptions(options.problem)),
      backend(solvers::MakeBandedSolver()) {
  backend->Prepare(problem.view());
  hard.view().Resize(&limits);
}

CaseMaker::CaseMaker(const CaseOptions& options, int points)
    : options_(options), binder_(options, points), search_(kVerticalCost) {
  for (const int size : kReferencePoints) {
    references_.push_back(std::make_unique<Binder>(options, size));
  }
  sim::ForestOfKind(options.forest);
  planning::OccupancyMap checks_inflation(MapOptions(options.inflation));
}

// An unusable scene (too long a flight, or the goal out of reach) has no map.
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
  const double acceleration = start.Uniform(0.0, 0.2 * limits.acceleration);
  scene.start.a = acceleration * Level(start.Uniform(-std::numbers::pi, std::numbers::pi));

  const double distance = pad.Uniform(7.0, 11.0);
  const double fastest = std::min(2.0, 0.6 * limits.speed);
  scene.pad.motion = estimation::PadMotion::kTurn;
  scene.pad.mean.head<2>() = (scene.start.p + distance * Level(direction)).head<2>();
  scene.pad.mean(2) = pad.Uniform(0.25 * fastest, fastest);
  scene.pad.mean(3) = pad.Uniform(-std::numbers::pi, std::numbers::pi);
  scene.pad.mean(4) = pad.Uniform(-0.2, 0.2);
  scene.forest_seed = world.Seed();

  const auto foretold = Foretold(scene.pad);
  scene.target.height = kArrivalHeight;
  scene.target.sink_rate = kSinkRate;
  scene.target.height_floor = -1.0e3;  // sinking goes on: the end stays smooth in a free arrival
  SetDuration(
      planning::GuessDuration(scene.start, 0.0, *foretold, {0.0, kArrivalHeight}, limits, kDetour),
      &scene);
  return scene;
}

// Where the pad will be decides which part of the forest is kept free. False, and no map, if the
// flight is too long or ends outside the map.
bool CaseMaker::SetDuration(double duration, Scene* scene) const {
  scene->map.reset();
  if (!(duration <= kLongest)) return false;
  const Eigen::Vector2d start = scene->start.p.head<2>();
  const Eigen::Vector2d goal = Foretold(scene->pad)->At(duration).p_WP.head<2>();
  if ((goal - start).lpNorm<Eigen::Infinity>() > kReach) return false;
  scene->duration = duration;
  scene->target.t_reference = duration;
  sim::ForestConfig forest = sim::ForestOfKind(options_.forest);
  forest.keep_out = {{start, kKeepOut}, {goal, kKeepOut}};
  scene->map = std::make_unique<planning::OccupancyMap>(MapOptions(options_.inflation));
  scene->map->Recentre({start.x(), start.y(), 0.5 * forest.height});
  FillMap(sim::MakeForest(forest, scene->forest_seed), scene->map.get());
  scene->space.map = scene->map.get();
  scene->space.floor = kFloor;
  scene->space.ceiling = kCeiling;
  return true;
}

// Leaves the last curve in `curve`, if there was one. Not clear: also if it exceeds the full limits;
// such a problem is one of how much to violate, which nobody flies.
CaseMaker::Outcome CaseMaker::BindUntilClear(const Scene& scene, Binder* binder, LandingCase* made,
                                             planning::UniformBspline* curve) {
  planning::LandingProblem& problem = binder->problem;
  made->pairs.clear();
  made->pair_scale = 1.0;
  std::vector<planning::BlockedRun> runs;
  std::vector<Eigen::Vector3d> guide;
  solvers::Stop stop;
  stop.max_iterations = kIterations;
  solvers::SolverResult result;
  Eigen::VectorXd y;
  made->clear = false;
  for (made->rounds = 0;; ++made->rounds) {
    made->Apply(&problem);
    if (made->rounds == 0) y = made->StartPoint(problem);
    binder->backend->Solve(problem.view(), y, stop, &result);
    if (!result.usable()) return Outcome::kUnsolved;
    y = result.x;
    *curve = problem.Curve(y);
    FindBlockedRuns(*curve, made->t0, scene.space, &runs);
    if (runs.empty()) {
      made->Apply(&binder->hard);
      made->clear = binder->hard.view().Evaluate(y.data(), {}, {}, &binder->limits) &&
                    binder->limits.full.max_violation <= 0.0;
      return made->clear ? Outcome::kClear : Outcome::kNotClear;
    }
    if (made->rounds == kRounds) return Outcome::kNotClear;
    int bound = 0;
    for (const planning::BlockedRun& run : runs) {
      if (run.at_start || run.at_end) return Outcome::kNotClear;
      const planning::SearchStatus found =
          search_.Search(scene.space, curve->Evaluate(run.t_in).p_WB,
                         curve->Evaluate(run.t_out).p_WB, kExpansions, &guide);
      if (found != planning::SearchStatus::kFound) return Outcome::kNotClear;
      bound += BindPairs(*curve, run, guide, scene.space,
                         static_cast<std::size_t>(problem.max_pairs()), &made->pairs);
    }
    if (bound == 0) return Outcome::kNotClear;
    if (made->rounds > 0) made->pair_scale *= kPressure;
  }
}

// Binds at every reference size; a warm case starts at each from the curve that `curves` holds for
// it, and leaves the new one there.
CaseMaker::Outcome CaseMaker::BindAtReferences(const Scene& scene, LandingCase* made,
                                               Curves* curves) {
  for (std::size_t i = 0; i < references_.size(); ++i) {
    if (made->warm) {
      made->warm = WarmStart(*made, (*curves)[i], references_[i]->problem.segments());
    }
    const Outcome outcome = BindUntilClear(scene, references_[i].get(), made, &(*curves)[i]);
    if (outcome != Outcome::kClear) return outcome;
  }
  return Outcome::kClear;
}

// As the replanner does, a longer flight is tried where the guessed one leaves no room.
CaseMaker::Outcome CaseMaker::StretchUntilClear(Scene* scene, LandingCase* made, Curves* curves) {
  bool unsolved = false;
  for (int stretch = 0; stretch <= kStretches; ++stretch) {
    if (stretch > 0 && !SetDuration(kStretch * scene->duration, scene)) break;
    if (scene->space.Blocked(scene->start.p)) break;
    made->duration = scene->duration;
    made->target = scene->target;
    const Outcome outcome = BindAtReferences(*scene, made, curves);
    if (outcome == Outcome::kClear) return outcome;
    unsolved = unsolved || outcome == Outcome::kUnsolved;
  }
  return unsolved ? Outcome::kUnsolved : Outcome::kNotClear;
}

// What the planner meets 0.1 s later: vehicle and pad where they were expected, but for noise.
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
  return later;
}

// Accepts the scene at the reference sizes, then binds pairs at the wanted one, where a failed solve
// leaves the pairs of the last round. The warm problem follows the finest reference's plan.
CaseMaker::Outcome CaseMaker::MakeOf(Scene* scene, int draw, LandingCase* made) {
  Curves curves;
  const Outcome first = StretchUntilClear(scene, made, &curves);
  if (first != Outcome::kClear) return first;
  planning::UniformBspline plan = curves.back();
  BindUntilClear(*scene, &binder_, made, &plan);
  if (!options_.warm) return Outcome::kClear;
  LandingCase later = Later(*scene, *made, curves.back(), draw);
  later.warm = plan;
  const Outcome second = BindAtReferences(*scene, &later, &curves);
  if (second != Outcome::kClear) return second;
  later.warm = WarmStart(later, plan, binder_.problem.segments());
  BindUntilClear(*scene, &binder_, &later, &plan);
  *made = std::move(later);
  return Outcome::kClear;
}

LandingCase CaseMaker::Make(int index) {
  int not_clear = 0;
  int unsolved = 0;
  for (int draw = 0; draw < kScenes; ++draw) {
    Scene scene = DrawScene(index, draw);
    if (!scene.map || scene.space.Blocked(scene.start.p)) continue;
    LandingCase made;
    made.index = index;
    made.start = scene.start;
    made.pad = Foretold(scene.pad);
    made.pad_speed = scene.pad.mean(2);
    made.pad_rate = scene.pad.mean(4);
    switch (MakeOf(&scene, draw, &made)) {
      case Outcome::kClear:
        made.draws = draw + 1;
        made.not_clear = not_clear;
        made.unsolved = unsolved;
        return made;
      case Outcome::kNotClear:
        ++not_clear;
        break;
      case Outcome::kUnsolved:
        ++unsolved;
        break;
    }
  }
  throw std::runtime_error(fmt::format(
      "problem {}: none of {} scenes of forest kind {} with an inflation of {:.4g} m could be "
      "made clear: {} not within the limits, {} not solved by {}, the others out of reach",
      index, kScenes, options_.forest, options_.inflation, not_clear, unsolved, backend()));
}

}  // namespace touchdown::evaluation
