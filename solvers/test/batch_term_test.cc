// SPDX-License-Identifier: BSD-3-Clause
// A map evaluated for all windows at once, against the same as a WindowTerm.

#include "touchdown/solvers/problem/batch_term.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "touchdown/solvers/backend/derivative_check.h"
#include "touchdown/solvers/backend/newton_step.h"
#include "touchdown/solvers/backend_registry.h"
#include "touchdown/solvers/problem/problem.h"
#include "touchdown/solvers/problem/window_term.h"
#include "touchdown/solvers/solve.h"

namespace touchdown::solvers {
namespace {

constexpr int kWindows = 4, kFirst = 1, kV = 4, kM = 2;

// Depends on blocks, interval, time and window.
template <class T>
void Formula(int k, const T* q, const T& h, const T& t, T* u) {
  using std::exp, std::sin;
  u[0] = sin(q[0] * q[3]) * h + (1.0 + k) * q[2] * q[2] * q[1] - 0.3 * t * q[0];
  u[1] = exp(0.3 * q[1]) / h - q[0] * q[2] + t * t;
}

struct Map {
  static constexpr int kBlockSize = 2, kWindow = 2, kOutputs = kM;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = false;
  int windows() const { return kWindows; }
  int first_block(int k) const { return kFirst + k; }
  template <class T>
  void operator()(int k, const T* q, const T& h, const T& t, T* u) const {
    Formula(k, q, h, t, u);
  }
};

class Batched : public BatchMap {
 public:
  explicit Batched(OwnSlopes own) : own_(own) {}
  int windows() const override { return kWindows; }
  int first_block() const override { return kFirst; }
  OwnSlopes own_slopes() const override { return own_; }
  void Value(const WindowBatch& b, double* u) const override {
    ++calls;
    for (int i = 0; i < b.size; ++i) Formula(b.window[i], b.q + i * kV, b.h, b.t[i], u + i * kM);
  }
  void Jacobian(const WindowBatch& b, double* u, double* du, double* du_dh) const override {
    using D = Dual<kV + 1>;
    for (int i = 0; i < b.size; ++i) {
      std::array<D, kV> q;
      for (int j = 0; j < kV; ++j) q[j] = D(b.q[i * kV + j], j);
      const D h(b.h, kV);
      std::array<D, kM> out;
      Formula(b.window[i], q.data(), h, b.t[i] + (kFirst + b.window[i]) * (h - b.h), out.data());
      for (int c = 0; c < kM; ++c) {
        u[i * kM + c] = out[c].v;
        for (int j = 0; j < kV; ++j) du[(i * kM + c) * kV + j] = out[c].d[j];
        if (own_ == OwnSlopes::kAll) du_dh[i * kM + c] = out[c].d[kV];
      }
    }
  }
  mutable int calls = 0;

 private:
  OwnSlopes own_;
};

BatchShape Shape() {
  return {
      .block_size = 2, .window = 2, .outputs = kM, .max_windows = kWindows, .uses_interval = true};
}

Evaluation At(std::shared_ptr<const Term> term, Role role, bool free_interval) {
  static const std::vector<double> multiplier = {0.3, -0.7, 0.2, 1.1, -0.4, 0.9, 0.1, -0.2};
  static const std::vector<double> weight(8, 0.5);
  const RowWeights rows{multiplier.data(), weight.data()};
  Problem problem({.blocks = 6, .block_size = 2, .free_interval = free_interval});
  problem.AddTerm(std::move(term), role);
  problem.set_t0(0.7);
  Evaluation at;
  problem.Resize(&at);
  const double x[] = {0.1, -0.4, 0.7, 0.2, -0.9, 0.5, 0.3, 0.8, -0.2, 0.6, 1.7, -0.6};
  EXPECT_TRUE(problem.Evaluate(x, 0.8, {.gradient = true, .hessian = true, .residual = true},
                               {.objective_factor = 2.0, .rows = &rows}, &at))
      << at.failure;
  return at;
}

TEST(BatchTerm, IsTheSameAsAWindowTermToWhatDifferencesResolve) {
  const HingeLoss loss(1.3, 0.4);
  for (const OwnSlopes own : {OwnSlopes::kNone, OwnSlopes::kBlocks, OwnSlopes::kAll}) {
    for (const Role role : {Role::kCost, Role::kConstraint}) {
      for (const bool free_interval : {false, true}) {
        const auto exact =
            std::make_shared<WindowTerm<Map, HingeLoss>>(TermInfo{"a"}, Map(), loss, kWindows);
        const Evaluation wanted = At(exact, role, free_interval);
        const Evaluation got = At(std::make_shared<BatchTerm>(TermInfo{"a"}, Shape(), loss,
                                                              std::make_shared<Batched>(own)),
                                  role, free_interval);
        EXPECT_DOUBLE_EQ(wanted.value, got.value);
        EXPECT_EQ(wanted.terms[0].r, got.terms[0].r);
        const double slope = 1e-11 * Largest(wanted.gradient);
        const double row_slope = 1e-11 * Largest(wanted.row_gradient);
        for (std::size_t i = 0; i < wanted.gradient.size(); ++i) {
          EXPECT_NEAR(wanted.gradient[i], got.gradient[i], slope);
          EXPECT_NEAR(wanted.row_gradient[i], got.row_gradient[i], row_slope);
        }
        const double curvature = 2e-7 * LargestElement(wanted.hessian);
        for (int i = 0; i < wanted.hessian.size(); ++i) {
          for (int j = 0; j < wanted.hessian.size(); ++j) {
            EXPECT_NEAR(wanted.hessian.At(i, j), got.hessian.At(i, j), curvature) << i << " " << j;
          }
        }
      }
    }
  }
}

TEST(BatchTerm, AsksAMapWithoutSlopesAFewTimes) {
  const auto map = std::make_shared<Batched>(OwnSlopes::kNone);
  At(std::make_shared<BatchTerm>(TermInfo{"a"}, Shape(), SquareLoss(1.0), map), Role::kCost, true);
  EXPECT_EQ(map->calls, 9);  // slopes: 1 + 4 of the interval; curvature: 1 + 3 of the interval
}

// sum_c (10 (x1 - x0^2))^2 + (1 - x0)^2, as a chain.
class Valley : public BatchMap {
 public:
  int windows() const override { return 19; }
  int first_block() const override { return 0; }
  void Value(const WindowBatch& b, double* u) const override {
    for (int i = 0; i < b.size; ++i) {
      const double* q = b.q + 2 * i;
      u[2 * i] = 10.0 * (q[1] - q[0] * q[0]);
      u[2 * i + 1] = 1.0 - q[0];
    }
  }
};

TEST(BatchTerm, LetsEveryBackendConverge) {
  Problem problem({.blocks = 20, .block_size = 1});
  const BatchShape shape{.block_size = 1, .window = 2, .outputs = 2, .max_windows = 19};
  problem.AddTerm(std::make_shared<BatchTerm>(TermInfo{"valley"}, shape, SquareLoss(2.0),
                                              std::make_shared<Valley>()),
                  Role::kCost);
  for (const char* backend : {"banded", "lbfgs"}) {
    const SolverResult found =
        Solve(problem, Eigen::VectorXd::Constant(20, 0.5), backend, {.max_iterations = 500});
    EXPECT_EQ(found.status, SolveStatus::kConverged) << backend << ": " << found.message;
    EXPECT_NEAR(found.cost, 0.0, 1e-8);
  }
}

// u = log(x - x0), which is steep beside its edge.
class Log : public BatchMap {
 public:
  Log(double offset, double length) : offset_(offset), length_(length) {}
  int windows() const override { return 1; }
  int first_block() const override { return 0; }
  void Value(const WindowBatch& b, double* u) const override {
    for (int i = 0; i < b.size; ++i) u[i] = std::log((b.q[i] - offset_) / length_);
  }

 private:
  double offset_, length_;
};

double SlopeAt(double offset, double length, double scale, double x) {
  Problem problem({.blocks = 1, .block_size = 1});
  const BatchShape shape{.block_size = 1, .max_windows = 1, .scale = scale};
  problem.AddTerm(std::make_shared<BatchTerm>(TermInfo{"log"}, shape, LinearLoss(1.0),
                                              std::make_shared<Log>(offset, length)),
                  Role::kCost);
  Evaluation at;
  problem.Resize(&at);
  EXPECT_TRUE(problem.Evaluate(&x, 1.0, {.gradient = true, .hessian = true}, {}, &at));
  return at.gradient[0];
}

TEST(BatchTerm, StepsAreSharesOfTheScaleWhereverTheBlocksAre) {
  EXPECT_NEAR(SlopeAt(5e5, 1.0, 1.0, 5e5 + 2.0), 0.5, 1e-6);  // as in UTM coordinates
  EXPECT_NEAR(SlopeAt(0.0, 1e-6, 1e-6, 2e-6) / 5e5, 1.0, 1e-9);
}

TEST(BatchTerm, BesideAnEdgeItAsksTheOtherSide) {
  EXPECT_NEAR(SlopeAt(0.0, 1.0, 1.0, 0.01), 100.0, 0.5);
  EXPECT_NEAR(SlopeAt(0.0, 1.0, 0.01, 1e-3), 1000.0, 1e-3);
  // A step of 7e-4 from above, where two steps below there is nothing.
  EXPECT_NEAR(SlopeAt(0.0, 1.0, 1.0, 1e-3), 1000.0, 150.0);
}

/// u = |q|^2 / 2 of many variables.
class Bowl : public BatchMap {
 public:
  static constexpr int kSize = 36;
  explicit Bowl(int windows) : windows_(windows) {}
  int windows() const override { return windows_; }
  int first_block() const override { return 0; }
  void Value(const WindowBatch& b, double* u) const override {
    most = std::max(most, b.size);
    for (int i = 0; i < b.size; ++i) {
      u[i] = 0.0;
      for (int j = 0; j < kSize; ++j) u[i] += 0.5 * b.q[i * kSize + j] * b.q[i * kSize + j];
    }
  }
  mutable int most = 0;

 private:
  int windows_;
};

TEST(BatchTerm, AsksForABoundedNumberOfCopiesAtATime) {
  constexpr int kWindowsOfMany = 200;
  const auto map = std::make_shared<Bowl>(kWindowsOfMany);
  Problem problem({.blocks = kWindowsOfMany + 5, .block_size = 6});
  const BatchShape shape{.block_size = 6, .window = 6, .max_windows = kWindowsOfMany};
  problem.AddTerm(std::make_shared<BatchTerm>(TermInfo{"bowl"}, shape, LinearLoss(1.0), map),
                  Role::kCost);
  Evaluation at;
  problem.Resize(&at);
  const std::vector<double> x(6 * (kWindowsOfMany + 5), 0.3);
  ASSERT_TRUE(problem.Evaluate(x.data(), 1.0, {.gradient = true, .hessian = true}, {}, &at));
  EXPECT_LE(map->most * Bowl::kSize, 1 << 22);
  for (int i = 0; i < at.hessian.size(); ++i) {
    const int block = i / 6, windows = std::min({block + 1, 6, kWindowsOfMany + 5 - block});
    EXPECT_NEAR(at.hessian.At(i, i), windows, 1e-5) << i;
    EXPECT_NEAR(at.gradient[i], 0.3 * windows, 1e-9) << i;
  }
}

TEST(BatchTerm, RefusesSizes) {
  const auto make = [](const BatchShape& shape, std::shared_ptr<BatchMap> map) {
    return BatchTerm(TermInfo{"a"}, shape, SquareLoss(1.0), std::move(map));
  };
  EXPECT_THROW(make(Shape(), nullptr), std::invalid_argument);
  BatchShape shape = Shape();
  shape.window = 7;
  EXPECT_THROW(make(shape, std::make_shared<Valley>()), std::invalid_argument);
  shape = Shape();
  shape.scale = 0.0;
  EXPECT_THROW(make(shape, std::make_shared<Valley>()), std::invalid_argument);
  shape = Shape();
  shape.max_windows = 3;  // the map has more
  Problem problem({.blocks = 6, .block_size = 2});
  const auto term = std::make_shared<BatchTerm>(TermInfo{"a"}, shape, SquareLoss(1.0),
                                                std::make_shared<Batched>(OwnSlopes::kNone));
  EXPECT_THROW(problem.AddTerm(term, Role::kCost), std::length_error);
}

/// log x - 1, which throws where there is no logarithm.
class Logarithm : public BatchMap {
 public:
  int windows() const override { return 2; }
  int first_block() const override { return 0; }
  void Value(const WindowBatch& b, double* u) const override {
    for (int i = 0; i < b.size; ++i) {
      if (!(b.q[i] >= 0.25 && b.q[i] <= 4.0)) throw std::domain_error("beyond the bounds");
      u[i] = std::log(b.q[i]) - 1.0 + 0.1 * b.window[i];
    }
  }
};

Problem BoundedLogarithms(std::vector<double> lower, std::vector<double> upper) {
  Problem problem({.blocks = 2, .block_size = 1});
  problem.AddTerm(
      std::make_shared<BatchTerm>(TermInfo{"log"},
                                  BatchShape{.block_size = 1, .window = 1, .max_windows = 2},
                                  SquareLoss(2.0), std::make_shared<Logarithm>()),
      Role::kCost);
  problem.SetBounds(std::move(lower), std::move(upper));
  return problem;
}

TEST(BatchTerm, DifferencesKeepToTheBounds) {
  for (const auto& [a, b] : {std::pair(0.25, 4.0), {0.2505, 3.999}, {1.0, 0.25}}) {
    const Problem problem = BoundedLogarithms({0.25, 0.25}, {4.0, 4.0});
    const View view(problem);
    ViewEvaluation at;
    view.Resize(&at);
    const Eigen::Vector2d y(a, b);
    ASSERT_TRUE(view.Evaluate(y.data(), {.gradient = true, .hessian = true}, {}, &at))
        << at.full.failure;
    for (int i = 0; i < 2; ++i) {
      const double u = std::log(y[i]) - 1.0 + 0.1 * i;
      EXPECT_NEAR(at.gradient[i], 2.0 * u / y[i], 1e-9 / std::pow(y[i], 5));
      const double bend = 2.0 * (1.0 - u) / (y[i] * y[i]);
      EXPECT_NEAR(at.hessian.Diagonal(i), bend, 1e-3 / std::pow(y[i], 4));
    }
    EXPECT_LT(CheckDerivatives(view, y).worst(), 1e-3);
  }
  // Narrow, and fixed: the slope of what cannot move is none.
  for (const double width : {1e-3, 1e-7, 0.0}) {
    const Problem problem = BoundedLogarithms({0.25, 4.0 - width}, {0.25 + width, 4.0});
    const View view(problem);
    ViewEvaluation at;
    view.Resize(&at);
    const Eigen::Vector2d y(0.25, 4.0);
    ASSERT_TRUE(view.Evaluate(y.data(), {.gradient = true, .hessian = true}, {}, &at)) << width;
    const double slope = 8.0 * (std::log(0.25) - 1.0);
    EXPECT_NEAR(at.gradient[0], width > 0.0 ? slope : 0.0, 1e-5) << width;
  }
  // Beyond its bounds a point has slopes, too.
  const Problem narrow = BoundedLogarithms({0.5, 0.5}, {1.0, 1.0});
  const View beyond(narrow);
  ViewEvaluation at;
  beyond.Resize(&at);
  const Eigen::Vector2d y(2.0, 0.3);
  ASSERT_TRUE(beyond.Evaluate(y.data(), {.gradient = true}, {}, &at));
  EXPECT_NEAR(at.gradient[0], std::log(2.0) - 1.0, 1e-9);
  for (const char* backend : {"banded", "lbfgs", "ipopt", "nlopt-lbfgs", "nlopt-slsqp"}) {
    const Problem problem = BoundedLogarithms({0.25, 0.25}, {4.0, 2.0});
    const View view(problem);
    const auto solver = MakeBackend(StandardBackends(), backend);
    if (!solver->Refusal(view).empty()) continue;
    const SolverResult result = Solve(problem, Eigen::Vector2d(0.25, 0.25), backend);
    EXPECT_NEAR(result.x[0], std::exp(1.0), 1e-4) << backend << " " << result.message;
    EXPECT_NEAR(result.x[1], 2.0, 1e-4) << backend << " " << result.message;
  }
}

}  // namespace
}  // namespace touchdown::solvers
