// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/list_option.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The value of a list option with the default 9 after the words of a command line. `fault`: the
/// message if they are refused.
struct Parsed {
  std::vector<double> list = {9.0};
  std::string fault;
};

Parsed Parse(std::vector<std::string> words) {
  Parsed parsed;
  CLI::App app;
  AddListOption(app, "--sizes", &parsed.list, "Sizes", "N,N,...", CLI::Range(1.0, 100.0));
  std::reverse(words.begin(), words.end());  // as the parser takes them
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    parsed.fault = error.what();
  }
  return parsed;
}

TEST(ListOption, TakesEntriesInTheirOrder) {
  EXPECT_THAT(Parse({}).list, ElementsAre(9.0));
  EXPECT_THAT(Parse({"--sizes", "20,3,5.5"}).list, ElementsAre(20.0, 3.0, 5.5));
  EXPECT_THAT(Parse({"--sizes", "20", "3"}).list, ElementsAre(20.0, 3.0));
  EXPECT_THAT(Parse({"--sizes", "20", "--sizes", "3"}).list, ElementsAre(20.0, 3.0));
}

TEST(ListOption, RefusesWhatIsEmptyTwiceOrOutOfRange) {
  for (const char* list : {"", ",", "20,,40", ",20", "20,"}) {
    EXPECT_THAT(Parse({"--sizes", list}).fault, HasSubstr("--sizes: an entry of the list '"))
        << list;
  }
  EXPECT_THAT(Parse({"--sizes", "20,3,20.0"}).fault, HasSubstr("--sizes: 20.0 is given twice"));
  EXPECT_THAT(Parse({"--sizes", "20", "--sizes", "20"}).fault, HasSubstr("twice"));
  EXPECT_THAT(Parse({"--sizes", "20,101"}).fault, HasSubstr("101"));
  EXPECT_THAT(Parse({"--sizes", "20,many"}).fault, HasSubstr("many"));
}

}  // namespace
}  // namespace touchdown::evaluation
