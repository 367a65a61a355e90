// SPDX-License-Identifier: BSD-3-Clause
// The check of optimality, and the status of claims that it does not confirm.

#include "touchdown/solvers/backend/optimality.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include "solvers/test/every_backend.h"
#include "touchdown/solvers/problem/loss.h"
#include "touchdown/solvers/problem/window_term.h"
#include "touchdown/solvers/problems/hock_schittkowski.h"
#include "touchdown/solvers/problems/more_garbow_hillstrom.h"

namespace touchdown::solvers {
namespace {

Optimality LookAt(const ReferenceProblem& p, const std::vector<double>& point) {
  const View view(*p.problem);
  OptimalityCheck check;
  check.Prepare(view);
  ViewEvaluation storage;
  view.Resize(&storage);
  view.Evaluate(p.start.data(), {}, {}, &storage);
  const double first = storage.full.value;
  const Eigen::Map<const Eigen::VectorXd> y(point.data(), static_cast<Eigen::Index>(point.size()));
  return check.Look(view, y, SolverResult(), first, {}, &storage);
}

/// 100 (x1 - x0^2)^2 + (1 - x0)^2, times a factor and with a constant.
ReferenceProblem ScaledRosenbrock(double factor, double constant) {
  return SmallProblem("rosenbrock", {-1.2, 1.0}, constant, EqualityForm::kRows)
      .Cost([=](const auto* x, auto* u) {
        const auto a = x[1] - x[0] * x[0], b = 1.0 - x[0];
        u[0] = factor * (100.0 * a * a + b * b) + constant;
      });
}

TEST(Optimality, DoesNotChangeWithTheCostsUnitOrAConstant) {
  for (const auto& [factor, constant] :
       {std::pair(1.0, 0.0), {1e-12, 0.0}, {1e9, 0.0}, {1.0, 1e6}}) {
    const ReferenceProblem p = ScaledRosenbrock(factor, constant);
    EXPECT_TRUE(LookAt(p, {1.0, 1.0}).stationary()) << factor;
    // With a large unit, too, little of the cost may be left: its optimum is 0.
    const double off = factor > 1.0 ? 1e-9 : 1e-7;
    EXPECT_TRUE(LookAt(p, {1.0 + off, 1.0 + 2.0 * off}).stationary()) << factor;
    EXPECT_FALSE(LookAt(p, {0.99, 0.98}).stationary()) << factor;
    EXPECT_FALSE(LookAt(p, {-1.2, 1.0}).stationary()) << factor;
  }
}

TEST(Optimality, ARowsUnitDoesNotChangeWhatCountsAsFeasible) {
  for (const double unit : {1e-7, 1.0, 1e7}) {
    const ReferenceProblem p =
        SmallProblem("row", {3.0}, 1.0, EqualityForm::kRows)
            .Squares(1, [](const auto* x, auto* u) { u[0] = x[0]; })
            .AtLeastZero(1, [=](const auto* x, auto* u) { u[0] = unit * (x[0] - 1.0); });
    EXPECT_TRUE(LookAt(p, {1.0}).feasible() && LookAt(p, {1.0}).stationary()) << unit;
    EXPECT_FALSE(LookAt(p, {0.99}).feasible()) << unit;
    EXPECT_FALSE(LookAt(p, {1.01}).stationary()) << unit;
  }
}

TEST(Optimality, ASaddleIsNoMinimum) {
  const ReferenceProblem p = SmallProblem("saddle", {0.5, 0.5}, -1.0, EqualityForm::kRows)
                                 .Cost([](const auto* x, auto* u) { u[0] = x[0] * x[1]; })
                                 .BoundAll(-1.0, 1.0);
  EXPECT_TRUE(LookAt(p, {0.0, 0.0}).saddle);
  const Optimality corner = LookAt(p, {1.0, -1.0});
  EXPECT_TRUE(corner.stationary() && !corner.saddle);
  EXPECT_FALSE(LookAt(p, {1.0, 1.0}).stationary()) << "its multipliers have the wrong sign";
}

TEST(Optimality, ANeighbourThatCostsLessRefutesAPoint) {
  // -x^2 where only one side is allowed: its bound does not push.
  const ReferenceProblem edge = SmallProblem("edge", {0.5}, -1.0, EqualityForm::kRows)
                                    .Cost([](const auto* x, auto* u) { u[0] = -x[0] * x[0]; })
                                    .Bound(0, 0.0, 1.0);
  EXPECT_TRUE(LookAt(edge, {0.0}).saddle);
  EXPECT_FALSE(LookAt(edge, {1.0}).saddle);
  const ReferenceProblem bend =
      SmallProblem("bend", {0.5}, 0.0, EqualityForm::kRows).Cost([](const auto* x, auto* u) {
        u[0] = x[0] * x[0] * x[0];
      });
  EXPECT_TRUE(LookAt(bend, {0.0}).stationary());
  EXPECT_TRUE(LookAt(bend, {0.0}).saddle);
  for (const EqualityForm form : {EqualityForm::kRows, EqualityForm::kPairs}) {
    for (const double sign : {1.0, -1.0}) {
      // Along the row the cost is 1 - t^2 / 2 or its opposite, and nothing pushes.
      const ReferenceProblem top =
          SmallProblem("circle", {1.0, 0.5}, -1.0, form)
              .Cost([sign](const auto* x, auto* u) { u[0] = sign * x[1]; })
              .Zero(1, [](const auto* x, auto* u) { u[0] = x[0] * x[0] + x[1] * x[1] - 1.0; });
      const Optimality at = LookAt(top, {0.0, 1.0});
      EXPECT_TRUE(at.stationary());
      EXPECT_EQ(at.saddle, sign > 0.0);
    }
  }
}

TEST(Optimality, NeitherAConstantNorAWideUnitHidesASaddle) {
  for (const double constant : {0.0, 1e5, -1e7}) {
    const ReferenceProblem p = SmallProblem("wells", {3.0, 0.0}, constant, EqualityForm::kRows)
                                   .Cost([=](const auto* x, auto* u) {
                                     const auto a = x[0] - 1.0, b = x[1] * x[1] - 1.0;
                                     u[0] = constant + a * a + b * b;
                                   });
    EXPECT_TRUE(LookAt(p, {1.0, 0.0}).saddle) << constant;
    EXPECT_FALSE(LookAt(p, {1.0, 1.0}).saddle) << constant;
  }
  for (const double width : {200.0, 1000.0}) {
    const ReferenceProblem p = SmallProblem("wide", {3.0, 0.0}, 0.0, EqualityForm::kRows)
                                   .Squares(2, [=](const auto* x, auto* u) {
                                     u[0] = x[0] - 1.0;
                                     u[1] = x[1] * x[1] / (width * width) - 1.0;
                                   });
    EXPECT_TRUE(LookAt(p, {1.0, 0.0}).saddle) << width;
    EXPECT_FALSE(LookAt(p, {1.0, width}).saddle) << width;
  }
}

TEST(Optimality, NearAnInflectionItCurvesUpwardsOnOneSide) {
  const ReferenceProblem p =
      SmallProblem("inflection", {1.0, 1.0}, 0.0, EqualityForm::kRows)
          .Cost([](const auto* x, auto* u) { u[0] = x[0] * x[0] * x[0] + x[1] * x[1]; });
  for (const double away : {0.0, 1e-9, 1e-7, 1e-5, 3e-4})
    EXPECT_TRUE(LookAt(p, {away, 0.0}).saddle);
}

TEST(Optimality, OfSeveralFlatWaysOneMayGoDown) {
  const ReferenceProblem quartic = SmallProblem("quartic", {1.0, 0.0}, 0.0, EqualityForm::kRows)
                                       .Cost([](const auto* x, auto* u) {
                                         const auto a = x[0] * x[0], b = x[1] * x[1];
                                         u[0] = a * a - b * b + b * b * b;
                                       });
  EXPECT_TRUE(LookAt(quartic, {0.0, 0.0}).saddle);
  const ReferenceProblem cross =
      SmallProblem("cross", {0.5, 0.5}, 0.0, EqualityForm::kRows).Cost([](const auto* x, auto* u) {
        const auto a = x[0] * x[0], b = x[1] * x[1];
        u[0] = 6.0 * a * b - a * a - b * b + a * a * a + b * b * b;
      });
  EXPECT_TRUE(LookAt(cross, {0.0, 0.0}).saddle);
  // Two curved pairs: the one that curves more is kept by its bounds.
  const ReferenceProblem pairs =
      SmallProblem("pairs", {1.0, 1.0, 0.0, 0.0}, -0.125, EqualityForm::kRows)
          .Cost([](const auto* x, auto* u) {
            const auto c = x[2] * x[2], d = x[3] * x[3];
            u[0] = 0.5 * (x[0] * x[0] + x[1] * x[1]) + 10.0 * x[0] * x[1] + 0.5 * (c + d) -
                   2.0 * x[2] * x[3] + c * c + d * d;
          })
          .BoundAll(0.0, SmallProblem::kInfinity);
  EXPECT_TRUE(LookAt(pairs, {0.0, 0.0, 0.0, 0.0}).saddle);
}

TEST(Optimality, AnInflectionIsNoMinimum) {
  const ReferenceProblem cubic = SmallProblem("cubic", {-1.0, 0.3}, 0.0, EqualityForm::kRows)
                                     .Squares(2, [](const auto* x, auto* u) {
                                       u[0] = x[0] * x[0] * x[0] - 8.0;
                                       u[1] = x[1] - 1.0;
                                     });
  EXPECT_FALSE(LookAt(cubic, {0.0, 1.0}).stationary() && !LookAt(cubic, {0.0, 1.0}).saddle);
  const Optimality before = LookAt(cubic, {-0.0042, 1.0});
  EXPECT_FALSE(before.stationary() && !before.saddle);
  for (const double scale : {1.0, 1e3}) {
    const ReferenceProblem p = SmallProblem("shelf", {-1.0}, -1.0 / 12.0, EqualityForm::kRows)
                                   .Cost([=](const auto* x, auto* u) {
                                     const auto t = scale * x[0];
                                     u[0] = t * t * t * t * 0.25 - t * t * t / 3.0;
                                   });
    EXPECT_TRUE(LookAt(p, {0.0}).saddle) << scale;
    EXPECT_FALSE(LookAt(p, {1.0 / scale}).saddle) << scale;
  }
}

/// Peano's surface (y - steep x^2) (y - 3 x^2) and a bowl around it, turned by an angle: of all lines
/// through 0 each has its minimum there, and between two parabolas it falls.
ReferenceProblem PeanosSurface(double steep, double angle, std::vector<double> start) {
  const double c = std::cos(angle), s = std::sin(angle);
  return SmallProblem("peano", std::move(start), -0.0822405634, EqualityForm::kRows)
      .Cost([=](const auto* q, auto* u) {
        const auto x = c * q[0] + s * q[1], y = c * q[1] - s * q[0], far = x * x + y * y;
        u[0] = (y - steep * x * x) * (y - 3.0 * x * x) + 0.1 * far * far * far;
      });
}

TEST(Optimality, AValleyThatBendsIsFollowed) {
  for (const double steep : {1.0, 2.0}) {
    for (const double angle : {0.0, 0.4, 1.2}) {
      EXPECT_TRUE(LookAt(PeanosSurface(steep, angle, {0.0, 0.0}), {0.0, 0.0}).saddle) << angle;
    }
  }
  const auto surface = [](const auto* x) {
    return (x[1] - x[0] * x[0]) * (x[1] - 3.0 * x[0] * x[0]);
  };
  // Its variables beside others, on a row, in a plane of flat ways, at a bound.
  const ReferenceProblem beside =
      SmallProblem("beside", {0.0, 0.0, 0.0}, 0.0, EqualityForm::kRows)
          .Cost([=](const auto* x, auto* u) {
            const auto a = x[2] - 0.5 * x[1] + 0.3 * x[0] * x[0];
            u[0] = surface(x) + 1e6 * a * a;
          });
  EXPECT_TRUE(LookAt(beside, {0.0, 0.0, 0.0}).saddle);
  const ReferenceProblem row = SmallProblem("row", {0.0, 0.0, 0.0}, 0.0, EqualityForm::kRows)
                                   .Cost([](const auto* x, auto* u) { u[0] = x[2]; })
                                   .AtLeastZero(1, [=](const auto* x, auto* u) {
                                     u[0] = x[2] - surface(x);
                                   });
  EXPECT_TRUE(LookAt(row, {0.0, 0.0, 0.0}).saddle);
  const ReferenceProblem plane = SmallProblem("plane", {0.0, 0.0, 0.0}, 0.0, EqualityForm::kRows)
                                     .Cost([](const auto* x, auto* u) {
                                       const auto a = x[0] * x[0], b = x[1] * x[1];
                                       u[0] = (x[2] - a - 2.0 * b) * (x[2] - 3.0 * a - 5.0 * b);
                                     });
  EXPECT_TRUE(LookAt(plane, {0.0, 0.0, 0.0}).saddle);
  for (const double side : {1.0, -1.0}) {
    const ReferenceProblem edge =
        SmallProblem("edge", {0.0, 0.0}, 0.0, EqualityForm::kRows)
            .Cost([=](const auto* x, auto* u) { u[0] = surface(x); })
            .Bound(1, side > 0.0 ? 0.0 : -1.0, side > 0.0 ? 1.0 : 0.0);
    EXPECT_EQ(LookAt(edge, {0.0, 0.0}).saddle, side > 0.0) << side;
  }
  // Floors that do not fall.
  for (const double fill : {1.01, 2.0}) {
    const ReferenceProblem filled =
        SmallProblem("filled", {0.0, 0.0}, 0.0, EqualityForm::kRows)
            .Cost([=](const auto* x, auto* u) {
              u[0] = surface(x) + fill * x[0] * x[0] * x[0] * x[0];
            });
    EXPECT_FALSE(LookAt(filled, {0.0, 0.0}).saddle) << fill;
  }
}

TEST(Optimality, AStiffDirectionDoesNotHideASaddle) {
  for (const double stiff : {1e6, 1e9, 1e12}) {
    const ReferenceProblem p = SmallProblem("stiff", {1.5, 0.1}, -0.0625, EqualityForm::kRows)
                                   .Cost([=](const auto* x, auto* u) {
                                     const auto a = x[0] - 1.0, b = x[1] * x[1];
                                     u[0] = 0.5 * stiff * a * a - 0.5 * b + b * b;
                                   });
    EXPECT_TRUE(LookAt(p, {1.0, 0.0}).saddle) << stiff;
    EXPECT_FALSE(LookAt(p, {1.0, 0.5}).saddle) << stiff;
  }
}

TEST(Optimality, AValleyBehindARiseIsAnotherOptimums) {
  // A strict minimum 60,000 away from 0: a hundredth of that is a hundred waves.
  const ReferenceProblem p =
      SmallProblem("waves", {62832.1}, 0.0, EqualityForm::kRows).Cost([](const auto* x, auto* u) {
        using std::cos;
        u[0] = -cos(x[0]) + 1e-3 * x[0];
      });
  const Optimality at = LookAt(p, {2e4 * std::acos(-1.0) - std::asin(1e-3)});
  EXPECT_TRUE(at.stationary() && !at.saddle);
}

TEST(Optimality, ACornerWhereNothingPushesIsNoMinimum) {
  const std::vector<std::pair<std::string, std::vector<double>>> corners = {
      {"HS24", {0.0, 0.0}},
      {"HS29", {0.0, 0.0, 0.0}},
      {"HS33", {0.0, 0.0, 2.0}},
      {"HS45", {0.0, 0.0, 1.0, 1.0, 1.0}}};
  for (const ReferenceProblem& p : HockSchittkowski()) {
    for (const auto& [name, corner] : corners) {
      if (p.name != name) continue;
      EXPECT_TRUE(LookAt(p, corner).saddle) << name;
    }
  }
}

TEST(Optimality, AMetricThatIsLostToRoundingProvesNothing) {
  // Least squares with weights up to 1e14 along a row, all of it oblique: softly falling ways are
  // below its rounding.
  const ReferenceProblem p =
      SmallProblem("oblique", {1.5, -1.0, 0.5}, 0.0, EqualityForm::kRows)
          .Squares(3,
                   [](const auto* x, auto* u) {
                     const auto a = x[0] - 1.0, b = x[1] - 1.0, c = x[2] - 1.0;
                     u[0] = 1e7 * (a + 0.7 * b - 0.4 * c);
                     u[1] = 3e3 * (0.3 * a - b + 0.9 * c);
                     u[2] = 0.8 * a + 0.5 * b + c;
                   })
          .Zero(1, [](const auto* x, auto* u) { u[0] = x[0] - 0.6 * x[1] + 0.2 * x[2] - 0.6; });
  EXPECT_TRUE(LookAt(p, {1.0, 1.0, 1.0}).stationary());
  // On the row and the stiffest plane, which leave one way: rounding is all that its cost of 0.01
  // shares with the metric.
  const Eigen::Vector3d way =
      Eigen::Vector3d(1.0, -0.6, 0.2).cross(Eigen::Vector3d(1.0, 0.7, -0.4));
  for (const double away : {1e-3, 1e-2, 1e-1}) {
    const Eigen::Vector3d at = Eigen::Vector3d::Ones() + away * way;
    EXPECT_FALSE(LookAt(p, {at[0], at[1], at[2]}).stationary()) << away;
  }
}

TEST(Optimality, WhatWasGainedDoesNotHideWhatIsLeft) {
  ReferenceProblem p =
      SmallProblem("quartic", {1001.0}, 0.0, EqualityForm::kRows).Cost([](const auto* x, auto* u) {
        const auto a = (x[0] - 1.0) * (x[0] - 1.0);
        u[0] = a * a;
      });
  EXPECT_FALSE(LookAt(p, {4.43}).stationary()) << "137 of 1e12 are left";
  EXPECT_TRUE(LookAt(p, {1.001}).stationary());
}

TEST(Optimality, ALargeVariableDoesNotHideASmallOne) {
  const auto far = [](const auto* x, auto* u) {
    u[0] = x[0] - 1e6;
    u[1] = x[1];
  };
  const ReferenceProblem p =
      SmallProblem("far", {1e6, 0.5}, 0.0, EqualityForm::kRows).Squares(2, far);
  EXPECT_FALSE(LookAt(p, {1e6, 0.5}).stationary());
  EXPECT_TRUE(LookAt(p, {1e6, 1e-7}).stationary());
  const ReferenceProblem row = SmallProblem("far", {1e6, 0.5}, 1.0, EqualityForm::kRows)
                                   .Squares(2, far)
                                   .Zero(1, [](const auto* x, auto* u) { u[0] = x[1] - 1.0; });
  EXPECT_FALSE(LookAt(row, {1e6, 0.0}).feasible());
  EXPECT_TRUE(LookAt(row, {1e6, 1.0}).feasible());
}

TEST(Optimality, FarOutASmallShareOfAVariableIsALongWay) {
  const ReferenceProblem wave =
      SmallProblem("wave", {0.0}, -1.0, EqualityForm::kRows).Cost([](const auto* x, auto* u) {
        using std::sin;
        u[0] = sin(x[0]);
      });
  const double lowest = 1.5 * std::acos(-1.0);
  EXPECT_TRUE(LookAt(wave, {lowest}).stationary());
  EXPECT_FALSE(LookAt(wave, {lowest + 2e5 * std::acos(-1.0) + 0.5}).stationary());
}

TEST(Optimality, WhatWasGainedDoesNotHideBoundsThatAreNotReached) {
  const ReferenceProblem p =
      SmallProblem("gap", {1e3, 1.0}, 0.0, EqualityForm::kRows)
          .Cost([](const auto* x, auto* u) { u[0] = 1e4 * (x[0] - 1.0) * (x[0] - 1.0) + x[1]; })
          .Bound(1, 0.0, SmallProblem::kInfinity);
  EXPECT_FALSE(LookAt(p, {1.0, 1.5e-5}).stationary());
  EXPECT_TRUE(LookAt(p, {1.0, 1e-8}).stationary());
}

TEST(Optimality, OfTwoBoundsThatAreBothNearTheNearerOneCounts) {
  for (const double width : {1e-4, 1e-6}) {
    const ReferenceProblem p = SmallProblem("narrow", {0.5, 0.5 * width}, 1.0, EqualityForm::kRows)
                                   .Squares(2,
                                            [](const auto* x, auto* u) {
                                              u[0] = x[0];
                                              u[1] = x[1] + 1.0;
                                            })
                                   .Bound(1, 0.0, width);
    EXPECT_TRUE(LookAt(p, {0.0, 0.0}).stationary()) << width;
  }
}

TEST(Optimality, AMultiplierThatIsRoundingIsNone) {
  const ReferenceProblem p = SmallProblem("corner", {-1.0, 1.0}, 1.0, EqualityForm::kRows)
                                 .Squares(2,
                                          [](const auto* x, auto* u) {
                                            u[0] = 10.0 * (x[1] - x[0] * x[0]);
                                            u[1] = 1.0 - x[0];
                                          })
                                 .AtLeastZero(2, [](const auto* x, auto* u) {
                                   u[0] = x[1] * x[1] - x[0];
                                   u[1] = x[0] * x[0] - x[1];
                                 });
  EXPECT_TRUE(LookAt(p, {5.19e-17, 1.4e-18}).stationary());
}

using Foot = OptimalityCheck::Foot;

Foot FootFrom(const ReferenceProblem& p, const Eigen::VectorXd& start,
              const OptimalityCheck::MustStop& must_stop = {}) {
  const View view(*p.problem);
  OptimalityCheck check;
  check.Prepare(view);
  ViewEvaluation storage;
  view.Resize(&storage);
  return check.StepOntoRows(view, start, must_stop, &storage);
}

TEST(Optimality, RowsAreInfeasibleWhereNoStepsLeadToAPointThatMeetsThem) {
  for (const double other : {3.0, 4.0}) {
    const ReferenceProblem p = SmallProblem("twice", {0.0, 0.0}, 0.0, EqualityForm::kRows)
                                   .Squares(1, [](const auto* x, auto* u) { u[0] = x[0] - x[1]; })
                                   .Zero(2, [=](const auto* x, auto* u) {
                                     u[0] = x[0] + x[1] - 3.0;
                                     u[1] = 2.0 * (x[0] + x[1] - other);
                                   });
    for (const double x : {1.6, 2.5, 1e3}) {
      const Foot foot = FootFrom(p, Eigen::Vector2d(x, x));
      EXPECT_EQ(foot, other == 3.0 ? Foot::kMeets : Foot::kLeast) << other << " from " << x;
    }
  }
}

TEST(Optimality, RowsAreNotInfeasibleWhereNothingIsSeenOfThem) {
  // The root has no value beside the point, and its slope has none at it.
  const ReferenceProblem p = SmallProblem("root", {0.0}, 0.0, EqualityForm::kRows)
                                 .Squares(1, [](const auto* x, auto* u) { u[0] = x[0]; })
                                 .Zero(1, [](const auto* x, auto* u) {
                                   using std::sqrt;
                                   u[0] = sqrt(-x[0] * x[0]) - 1.0;
                                 });
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(1);
  EXPECT_EQ(FootFrom(p, start), Foot::kUnknown);
  EXPECT_EQ(FootFrom(p, start, [] { return true; }), Foot::kUnknown);
}

TEST(Optimality, InACornerTheRowsMayBeMetWithinTheBounds) {
  // Down the slope, x leaves its bound while y is held.
  const ReferenceProblem p = SmallProblem("corner", {0.0, 0.0}, 0.0, EqualityForm::kRows)
                                 .Squares(1, [](const auto* x, auto* u) { u[0] = x[0]; })
                                 .Zero(1, [](const auto* x, auto* u) { u[0] = x[0] - x[1] - 1.0; })
                                 .BoundAll(0.0, SmallProblem::kInfinity);
  EXPECT_EQ(FootFrom(p, Eigen::VectorXd::Zero(2)), Foot::kMeets);
}

TEST(Optimality, EndsWhereItIsToldTo) {
  const ReferenceProblem p = ScaledRosenbrock(1.0, 0.0);
  const View view(*p.problem);
  OptimalityCheck check;
  check.Prepare(view);
  ViewEvaluation storage;
  view.Resize(&storage);
  const Eigen::VectorXd optimum = Eigen::VectorXd::Ones(2);
  const Optimality whole = check.Look(view, optimum, SolverResult(), 24.2, {}, &storage);
  EXPECT_GT(whole.evaluations, 2);
  int asked = 0;
  const Optimality cut = check.Look(
      view, optimum, SolverResult(), 24.2, [&asked] { return ++asked > 1; }, &storage);
  EXPECT_EQ(cut.evaluations, 1);
}

TEST(Optimality, WhatAShortStepLeavesIsLittleOfTheCost) {
  const ReferenceProblem p = SmallProblem("units", {1.0, 1.0}, 0.0, EqualityForm::kRows)
                                 .Squares(3, [](const auto* x, auto* u) {
                                   u[0] = x[0] - 1e6;
                                   u[1] = x[1] - 2e-6;
                                   u[2] = x[0] * x[1] - 2.0;
                                 });
  EXPECT_FALSE(LookAt(p, {1e6, 2e-6 * (1.0 - 2e-3)}).stationary()) << "1.6e-5 of 1e12 are left";
  EXPECT_TRUE(LookAt(p, {1e6, 2e-6}).stationary());
}

TEST(Optimality, MoreKnownOptimaPass) {
  for (const ReferenceProblem& p : MoreGarbowHillstrom()) {
    const View view(*p.problem);
    const auto banded = MakeBackend(StandardBackends(), "banded");
    banded->Prepare(view);
    SolverResult result;
    banded->Solve(view, p.start, {.max_iterations = 1000}, &result);
    EXPECT_EQ(result.status, SolveStatus::kConverged) << p.name;
    EXPECT_LT(p.Off(result.cost), 1e-6) << p.name << ": " << result.cost;
  }
}

TEST(Optimality, KnownOptimaOfTheSetPass) {
  // The optimum by the most exact backend available; it has the published cost.
  const BackendRegistry backends = StandardBackends();
  const auto ipopt = MakeBackend(backends, "ipopt");
  if (!ipopt->capabilities().compiled) GTEST_SKIP() << "without Ipopt there is nobody to ask";
  int found = 0;
  for (const EqualityForm form : {EqualityForm::kRows, EqualityForm::kPairs}) {
    for (const ReferenceProblem& p : HockSchittkowski(form)) {
      const View view(*p.problem);
      ipopt->Prepare(view);
      SolverResult result;
      ipopt->Solve(view, p.start, {.max_iterations = 1000}, &result);
      if (result.status != SolveStatus::kConverged) continue;
      ++found;
      EXPECT_LT(p.Off(result.cost), 2e-6) << p.name << ": " << result.cost;
    }
  }
  EXPECT_GT(found, 115);  // of 136
}

class ClaimsOfEveryBackend : public EveryBackend {
 protected:
  SolverResult SolveReference(const ReferenceProblem& p) {
    const View view(*p.problem);
    auto backend = Make();
    SolverResult result;
    if (!backend->Refusal(view).empty()) return result;  // numerical failure: no claim
    backend->Prepare(view);
    backend->Solve(view, p.start, {.max_iterations = 300}, &result);
    return result;
  }
};

TEST_P(ClaimsOfEveryBackend, NobodyClaimsWhatIsNone) {
  const auto line = [](const auto* x, auto* u) { u[0] = x[0]; };
  const ReferenceProblem unbounded =
      SmallProblem("unbounded", {0.0}, 0.0, EqualityForm::kRows).Cost(line);
  EXPECT_NE(SolveReference(unbounded).status, SolveStatus::kConverged);
  const ReferenceProblem hill = SmallProblem("hill", {0.0}, -4.0, EqualityForm::kRows)
                                    .Cost([](const auto* x, auto* u) { u[0] = -x[0] * x[0]; })
                                    .Bound(0, -1.0, 2.0);
  const SolverResult top = SolveReference(hill);
  if (top.status == SolveStatus::kConverged) {
    EXPECT_LT(top.cost, -1.0 + 1e-6);
  }
  // Three times the same equality, one of them moved: no point meets all.
  for (const double other : {1.0, 2.0}) {
    const ReferenceProblem thrice = SmallProblem("thrice", {0.3, 0.0}, 0.5, EqualityForm::kRows)
                                        .Squares(2,
                                                 [](const auto* x, auto* u) {
                                                   u[0] = x[0];
                                                   u[1] = x[1];
                                                 })
                                        .Zero(3, [=](const auto* x, auto* u) {
                                          u[0] = x[0] + x[1] - 1.0;
                                          u[1] = x[0] + x[1] - 1.0;
                                          u[2] = x[0] + x[1] - other;
                                        });
    const SolverResult result = SolveReference(thrice);
    if (result.status == SolveStatus::kConverged) {
      EXPECT_EQ(other, 1.0);
      EXPECT_NEAR(result.cost, 0.5, 1e-6);
    }
  }
}

TEST_P(ClaimsOfEveryBackend, NeitherUnboundedNorInfeasibleHasAUnit) {
  for (const double factor : {1e-6, 1.0, 1e13}) {
    const ReferenceProblem bowl = SmallProblem("bowl", {0.0, 0.0}, -factor, EqualityForm::kRows)
                                      .Cost([=](const auto* x, auto* u) {
                                        u[0] = factor * (x[0] * x[0] - 2.0 * x[0] + x[1] * x[1]);
                                      });
    EXPECT_NE(SolveReference(bowl).status, SolveStatus::kUnbounded) << factor;
  }
  for (const double far : {10.0, 1e3, 1e6}) {
    const ReferenceProblem corner =
        SmallProblem("far", {0.0, 0.0}, 1.25 * far * far, EqualityForm::kRows)
            .Squares(2,
                     [](const auto* x, auto* u) {
                       u[0] = x[0];
                       u[1] = x[1];
                     })
            .AtLeastZero(1, [=](const auto* x, auto* u) { u[0] = x[0] - far; })
            .Zero(1, [](const auto* x, auto* u) { u[0] = x[1] - 0.5 * x[0]; });
    const SolverResult result = SolveReference(corner);
    EXPECT_NE(result.status, SolveStatus::kInfeasible) << far;
    if (result.status == SolveStatus::kConverged) {
      EXPECT_LT(corner.Off(result.cost), 1e-6) << far;
    }
  }
}

TEST_P(ClaimsOfEveryBackend, AStartWhereNothingSlopesTellsNothingOfUnbounded) {
  const ReferenceProblem product =
      SmallProblem("product", {0.0, 0.0, 0.0}, -std::pow(3.0, -1.5), EqualityForm::kRows)
          .Cost([](const auto* x, auto* u) { u[0] = -x[0] * x[1] * x[2]; })
          .AtLeastZero(1,
                       [](const auto* x, auto* u) {
                         u[0] = 1e-6 * (1.0 - x[0] * x[0] - x[1] * x[1] - x[2] * x[2]);
                       })
          .BoundAll(0.0, SmallProblem::kInfinity);
  EXPECT_NE(SolveReference(product).status, SolveStatus::kUnbounded);
}

TEST_P(ClaimsOfEveryBackend, AStartThatIsFeasibleInTheRowsUnitIsNotTheBestPoint) {
  // x = 0 violates the row by its unit alone, and costs nothing.
  for (const double unit : {1.0, 1e-6}) {
    const ReferenceProblem p =
        SmallProblem("unit", {0.0, 0.5}, 1.0, EqualityForm::kRows)
            .Squares(2,
                     [](const auto* x, auto* u) {
                       u[0] = x[0];
                       u[1] = x[1];
                     })
            .Zero(1, [=](const auto* x, auto* u) { u[0] = unit * (x[0] - 1.0); });
    const SolverResult result = SolveReference(p);
    const bool strong = Make()->capabilities().equality_rows;
    EXPECT_EQ(result.status == SolveStatus::kConverged, strong) << unit;
    if (strong) {
      EXPECT_NEAR(result.cost, 1.0, 1e-6) << unit;
    }
  }
}

TEST_P(ClaimsOfEveryBackend, ClaimsInTheSetAreRight) {
  // Those whose numbers end with 2 or 7 are left for the table of the whole set.
  int claimed = 0;
  for (const EqualityForm form : {EqualityForm::kRows, EqualityForm::kPairs}) {
    for (ReferenceProblem p : HockSchittkowski(form)) {
      const int number = std::stoi(p.name.substr(2));
      if (number % 5 == 2) continue;
      std::mt19937_64 random(static_cast<unsigned>(number));
      std::uniform_real_distribution<double> share(-1.0, 1.0);
      for (int start = 0; start < 2; ++start) {
        const SolverResult result = SolveReference(p);
        for (double& x : p.start) x += (1.0 + 0.5 * std::abs(x)) * share(random);
        EXPECT_NE(result.status, SolveStatus::kInfeasible)
            << p.name << " start " << start << ": " << result.message;
        if (result.status != SolveStatus::kConverged) continue;
        ++claimed;
        EXPECT_LE(p.Off(result.cost), 1e-6) << p.name << " start " << start << ": " << result.cost;
      }
    }
  }
  RecordProperty("claimed", claimed);
  const std::string& name = GetParam();
  const bool strong = name == "banded" || name == "ipopt" || name == "nlopt-slsqp";
  EXPECT_GT(claimed, strong ? 180 : -1);  // of 224
}

TEST_P(ClaimsOfEveryBackend, WhereAValleyBendsAwayIsNoMinimum) {
  for (const double angle : {0.0, 0.4}) {
    for (const double far : {1.0, 0.1, 1e-2, 1e-4, 0.0}) {
      for (const double turn : {0.3, 0.5 * M_PI, 2.8, 4.0, -0.5 * M_PI, 5.5}) {
        const ReferenceProblem p =
            PeanosSurface(1.0, angle, {far * std::cos(turn + angle), far * std::sin(turn + angle)});
        const SolverResult result = SolveReference(p);
        if (result.status != SolveStatus::kConverged) continue;
        EXPECT_LE(p.Off(result.cost), 1e-6)
            << "from " << far << " at " << turn << ": " << result.x.transpose();
      }
    }
  }
}

TEST_P(ClaimsOfEveryBackend, AnInfiniteSlopeIsAStatus) {
  const ReferenceProblem root = SmallProblem("root", {0.0}, 0.0, EqualityForm::kRows)
                                    .Squares(1, [](const auto* x, auto* u) { u[0] = x[0]; })
                                    .AtLeastZero(1, [](const auto* x, auto* u) {
                                      using std::sqrt;
                                      u[0] = 1.0 - sqrt(x[0]);
                                    });
  EXPECT_FALSE(SolveReference(root).status == SolveStatus::kConverged);
}

TEST_P(ClaimsOfEveryBackend, WhatFailedIsNamed) {
  for (const bool throws : {true, false}) {
    const ReferenceProblem sensor = SmallProblem("sensor", {-1.0}, 0.0, EqualityForm::kRows)
                                        .Squares(1, [=](const auto* x, auto* u) {
                                          using std::sqrt;
                                          if (throws) throw std::range_error("out of its range");
                                          u[0] = sqrt(x[0]);
                                        });
    const SolverResult result = SolveReference(sensor);
    EXPECT_EQ(result.status, SolveStatus::kEvaluationFailed);
    EXPECT_EQ(result.message,
              throws ? "term squares: out of its range, at (-1)"
                     : "term squares is not finite, at (-1)");
  }
}

/// Pairs of blocks; one of them is out of its range.
struct ShortRange {
  static constexpr int kBlockSize = 2, kWindow = 2, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = false;
  bool throws;
  int windows() const { return 19; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int k, const T* q, const T&, const T&, T* u) const {
    using std::sqrt;
    if (k == 7 && throws) throw std::range_error("out of its range");
    u[0] = k == 7 ? sqrt(q[0] - 1e3) : q[0] * q[3];
  }
};

// Of many variables, those that the term reads there.
TEST_P(ClaimsOfEveryBackend, WhereItFailedIsNamed) {
  for (const bool throws : {true, false}) {
    TermInfo info;
    info.name = "range";
    Problem problem({.blocks = 20, .block_size = 2});
    problem.AddTerm(std::make_unique<WindowTerm<ShortRange, SquareLoss>>(info, ShortRange{throws},
                                                                         SquareLoss(1.0), 19),
                    Role::kCost);
    Eigen::VectorXd start(40);
    for (int i = 0; i < 40; ++i) start[i] = 0.5 * i;
    const SolverResult result = Solve(problem, start);
    EXPECT_EQ(result.status, SolveStatus::kEvaluationFailed);
    EXPECT_EQ(result.message, throws ? "term range, window 7: out of its range, at (7, 7.5, 8, 8.5)"
                                     : "term range, window 7 is not finite, at (7, 7.5, 8, 8.5)");
    const SolverResult judged = Solve(problem, start, {.confirm = false});
    EXPECT_EQ(judged.status, SolveStatus::kEvaluationFailed);
    EXPECT_EQ(judged.message, "");
    EXPECT_EQ(judged.worst_term, 0);
  }
}

/// Known up to x = 1 alone, and falls beyond.
struct Cliff {
  static constexpr int kBlockSize = 1, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = false;
  int windows() const { return 1; }
  int first_block(int) const { return 0; }
  template <class T>
  void operator()(int, const T* q, const T&, const T&, T* u) const {
    if (!(q[0] <= 1.0)) throw std::range_error("beyond the cliff");
    u[0] = q[0] - 3.0;
  }
};

TEST_P(ClaimsOfEveryBackend, WhatFailedAfterTheStartIsTold) {
  TermInfo info;
  info.name = "cliff";
  Problem problem({.blocks = 1, .block_size = 1});
  problem.AddTerm(
      std::make_unique<WindowTerm<Cliff, SquareLoss>>(info, Cliff(), SquareLoss(1.0), 1),
      Role::kCost);
  const SolverResult result = Solve(problem, Eigen::VectorXd::Constant(1, -2.0));
  EXPECT_NE(result.status, SolveStatus::kConverged);
  EXPECT_NE(result.message.find("term cliff: beyond the cliff, at ("), std::string::npos)
      << ToString(result.status) << ": " << result.message;
}

TEST_P(ClaimsOfEveryBackend, ARedundantRowIsNotInfeasible) {
  const ReferenceProblem p = SmallProblem("thrice", {0.0, 0.0}, 2.0, EqualityForm::kRows)
                                 .Squares(2,
                                          [](const auto* x, auto* u) {
                                            u[0] = x[0] - 3.0;
                                            u[1] = x[1] - 2.0;
                                          })
                                 .Zero(3, [](const auto* x, auto* u) {
                                   u[0] = 3.0 - x[0] - x[1];
                                   u[1] = 2.0 * u[0];
                                   u[2] = 0.5 * u[0];
                                 });
  const SolverResult result = SolveReference(p);
  EXPECT_NE(result.status, SolveStatus::kInfeasible);
  if (result.status == SolveStatus::kConverged) {
    EXPECT_NEAR(result.cost, 2.0, 1e-6);
  }
}

TEST_P(ClaimsOfEveryBackend, NothingIsPrinted) {
  // Ceres's line search warns of polynomials that are constant.
  const ReferenceProblem endless = SmallProblem("endless", {1.0, 1.0}, 0.0, EqualityForm::kRows)
                                       .Cost([](const auto* x, auto* u) { u[0] = x[0] + x[1]; });
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  SolveReference(endless);
  SolveReference(ScaledRosenbrock(1e-12, 0.0));
  SolveReference(ScaledRosenbrock(1.0, 1e8));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_P(ClaimsOfEveryBackend, EvaluationsCountAgainstTheBudget) {
  for (const ReferenceProblem& p : HockSchittkowski()) {
    if (p.name != "HS38" && p.name != "HS16") continue;
    const View view(*p.problem);
    auto backend = Make();
    if (!backend->Refusal(view).empty()) continue;
    backend->Prepare(view);
    SolverResult result;
    backend->Solve(view, p.start, {.max_iterations = 10}, &result);
    EXPECT_LE(result.evaluations, 11 * Evaluator::kMostPerIteration) << p.name;
  }
}

TEST_P(ClaimsOfEveryBackend, ASaddleBesideALargeVariableIsNoOptimum) {
  const ReferenceProblem valleys = SmallProblem("valleys", {103.0, 0.0}, 0.0, EqualityForm::kRows)
                                       .Squares(2, [](const auto* x, auto* u) {
                                         u[0] = x[0] - 100.0;
                                         u[1] = 4.0 * (x[1] * x[1] - 0.25);
                                       });
  const SolverResult result = SolveReference(valleys);
  EXPECT_FALSE(result.status == SolveStatus::kConverged && result.cost > 1e-6) << result.cost;
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ClaimsOfEveryBackend);
INSTANTIATE_TEST_SUITE_P(Backends, ClaimsOfEveryBackend, ::testing::ValuesIn(CompiledBackends()),
                         TestName);

TEST(Problem, RefusesRowsThatCouldNotBeMissed) {
  Problem problem({.blocks = 3, .block_size = 1});
  const auto sum = [](const auto* q, auto* u) { u[0] = q[0] + q[1]; };
  const auto term = [&](const FunctionTerm::Loss& loss, int windows) {
    return std::make_shared<FunctionTerm>(
        TermInfo{"sum"}, FunctionShape{.window = 2, .windows = windows}, loss, sum);
  };
  EXPECT_THROW(problem.AddTerm(term(LinearLoss(1.0), 2), Role::kConstraint), std::invalid_argument);
  EXPECT_THROW(problem.AddTerm(term(SquareLoss(1.0), 3), Role::kCost), std::invalid_argument)
      << "its last window would end beyond the last block";
  EXPECT_NO_THROW(problem.AddTerm(term(LinearLoss(1.0), 2), Role::kCost));
}

TEST(Problem, RefusesRowsWithoutAnInterval) {
  struct Crossed : FunctionTerm {
    using FunctionTerm::FunctionTerm;
    LossBounds bounds() const override { return {2.0, 1.0}; }
  };
  Problem problem({.blocks = 1, .block_size = 1});
  const auto term = std::make_shared<Crossed>(TermInfo{"crossed"}, FunctionShape{}, SquareLoss(1.0),
                                              [](const auto* q, auto* u) { u[0] = q[0]; });
  EXPECT_THROW(problem.AddTerm(term, Role::kConstraint), std::invalid_argument);
  EXPECT_NO_THROW(problem.AddTerm(term, Role::kCost));
}

}  // namespace
}  // namespace touchdown::solvers
