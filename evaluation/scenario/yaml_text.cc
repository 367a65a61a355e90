// SPDX-License-Identifier: BSD-3-Clause
// yaml-cpp loads without bounds, and YAML::LoadAll does not come to an end at a comma between documents. So the text is
// walked first, without keeping a node.
#include "evaluation/scenario/yaml_text.h"

#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "evaluation/base/bad_input.h"
#include "sim/base/input_file.h"

namespace touchdown::evaluation {
namespace {

constexpr std::size_t kMostYamlBytes = 4 << 20;
constexpr int kMostValues = 1'000'000;

// Counts, and lets the parser go on until there is too much.
class Bounds : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) {
      throw YAML::ParserException(mark, "another YAML document begins here; allowed is one");
    }
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { Count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { Count(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string&) override {
    Count(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    Count(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    Count(mark);
  }
  void OnMapEnd() override {}

 private:
  void Count(const YAML::Mark& mark) {
    if (++values_ > kMostValues) {
      throw YAML::ParserException(mark, "it holds more than a million values");
    }
  }
  int documents_ = 0;
  int values_ = 0;
};

}  // namespace

YAML::Node ParseYaml(const std::string& text, const std::string& name, bool with_line) {
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    Bounds bounds;
    while (parser.HandleNextDocument(bounds)) {
    }
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw BadInput(with_line ? fmt::format("{}:{}: {}.", name, error.mark.line + 1, error.msg)
                             : fmt::format("{}: {}.", name, error.msg));
  }
}

YAML::Node ReadYamlFile(const std::string& path, const std::string& what) {
  std::string text;
  try {
    text = sim::ReadInputFile(path, kMostYamlBytes);
  } catch (const std::invalid_argument& error) {
    throw BadInput(fmt::format("{}.", error.what()));
  }
  YAML::Node root = ParseYaml(text, path);
  if (root.IsNull()) throw BadInput(fmt::format("{}: the {} file holds no key.", path, what));
  return root;
}

}  // namespace touchdown::evaluation
