// SPDX-License-Identifier: BSD-3-Clause
// The arrowhead answers for the whole symmetric matrix.

#include "touchdown/solvers/linear/bordered_band_matrix.h"

#include <gtest/gtest.h>

namespace touchdown::solvers {
namespace {

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
  EXPECT_FALSE(m.BandIsZero());
  m.SetZero();
  EXPECT_EQ(m.At(2, 5), 0.0);
  m.border()[3] = 7.0;
  EXPECT_TRUE(m.BandIsZero());
  m.corner() = 1.0;
  EXPECT_FALSE(m.BandIsZero());
}

TEST(BorderedBandMatrix, KnowsTheLargestOfEachRow) {
  BorderedBandMatrix m;
  m.Resize(4, 2, 1, true);
  m.block(1, 0)[3] = -1.0;  // (3, 3)
  m.block(1, 1)[1] = 5.0;   // (2, 5)
  m.border()[3] = -7.0;     // (3, 8)
  m.corner() = 2.0;
  std::vector<double> largest(9);
  m.LargestInRows(largest.data());
  EXPECT_EQ(largest, (std::vector<double>{0.0, 0.0, 5.0, 7.0, 0.0, 5.0, 0.0, 0.0, 7.0}));
}

TEST(BorderedBandMatrix, ScalesRowsAndColumns) {
  BorderedBandMatrix m;
  m.Resize(4, 2, 1, true);
  const std::vector<double> d = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0};
  m.block(1, 0)[3] = 1.0;
  m.block(1, 1)[1] = 1.0;
  m.block(3, 0)[0] = 1.0;
  m.border()[3] = 1.0;
  m.corner() = 1.0;
  m.Scale(d.data());
  EXPECT_EQ(m.At(3, 3), 16.0);
  EXPECT_EQ(m.At(2, 5), 18.0);
  EXPECT_EQ(m.At(6, 6), 49.0);
  EXPECT_EQ(m.At(8, 3), 36.0);
  EXPECT_EQ(m.At(8, 8), 81.0);
}

}  // namespace
}  // namespace touchdown::solvers
