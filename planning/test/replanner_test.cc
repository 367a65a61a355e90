// SPDX-License-Identifier: BSD-3-Clause
// The replanning step over random pads, horizons, fields and both arrival modes. What is accepted
// is certified, and every kind of failure has its name.

#include "touchdown/planning/replan/replanner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "planning/replan/replan_checks.h"
#include "planning/test/replanner_fixtures.h"
#include "touchdown/planning/replan/span_log.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::planning {
namespace {

class BothArrivals : public ::testing::TestWithParam<ArrivalMode> {};
INSTANTIATE_TEST_SUITE_P(Arrival, BothArrivals,
                         ::testing::Values(ArrivalMode::kFixed, ArrivalMode::kFree),
                         [](const auto& test) {
                           return test.param == ArrivalMode::kFree ? "Free" : "Fixed";
                         });

TEST_P(BothArrivals, EveryAcceptedPlanEndsOnThePadAndIsCertified) {
  Draw draw(31);
  int planned = 0, first_arrival = 0;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    OccupancyMap map = ObservedMap();
    const Eigen::Vector3d start{draw.Uniform(-6, -4), draw.Uniform(-3, 3), draw.Uniform(1.2, 2.5)};
    for (int i = 0; i < 4; ++i) AddPillar({draw.Uniform(-2.5, 1.5), draw.Uniform(-4, 4)}, &map);
    const ArcPad pad{{draw.Uniform(3, 7), draw.Uniform(-4, 4), 0.3},
                     draw.Uniform(0, 1.2),
                     draw.Uniform(-3, 3),
                     draw.Uniform(-0.3, 0.3)};
    Replanner replanner(Options(GetParam()), solvers::StandardBackends());
    ReplanLog log;
    replanner.set_log(&log);
    const double t = draw.Uniform(0.0, 50.0);
    replanner.CommitHover(start, t);
    ReplanInput input = Input(start, pad, t);
    input.endpoint.sink_rate = trial % 3 == 0 ? 0.1 : 0.0;
    input.endpoint.height_floor = 0.5;
    const ReplanResult& result = replanner.Replan(input, map);
    // A step ends with its first success: nothing is tried after it.
    for (const AttemptLog& attempt : log.attempts) {
      if (attempt.reason == ReplanReason::kNone) {
        EXPECT_EQ(&attempt, &log.attempts.back());
      }
    }
    if (result.status != ReplanStatus::kPlanned) continue;
    ++planned;
    first_arrival += log.attempts.size() == 1 && log.attempts.front().arrival == GetParam();
    EXPECT_TRUE(result.certificate.passed());

    // Independent of the certificate: ends, limits and clearance by sampling.
    const double t_end = result.curve.t_end();
    const SplineState wanted = EndStateAt(pad, input.endpoint, t_end).state;
    const FlatState last = result.curve.Evaluate(t_end);
    EXPECT_LE((last.p_WB - wanted.p).norm(), 1e-9);
    EXPECT_LE((last.v_WB - wanted.v).norm(), 1e-9);
    EXPECT_LE((result.curve.Evaluate(input.t_start).p_WB - start).norm(), 1e-9);
    for (double s = input.t_start; s <= t_end; s += 0.01) {
      const FlatState at = result.curve.Evaluate(s);
      EXPECT_LE(at.v_WB.norm(), 3.0 + 1e-6);
      EXPECT_LE(at.a_WB.norm(), 6.0 + 1e-6);
      EXPECT_FALSE(map.IsBlocked(at.p_WB));
    }
  }
  EXPECT_GE(planned, kTrials * 9 / 10);
  EXPECT_GE(first_arrival, kTrials / 2);
}

TEST_P(BothArrivals, FollowsAMovingPadWithPerfectTracking) {
  // One replan every 0.1 s until well after arrival; the reference is flown exactly.
  const ArcPad pad({5.0, 2.0, 0.3}, 1.0, 0.4, 0.1);
  OccupancyMap map = ObservedMap();
  AddPillar({0.5, 1.0}, &map);
  Replanner replanner(Options(GetParam()), solvers::StandardBackends());
  Eigen::Vector3d p(-4.0, 0.0, 1.6);
  replanner.CommitHover(p, 0.0);
  double worst_jump = 0.0;
  for (int step = 0; step < 100; ++step) {
    const double t = 0.1 * step;
    ReplanInput input = Input(p, pad, t);
    input.vehicle.v_WB = replanner.Reference(t).v_WB;
    const FlatState before = replanner.Reference(input.t_start);
    map.Recentre(p);
    map.MarkFree(p, 6.0);
    const ReplanResult& result = replanner.Replan(input, map);
    ASSERT_EQ(result.status, ReplanStatus::kPlanned) << ToString(result.reason) << " at " << t;
    const FlatState after = replanner.Reference(input.t_start);
    worst_jump = std::max(
        {worst_jump, (after.p_WB - before.p_WB).norm(), (after.v_WB - before.v_WB).norm()});
    p = replanner.Reference(t + 0.1).p_WB;
  }
  EXPECT_LT(worst_jump, 1e-9);  // the committed trajectory is continuous
  const Eigen::Vector3d wanted = pad.At(10.0).p_WP + Eigen::Vector3d(0, 0, 1.3);
  EXPECT_LT((p - wanted).norm(), 0.02);
}

TEST(Replanner, TheSameQuestionTwiceGivesTheSameBits) {
  const auto run = []() -> ControlPoints {
    OccupancyMap map = ObservedMap();
    AddPillar({0.0, 0.2}, &map);
    const ArcPad pad({5.0, 0.0, 0.3}, 0.8, 0.3, 0.1);
    Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
    replanner.CommitHover({-4.0, 0.0, 1.5}, 0.0);
    return replanner.Replan(Input({-4.0, 0.0, 1.5}, pad, 0.0), map).curve.control_points();
  };
  EXPECT_EQ(run(), run());
}

// Every step again in another replanner, from the state before it, with a log and without.
TEST(Replanner, AStepIsRepeatedFromItsState) {
  const ArcPad pad({5.0, 2.0, 0.3}, 1.0, 0.4, 0.1);
  OccupancyMap map = ObservedMap();
  AddPillar({0.5, 1.0}, &map);
  Replanner flown(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  Replanner other(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  ReplanLog log;
  Eigen::Vector3d p(-4.0, 0.0, 1.6);
  flown.CommitHover(p, 0.0);
  std::vector<std::string> statuses;
  for (int step = 0; step < 50; ++step) {
    ReplanInput input = Input(p, pad, 0.1 * step);
    input.vehicle.v_WB = flown.Reference(input.t_now).v_WB;
    if (step == 12) AddPillar({p.x() + 1.5, p.y()}, &map);
    const bool rests = step > 20 && step < 25;
    if (step > 30 && step < 34) input.pad = nullptr;
    const ReplannerState before = flown.state();
    const ReplanResult& wanted = rests ? flown.Rest(input, 1.0, map) : flown.Replan(input, map);
    statuses.push_back(ToString(wanted.status));
    for (ReplanLog* written : {static_cast<ReplanLog*>(nullptr), &log}) {
      other.set_log(written);
      other.Restore(before);
      const ReplanResult& got = rests ? other.Rest(input, 1.0, map) : other.Replan(input, map);
      ASSERT_EQ(got.status, wanted.status) << step;
      ASSERT_EQ(got.reason, wanted.reason) << step;
      ASSERT_EQ(got.curve.control_points(), wanted.curve.control_points()) << step;
      ASSERT_EQ(got.curve.t_end(), wanted.curve.t_end()) << step;
    }
    EXPECT_EQ(log.attempts.empty(), rests || input.pad == nullptr);
    if (wanted.status == ReplanStatus::kPlanned) {
      const AttemptLog& last = log.attempts.back();
      EXPECT_EQ(last.reason, ReplanReason::kNone);
      const RoundLog& best = last.rounds.at(last.best);
      EXPECT_EQ(best.curve.control_points(), wanted.curve.control_points());
      EXPECT_TRUE(best.blocked.empty());
      EXPECT_EQ(static_cast<int>(best.pairs.size()), wanted.pairs);
      EXPECT_EQ(best.solver.trace.size(), static_cast<std::size_t>(wanted.solver.iterations));
    }
    p = flown.Reference(input.t_now + 0.1).p_WB;
  }
  EXPECT_THAT(statuses, ::testing::Contains("climbing"));
  EXPECT_THAT(statuses, ::testing::Contains("kept"));
}

TEST(Replanner, SpansAreLoggedWhereSomebodyListens) {
  OccupancyMap map = ObservedMap();
  AddPillar({0.0, 0.2}, &map);
  const ArcPad pad({5.0, 0.0, 0.3}, 0.8, 0.3, 0.1);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover({-4.0, 0.0, 1.5}, 0.0);
  const ReplanInput input = Input({-4.0, 0.0, 1.5}, pad, 0.0);
  const ReplannerState before = replanner.state();
  const StageTimes unlogged = replanner.Replan(input, map).times;
  EXPECT_GT(unlogged.total.cpu, 0.0);
  EXPECT_GT(unlogged.solve.wall, 0.0);
  EXPECT_TRUE(std::isnan(unlogged.solve.cpu));
  replanner.Restore(before);
  SpanLog log, full;
  log.Reserve(1000);
  full.Reserve(1);
  {
    const SpanLog::Listening listening(&log);
    replanner.Replan(input, map);
  }
  replanner.Restore(before);
  {
    const SpanLog::Listening listening(&full);
    const StageTimes& times = replanner.Replan(input, map).times;
    EXPECT_LE(times.solve.cpu + times.check.cpu + times.search.cpu, times.total.cpu);
  }
  EXPECT_EQ(full.spans().size(), 1u);
  EXPECT_EQ(full.dropped() + 1, log.spans().size());
  ASSERT_FALSE(log.spans().empty());
  const LoggedSpan& total = log.spans().front();
  EXPECT_STREQ(total.stage, "total");
  double end = total.begin;
  for (std::size_t i = 1; i < log.spans().size(); ++i) {
    const LoggedSpan& span = log.spans()[i];
    EXPECT_EQ(span.depth, 1);
    EXPECT_GE(span.begin, end);
    end = span.begin + span.wall;
  }
  EXPECT_LE(end, total.begin + total.wall);
}

TEST(Replanner, SegmentsAreAsShortAsTheOptionSays) {
  const ArcPad pad({6.0, 0.0, 0.3}, 0.3, 0.0, 0.0);
  const OccupancyMap map = ObservedMap();
  int before = 0;
  for (const double length : {0.75, 0.5, 0.3}) {
    ReplannerOptions options = Options(ArrivalMode::kFixed);
    options.segment_length = length;
    Replanner replanner(options, solvers::StandardBackends());
    replanner.CommitHover({-4.0, 0.0, 1.5}, 0.0);
    const ReplanResult& plan = replanner.Replan(Input({-4.0, 0.0, 1.5}, pad, 0.0), map);
    ASSERT_EQ(plan.status, ReplanStatus::kPlanned) << Explain(plan.reason);
    EXPECT_GT(plan.curve.segments(), before) << length;
    EXPECT_LE(plan.curve.interval() * options.limits.speed, length + 1e-9);
    before = plan.curve.segments();
  }
  ReplannerOptions none;
  none.segment_length = 0.0;
  EXPECT_THROW(Replanner(none, solvers::StandardBackends()), std::invalid_argument);
}

/// Near and slow when it is asked first: it runs away, or turns on the spot too fast to be followed.
class FaultyPad : public ArcPad {
 public:
  FaultyPad(double acceleration, double turn)
      : ArcPad({5.0, 0.0, 0.3}, 0.5, 0.0, turn), acceleration_(acceleration) {}
  estimation::PadState At(double t) const noexcept override {
    estimation::PadState state = ArcPad::At(t);
    state.p_WP.x() += 0.5 * acceleration_ * t * t;
    state.v_WP.x() += acceleration_ * t;
    state.a_WP.x() += acceleration_;
    return state;
  }

 private:
  double acceleration_;
};

TEST(Replanner, NamesWhyThereIsNoPlan) {
  const ArcPad pad({5.0, 0.0, 0.3}, 0.5, 0.0, 0.0);
  const ArcPad racing({5.0, 0.0, 0.3}, 6.0, 0.0, 0.0);
  const Eigen::Vector3d start(-4.0, 0.0, 1.5);
  const auto ask = [&](OccupancyMap map, const ReplanInput& input) {
    Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
    replanner.CommitHover(start, 0.0);
    const ReplanResult result = replanner.Replan(input, map);
    EXPECT_STRNE(Explain(result.reason), "");
    return result;
  };
  const OccupancyMap free = ObservedMap();

  const double nan = std::numeric_limits<double>::quiet_NaN();
  const ArcPad nowhere({nan, 0.0, 0.3}, 0.0, 0.0, 0.0), away({5e6, 0.0, 0.3}, 0.0, 0.0, 0.0);
  const FaultyPad fleeing(-900.0, 0.0), vanishing(-9e18, 0.0), spinning(0.0, 9e18);
  const struct {
    const char* what;
    void (*spoil)(ReplanInput* input, double nan);
    const ArcPad* pad;
  } mistakes[] = {
      {"t_now", [](ReplanInput* input, double none) { input->t_now = none; }, &pad},
      {"t_start is not finite", [](ReplanInput* input, double none) { input->t_start = none; },
       &pad},
      {"before t_now", [](ReplanInput* input, double) { input->t_start = -1.0; }, &pad},
      {"p_WB is not", [](ReplanInput* input, double none) { input->vehicle.p_WB.x() = none; },
       &pad},
      {"p_WB is a million metres away or farther: subtract an origin",
       [](ReplanInput* input, double) { input->vehicle.p_WB.x() = 1e7; }, &pad},
      {"v_WB is not", [](ReplanInput* input, double none) { input->vehicle.v_WB.x() = none; },
       &pad},
      {"v_WB is 1000", [](ReplanInput* input, double) { input->vehicle.v_WB.x() = 2e3; }, &pad},
      {"pull_W", [](ReplanInput* input, double none) { input->pull_W.x() = none; }, &pad},
      {"margin", [](ReplanInput* input, double) { input->margins.tracking = -1.0; }, &pad},
      {"margin", [](ReplanInput* input, double) { input->margins.attitude = 1e171; }, &pad},
      {"pull_W is 1000", [](ReplanInput* input, double) { input->pull_W.z() = -1e171; }, &pad},
      {"1000 s after", [](ReplanInput* input, double) { input->t_start = 1e171; }, &pad},
      {"endpoint is too far", [](ReplanInput* input, double) { input->endpoint.height = 1e171; },
       &pad},
      {"endpoint is too far", [](ReplanInput* input, double) { input->endpoint.sink_rate = -1e9; },
       &pad},
      {"no pad", [](ReplanInput* input, double) { input->pad = nullptr; }, &pad},
      {"goal is not finite", [](ReplanInput*, double) {}, &nowhere},
      {"goal is a million metres away or farther: subtract an origin", [](ReplanInput*, double) {},
       &away},
      {"goal moves with 1000 m/s", [](ReplanInput*, double) {}, &fleeing},
      {"goal is a million metres away", [](ReplanInput*, double) {}, &vanishing},
      {"goal accelerates with 1000 m/s^2", [](ReplanInput*, double) {}, &spinning},
      {"endpoint", [](ReplanInput* input, double none) { input->endpoint.height = none; }, &pad},
      {"arrival_sink", [](ReplanInput* input, double) { input->endpoint.arrival_sink = -1.0; },
       &pad},
      {"passing_W", [](ReplanInput* input, double none) { input->endpoint.passing_W.x() = none; },
       &pad},
  };
  for (const auto& mistake : mistakes) {
    ReplanInput input = Input(start, *mistake.pad, 0.0);
    mistake.spoil(&input, nan);
    const ReplanResult result = ask(free, input);
    EXPECT_EQ(result.reason, ReplanReason::kInvalidInput) << mistake.what;
    EXPECT_NE(std::string(result.detail).find(mistake.what), std::string::npos)
        << mistake.what << ": " << result.detail;
  }
  EXPECT_EQ(ask(free, Input(start, pad, 0.0)).detail, "");

  EXPECT_EQ(ask(free, Input(start, racing, 0.0)).reason, ReplanReason::kPadUnreachable);

  // Too far for one plan: it ends on the way, and not in contact.
  const ArcPad distant({150.0, 0.0, 0.3}, 0.0, 0.0, 0.0);
  ReplanInput to_contact = Input(start, distant, 0.0);
  to_contact.endpoint.arrival_sink = 0.3;
  const ReplanResult on_the_way = ask(free, to_contact);
  EXPECT_EQ(on_the_way.status, ReplanStatus::kPlanned);
  EXPECT_FALSE(on_the_way.ends_in_contact);
  const FlatState end = on_the_way.curve.EvaluateOnward(on_the_way.curve.t_end());
  EXPECT_LT(end.v_WB.norm(), 1e-6);
  EXPECT_GT(end.p_WB.x(), start.x() + 20.0);
  EXPECT_LT(end.p_WB.x(), 100.0);

  // A pad that drives ahead: it is met where the vehicle has caught up with it, be it near or far now.
  for (const double ahead : {20.0, 60.0, 100.0}) {
    const ArcPad drives_off({ahead, 0.0, 0.3}, 2.0, 0.0, 0.0);
    const ReplanResult chase = ask(free, Input(start, drives_off, 0.0));
    EXPECT_EQ(chase.status, ReplanStatus::kPlanned) << ahead;
    const FlatState at = chase.curve.EvaluateOnward(chase.curve.t_end());
    EXPECT_GT(at.p_WB.x(), start.x() + 20.0) << ahead;
  }

  // A pad that stands inside a pillar.
  OccupancyMap on_pad = ObservedMap();
  AddPillar({5.0, 0.0}, &on_pad);
  const ArcPad standing({5.0, 0.0, 0.3}, 0.0, 0.0, 0.0);
  const ReplanResult goal = ask(on_pad, Input(start, standing, 0.0));
  EXPECT_EQ(goal.reason, ReplanReason::kGoalBlocked);
  EXPECT_EQ(goal.status, ReplanStatus::kHolding);  // it hovers, and that is safe

  // A closed room around the start.
  OccupancyMap room = ObservedMap();
  for (double a = -1.5; a <= 1.55; a += 0.1) {
    for (double b = -1.5; b <= 1.55; b += 0.1) {
      for (const double wall : {-1.5, 1.5}) {
        room.SetOccupied(start + Eigen::Vector3d(wall, a, b));
        room.SetOccupied(start + Eigen::Vector3d(a, wall, b));
        room.SetOccupied(start + Eigen::Vector3d(a, b, wall));
      }
    }
  }
  EXPECT_EQ(ask(room, Input(start, pad, 0.0)).reason, ReplanReason::kSearchFailed);
}

/// Gives back its first guess, the first three control points moved aside: a solve that was cut.
class CutBackend : public solvers::SolverBackend {
 public:
  explicit CutBackend(double aside) : SolverBackend("cut", {}), aside_(aside) {}
  solvers::Capabilities capabilities() const override {
    return {.hard_rows = true, .equality_rows = true};
  }

 private:
  void DoPrepare(const solvers::View& /*view*/) override {}
  void DoSolve(const solvers::View& /*view*/, const solvers::WarmStart& warm,
               const solvers::Stop& /*stop*/, solvers::Evaluator* evaluator,
               solvers::SolverResult* result) override {
    Eigen::VectorXd y = warm.y;
    for (const int row : {0, 3, 6}) y[row] += aside_;
    evaluator->Evaluate(y.data(), {});
    result->status = solvers::SolveStatus::kIterationLimit;
  }
  double aside_;
};

solvers::BackendRegistry OnlyCut(double aside) {
  return {{"cut", "", [aside] { return std::make_unique<CutBackend>(aside); }}};
}

TEST(Replanner, ACutSolveThatViolatesARowIsNoPlan) {
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({5.0, 0.0, 0.3}, 0.5, 0.0, 0.0);
  const Eigen::Vector3d start(-4.0, 0.0, 1.5);
  const auto plan = [&](const solvers::BackendRegistry& backends, double tilt_max,
                        const std::string& backend) {
    ReplannerOptions options = Options(ArrivalMode::kFixed);
    options.backend = backend;
    options.max_iterations = 1;
    options.max_duration = 10.0;  // no time to wait until the tilt is small of itself
    options.problem.vehicle.tilt_max = tilt_max;
    options.problem.settings = {{"tilt_limit", {}, true, {}}};
    Replanner replanner(options, backends);
    replanner.CommitHover(start, 0.0);
    const ReplanResult result = replanner.Replan(Input(start, pad, 0.0), map);
    EXPECT_TRUE(result.status != ReplanStatus::kPlanned || result.solver.max_violation <= 2e-6);
    return result;
  };
  EXPECT_EQ(plan(OnlyCut(0.0), 0.6, "cut").status, ReplanStatus::kPlanned);
  const ReplanResult steep = plan(OnlyCut(0.0), 0.02, "cut");
  EXPECT_NE(steep.status, ReplanStatus::kPlanned);
  EXPECT_EQ(steep.reason, ReplanReason::kLimitsExceeded);
  for (const double tilt_max : {0.02, 0.05, 0.1, 0.2}) {
    plan(solvers::StandardBackends(), tilt_max, "banded");
  }
}

// What forbids the first plan, in the answer and in the log of its last attempt.
std::string ForbiddenBy(const ReplannerOptions& options, const solvers::BackendRegistry& backends,
                        ReplanReason reason, const OccupancyMap& map = ObservedMap()) {
  const ArcPad pad({5.0, 0.0, 0.3}, 0.5, 0.0, 0.0);
  const Eigen::Vector3d start(-4.0, 0.0, 1.5);
  Replanner replanner(options, backends);
  replanner.CommitHover(start, 0.0);
  ReplanLog log;
  replanner.set_log(&log);
  const ReplanResult& result = replanner.Replan(Input(start, pad, 0.0), map);
  EXPECT_NE(result.status, ReplanStatus::kPlanned);
  EXPECT_EQ(result.reason, reason) << ToString(result.reason);
  EXPECT_FALSE(log.attempts.empty());
  if (log.attempts.empty()) return "";
  EXPECT_EQ(log.attempts.back().forbidden_by, result.forbidden_by);
  return std::string(result.forbidden_by);
}

// u = value, wherever a control point is.
struct OwnMap {
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = false;
  double value;
  int windows() const { return 1; }
  int first_block(int) const { return 4; }
  template <class T>
  void operator()(int, const T* q, const T&, const T&, T* u) const {
    u[0] = value + 0.0 * q[0];
  }
};

ReplannerOptions WithOwnTerm(double value, bool hard) {
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  TermEntry own;
  own.info = {"own", "", "", "", false};
  own.default_weight = 1.0;
  own.parameters = {HingeWidth(0.2, "m")};
  own.make = [info = own.info, value](const TermSetup& setup) {
    return MakeLandingTerm(info, OwnMap{value}, setup.Hinge(), 1);
  };
  options.problem.terms.push_back(own);
  options.problem.settings = {{"own", {}, hard, {}}};
  return options;
}

TEST(Replanner, ARefusedPlanNamesTheTermThatForbidsIt) {
  // Rows that no curve keeps; a cost that has no value.
  for (const auto& [value, hard] : {std::pair(1.0, true), std::pair(std::nan(""), false)}) {
    EXPECT_EQ(ForbiddenBy(WithOwnTerm(value, hard), solvers::StandardBackends(),
                          ReplanReason::kSolverFailed),
              "own");
  }
  // Rows that a point which is cut short violates.
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  options.max_duration = 10.0;
  options.backend = "cut";
  options.problem.vehicle.tilt_max = 0.02;
  options.problem.settings = {{"tilt_limit", {}, true, {}}};
  EXPECT_EQ(ForbiddenBy(options, OnlyCut(0.0), ReplanReason::kLimitsExceeded), "tilt_limit");
}

// Nobody reads in flight what failed, so it is not put into words.
TEST(Replanner, AStepWhoseSolvesFailDoesNotAllocate) {
  if (solvers::AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({5.0, 0.0, 0.3}, 0.5, 0.0, 0.0);
  const Eigen::Vector3d start(-4.0, 0.0, 1.5);
  Replanner replanner(WithOwnTerm(std::nan(""), false), solvers::StandardBackends());
  replanner.CommitHover(start, 0.0);
  long allocated = 0;
  for (int k = 0; k < 5; ++k) {
    const ReplanInput input = Input(start, pad, 0.1 * k);
    const long before = solvers::AllocationCount();
    EXPECT_EQ(replanner.Replan(input, map).reason, ReplanReason::kSolverFailed);
    if (k > 0) allocated += solvers::AllocationCount() - before;
  }
  EXPECT_EQ(allocated, 0);
}

// The certificate forbids what no row does.
TEST(Replanner, ARefusedPlanNamesTheLimitThatForbidsIt) {
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  options.limits.body_rate = 1e-4;
  EXPECT_EQ(ForbiddenBy(options, solvers::StandardBackends(), ReplanReason::kLimitsExceeded),
            "limits.body_rate");
  options = Options(ArrivalMode::kFixed);
  options.backend = "cut";  // it leaves the guess, which is too fast in the middle
  options.max_iterations = 1;
  options.max_duration = 6.0;
  EXPECT_EQ(ForbiddenBy(options, OnlyCut(0.0), ReplanReason::kLimitsExceeded), "limits.speed");
}

// The cut solve's point violates a row, and stays in the wall.
TEST(Replanner, WhereAnObstacleForbidsAPlanNoTermDoes) {
  OccupancyMap map = ObservedMap();
  for (double y = -1.0; y < 1.0; y += 0.1) {
    for (double z = 0.0; z < 2.0; z += 0.1) map.SetOccupied({0.0, y, z});
  }
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  options.backend = "cut";
  options.problem.vehicle.tilt_max = 0.02;
  options.problem.settings = {{"tilt_limit", {}, true, {}}};
  EXPECT_EQ(ForbiddenBy(options, OnlyCut(0.0), ReplanReason::kCollisionRemains, map), "");
}

TEST(Replanner, ACutSolveThatStartsElsewhereIsNoPlan) {
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({5.0, 0.0, 0.3}, 0.5, 0.0, 0.0);
  const Eigen::Vector3d start(-4.0, 0.0, 1.5);
  for (const double aside : {0.0, 1e-5, 0.3}) {
    ReplannerOptions options = Options(ArrivalMode::kFixed);
    options.backend = "cut";
    options.gap = 0.0;  // a start that is near enough would be the answer
    options.problem.endpoint = EndpointMode::kExplicit;
    Replanner replanner(options, OnlyCut(aside));
    replanner.CommitHover(start, 0.0);
    const ReplanResult result = replanner.Replan(Input(start, pad, 0.0), map);
    const bool there = aside == 0.0;
    EXPECT_EQ(result.status == ReplanStatus::kPlanned, there) << aside;
    EXPECT_EQ(result.reason, there ? ReplanReason::kNone : ReplanReason::kSolverFailed) << aside;
    EXPECT_LT((replanner.Reference(0.02).p_WB - start).norm(), 1e-9);
  }
}

TEST(Replanner, APadEstimateThatJumpsIsFollowed) {
  const OccupancyMap map = ObservedMap();
  const ArcPad before({0.0, 0.0, 0.3}, 0.0, 0.0, 0.0), after({5.0, 3.0, 0.3}, 0.0, 0.0, 0.0);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  ReplanLog log;
  replanner.set_log(&log);
  replanner.CommitHover({-2.0, 0.0, 1.6}, 0.0);
  int later = 0;
  for (int step = 0; step < 140; ++step) {
    const double t = 0.1 * step;
    const FlatState at = replanner.Reference(t);
    ReplanInput input = Input(at.p_WB, t < 5.0 ? before : after, t);
    input.vehicle.v_WB = at.v_WB;
    EXPECT_EQ(replanner.Replan(input, map).status, ReplanStatus::kPlanned) << "at " << t;
    if (log.attempts.size() < 2) continue;
    ++later;  // the promised arrival is too early: the way has become longer, and needs its segments
    EXPECT_LE(log.attempts[1].duration, 0.3 * log.attempts[1].segments) << "at " << t;
  }
  EXPECT_GT(later, 0);
  EXPECT_LT((replanner.Reference(14.0).p_WB - Eigen::Vector3d(5.0, 3.0, 1.6)).norm(), 0.02);
}

TEST(Replanner, APlanThatEndsInACreepIsNotFlownPastItsEnd) {
  OccupancyMap map = ObservedMap();
  const ArcPad creeping({0.0, 0.0, 0.3}, 0.03, 0.0, 0.0);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover({-2.0, 0.0, 1.6}, 0.0);
  for (int step = 0; step < 400; ++step) {
    const double t = 0.1 * step;
    // The pad drives on into pillars, and is not behind them at any arrival.
    for (double x = 0.9; step == 60 && x < 3.0; x += 0.7) AddPillar({x, 0.0}, &map);
    const FlatState at = replanner.Reference(t);
    ReplanInput input = Input(at.p_WB, creeping, t);
    input.vehicle.v_WB = at.v_WB;
    const ReplanResult& result = replanner.Replan(input, map);
    EXPECT_TRUE(result.proven && result.certificate.stops_in_observed_space) << "at " << t;
    EXPECT_FALSE(map.IsBlocked(at.p_WB)) << "at " << t;
  }
  EXPECT_LT(replanner.Reference(40.0).v_WB.norm(), 1e-9);
}

TEST(Replanner, WalksNoCurveThatIsFasterThanAFault) {
  ControlPoints points = ControlPoints::Zero(3, 8);
  points(1, 7) = 199.0;
  EXPECT_TRUE(IsWalkable(UniformBspline(points, 0.2, 0.0)));
  points(1, 7) = -201.0;
  EXPECT_FALSE(IsWalkable(UniformBspline(points, 0.2, 0.0)));
}

TEST(Replanner, OneAnswerIsPendingAtATime) {
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({5.0, 0.0, 0.3}, 0.5, 0.0, 0.0);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover({-4.0, 0.0, 1.5}, 0.0);
  ReplanInput input = Input({-4.0, 0.0, 1.5}, pad, 0.0);
  input.t_start = 0.3;
  ASSERT_EQ(replanner.Replan(input, map).status, ReplanStatus::kPlanned);
  const Eigen::Vector3d promised = replanner.Reference(1.0).p_WB;
  input.t_now = 0.1;
  input.t_start = 0.4;
  EXPECT_EQ(replanner.Replan(input, map).reason, ReplanReason::kInvalidInput);
  EXPECT_EQ(replanner.Reference(1.0).p_WB, promised);
}

TEST(Replanner, StartsAtTheVehicleWhenTrackingIsLost) {
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({5.0, 0.0, 0.3}, 0.5, 0.0, 0.0);
  Replanner replanner(Options(ArrivalMode::kFixed), solvers::StandardBackends());
  replanner.CommitHover({-4.0, 0.0, 1.5}, 0.0);
  const Eigen::Vector3d blown_away(-4.0, 0.8, 1.5);
  const ReplanResult& result = replanner.Replan(Input(blown_away, pad, 0.0), map);
  EXPECT_TRUE(result.from_odometry);
  EXPECT_LT((replanner.Reference(0.02).p_WB - blown_away).norm(), 1e-9);
}

TEST(Replanner, RefusesBadOptions) {
  const auto make = [](auto change) {
    ReplannerOptions options;
    change(&options);
    Replanner(options, solvers::StandardBackends());
  };
  EXPECT_THROW(make([](auto* o) { o->backend = "none"; }), std::invalid_argument);
  EXPECT_THROW(make([](auto* o) { o->limits.speed = 0.0; }), std::invalid_argument);
  EXPECT_THROW(make([](auto* o) { o->min_duration = -1.0; }), std::invalid_argument);
  EXPECT_THROW(make([](auto* o) { o->ceiling_height = 0.1; }), std::invalid_argument);
  EXPECT_THROW(make([](auto* o) { o->vertical_cost = 0.5; }), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::planning
