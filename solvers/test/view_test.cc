// SPDX-License-Identifier: BSD-3-Clause
// Problems through views against central differences.

#include "touchdown/solvers/problem/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <type_traits>

#include "solvers/test/test_terms.h"
#include "touchdown/solvers/backend/derivative_check.h"

namespace touchdown::solvers {
namespace {

TEST(View, EveryDerivativeMatchesDifferences) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const bool free_interval : {false, true}) {
    Problem problem({.blocks = 9, .block_size = 2, .free_interval = free_interval});
    problem.set_interval(0.8);
    problem.set_t0(0.3);
    problem.AddTerm(std::make_shared<WindowTerm<WavyMap, SquareLoss>>(
                        TermInfo{"wavy", "", "", "", false}, WavyMap(7), SquareLoss(1.3), 7),
                    Role::kCost);
    problem.AddTerm(std::make_shared<WindowTerm<WavyMap, HingeLoss>>(
                        TermInfo{"hinged", "", "", "", false}, WavyMap(5), HingeLoss(0.7, 0.4), 5),
                    Role::kCost);
    for (const View& view : {View(problem, AffineLift::Identity(9)), FoldedView(problem)}) {
      for (int trial = 0; trial < 10; ++trial) {
        Eigen::VectorXd y(view.num_variables());
        for (int i = 0; i < y.size(); ++i) y[i] = 0.7 * normal(random);
        if (free_interval) y[y.size() - 1] = 0.8;
        const DerivativeErrors errors = CheckDerivatives(view, y);
        ASSERT_TRUE(errors.evaluated);
        EXPECT_LT(errors.worst(), 1e-5);
      }
    }
  }
}

TEST(View, TheLagrangiansHessianMatchesDifferences) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  for (const bool free_interval : {false, true}) {
    Problem problem({.blocks = 9, .block_size = 2, .free_interval = free_interval});
    problem.set_interval(0.8);
    const auto wavy = [](int windows) {
      return std::make_shared<WindowTerm<WavyMap, SquareLoss>>(
          TermInfo{"wavy", "", "", "", false}, WavyMap(windows), SquareLoss(1.3), windows);
    };
    problem.AddTerm(wavy(7), Role::kCost);
    problem.AddTerm(wavy(6), Role::kConstraint);
    std::vector<double> row_multipliers(12);
    for (double& m : row_multipliers) m = normal(random);
    const RowWeights rows[] = {{}, {.multiplier = row_multipliers.data()}};
    for (const View& view : {View(problem, AffineLift::Identity(9)), FoldedView(problem)}) {
      Eigen::VectorXd y(view.num_variables());
      for (int i = 0; i < y.size(); ++i) y[i] = 0.7 * normal(random);
      if (free_interval) y[y.size() - 1] = 0.8;
      const Lagrangian lagrangian{.objective_factor = 0.4, .rows = rows};
      const DerivativeErrors errors = CheckDerivatives(view, y, lagrangian);
      EXPECT_LT(errors.worst(), 1e-5);
    }
  }
}

/// Possible errors of a map with derivatives by hand.
enum class Fault { kNone, kNan, kSlope, kCurvature, kLowerHalf };

/// u = scale (q_0 q_1 + q_0^2), d = 2, with derivatives by hand.
struct FaultyMap {
  static constexpr int kBlockSize = 2, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = false;
  Fault fault;
  double scale;
  int windows() const { return 3; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = scale * (q[0] * q[1] + q[0] * q[0]);
  }
  void Jacobian(int k, const double* q, double h, double t, double* u, double* du,
                double* du_dh) const {
    (*this)(k, q, h, t, u);
    du[0] = scale * (q[1] + 2.0 * q[0]);
    du[1] = scale * q[0];
    if (fault == Fault::kSlope) du[1] *= 1.01;
    if (fault == Fault::kNan && k == 1) du[1] = std::numeric_limits<double>::quiet_NaN();
    du_dh[0] = 0.0;
  }
  void Curvature(int /*k*/, const double* /*q*/, double /*h*/, double /*t*/, bool /*free*/,
                 const double* slope, double* sum) const {
    sum[0] += slope[0] * scale * 2.0;
    sum[1] += slope[0] * scale * (fault == Fault::kCurvature ? 1.01 : 1.0);
    if (fault != Fault::kLowerHalf) sum[3] += slope[0] * scale;
  }
};

TEST(View, AWrongDerivativeIsFoundAtAnyScale) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const Role role : {Role::kCost, Role::kConstraint}) {
      for (const Fault fault :
           {Fault::kNone, Fault::kNan, Fault::kSlope, Fault::kCurvature, Fault::kLowerHalf}) {
        SCOPED_TRACE(testing::Message() << scale << " as rows " << (role == Role::kConstraint)
                                        << " fault " << static_cast<int>(fault));
        Problem problem({.blocks = 3, .block_size = 2});
        problem.AddTerm(
            std::make_shared<WindowTerm<FaultyMap, SquareLoss>>(
                TermInfo{"faulty", "", "", "", false}, FaultyMap{fault, scale}, SquareLoss(1.0), 3),
            role);
        const View view(problem);
        const Eigen::VectorXd y = Eigen::VectorXd::LinSpaced(6, 0.4, 1.3);
        const double multipliers[] = {0.7, -0.4, 1.1};
        const RowWeights rows[] = {{.multiplier = multipliers}};
        const double worst = CheckDerivatives(view, y, {.rows = rows}).worst();
        if (fault == Fault::kNone) {
          EXPECT_LT(worst, 2e-5);
        } else {
          EXPECT_GT(worst, 1e-3);
        }
      }
    }
  }
}

TEST(View, RestrictInvertsLift) {
  Problem problem({.blocks = 9, .block_size = 2, .free_interval = true});
  const View view = FoldedView(problem);
  Eigen::VectorXd y = Eigen::VectorXd::LinSpaced(view.num_variables(), 0.1, 2.0);
  std::vector<double> x;
  double h = 0.0;
  view.Lift(y.data(), &x, &h);
  EXPECT_EQ(h, y[y.size() - 1]);
  EXPECT_LT((view.Restrict(x.data(), h) - y).cwiseAbs().maxCoeff(), 1e-12);
}

struct Product {
  static constexpr int kBlockSize = 2, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = false;
  int windows() const { return 9; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = q[0] * q[1];
  }
};

// The view was made when the band was narrow.
TEST(View, ATermThatIsAddedLaterCounts) {
  Problem problem({.blocks = 9, .block_size = 2});
  problem.AddTerm(std::make_shared<WindowTerm<Product, SquareLoss>>(
                      TermInfo{"product", "", "", "", false}, Product(), SquareLoss(0.8), 9),
                  Role::kCost);
  const View view = FoldedView(problem);
  problem.AddTerm(std::make_shared<WindowTerm<WavyMap, SquareLoss>>(
                      TermInfo{"wavy", "", "", "", false}, WavyMap(7), SquareLoss(1.3), 7),
                  Role::kCost);
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  Eigen::VectorXd y(view.num_variables());
  for (int i = 0; i < y.size(); ++i) y[i] = 0.7 * normal(random);
  EXPECT_LT(CheckDerivatives(view, y).worst(), 1e-5);
}

TEST(View, AnEvaluationOfOtherSizesSaysSo) {
  Problem problem({.blocks = 9, .block_size = 2});
  problem.AddTerm(std::make_shared<WindowTerm<Product, SquareLoss>>(
                      TermInfo{"product", "", "", "", false}, Product(), SquareLoss(0.8), 9),
                  Role::kCost);
  const View view(problem), folded = FoldedView(problem);
  const std::vector<double> y(18, 0.3);
  const Want want{.gradient = true, .hessian = true};
  ViewEvaluation e;
  EXPECT_FALSE(view.Evaluate(y.data(), want, {}, &e)) << "never sized";
  EXPECT_NE(e.full.failure, "");
  folded.Resize(&e);
  EXPECT_FALSE(view.Evaluate(y.data(), want, {}, &e)) << "of another view";
  view.Resize(&e);
  EXPECT_TRUE(view.Evaluate(y.data(), want, {}, &e));
  problem.AddTerm(std::make_shared<WindowTerm<WavyMap, SquareLoss>>(
                      TermInfo{"wavy", "", "", "", false}, WavyMap(7), SquareLoss(1.3), 7),
                  Role::kCost);
  EXPECT_FALSE(view.Evaluate(y.data(), want, {}, &e)) << "before a term";
}

static_assert(!std::is_constructible_v<View, Problem>, "a view of a temporary");
static_assert(!std::is_constructible_v<View, Problem, AffineLift>);

TEST(View, RefusesALiftThatDoesNotFit) {
  Problem problem({.blocks = 4, .block_size = 1});
  EXPECT_THROW(View(problem, AffineLift::Identity(5)), std::invalid_argument);
  AffineLift jumps = AffineLift::Identity(4);
  jumps.block = {0, 2, 1, 3};
  EXPECT_THROW(View(problem, jumps), std::invalid_argument);
  AffineLift flat = AffineLift::Identity(4);
  flat.coefficient[2] = 0.0;
  EXPECT_THROW(View(problem, flat), std::invalid_argument);
  AffineLift unused = AffineLift::Identity(4);
  unused.reduced_blocks = 5;
  EXPECT_THROW(View(problem, unused), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::solvers
