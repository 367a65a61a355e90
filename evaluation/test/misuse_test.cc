// SPDX-License-Identifier: BSD-3-Clause
// Mistakes of a newcomer with the public classes end in a sentence that names them. Also run under sanitizers, where a
// read out of bounds fails.
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/tracking/disturbance_observer.h"
#include "control/tracking/geometric_controller.h"
#include "control/tracking/mixer.h"
#include "control/tracking/paper_controller.h"
#include "control/tracking/yaw_planner.h"
#include "planning/baselines/ego/ego_planner.h"
#include "planning/baselines/pid/pid_follower.h"
#include "planning/search/grid_search.h"
#include "sim/obstacles/forest.h"
#include "sim/sensors/depth_camera.h"
#include "sim/sensors/gps.h"
#include "sim/world/world.h"
#include "touchdown/estimation/own_state/own_state_filter.h"
#include "touchdown/estimation/pad/pad_predictor.h"
#include "touchdown/estimation/tags/pad_finder.h"
#include "touchdown/estimation/tags/tag_detector.h"
#include "touchdown/planning/map/persistent_map.h"
#include "touchdown/planning/replan/replanner.h"
#include "touchdown/solvers/problem/function_term.h"
#include "touchdown/solvers/solve.h"

namespace touchdown {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndless = std::numeric_limits<double>::infinity();

struct Misuse {
  const char* what;
  const char* named;  ///< what its sentence has to name
  std::function<void()> call;
};

std::shared_ptr<solvers::Term> Square(int block_size, int window) {
  return std::make_shared<solvers::FunctionTerm>(
      solvers::TermInfo{"square", "", "", "", true},
      solvers::FunctionShape{.block_size = block_size, .window = window}, solvers::SquareLoss(1.0),
      [](const auto* x, auto* u) { u[0] = x[0] - 1.0; });
}

solvers::Problem Line() {
  solvers::Problem problem({.blocks = 4, .block_size = 1});
  problem.AddTerm(Square(1, 1), solvers::Role::kCost);
  return problem;
}

planning::OccupancyMap Map() { return planning::OccupancyMap(planning::OccupancyMapOptions{}); }

planning::Replanner MakeReplanner(const std::function<void(planning::ReplannerOptions*)>& change) {
  planning::ReplannerOptions options;
  change(&options);
  return planning::Replanner(options, solvers::StandardBackends());
}

const std::vector<Misuse>& Misuses() {
  using namespace estimation;  // NOLINT: a list of one-liners
  using namespace planning;    // NOLINT
  using namespace solvers;     // NOLINT
  using Eigen::Vector3d, Eigen::VectorXd;
  static const std::vector<Misuse> list = {
      {"a problem without blocks", "0 blocks", [] { Problem({.blocks = 0}); }},
      {"a problem of more numbers than there are", "1e8",
       [] { Problem({.blocks = 2000000000, .block_size = 4}); }},
      {"nowhere to put the result", "result",
       [] {
         const Problem line = Line();
         const View view(line);
         const auto backend = MakeBackend(StandardBackends(), "banded");
         backend->Prepare(view);
         backend->Solve(view, VectorXd(VectorXd::Zero(4)), {}, nullptr);
       }},
      {"a term of another block size", "square",
       [] { Problem({.blocks = 4, .block_size = 2}).AddTerm(Square(1, 1), Role::kCost); }},
      {"a window longer than the problem", "square",
       [] { Problem({.blocks = 2, .block_size = 1}).AddTerm(Square(1, 3), Role::kCost); }},
      {"no term at all", "null",
       [] { Problem({.blocks = 2, .block_size = 1}).AddTerm(nullptr, Role::kCost); }},
      {"bounds that cross", "scalar 0",
       [] { Problem({.blocks = 1, .block_size = 1}).SetBounds({2.0}, {1.0}); }},
      {"bounds of another size", "bounds",
       [] { Problem({.blocks = 2, .block_size = 1}).SetBounds({2.0}, {3.0}); }},
      {"a negative weight", "weight", [] { SquareLoss(-1.0); }},
      {"a hinge without width", "width", [] { HingeLoss(1.0, 0.0); }},
      {"a function of too many variables", "FunctionTerm", [] { Square(40, 1); }},
      {"a start of another size", "2 numbers", [] { Solve(Line(), VectorXd::Zero(2)); }},
      {"a start that is no number", "finite", [] { Solve(Line(), VectorXd::Constant(4, kNan)); }},
      {"a backend that does not exist", "newton",
       [] { Solve(Line(), VectorXd::Zero(4), "newton"); }},
      {"a gap that is no share", "gap",
       [] { Solve(Line(), VectorXd::Zero(4), "banded", {.gap = 2.0}); }},
      {"a stop after less than no iterations", "max_iterations",
       [] { Solve(Line(), VectorXd::Zero(4), "banded", {.max_iterations = -1}); }},
      {"a stop after no time that there is", "wall_limit_s",
       [] { Solve(Line(), VectorXd::Zero(4), "banded", {.wall_limit_s = kNan}); }},
      {"multipliers of another problem", "multipliers",
       [] {
         const Problem line = Line();
         const View view(line);
         const auto backend = MakeBackend(StandardBackends(), "banded");
         backend->Prepare(view);
         SolverResult result;
         backend->Solve(view, {VectorXd::Zero(4), {{1.0}, {2.0}}}, {}, &result);
       }},
      {"a solve before Prepare", "before Prepare",
       [] {
         const Problem line = Line();
         SolverResult result;
         MakeBackend(StandardBackends(), "banded")
             ->Solve(View(line), VectorXd(VectorXd::Zero(4)), {}, &result);
       }},
      {"a solve after a term was added", "structure",
       [] {
         Problem line = Line();
         const View view(line);
         const auto backend = MakeBackend(StandardBackends(), "lbfgs");
         backend->Prepare(view);
         line.AddTerm(Square(1, 2), Role::kCost);
         SolverResult result;
         backend->Solve(view, VectorXd(VectorXd::Zero(4)), {}, &result);
       }},
      {"an option out of range", "gap_tolerance",
       [] { MakeBackend(StandardBackends(), "banded")->options().Set("gap_tolerance", -1.0); }},
      {"an option that does not exist", "speed",
       [] { MakeBackend(StandardBackends(), "banded")->options().Set("speed", 1.0); }},
      {"a lift of another size", "lift",
       [] {
         const Problem line = Line();
         View(line, AffineLift::Identity(7));
       }},
      {"a spline of three points", "3 control points",
       [] { UniformBspline(ControlPoints::Zero(3, 3), 0.1, 0.0); }},
      {"a knot past the end", "knot 2", [] { UniformBspline().AtKnot(2); }},
      {"a landing of three segments", "segments", [] { LandingProblem(3, {}); }},
      {"a guess before the boundary", "SetBoundary", [] { LandingProblem(12, {}).Guess(); }},
      {"a duration of zero", "duration", [] { LandingProblem(12, {}).SetDuration(0.0); }},
      {"a pair of a point that is not there", "control point",
       [] { LandingProblem(12, {}).SetPairs(std::vector<ObstaclePair>{{.control_point = 15}}); }},
      {"obstacles without room for them", "moving obstacles",
       [] { LandingProblem(12, {}).SetObstacles(std::vector<MovingObstacle>(1)); }},
      {"a term that does not exist", "hover",
       [] {
         LandingProblemOptions options;
         options.settings = {{"hover", 1.0, {}, {}}};
         LandingProblem(12, options);
       }},
      {"a map of cells without size", "resolution", [] { OccupancyMap({.resolution = 0.0}); }},
      {"an occupied cell nowhere", "SetOccupied",
       [] {
         Map().SetOccupied({kNan, 0.0, 0.0});
       }},
      {"free space without end", "MarkFree", [] { Map().MarkFree(Vector3d::Zero(), kEndless); }},
      {"free space nowhere", "MarkFree",
       [] {
         Map().MarkFree({0.0, kNan, 0.0}, 1.0);
       }},
      {"a depth frame without depths", "depth",
       [] {
         DepthFrame frame;
         frame.intrinsics.width = frame.intrinsics.height = 8;
         Map().Integrate(frame, {});
       }},
      {"no map in the file", "OctoMap",
       [] {
         std::istringstream text("this is no map");
         PersistentMap(OccupancyMapOptions{}).Read(text);
       }},
      {"a search that likes detours", "greed", [] { GridSearch(1.0, 0.5); }},
      {"a replanner of a backend that does not exist", "newton",
       [] { MakeReplanner([](auto* o) { o->backend = "newton"; }); }},
      {"a hull that is no size", "hull_radius",
       [] { MakeReplanner([](auto* o) { o->hull_radius = kNan; }); }},
      {"a hull smaller than nothing", "hull_radius",
       [] { MakeReplanner([](auto* o) { o->hull_radius = -1.0; }); }},
      {"a height of contact that is none", "contact_height",
       [] { MakeReplanner([](auto* o) { o->contact_height = kNan; }); }},
      {"more pairs than there is room for", "max_pairs_per_point",
       [] { MakeReplanner([](auto* o) { o->problem.max_pairs_per_point = 1000000; }); }},
      {"a replanner without speed", "speed",
       [] { MakeReplanner([](auto* o) { o->limits.speed = 0.0; }); }},
      {"a hover nowhere", "finite",
       [] {
         MakeReplanner([](auto*) {}).CommitHover({kNan, 0.0, 0.0}, 0.0);
       }},
      {"a takeover at no time", "TakeOverAt", [] { MakeReplanner([](auto*) {}).TakeOverAt(kNan); }},
      {"an EGO-Planner without goals", "goal_rate", [] { EgoPlanner({.goal_rate = 0.0}); }},
      {"a PID law that pushes away", "proportional",
       [] { PidFollower({.proportional = -1.0}, Limits{}); }},
      {"a controller of a vehicle without mass", "mass",
       [] { control::GeometricController({.mass_kg = 0.0}); }},
      {"a paper's controller of a vehicle without mass", "mass",
       [] { control::PaperController({.mass_kg = 0.0}); }},
      {"a mixer of a vehicle without rotors", "actuators",
       [] { control::Mixer({.mass_kg = 0.0}); }},
      {"an observer of a vehicle without rotors", "actuators",
       [] { control::DisturbanceObserver({.mass_kg = 0.0}, {}); }},
      {"a heading that goes back in time", "dt", [] { control::StepYaw({}, 1.0, -0.1); }},
      {"a gate that lets more than all pass", "gate_probability",
       [] { PadFilter({.gate_probability = 2.0}); }},
      {"a prediction before any measurement", "measurement",
       [] { Predict(PadFilter(PadFilterOptions{})); }},
      {"tags in an image without pixels", "image", [] { TagDetector().Detect({}); }},
      {"an image enlarged by seven", "enlarge", [] { TagDetector({.enlarge = 7}); }},
      {"a world in steps of a second", "timestep", [] { sim::World({.timestep = 1.0}); }},
      {"thrusts that are no number", "thrust",
       [] {
         sim::World({.start = {.p_WB = {0.0, 0.0, 5.0}}})
             .Step(Eigen::Vector4d(kNan, 1.0, 1.0, 1.0), Vector3d::Zero());
       }},
      {"a pad that drives backwards through time", "speed",
       [] { sim::PadMotion({.speed = -1.0}); }},
      {"a receiver without a rate", "rate", [] { sim::PadGps({.rate_hz = 0.0}, 1); }},
      {"a forest of a kind that does not exist", "jungle", [] { sim::ForestOfKind("jungle"); }},
      {"a forest denser than wood", "density",
       [] {
         sim::ForestConfig forest;
         sim::SetDensity(3.0, &forest);
       }},
  };
  return list;
}

TEST(Misuse, EndsInASentenceThatNamesIt) {
  for (const Misuse& misuse : Misuses()) {
    SCOPED_TRACE(misuse.what);
    try {
      misuse.call();
      ADD_FAILURE() << "nothing was said";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(misuse.named));
    } catch (const std::exception& error) {
      ADD_FAILURE() << "not std::invalid_argument: " << error.what();
    }
  }
}

// A question at a time that is not finite has no answer, and reads nothing out of bounds.
TEST(Misuse, AReferenceAtNoTimeIsNoNumber) {
  planning::Replanner replanner = MakeReplanner([](auto*) {});
  replanner.CommitHover({1.0, 2.0, 3.0}, 0.0);
  EXPECT_TRUE(replanner.Reference(kNan).p_WB.array().isNaN().all());
  EXPECT_EQ(replanner.Reference(1e12).p_WB, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(replanner.Reference(-kEndless).p_WB, Eigen::Vector3d(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace touchdown
