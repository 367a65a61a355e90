// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/scenario/yaml_text.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "evaluation/base/bad_input.h"

namespace touchdown::evaluation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string Refusal(const std::string& text) {
  try {
    ParseYaml(text, "file");
  } catch (const BadInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(YamlText, OneDocumentIsRead) {
  EXPECT_EQ(ParseYaml("a: [1, 2]\n", "file")["a"][1].as<int>(), 2);
  EXPECT_EQ(ParseYaml("---\na: 1\n...\n", "file")["a"].as<int>(), 1);
  EXPECT_TRUE(ParseYaml("", "file").IsNull());
  EXPECT_THAT(Refusal("a: 1\n---\nb: 2\n"),
              HasSubstr("file:2: another YAML document begins here; allowed is one"));
  EXPECT_THAT(Refusal("a: 1\nb: [\n"), HasSubstr("file:"));
}

// yaml-cpp would go on for ever, with a new document each time.
TEST(YamlText, ACommaBetweenDocumentsEnds) {
  EXPECT_THAT(Refusal(","), HasSubstr("file:1: "));
  EXPECT_THAT(Refusal("a: 1\n,\n"), HasSubstr("file:2: "));
  EXPECT_THAT(Refusal("--- ]"), HasSubstr("file:1: "));
}

TEST(YamlText, TooManyAndTooDeepValuesAreRefused) {
  std::string many = "[0";
  for (int i = 0; i < 1'000'000; ++i) many += ",0";
  EXPECT_THAT(Refusal(many + "]"), HasSubstr("more than a million values"));
  EXPECT_THAT(Refusal(std::string(100'000, '[')), HasSubstr("file:1: "));
  std::string deep;
  for (int i = 0; i < 5'000; ++i) deep += "- ";
  EXPECT_THAT(Refusal(deep), HasSubstr("file:1: "));
}

TEST(YamlText, AFileIsNamed) {
  const auto refusal = [](const std::string& path) {
    try {
      ReadYamlFile(path, "study");
    } catch (const BadInput& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const std::string path = ::testing::TempDir() + "yaml_text.yaml";
  std::ofstream(path) << "# nothing\n";
  EXPECT_EQ(refusal(path), path + ": the study file holds no key.");
  std::ofstream(path) << std::string((4 << 20) + 1, ' ');
  EXPECT_THAT(refusal(path), HasSubstr("larger than the 4 MiB"));
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("/dev/zero: it is no regular file."));
  EXPECT_THAT(refusal("/no/such.yaml"), AllOf(HasSubstr("/no/such.yaml: "), HasSubstr("cannot be read")));
}

}  // namespace
}  // namespace touchdown::evaluation
