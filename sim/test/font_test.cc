// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rendering/font.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include <gtest/gtest.h>

namespace touchdown::sim {
namespace {

int CoverageOf(const Font& font, char letter, int from_row, int to_row) {
  const Font::Glyph& glyph = font.Of(letter);
  int sum = 0;
  for (int i = from_row * glyph.width; i < to_row * glyph.width; ++i) {
    sum += glyph.coverage[static_cast<std::size_t>(i)];
  }
  return sum;
}

TEST(Font, LettersStandWholeOnTheirLine) {
  for (const int size : {1, 4, 6}) {
    const Font font(size);
    const int h = font.height();
    EXPECT_GT(font.WidthOf("mm"), font.WidthOf("ii"));
    for (char letter = '!'; letter <= '~'; ++letter) {
      const Font::Glyph& glyph = font.Of(letter);
      ASSERT_EQ(glyph.coverage.size(), static_cast<std::size_t>(glyph.width * h)) << letter;
      EXPECT_GT(CoverageOf(font, letter, 0, h), 0) << letter;
      if (size > 1 && std::isalnum(letter)) {
        EXPECT_EQ(CoverageOf(font, letter, 0, 1), 0) << letter;  // nothing is cut off
        EXPECT_EQ(CoverageOf(font, letter, h - 1, h), 0) << letter;
      }
    }
    EXPECT_EQ(CoverageOf(font, ' ', 0, h), 0);
    // What hangs below the line: of a g, not of an a.
    EXPECT_GT(CoverageOf(font, 'g', h - h / 4, h), 0);
    EXPECT_EQ(CoverageOf(font, 'a', h - h / 4, h), 0);
  }
}

TEST(Font, IsSmooth) {
  const Font font(5);
  const std::vector<std::uint8_t>& o = font.Of('o').coverage;
  EXPECT_EQ(*std::max_element(o.begin(), o.end()), 255);
  EXPECT_TRUE(std::any_of(o.begin(), o.end(), [](int level) { return level > 60 && level < 200; }));
}

TEST(Font, WhatItLacksIsAQuestion) {
  const Font font(2);
  EXPECT_EQ(&font.Of('\n'), &font.Of('?'));
  EXPECT_EQ(&font.Of(static_cast<char>(200)), &font.Of('?'));
  EXPECT_THROW(Font(0), std::invalid_argument);
  EXPECT_THROW(Font(7), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::sim
