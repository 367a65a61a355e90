// SPDX-License-Identifier: BSD-3-Clause
// The factor of random arrowheads against Eigen's dense one, for blocks of three and of other
// sizes.

#include "touchdown/solvers/linear/bordered_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace touchdown::solvers {
namespace {

struct Shape {
  int blocks, block_size, half;
  bool bordered;
};

BorderedBandMatrix RandomDefinite(const Shape& shape, std::mt19937_64* random) {
  std::normal_distribution<double> normal;
  BorderedBandMatrix A;
  A.Resize(shape.blocks, shape.block_size, shape.half, shape.bordered);
  const int d = shape.block_size;
  for (int i = 0; i < shape.blocks; ++i) {
    for (int k = 0; k <= shape.half && i + k < shape.blocks; ++k) {
      for (int r = 0; r < d; ++r) {
        for (int c = 0; c < d; ++c) A.block(i, k)[r * d + c] = normal(*random);
      }
    }
    for (int r = 0; r < d; ++r) {
      for (int c = 0; c < r; ++c) A.block(i, 0)[r * d + c] = A.block(i, 0)[c * d + r];
      A.block(i, 0)[r * d + r] += 8.0 * d * (shape.half + 1);
    }
  }
  if (shape.bordered) {
    for (int i = 0; i < shape.blocks * d; ++i) A.border()[i] = normal(*random);
    A.corner() = 20.0;
  }
  return A;
}

Eigen::MatrixXd Dense(const BorderedBandMatrix& A) {
  Eigen::MatrixXd dense(A.size(), A.size());
  for (int i = 0; i < A.size(); ++i) {
    for (int j = 0; j < A.size(); ++j) dense(i, j) = A.At(i, j);
  }
  return dense;
}

TEST(BorderedCholesky, MatchesTheDenseFactor) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const Shape shape :
       {Shape{15, 3, 3, false}, Shape{15, 3, 3, true}, Shape{2, 3, 3, true}, Shape{9, 3, 1, false},
        Shape{9, 3, 2, true}, Shape{9, 3, 5, true}, Shape{6, 1, 3, false}, Shape{8, 2, 4, true},
        Shape{7, 4, 3, true}, Shape{1, 1, 0, true}, Shape{5, 5, 5, false}, Shape{12, 1, 7, true},
        Shape{20, 1, 15, false}, Shape{40, 1, 31, true}, Shape{9, 8, 5, true},
        Shape{3, 24, 2, false}, Shape{20, 24, 5, true}, Shape{1, 33, 0, false},
        Shape{4, 33, 1, true}}) {
    const BorderedBandMatrix A = RandomDefinite(shape, &random);
    const Eigen::MatrixXd dense = Dense(A);
    BorderedCholesky factor;
    factor.Prepare(A);
    ASSERT_EQ(factor.Factor(A), BorderedCholesky::Status::kDefinite);
    const Eigen::VectorXd b =
        Eigen::VectorXd::NullaryExpr(A.size(), [&](Eigen::Index) { return normal(random); });

    Eigen::VectorXd x = b;
    factor.Solve(x.data());
    EXPECT_LT((dense * x - b).norm(), 1e-12 * b.norm() * dense.norm());

    const Eigen::MatrixXd L = dense.llt().matrixL();
    Eigen::VectorXd lower = b, upper = b, product(A.size());
    factor.SolveLower(lower.data());
    factor.SolveUpper(upper.data());
    factor.MultiplyUpper(b.data(), product.data());
    EXPECT_LT((L * lower - b).norm(), 1e-12 * b.norm() * L.norm());
    EXPECT_LT((L.transpose() * upper - b).norm(), 1e-12 * b.norm() * L.norm());
    EXPECT_LT((L.transpose() * b - product).norm(), 1e-12 * b.norm() * L.norm());

    ASSERT_EQ(factor.Factor(A, 2.0, 3.0), BorderedCholesky::Status::kDefinite);
    Eigen::MatrixXd shifted = dense;
    shifted.diagonal().array() += 2.0;
    if (shape.bordered) shifted(A.size() - 1, A.size() - 1) += 1.0;
    x = b;
    factor.Solve(x.data());
    EXPECT_LT((shifted * x - b).norm(), 1e-12 * b.norm() * dense.norm());
  }
}

// The last blocks have room for neighbours that do not exist.
TEST(BorderedCholesky, WhatLiesBeyondTheEndIsNotRead) {
  std::mt19937_64 random(4);
  for (const Shape shape : {Shape{9, 3, 3, false}, Shape{9, 3, 5, true}, Shape{8, 2, 4, true},
                            Shape{12, 1, 7, false}, Shape{7, 4, 3, true}}) {
    BorderedBandMatrix A = RandomDefinite(shape, &random);
    BorderedCholesky clean, spoilt;
    clean.Prepare(A);
    spoilt.Prepare(A);
    ASSERT_EQ(clean.Factor(A), BorderedCholesky::Status::kDefinite);
    const int d = shape.block_size;
    for (int i = 0; i < shape.blocks; ++i) {
      for (int k = shape.blocks - i; k <= shape.half; ++k) {
        std::fill_n(A.block(i, k), d * d, std::numeric_limits<double>::quiet_NaN());
      }
    }
    ASSERT_EQ(spoilt.Factor(A), BorderedCholesky::Status::kDefinite);
    Eigen::VectorXd x = Eigen::VectorXd::Ones(A.size()), y = x;
    clean.Solve(x.data());
    spoilt.Solve(y.data());
    EXPECT_EQ(x, y);
  }
}

TEST(BorderedCholesky, SaysWhatIsIndefinite) {
  std::mt19937_64 random(4);
  BorderedBandMatrix A = RandomDefinite({6, 3, 3, true}, &random);
  BorderedCholesky factor;
  factor.Prepare(A);
  A.corner() = -5.0;
  EXPECT_EQ(factor.Factor(A), BorderedCholesky::Status::kBorderIndefinite);
  EXPECT_GT(factor.corner(), 0.0);
  A.block(4, 0)[4] = -100.0;
  EXPECT_EQ(factor.Factor(A), BorderedCholesky::Status::kIndefinite);
  A.block(4, 0)[4] = std::nan("");
  EXPECT_EQ(factor.Factor(A), BorderedCholesky::Status::kIndefinite);
}

// An unfinished factor, or NaN in it, does not affect the next factor.
TEST(BorderedCholesky, StartsAnewAfterAFailure) {
  std::mt19937_64 random(5);
  const BorderedBandMatrix good = RandomDefinite({6, 3, 3, true}, &random);
  BorderedCholesky fresh, used;
  fresh.Prepare(good);
  used.Prepare(good);
  ASSERT_EQ(fresh.Factor(good), BorderedCholesky::Status::kDefinite);
  for (const double bad : {-100.0, 0.0, std::nan(""), std::numeric_limits<double>::denorm_min(),
                           std::numeric_limits<double>::infinity()}) {
    BorderedBandMatrix broken = good;
    for (int k = 0; k <= 3; ++k) std::fill_n(broken.block(2, k), 9, k == 0 ? bad : 0.0);
    EXPECT_EQ(used.Factor(broken), BorderedCholesky::Status::kIndefinite) << bad;
    ASSERT_EQ(used.Factor(good), BorderedCholesky::Status::kDefinite);
    std::vector<double> x(static_cast<std::size_t>(good.size()), 1.0), expected = x;
    used.Solve(x.data());
    fresh.Solve(expected.data());
    EXPECT_EQ(x, expected);
  }
}

}  // namespace
}  // namespace touchdown::solvers
