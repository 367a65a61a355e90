// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/video/picture.h"

#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

constexpr Rgb kInk = {200, 100, 50};

Rgb At(const Picture& picture, int x, int y) {
  const auto p = picture.rgb.begin() + 3 * (y * picture.width + x);
  return {p[0], p[1], p[2]};
}

TEST(Picture, FillsWithinItsEdges) {
  Picture picture(10, 6);
  picture.Fill({8, -2, 5, 4}, kInk, 0.5);
  EXPECT_EQ(At(picture, 9, 1), (Rgb{100, 50, 25}));
  EXPECT_EQ(At(picture, 7, 1), (Rgb{0, 0, 0}));
  EXPECT_EQ(At(picture, 9, 2), (Rgb{0, 0, 0}));
}

TEST(Picture, EnlargesAnotherOne) {
  Picture small(2, 1), picture(8, 8);
  small.Fill({1, 0, 1, 1}, kInk, 1.0);
  picture.Put({4, 6, 6, 4}, small);  // reaches over the edges
  EXPECT_EQ(At(picture, 6, 7), (Rgb{0, 0, 0}));
  EXPECT_EQ(At(picture, 7, 7), kInk);
  EXPECT_EQ(At(picture, 7, 5), (Rgb{0, 0, 0}));
}

TEST(Picture, LinesAreAsWideAsTheySay) {
  Picture picture(20, 20);
  picture.Line({2.0, 10.0}, {18.0, 10.0}, 4.0, kInk);
  for (const int y : {8, 9, 10, 11}) EXPECT_EQ(At(picture, 10, y), kInk) << y;
  for (const int y : {7, 12}) EXPECT_LT(At(picture, 10, y)[0], 110) << y;
  EXPECT_EQ(At(picture, 10, 5), (Rgb{0, 0, 0}));
  picture.Line({-50.0, -3.0}, {50.0, -3.0}, 2.0, kInk);  // outside
}

TEST(Picture, WritesTextFromItsUpperLeftCorner) {
  const sim::Font font(4);
  Picture picture(80, 40);
  picture.Text(20, 10, "HH", font, kInk);
  int inked = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 80; ++x) {
      if (At(picture, x, y) == Rgb{0, 0, 0}) continue;
      ++inked;
      EXPECT_TRUE(x >= 20 && x < 20 + font.WidthOf("HH") && y >= 10 && y < 10 + font.height());
    }
  }
  EXPECT_GT(inked, 40);
  picture.Text(70, 35, "beyond", font, kInk);  // cut off
}

TEST(Picture, SmoothsStairsAndNothingElse) {
  Picture picture(40, 40);
  for (int y = 0; y < 40; ++y) picture.Fill({0, y, 5 + y / 3, 1}, {240, 240, 240}, 1.0);
  const Picture before = picture;
  picture.SmoothEdges();
  int between = 0;
  for (int y = 2; y < 38; ++y) {
    for (int x = 1; x < 39; ++x) {
      const int level = At(picture, x, y)[0];
      if (level > 30 && level < 210) ++between;
      const bool flat = x < 2 + y / 3 || x > 8 + y / 3;
      if (flat) {
        EXPECT_EQ(At(picture, x, y), At(before, x, y));
      }
    }
  }
  EXPECT_GT(between, 20);
}

}  // namespace
}  // namespace touchdown::evaluation
