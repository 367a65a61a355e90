// SPDX-License-Identifier: BSD-3-Clause
// The committed corpora of the fuzzers (./test.sh fuzz), in this build: what was found once does not come back.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "evaluation/test/fuzz/fuzz_target.h"

namespace touchdown::evaluation::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<Target> Targets() {
  std::vector<Target> targets = ReaderTargets();
  for (const Target& target : FlyingTargets()) targets.push_back(target);
  return targets;
}

class FuzzCorpus : public ::testing::TestWithParam<Target> {};
INSTANTIATE_TEST_SUITE_P(Targets, FuzzCorpus, ::testing::ValuesIn(Targets()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(FuzzCorpus, EveryInputEnds) {
  const fs::path corpus = fs::path(TOUCHDOWN_SOURCE_DIR) / "evaluation/test/fuzz/corpus" / GetParam().name;
  int inputs = 0;
  for (const auto& entry : fs::directory_iterator(corpus)) {
    SCOPED_TRACE(entry.path());
    std::ostringstream bytes;
    bytes << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    EXPECT_NO_THROW(GetParam().run(bytes.str()));
    ++inputs;
  }
  EXPECT_GT(inputs, 0) << corpus;
}

}  // namespace
}  // namespace touchdown::evaluation::fuzz
