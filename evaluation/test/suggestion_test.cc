// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/suggestion.h"

#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

TEST(Suggestion, DistanceCountsEveryKindOfTypoOnce) {
  EXPECT_EQ(EditDistance("land", "land"), 0);
  EXPECT_EQ(EditDistance("lnad", "land"), 1);   // changed with its neighbour
  EXPECT_EQ(EditDistance("lad", "land"), 1);    // left out
  EXPECT_EQ(EditDistance("laand", "land"), 1);  // added
  EXPECT_EQ(EditDistance("lamd", "land"), 1);   // replaced
  EXPECT_EQ(EditDistance("ca", "abc"), 3);      // nothing is changed twice
  EXPECT_EQ(EditDistance("", "land"), 4);
  EXPECT_EQ(EditDistance("land", ""), 4);
}

TEST(Suggestion, OnlyWhatIsNearIsMeant) {
  const std::vector<std::string> names = {"fly", "land", "lend", "study"};
  EXPECT_EQ(DidYouMean("lnad", names), " (did you mean land?)");
  EXPECT_EQ(DidYouMean("lxnd", names), " (did you mean land?)");  // the first of two
  EXPECT_EQ(DidYouMean("stduyy", names), " (did you mean study?)");
  EXPECT_EQ(DidYouMean("flutter", names), "");
  EXPECT_EQ(DidYouMean("landings", names), "");  // four letters too many
  EXPECT_EQ(DidYouMean("land", names), "");      // it is there
  EXPECT_EQ(DidYouMean("x", {"A", "B"}), "");
  EXPECT_EQ(DidYouMean("", names), "");
  EXPECT_EQ(DidYouMean("land", {}), "");
}

TEST(Suggestion, OfDottedNamesOnePartIsMeantAndComparedAlone) {
  const std::vector<std::string> names = {"solver.gap",     "planning.rate", "pad.rate",
                                          "pad.speed",      "wind.max",      "wind.gust.speed",
                                          "pads.prediction"};
  EXPECT_EQ(DidYouMean("pad.sped", names), " (did you mean pad.speed?)");
  EXPECT_EQ(DidYouMean("planing.rate", names), " (did you mean planning.rate?)");
  EXPECT_EQ(DidYouMean("wind.gus.speed", names), " (did you mean wind.gust.speed?)");
  EXPECT_EQ(DidYouMean("pads.prediktion", names), " (did you mean pads.prediction?)");
  // The same group is asked first, though pad.rate is as near.
  EXPECT_EQ(DidYouMean("pad.rats", {"pat.rats", "pad.rate"}), " (did you mean pad.rate?)");
  // A common beginning does not make names near, and neither do two parts that are both a little wrong.
  for (const char* word : {"solver.max", "planning.name", "wind.far", "pid.seed", "planing.rat",
                           "pad", "wind.gust", "wind.speed"}) {
    EXPECT_EQ(DidYouMean(word, names), "") << word;
  }
}

TEST(Suggestion, ALongListIsLeftOutWhereANameIsNear) {
  EXPECT_EQ(Instead("lnad", {"fly", "land"}, "known:"),
            " (did you mean land?); known: fly or land");
  EXPECT_EQ(Instead("x", {"fly", "land"}, "known:"), "; known: fly or land");
  std::vector<std::string> many(20, "fly");
  many.emplace_back("land");
  EXPECT_EQ(Instead("lnad", many, "known:"), " (did you mean land?)");
  EXPECT_EQ(Instead("x", many, "known:").substr(0, 16), "; known: fly, fl");
}

TEST(Suggestion, StandsInASentenceInPlaceOfItsList) {
  const std::vector<std::string> names = {"weight", "margin"};
  EXPECT_EQ(WithSuggestion("key wieght is unknown; known: weight, margin", "wieght", names),
            "key wieght is unknown (did you mean weight?); known: weight or margin");
  EXPECT_EQ(WithSuggestion("weight must be in [0, 1]", "weight", names),
            "weight must be in [0, 1]");
}

}  // namespace
}  // namespace touchdown::evaluation
