// SPDX-License-Identifier: BSD-3-Clause
// The arrowhead answers for the whole symmetric matrix.

#include "touchdown/solvers/bordered_band_matrix.h"

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
  m.SetZero();
  EXPECT_EQ(m.At(2, 5), 0.0);
}

}  // namespace
}  // namespace touchdown::solvers
