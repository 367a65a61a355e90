// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/words.h"

#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

TEST(Words, InOneLineNoControlCharacterIsLeft) {
  EXPECT_EQ(InOneLine("a\nb\x1b[2Jc\x7f"), "a\\nb\\x1b[2Jc\\x7f");
  // In UTF-8: next line, and the begin of a terminal's sequence.
  EXPECT_EQ(InOneLine("a\xc2\x85"
                      "b\xc2\x9b"),
            "a\\x85b\\x9b");
  EXPECT_EQ(InOneLine("\xc2\xa7 \xc3\x9f \xe2\x82\xac"), "\xc2\xa7 \xc3\x9f \xe2\x82\xac");
}

}  // namespace
}  // namespace touchdown::evaluation
