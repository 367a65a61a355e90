// SPDX-License-Identifier: BSD-3-Clause
// Duals, losses, the bordered band, options, and problems through views against dense computations.

#include <gtest/gtest.h>

#include <random>

#include "touchdown/solvers/derivative_check.h"
#include "touchdown/solvers/dual.h"
#include "touchdown/solvers/solver_options.h"
#include "touchdown/solvers/test/test_terms.h"

namespace touchdown::solvers {
namespace {

template <class T>
T Formula(const T& x, const T& y) {
  using std::atan2, std::cos, std::exp, std::log, std::sin, std::sqrt;
  return sin(x * y) / sqrt(1.0 + x * x) + exp(-y) * cos(x) - log(2.0 + x * x) + atan2(y, x + 3.0);
}

TEST(Dual, FirstAndSecondDerivativesMatchDifferences) {
  using First = Dual<double, 2>;
  using Second = Dual<First, 2>;
  const double x = 0.7, y = -0.4, d = 1e-5;
  const First f = Formula(First(x, 0), First(y, 1));
  EXPECT_DOUBLE_EQ(f.v, Formula(x, y));
  EXPECT_NEAR(f.d[0], (Formula(x + d, y) - Formula(x - d, y)) / (2 * d), 1e-9);
  EXPECT_NEAR(f.d[1], (Formula(x, y + d) - Formula(x, y - d)) / (2 * d), 1e-9);
  const Second s = Formula(Second(First(x, 0), 0), Second(First(y, 1), 1));
  const First plus = Formula(First(x + d, 0), First(y, 1));
  const First minus = Formula(First(x - d, 0), First(y, 1));
  EXPECT_NEAR(s.d[0].d[0], (plus.d[0] - minus.d[0]) / (2 * d), 1e-8);
  EXPECT_NEAR(s.d[0].d[1], (plus.d[1] - minus.d[1]) / (2 * d), 1e-8);
  EXPECT_DOUBLE_EQ(s.d[0].d[1], s.d[1].d[0]);
}

template <class Loss>
void ExpectConsistent(const Loss& loss) {
  const double d = 1e-6;
  for (double u = -2.0; u <= 3.0; u += 0.0371) {
    const LossValue at = loss.Value(u), plus = loss.Value(u + d), minus = loss.Value(u - d);
    EXPECT_NEAR(at.drho, (plus.rho - minus.rho) / (2 * d), 1e-5);
    EXPECT_NEAR(at.d2rho, (plus.drho - minus.drho) / (2 * d), 1e-4);
    EXPECT_GE(at.d2rho, 0.0);  // both are convex
    const LossResidual r = loss.Residual(u);
    EXPECT_NEAR(r.r * r.r, 2.0 * at.rho, 1e-12);
    EXPECT_NEAR(r.r * r.dr, at.drho, 1e-9);  // the residual's gradient is the loss's
  }
}

TEST(Loss, DerivativesResidualsAndConvexity) {
  ExpectConsistent(SquareLoss(3.0));
  ExpectConsistent(HingeLoss(2.0, 0.5));
}

TEST(Loss, HingeIsTwiceContinuouslyDifferentiable) {
  const HingeLoss hinge(2.0, 0.5);
  for (const double joint : {0.0, 0.5}) {
    const LossValue below = hinge.Value(joint - 1e-12), above = hinge.Value(joint + 1e-12);
    EXPECT_NEAR(below.rho, above.rho, 1e-10);
    EXPECT_NEAR(below.drho, above.drho, 1e-10);
    EXPECT_NEAR(below.d2rho, above.d2rho, 1e-10);
  }
  EXPECT_TRUE(std::isnan(hinge.Value(std::nan("")).rho));
}

TEST(Loss, RefusesBadParameters) {
  EXPECT_THROW(SquareLoss(-1.0), std::invalid_argument);
  EXPECT_THROW(SquareLoss(std::nan("")), std::invalid_argument);
  EXPECT_THROW(HingeLoss(1.0, 0.0), std::invalid_argument);
}

TEST(BorderedBandMatrix, AnswersForTheWholeSymmetricMatrix) {
  BorderedBandMatrix m;
  m.Resize(4, 2, 1, true);
  m.block(1, 1)[1] = 5.0;  // block (1, 2), element (0, 1): row 2, column 5
  m.border()[3] = 7.0;
  m.corner() = 9.0;
  EXPECT_EQ(m.size(), 9);
  EXPECT_EQ(m.At(2, 5), 5.0);
  EXPECT_EQ(m.At(5, 2), 5.0);
  EXPECT_EQ(m.At(8, 3), 7.0);
  EXPECT_EQ(m.At(8, 8), 9.0);
  EXPECT_EQ(m.At(0, 7), 0.0);  // outside the band
  m.SetZero();
  EXPECT_EQ(m.At(2, 5), 0.0);
}

TEST(SolverOptions, NamesOptionValueAndRange) {
  SolverOptions options({{"tolerance", 1e-6, 0.0, 1.0, false, ""}, {"memory", 8, 1, 100, true, ""}});
  options.Set("tolerance", 0.5);
  EXPECT_EQ(options.Get("tolerance"), 0.5);
  for (const auto& [name, value] : {std::pair{"tolerance", 2.0}, std::pair{"memory", 2.5}}) {
    try {
      options.Set(name, value);
      FAIL() << name << " took " << value;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("["), std::string::npos);
    }
  }
  EXPECT_THROW(options.Get("none"), std::invalid_argument);
}

/// A nonlinear map on windows of three 2-vectors that uses h and t.
class WavyMap {
 public:
  static constexpr int kBlockSize = 2, kWindow = 3, kOutputs = 2;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = false;
  explicit WavyMap(int windows) : windows_(windows) {}
  int windows() const { return windows_; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& t, T* u) const {
    using std::cos, std::sin;
    u[0] = sin(q[0] * q[3]) + q[5] / h + 0.3 * cos(t);
    u[1] = (q[4] - q[0]) * (q[1] + q[2]) * h;
  }

 private:
  int windows_;
};

/// An offset that moves nonlinearly with h.
class CurvedOffset : public LiftOffset {
 public:
  explicit CurvedOffset(int n) : n_(n) {}
  void At(double h, double* l, double* dl, double* d2l) const noexcept override {
    for (int i = 0; i < n_; ++i) {
      l[i] = std::sin(i + h);
      if (dl) dl[i] = std::cos(i + h);
      if (d2l) d2l[i] = -std::sin(i + h);
    }
  }

 private:
  int n_;
};

View FoldedView(const Problem& problem) {
  // Blocks 0 and 1 fixed, the last three folded onto one reduced block, as a landing's ends are.
  AffineLift lift;
  const int n = problem.shape().blocks;
  for (int i = 0; i < n; ++i) {
    lift.block.push_back(i < 2 ? -1 : std::min(i - 2, n - 5));
    lift.coefficient.push_back(i < 2 ? 0.0 : i == n - 2 ? 1.0 : i > n - 4 ? -2.0 : 1.0);
  }
  lift.reduced_blocks = n - 4;
  lift.offset = std::make_shared<CurvedOffset>(2 * n);
  return View(problem, lift);
}

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

TEST(View, RefusesALiftThatDoesNotFit) {
  Problem problem({.blocks = 4, .block_size = 1});
  EXPECT_THROW(View(problem, AffineLift::Identity(5)), std::invalid_argument);
  AffineLift jumps = AffineLift::Identity(4);
  jumps.block = {0, 2, 1, 3};
  EXPECT_THROW(View(problem, jumps), std::invalid_argument);
}

TEST(Problem, RefusesTermsThatDoNotFit) {
  Problem problem({.blocks = 2, .block_size = 2});
  const auto wavy = std::make_shared<WindowTerm<WavyMap, SquareLoss>>(
      TermInfo{"wavy", "", "", "", false}, WavyMap(1), SquareLoss(1.0), 1);
  EXPECT_THROW(problem.AddTerm(wavy, Role::kCost), std::invalid_argument);
  EXPECT_THROW(Problem({.blocks = 0}), std::invalid_argument);
}

TEST(Problem, ConstraintRowsReportTheirViolationAndCurvature) {
  Problem problem({.blocks = 1, .block_size = 1});
  // u = x^2 - 4 <= 0 as a row; its curvature with multiplier 3 is 6.
  const auto map = [](const auto* x, auto* u) { u[0] = x[0] * x[0] - 4.0; };
  using Map = WholeMap<1, 1, decltype(map)>;
  problem.AddTerm(std::make_shared<WindowTerm<Map, HingeLoss>>(TermInfo{"row", "", "", "", true},
                                                               Map(map), HingeLoss(1.0, 1.0), 1),
                  Role::kConstraint);
  Evaluation e;
  problem.Resize(&e);
  const double x = 3.0, multiplier = 3.0;
  const double* multipliers[] = {&multiplier};
  ASSERT_TRUE(problem.Evaluate(&x, 1.0, {.gradient = true, .hessian = true}, multipliers, &e));
  EXPECT_EQ(e.value, 0.0);
  EXPECT_DOUBLE_EQ(e.max_violation, 5.0);
  EXPECT_DOUBLE_EQ(e.terms[0].du[0], 6.0);
  EXPECT_DOUBLE_EQ(e.hessian.At(0, 0), 6.0);
  EXPECT_EQ(e.gradient[0], 0.0);
}

}  // namespace
}  // namespace touchdown::solvers
