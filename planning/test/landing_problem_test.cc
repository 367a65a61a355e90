// SPDX-License-Identifier: BSD-3-Clause
// The landing problem as a whole. Both ends are met exactly at every point the solver can reach.
// The convex problem has one optimum from any start.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "planning/problem/duration_guess.h"
#include "planning/test/planning_fixtures.h"
#include "touchdown/planning/certify/certificate.h"
#include "touchdown/planning/problem/landing_problem.h"
#include "touchdown/planning/replan/replan_result.h"
#include "touchdown/solvers/allocation_count.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::planning {
namespace {

constexpr double kExact = 1e-9;

LandingProblemOptions Options(ArrivalMode arrival, bool free_end_acceleration = true) {
  LandingProblemOptions options;
  options.arrival = arrival;
  options.free_end_acceleration = free_end_acceleration;
  return options;
}

TEST(LandingProblem, BothEndsAreMetExactlyAtAnyPoint) {
  Draw draw(3);
  for (int trial = 0; trial < 400; ++trial) {
    const ArrivalMode arrival = trial % 2 ? ArrivalMode::kFree : ArrivalMode::kFixed;
    const bool free_end = trial % 4 < 2;
    const int segments = 6 + trial % 30;
    LandingProblem problem(segments, Options(arrival, free_end));
    const ArcPad pad = draw.Pad();
    const SplineState start = draw.State(10.0, 3.0, 4.0);
    const double t0 = draw.Uniform(0.0, 100.0);
    const EndpointTarget target{t0, draw.Uniform(0.0, 3.0), draw.Uniform(0.0, 0.5), 0.2};
    problem.SetBoundary(start, t0, pad, target);
    problem.SetDuration(draw.Uniform(0.6, 12.0));
    Eigen::VectorXd y = problem.Guess();
    for (int i = 0; i < y.size(); ++i) y[i] += draw.Uniform(-0.2, 0.2) * (i + 1 < y.size());

    const UniformBspline curve = problem.Curve(y);
    const SplineState first = curve.AtKnot(0), last = curve.AtKnot(segments);
    const SplineState wanted = EndStateAt(pad, target, curve.t_end()).state;
    EXPECT_LT((first.p - start.p).norm(), kExact);
    EXPECT_LT((first.v - start.v).norm(), kExact);
    EXPECT_LT((first.a - start.a).norm(), 1e-7);
    EXPECT_LT((last.p - wanted.p).norm(), kExact);
    EXPECT_LT((last.v - wanted.v).norm(), kExact);
    if (!free_end) {
      EXPECT_LT((last.a - wanted.a).norm(), 1e-7);
    }
  }
}

// The same problem gives the point itself. A pad that moved gives the same shape between new ends.
TEST(LandingProblem, AWarmGuessKeepsTheShapeOfThePreviousCurve) {
  Draw draw(17);
  for (int trial = 0; trial < 200; ++trial) {
    const ArrivalMode arrival = trial % 2 ? ArrivalMode::kFree : ArrivalMode::kFixed;
    const int segments = 8 + trial % 20;
    LandingProblem problem(segments, Options(arrival, trial % 4 < 2));
    const ArcPad pad = draw.Pad(), elsewhere = draw.Pad();
    const SplineState start = draw.State(10.0, 3.0, 4.0), moved = draw.State(10.0, 3.0, 4.0);
    const EndpointTarget target{5.0, 1.0, 0.0, 0.2};
    problem.SetBoundary(start, 5.0, pad, target);
    problem.SetDuration(draw.Uniform(1.0, 8.0));
    Eigen::VectorXd y = problem.Guess(), warm = y, other = y;
    for (int i = 0; i < y.size(); ++i) y[i] += draw.Uniform(-0.02, 0.02) * (i + 1 < y.size());
    const UniformBspline curve = problem.Curve(y);
    problem.WarmGuess(curve, &warm);
    EXPECT_LT((warm - y).norm(), 1e-7);

    problem.SetBoundary(moved, 5.0, elsewhere, target);
    problem.WarmGuess(curve, &other);
    EXPECT_LT((other - warm).norm(), 1e-7);
    EXPECT_LT((problem.Curve(other).AtKnot(0).p - moved.p).norm(), kExact);

    // Later, with the remaining time, it follows the curve.
    const double t = 5.0 + 0.3 * curve.duration();
    const FlatState at = curve.Evaluate(t);
    problem.SetBoundary({at.p_WB, at.v_WB, at.a_WB}, t, pad, target);
    problem.SetDuration(curve.t_end() - t);
    problem.WarmGuess(curve, &other);
    const UniformBspline rest = problem.Curve(other);
    for (double s = t; s < curve.t_end(); s += 0.1) {
      EXPECT_LT((rest.Evaluate(s).p_WB - curve.Evaluate(s).p_WB).norm(), 0.15);
    }
  }
}

TEST(LandingProblem, FixedArrivalIsConvexAndHasOneOptimum) {
  Draw draw(5);
  const solvers::BackendRegistry backends = solvers::StandardBackends();
  for (int trial = 0; trial < 10; ++trial) {
    LandingProblem problem(20, Options(ArrivalMode::kFixed));
    EXPECT_TRUE(problem.view().problem().convex());
    const ArcPad pad = draw.Pad();
    const SplineState start = draw.State(4.0, 1.0, 1.0);
    const EndpointTarget target{0.0, 1.5, 0.0, 0.5};
    problem.SetBoundary(start, 0.0, pad, target);
    problem.SetDuration(1.2 * GuessDuration(start, 0.0, pad, target, {}, 1.0));
    const UniformBspline guess = problem.Curve(problem.Guess());
    std::vector<ObstaclePair> pairs;
    for (int i = 6; i < 16; i += 3) {
      pairs.push_back(
          {i, guess.control_points().col(i) + draw.Vector(0.3), draw.Vector(1.0).normalized()});
    }
    problem.SetPairs(pairs);

    auto backend = solvers::MakeBackend(backends, "ceres");
    backend->options().Set("function_tolerance", 1e-14);
    backend->Prepare(problem.view());
    solvers::SolverResult a, b;
    backend->Solve(problem.view(), problem.Guess(), {}, &a);
    Eigen::VectorXd far = problem.Guess();
    for (int i = 0; i < far.size(); ++i) far[i] = draw.Uniform(-1.0, 1.0);
    backend->Solve(problem.view(), far, {.max_iterations = 300}, &b);
    ASSERT_TRUE(a.usable() && b.usable()) << a.message << b.message;
    EXPECT_NEAR(a.cost, b.cost, 1e-6 * a.cost);
    EXPECT_LT((a.x - b.x).cwiseAbs().maxCoeff(), 1e-2);
  }
}

TEST(LandingProblem, FreeArrivalBeatsTheGuessAndStaysInItsBounds) {
  Draw draw(7);
  const solvers::BackendRegistry backends = solvers::StandardBackends();
  for (int trial = 0; trial < 10; ++trial) {
    const LandingProblemOptions options = Options(ArrivalMode::kFree);
    LandingProblem problem(20, options);
    const ArcPad pad = draw.Pad();
    const SplineState start = draw.State(4.0, 1.0, 1.0);
    const EndpointTarget target{0.0, 1.5, 0.0, 0.5};
    problem.SetBoundary(start, 0.0, pad, target);
    problem.SetDuration(GuessDuration(start, 0.0, pad, target, options.limits, 1.0));
    auto backend = solvers::MakeBackend(backends, "ceres");
    backend->Prepare(problem.view());
    solvers::SolverResult result;
    backend->Solve(problem.view(), problem.Guess(), {}, &result);
    ASSERT_TRUE(result.usable()) << result.message;
    // The best curve that arrives when the guess does, evaluated in the free problem.
    LandingProblem fixed(20, Options(ArrivalMode::kFixed));
    fixed.SetBoundary(start, 0.0, pad, target);
    fixed.SetDuration(GuessDuration(start, 0.0, pad, target, options.limits, 1.0));
    auto newton = solvers::MakeBackend(backends, "banded");
    newton->Prepare(fixed.view());
    solvers::SolverResult at_guessed_time;
    newton->Solve(fixed.view(), fixed.Guess(), {}, &at_guessed_time);
    ASSERT_TRUE(at_guessed_time.usable());
    Eigen::VectorXd there = problem.Guess();
    there.head(at_guessed_time.x.size()) = at_guessed_time.x;
    solvers::ViewEvaluation evaluation;
    problem.view().Resize(&evaluation);
    ASSERT_TRUE(problem.view().Evaluate(there.data(), {}, {}, &evaluation));
    EXPECT_LT(result.cost, evaluation.full.value - 1e-9);
    const double T = problem.Curve(result.x).duration();
    EXPECT_GE(T, options.min_duration - 1e-9);
    EXPECT_LE(T, options.max_duration + 1e-9);
  }
}

/// A landing on a random pad with a start inside the limits, set up in `problem`.
struct Landing {
  ArcPad pad;
  SplineState start;
  EndpointTarget target{0.0, 1.5, 0.0, 0.5};

  explicit Landing(Draw* draw) : pad(draw->Pad()), start(draw->State(4.0, 1.0, 1.0)) {}
  void Apply(double stretch, LandingProblem* problem) const {
    problem->SetBoundary(start, 0.0, pad, target);
    problem->SetDuration(stretch * GuessDuration(start, 0.0, pad, target, {}, 1.0));
  }
};

solvers::SolverResult SolveTightly(const std::string& name, const LandingProblem& problem) {
  auto backend = solvers::MakeBackend(solvers::StandardBackends(), name);
  for (const solvers::OptionSpec& spec : std::vector(backend->options().specs())) {
    if (spec.name.find("tolerance") == std::string::npos) continue;
    backend->options().Set(spec.name, std::max(spec.lo, 1e-10));
  }
  backend->Prepare(problem.view());
  solvers::SolverResult result;
  backend->Solve(problem.view(), problem.Guess(), {.max_iterations = 2000}, &result);
  EXPECT_TRUE(result.usable()) << name << ": " << result.message;
  return result;
}

bool Compiled(const std::string& name) {
  return solvers::MakeBackend(solvers::StandardBackends(), name)->capabilities().compiled;
}

TEST(LandingProblem, ExplicitAndEliminatedEndpointsHaveOneOptimum) {
  for (const char* name : {"ipopt", "nlopt-slsqp"}) {
    if (!Compiled(name)) continue;
    for (const ArrivalMode arrival : {ArrivalMode::kFixed, ArrivalMode::kFree}) {
      SCOPED_TRACE(std::string(name) + (arrival == ArrivalMode::kFree ? " free" : " fixed"));
      Draw draw(19);
      for (const bool free_end : {true, false}) {
        const Landing landing(&draw);
        LandingProblemOptions options = Options(arrival, free_end);
        LandingProblem eliminated(12, options);
        options.endpoint = EndpointMode::kExplicit;
        LandingProblem rows(12, options);
        landing.Apply(1.2, &eliminated);
        landing.Apply(1.2, &rows);
        const solvers::SolverResult a = SolveTightly(name, eliminated);
        const solvers::SolverResult b = SolveTightly(name, rows);
        EXPECT_LE(b.max_violation, 1e-6);
        EXPECT_NEAR(a.cost, b.cost, 1e-5 * (1.0 + a.cost));
        const UniformBspline curve = rows.Curve(b.x);
        const SplineState wanted = EndStateAt(landing.pad, landing.target, curve.t_end()).state;
        EXPECT_LT((curve.AtKnot(0).p - landing.start.p).norm(), 2e-6);
        EXPECT_LT((curve.AtKnot(12).p - wanted.p).norm(), 2e-6);
        EXPECT_LT((curve.AtKnot(12).v - wanted.v).norm(), 2e-6);
      }
    }
  }
}

TEST(LandingProblem, TheExplicitGuessMeetsBothEnds) {
  Draw draw(23);
  LandingProblemOptions options = Options(ArrivalMode::kFree);
  options.endpoint = EndpointMode::kExplicit;
  LandingProblem problem(15, options);
  const Landing landing(&draw);
  landing.Apply(1.3, &problem);
  solvers::ViewEvaluation e;
  problem.view().Resize(&e);
  ASSERT_TRUE(problem.view().Evaluate(problem.Guess().data(), {}, {}, &e));
  EXPECT_LT(e.full.max_violation, 1e-9);
}

TEST(LandingProblem, HardLimitsHoldOnTheWholeCurve) {
  Draw draw(29);
  LandingProblemOptions options = Options(ArrivalMode::kFixed);
  options.limits_mode = LimitsMode::kHard;
  options.settings = {{"tilt_limit", 1.0, {}, {}}, {"thrust_max", 1.0, {}, {}}};
  for (int trial = 0; trial < 8; ++trial) {
    const Landing landing(&draw);
    LandingProblem problem(20, options);
    landing.Apply(1.4, &problem);
    const solvers::SolverResult result = SolveTightly("banded", problem);
    ASSERT_EQ(result.status, solvers::SolveStatus::kConverged);
    const UniformBspline curve = problem.Curve(result.x);
    const DerivativeBounds bounds = BoundDerivatives(curve);
    EXPECT_LE(bounds.speed, options.limits.speed + 2e-6);
    EXPECT_LE(bounds.acceleration, options.limits.acceleration + 2e-6);
    for (double t = 0.0; t <= curve.duration(); t += 0.01) {
      const FlatInputs inputs = InvertFlatness(curve.Evaluate(t));
      EXPECT_LE(inputs.specific_thrust, options.vehicle.thrust_max + 2e-6);
      EXPECT_LE(std::acos(inputs.R_WB(2, 2)), options.vehicle.tilt_max + 2e-6);
    }
  }
}

TEST(LandingProblem, AStartBeyondTheLimitsLeavesHardRowsAnInterior) {
  Draw draw(31);
  LandingProblemOptions options = Options(ArrivalMode::kFixed);
  options.limits_mode = LimitsMode::kHard;
  for (int trial = 0; trial < 8; ++trial) {
    Landing landing(&draw);
    landing.start.v = draw.Uniform(3.2, 5.0) * Eigen::Vector3d(draw.Vector(1.0)).normalized();
    LandingProblem problem(20, options);
    landing.Apply(1.5, &problem);
    const BoundaryFacts facts = problem.boundary_facts();
    EXPECT_TRUE(facts.recovering);
    EXPECT_FALSE(facts.end_too_fast);
    EXPECT_NEAR(facts.start_speed, landing.start.v.norm(), 1e-12);
    const solvers::SolverResult result = SolveTightly("banded", problem);
    EXPECT_EQ(result.status, solvers::SolveStatus::kConverged) << result.message;
    EXPECT_LE(result.max_violation, 1e-6);
    EXPECT_LE(BoundDerivatives(problem.Curve(result.x)).speed,
              std::max(facts.start_speed, facts.first_hull_speed) + 2e-6);
  }
}

TEST(LandingProblem, APadNearTheSpeedLimitIsAFact) {
  LandingProblem problem(12, {});
  const ArcPad pad({5.0, 0.0, 0.5}, 2.8, 0.0, 0.0);
  problem.SetBoundary({}, 0.0, pad, {0.0, 1.5, 0.0, 1.5});
  problem.SetDuration(5.0);
  EXPECT_TRUE(problem.boundary_facts().end_too_fast);
  EXPECT_NEAR(problem.boundary_facts().end_speed, 2.8, 1e-12);
}

TEST(LandingProblem, TermsAreChosenBySettings) {
  const auto terms = [](LandingProblemOptions options) {
    const LandingProblem problem(12, options);
    std::string names;
    for (int i = 0; i < problem.view().problem().num_terms(); ++i) {
      const bool rows = problem.view().problem().role(i) == solvers::Role::kConstraint;
      names += problem.view().problem().term(i).info().name + (rows ? "! " : " ");
    }
    return names;
  };
  LandingProblemOptions options;
  EXPECT_EQ(terms(options), "smoothness obstacle_pair speed_limit acceleration_limit ");
  options.limits_mode = LimitsMode::kHard;
  options.arrival = ArrivalMode::kFree;
  options.endpoint = EndpointMode::kExplicit;
  options.settings = {{"acceleration_limit", {}, false, {}},
                      {"obstacle_pair", 0.0, {}, {}},
                      {"thrust_max", {}, true, {}},
                      {"consistency", 2.0, {}, {}}};
  EXPECT_EQ(terms(options),
            "smoothness speed_limit! acceleration_limit arrival_time thrust_max! consistency "
            "endpoint_state! ");
  options.settings = {{"no_such_term", 1.0, {}, {}}};
  try {
    LandingProblem(12, options);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no_such_term is unknown; known: smoothness"));
  }
}

TEST(LandingProblem, NothingIsAllocatedAfterConstruction) {
  if (solvers::AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  Draw draw(37);
  LandingProblemOptions options = Options(ArrivalMode::kFree);
  options.limits_mode = LimitsMode::kHard;
  options.max_obstacles = 8;
  for (const TermEntry& entry : options.terms) options.settings.push_back({entry.info.name, 1.0});
  LandingProblem problem(20, options);
  const Landing landing(&draw);
  landing.Apply(1.3, &problem);
  const UniformBspline previous = problem.Curve(problem.Guess());
  const std::vector<MovingObstacle> obstacles(3);
  const std::vector<ObstaclePair> pairs(10);
  auto backend = solvers::MakeBackend(solvers::StandardBackends(), "banded");
  backend->Prepare(problem.view());
  const solvers::WarmStart guess(problem.Guess());
  const solvers::Stop stop;
  solvers::SolverResult result;
  long before = 0;
  for (int round = 0; round < 2; ++round) {  // the first sizes the result
    before = solvers::AllocationCount();
    landing.Apply(1.4, &problem);
    problem.SetPrevious(&previous);
    problem.SetObstacles(obstacles);
    problem.SetPairs(pairs);
    problem.SetPairWeightScale(1.6);
    backend->Solve(problem.view(), guess, stop, &result);
  }
  EXPECT_EQ(solvers::AllocationCount(), before);
}

TEST(LandingProblem, RefusesTooFewSegments) {
  EXPECT_THROW(LandingProblem(5, {}), std::invalid_argument);
}

TEST(LandingProblem, ATermThatIsOffByDefaultHasAMetricAsRows) {
  LandingProblemOptions options;
  options.settings = {{"tilt_limit", {}, true, {}}};
  const LandingProblem landing(12, options);
  const solvers::Problem& problem = landing.view().problem();
  int found = 0;
  for (int i = 0; i < problem.num_terms(); ++i) {
    if (problem.term(i).info().name != "tilt_limit") continue;
    ++found;
    EXPECT_EQ(problem.role(i), solvers::Role::kConstraint);
    EXPECT_GT(problem.term(i).nominal_row_weight(), 0.0);
  }
  EXPECT_EQ(found, 1);
}

template <class Call>
std::string Refused(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(LandingProblem, BeforeItsBoundaryItSaysSo) {
  for (const EndpointMode endpoint : {EndpointMode::kEliminated, EndpointMode::kExplicit}) {
    LandingProblemOptions options = Options(ArrivalMode::kFree);
    options.endpoint = endpoint;
    options.max_obstacles = 2;
    for (const TermEntry& entry : options.terms) options.settings.push_back({entry.info.name, 1.0});
    LandingProblem problem(12, options);
    problem.SetDuration(3.0);
    problem.SetPairs(std::vector<ObstaclePair>(3));
    Eigen::VectorXd y = Eigen::VectorXd::Ones(problem.view().num_variables());
    UniformBspline curve;
    EXPECT_THAT(Refused([&] { problem.Guess(); }),
                testing::HasSubstr("Guess() before SetBoundary"));
    EXPECT_NE(Refused([&] { problem.Guess(&y); }), "");
    EXPECT_NE(Refused([&] { problem.WarmGuess(curve, &y); }), "");
    EXPECT_THAT(Refused([&] { problem.boundary_facts(); }), testing::HasSubstr("boundary_facts()"));
    EXPECT_THAT(Refused([&] { problem.Curve(y); }), testing::HasSubstr("Curve()"));
    EXPECT_NE(Refused([&] { problem.Curve(y, &curve); }), "");
    // A solve then reports that the problem has no value.
    auto backend = solvers::MakeBackend(solvers::StandardBackends(), "ipopt");
    backend->Prepare(problem.view());
    solvers::SolverResult result;
    backend->Solve(problem.view(), y, {}, &result);
    EXPECT_EQ(result.status, solvers::SolveStatus::kEvaluationFailed);
  }
}

TEST(LandingProblem, RefusesDurationsAndStartsThatAreNone) {
  LandingProblem problem(12, Options(ArrivalMode::kFree));
  for (const double T : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(Refused([&] { problem.SetDuration(T); }), testing::HasSubstr("duration is"));
  }
  const ArcPad pad({3.0, 0.0, 0.3}, 0.8, 0.0, 0.0);
  SplineState start;
  start.v.y() = std::nan("");
  const auto bounded = [&](double t0, const EndpointTarget& target, const Eigen::Vector3d& pull) {
    return Refused([&] { problem.SetBoundary({}, t0, pad, target, pull); });
  };
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  EXPECT_THAT(Refused([&] { problem.SetBoundary(start, 0.0, pad, {}); }),
              testing::HasSubstr("velocity of the start is nan"));
  EXPECT_THAT(bounded(std::nan(""), {}, none), testing::HasSubstr("time of the start is nan"));
  EXPECT_THAT(bounded(0.0, {.height = std::nan("")}, none),
              testing::HasSubstr("height of the end"));
  EXPECT_THAT(bounded(0.0, {}, {0.0, std::nan(""), 0.0}), testing::HasSubstr("pull is nan"));
  EXPECT_EQ(Refused([&] { problem.SetBoundary({}, 0.0, pad, {}); }), "");
}

TEST(LandingProblem, RefusesATermThatNothingFeeds) {
  LandingProblemOptions options = Options(ArrivalMode::kFixed);
  options.settings = {{"moving_obstacle", 5.0, {}, {}}};
  EXPECT_THAT(Refused([&] { LandingProblem(12, options); }), testing::HasSubstr("moving_obstacle"));
  options.max_obstacles = 1;
  EXPECT_EQ(Refused([&] { LandingProblem(12, options); }), "");
}

// A wind from the side leans the vehicle, and its camera with it: the pad that it leans over is seen farther out.
TEST(LandingProblem, TheCameraLeansAgainstThePull) {
  const TermRegistry terms = StandardTerms();
  const TermEntry& entry = FindTerm(terms, "pad_visibility");
  const ArcPad pad({1.2, 0.0, 0.0}, 0.0, 0.0, 0.0);
  const auto out_of_view = [&](const Eigen::Vector3d& pull_W) {
    const int segments = 8;
    TermSetup setup = DefaultSetup(entry, segments + 3);
    const std::shared_ptr<solvers::Term> term = entry.make(setup);
    LandingContext context;
    context.segments = segments;
    context.interval = 0.1;
    context.pad = &pad;
    context.pull_W = pull_W;
    dynamic_cast<ContextUser&>(*term).Update(context);
    solvers::Problem problem({.blocks = segments + 3});
    problem.set_interval(0.1);
    problem.AddTerm(term, solvers::Role::kCost);
    solvers::Evaluation at;
    problem.Resize(&at);
    const ControlPoints hover = Eigen::Vector3d(0.0, 0.0, 1.5).replicate(1, segments + 3);
    EXPECT_TRUE(problem.Evaluate(hover.data(), 0.1, {}, {}, &at));
    return at.terms[0].u[0];
  };
  const auto expected = [](const Eigen::Vector3d& pull_W) {
    const Eigen::Vector3d d(1.2, 0.0, -1.5), f = Eigen::Vector3d(0.0, 0.0, 9.81) - pull_W;
    return d.norm() * std::cos(0.25 * 3.14159265358979) + d.dot(f) / f.norm();
  };
  for (const double side : {0.0, 2.0, -2.0}) {
    EXPECT_NEAR(out_of_view({side, 0.0, 0.0}), expected({side, 0.0, 0.0}), 5e-3) << side;
  }
  EXPECT_GT(std::abs(expected({2.0, 0.0, 0.0}) - expected({-2.0, 0.0, 0.0})), 0.2);
}

template <class Pad>
concept CanBound = requires(LandingProblem problem, Pad&& pad) {
  problem.SetBoundary({}, 0.0, std::forward<Pad>(pad), {});
};
static_assert(CanBound<const ArcPad&>);
static_assert(!CanBound<ArcPad>, "the prediction of a temporary");

// Options that the replanner decides cannot be set.
template <class Options>
concept HasArrival = requires(Options options) {
  options.arrival;
};
template <class Options>
concept HasLimits = requires(Options options) {
  options.limits;
};
static_assert(HasArrival<LandingProblemOptions> && HasLimits<LandingProblemOptions>);
static_assert(!HasArrival<decltype(ReplannerOptions::problem)>);
static_assert(!HasLimits<decltype(ReplannerOptions::problem)>);

TEST(LandingProblem, RefusesATermThatIsRegisteredTwice) {
  LandingProblemOptions options;
  options.terms.push_back(FindTerm(options.terms, "smoothness"));
  EXPECT_THROW(LandingProblem(12, options), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::planning
