// SPDX-License-Identifier: BSD-3-Clause
// Every registered term, on every view, as cost and as rows, against central differences. A new
// term is covered by being registered. Maps with derivatives by hand are also compared with
// automatic differentiation, to rounding.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "planning/problem/random_context.h"
#include "planning/problem/terms/norm_limit.h"
#include "planning/problem/terms/smoothness.h"
#include "touchdown/planning/problem/term_check.h"

namespace touchdown::planning {
namespace {

TEST(TermDerivatives, EveryTermOnEveryView) {
  for (const TermEntry& entry : StandardTerms()) {
    SCOPED_TRACE(entry.info.name);
    const std::vector<TermCheckRow> rows = CheckTerm(entry, {});
    EXPECT_EQ(Complaint(rows), "");
    for (const TermCheckRow& row : rows) {
      if (row.points == 0) {
        EXPECT_NE(row.point, CheckedPoint::kRandom);
        continue;
      }
      SCOPED_TRACE(testing::Message() << "view " << static_cast<int>(row.view) << " arrival "
                                      << static_cast<int>(row.arrival) << " hard " << row.hard
                                      << " point " << static_cast<int>(row.point));
      EXPECT_TRUE(row.errors.evaluated);
      EXPECT_LT(row.errors.gradient, kTermCheckTolerance);
      EXPECT_LT(row.errors.hessian, kTermCheckTolerance);
      EXPECT_LT(row.errors.residual_jacobian, kTermCheckTolerance);
      EXPECT_LT(row.errors.row_jacobian, kTermCheckTolerance);
    }
  }
}

/// u = |q|^2 with half of its gradient.
struct Wrong {
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = false;
  int windows() const { return 4; }
  int first_block(int k) const { return k + 4; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
  }
  void Jacobian(int k, const double* q, double h, double t, double* u, double* du,
                double* du_dh) const {
    (*this)(k, q, h, t, u);
    for (int c = 0; c < 3; ++c) du[c] = q[c];
    du_dh[0] = 0.0;
  }
};

TEST(TermDerivatives, AWrongOneIsFound) {
  TermEntry entry;
  entry.info.name = "wrong";
  entry.make = [](const TermSetup&) {
    return MakeLandingTerm({"wrong"}, Wrong{}, solvers::SquareLoss(1.0), 4);
  };
  EXPECT_FALSE(Passed(CheckTerm(entry, {})));
  std::vector<TermCheckRow> rows(1);
  rows[0].points = rows[0].windows = 1;
  rows[0].errors = {.evaluated = true, .gradient = 0.1};
  EXPECT_NE(Complaint(rows).find("disagree"), std::string::npos);
  rows[0].errors = {.evaluated = true, .residual_jacobian = std::nan("")};
  EXPECT_NE(Complaint(rows).find("derivative is not finite"), std::string::npos);
}

/// q_x^2 - q_y^2 + c on `count` control points.
struct Saddle {
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = false;
  int count;
  double c;
  int windows() const { return count; }
  int first_block(int k) const { return k + 4; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = q[0] * q[0] - q[1] * q[1] + c;
  }
};

/// Saddle as a sum of squares, which has no edge.
struct Above : Saddle {
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + c;
  }
};

template <class Map>
std::string ComplaintOf(const Map& map, bool convex) {
  TermEntry entry;
  entry.info.name = "term";
  entry.info.convex = convex;
  entry.make = [=](const TermSetup& setup) {
    return MakeLandingTerm(entry.info, map, solvers::HingeLoss(setup.weight, 1.0), 4);
  };
  return Complaint(CheckTerm(entry, {}));
}

TEST(TermDerivatives, WhatWasNotComparedIsNotPassed) {
  EXPECT_EQ(ComplaintOf(Saddle{4, 0.0}, false), "");
  EXPECT_NE(ComplaintOf(Saddle{4, 0.0}, true).find("convex"), std::string::npos);
  EXPECT_NE(ComplaintOf(Saddle{0, 0.0}, false).find("no window"), std::string::npos);
  EXPECT_EQ(ComplaintOf(Above{{4, -1.0}}, true), "");
  EXPECT_NE(ComplaintOf(Above{{4, 1.0}}, true).find("edge"), std::string::npos);
}

/// NaN wherever a random landing flies.
struct Log : Saddle {
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    using std::log;
    u[0] = log(q[0] - 100.0);
  }
};

TEST(TermDerivatives, WhatIsNoNumberIsSaidToBeNone) {
  TermEntry entry;
  entry.info.name = "log";
  entry.make = [&](const TermSetup&) {
    return MakeLandingTerm(entry.info, Log{{4, 0.0}}, solvers::SquareLoss(1.0), 4);
  };
  EXPECT_NE(Complaint(CheckTerm(entry, {})).find("could not be evaluated"), std::string::npos);
  const std::string hinged = ComplaintOf(Log{{4, 0.0}}, false);
  EXPECT_NE(hinged.find("not finite"), std::string::npos) << hinged;
}

/// Draws of a check with windows that only a fixed end acceleration has.
TEST(TermDerivatives, BothEndsAreChecked) {
  bool seen[2] = {false, false};
  TermEntry entry;
  entry.info.name = "term";
  entry.make = [&](const TermSetup& setup) {
    seen[setup.free_end_acceleration] = true;
    return MakeLandingTerm(entry.info, Saddle{4, 0.0}, solvers::SquareLoss(1.0), 4);
  };
  EXPECT_EQ(Complaint(CheckTerm(entry, {})), "");
  EXPECT_TRUE(seen[false] && seen[true]);
}

/// A map without its derivatives by hand.
template <class Inner>
struct Plain {
  static constexpr int kBlockSize = Inner::kBlockSize, kWindow = Inner::kWindow,
                       kOutputs = Inner::kOutputs;
  static constexpr bool kUsesInterval = Inner::kUsesInterval;
  static constexpr bool kLinearInBlocks = Inner::kLinearInBlocks;
  Inner inner;
  int windows() const { return inner.windows(); }
  int first_block(int k) const { return inner.first_block(k); }
  template <class T>
  void operator()(int k, const T* q, const T& h, const T& t, T* u) const {
    inner(k, q, h, t, u);
  }
};

template <class Inner, class Loss>
void CompareWithDuals(Inner inner, const Loss& loss) {
  using solvers::Role;
  constexpr int kPoints = 12;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  for (int trial = 0; trial < 40; ++trial) {
    const RandomContext context(kPoints - 3, 0, 0, random);
    inner.Update(context.get());
    solvers::ProblemShape shape;
    shape.blocks = kPoints;
    shape.free_interval = trial % 2 == 1;
    const Role role = trial % 4 < 2 ? Role::kCost : Role::kConstraint;
    solvers::Problem by_hand(shape), by_duals(shape);
    by_hand.AddTerm(MakeLandingTerm({"by_hand"}, inner, loss, inner.windows()), role);
    by_duals.AddTerm(MakeLandingTerm({"by_duals"}, Plain<Inner>{inner}, loss, inner.windows()),
                     role);
    std::vector<double> x(3 * kPoints), multipliers(6 * kPoints);
    for (double& number : x) number = draw(random);
    for (double& number : multipliers) number = draw(random);
    const solvers::RowWeights rows{.multiplier = multipliers.data()};
    // Every third evaluation is at another interval than the map was given.
    const double h = context.get().interval * (trial % 3 == 0 ? 1.3 : 1.0);
    solvers::Evaluation a, b;
    for (auto [problem, e] : {std::pair{&by_hand, &a}, {&by_duals, &b}}) {
      problem->set_t0(context.get().t0);
      problem->Resize(e);
      ASSERT_TRUE(
          problem->Evaluate(x.data(), h, {.gradient = true, .hessian = true}, {.rows = &rows}, e));
    }
    const auto expect_same = [](double mine, double dual) {
      EXPECT_NEAR(mine, dual, 1e-12 * (1.0 + std::abs(dual)));
    };
    const int n = 3 * kPoints + (shape.free_interval ? 1 : 0);
    expect_same(a.value, b.value);
    for (int i = 0; i < n; ++i) {
      expect_same(a.gradient[i], b.gradient[i]);
      expect_same(a.row_gradient[i], b.row_gradient[i]);
      for (int j = 0; j < n; ++j) expect_same(a.hessian.At(i, j), b.hessian.At(i, j));
    }
    for (std::size_t i = 0; i < a.terms[0].du.size(); ++i) {
      expect_same(a.terms[0].du[i], b.terms[0].du[i]);
    }
  }
}

TEST(TermDerivatives, ByHandAsByDuals) {
  CompareWithDuals(SegmentDerivatives(9, 0.1), solvers::SquareLoss(2.0));
  for (const bool may_recover : {false, true}) {
    CompareWithDuals(DerivativeNorm<1>(8, 3.0, 0.7 / 3.0, may_recover),
                     solvers::HingeLoss(10.0, 0.3));
    CompareWithDuals(DerivativeNorm<2>(9, 6.0, 2.0 / 6.0, may_recover),
                     solvers::HingeLoss(10.0, 0.3));
  }
}

}  // namespace
}  // namespace touchdown::planning
