// SPDX-License-Identifier: BSD-3-Clause
// Numbers are read by std::from_chars over the whole text. So "1.0x", "1,5" and YAML's own .inf and
// .nan are mistakes and not values. Every written value reads back bit by bit.
#include "evaluation/scenario/scenario_value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/suggestion.h"
#include "evaluation/base/words.h"

namespace touchdown::evaluation {
namespace {

constexpr std::size_t kMostShown = 60;  // of a list [characters]

std::string Shown(const YAML::Node& node) {
  if (!node || node.IsNull()) return "empty";
  if (node.IsScalar()) return "'" + node.Scalar() + "'";
  if (!node.IsSequence()) return "a map";
  std::vector<std::string> items;
  for (const YAML::Node& item : node) items.push_back(item.IsScalar() ? item.Scalar() : "...");
  const std::string list = fmt::format("[{}]", fmt::join(items, ", "));
  return list.size() > kMostShown ? fmt::format("a list of {}", items.size()) : list;
}

std::optional<double> Number(const YAML::Node& node) {
  // yaml-cpp marks a quoted scalar with the tag "!": that is text, not a number.
  if (!node.IsScalar() || node.Tag() == "!") return std::nullopt;
  const std::string& text = node.Scalar();
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

// Of a position that was given in the coordinates of a map.
std::string Advice(const std::optional<double>& value, const ValueRange& range) {
  const bool is_position = range.unit == "m" && range.lo < 0.0;
  return value && is_position ? OriginAdvice(*value) : "";
}

bool Inside(double value, const ValueRange& range) {
  return value <= range.hi && (range.above_lo ? value > range.lo : value >= range.lo);
}

}  // namespace

std::string Where::ToString() const { return line > 0 ? fmt::format("{}:{}", file, line) : file; }

std::string ValueRange::ToString() const {
  return fmt::format("{}{}, {}]{}{}", above_lo ? "(" : "[", lo, hi, unit.empty() ? "" : " ", unit);
}

void RefuseValue(const Where& where, const std::string& key, const std::string& what,
                 const YAML::Node& node, const std::string& advice) {
  throw BadInput(fmt::format("{}: {} must be {}, not {}{}.", where.ToString(), key, what,
                             Shown(node), advice));
}

double ReadNumber(const YAML::Node& node, const Where& where, const std::string& key,
                  const ValueRange& range) {
  const std::optional<double> value = Number(node);
  if (!value || !Inside(*value, range)) {
    RefuseValue(where, key, "a number in " + range.ToString(), node, Advice(value, range));
  }
  return *value;
}

int ReadWhole(const YAML::Node& node, const Where& where, const std::string& key, int lowest,
              int highest) {
  const std::optional<double> value = Number(node);
  if (!value || *value < lowest || *value > highest || *value != std::floor(*value)) {
    RefuseValue(where, key, fmt::format("a whole number in [{}, {}]", lowest, highest), node);
  }
  return static_cast<int>(*value);
}

std::uint64_t ReadSeed(const YAML::Node& node, const Where& where, const std::string& key) {
  // SQLite and JSON readers keep integers exactly up to 2^53.
  constexpr std::uint64_t kLargest = std::uint64_t{1} << 53;
  std::uint64_t value = 0;
  bool good = node.IsScalar() && node.Tag() != "!";
  if (good) {
    const std::string& text = node.Scalar();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    good = error == std::errc() && end == text.data() + text.size() && value <= kLargest;
  }
  if (!good) RefuseValue(where, key, fmt::format("a whole number in [0, {}]", kLargest), node);
  return value;
}

bool ReadBool(const YAML::Node& node, const Where& where, const std::string& key) {
  if (node.IsScalar() && node.Scalar() == "true") return true;
  if (node.IsScalar() && node.Scalar() == "false") return false;
  RefuseValue(where, key, "true or false", node);
}

std::string ReadText(const YAML::Node& node, const Where& where, const std::string& key) {
  if (!node.IsScalar() || node.Scalar().empty()) RefuseValue(where, key, "a text", node);
  return node.Scalar();
}

int ReadChoice(const YAML::Node& node, const Where& where, const std::string& key,
               const std::vector<std::string>& allowed) {
  if (node.IsScalar()) {
    const auto found = std::find(allowed.begin(), allowed.end(), node.Scalar());
    if (found != allowed.end()) return static_cast<int>(found - allowed.begin());
  }
  throw BadInput(fmt::format("{}: {} must be {}, not {}{}.", where.ToString(), key,
                             Enumerate(allowed), Shown(node),
                             node.IsScalar() ? DidYouMean(node.Scalar(), allowed) : ""));
}

Eigen::VectorXd ReadVector(const YAML::Node& node, const Where& where, const std::string& key,
                           int size, const ValueRange& range) {
  const std::string what = fmt::format("a list of {} numbers in {}", size, range.ToString());
  if (!node.IsSequence() || static_cast<int>(node.size()) != size) {
    RefuseValue(where, key, what, node);
  }
  Eigen::VectorXd values(size);
  for (int i = 0; i < size; ++i) {
    const std::optional<double> value = Number(node[i]);
    if (!value || !Inside(*value, range)) {
      RefuseValue(where, key, what, node[i], Advice(value, range));
    }
    values[i] = *value;
  }
  return values;
}

std::string WriteNumber(double value) { return fmt::format("{}", value); }

std::string WriteVector(const Eigen::VectorXd& values) {
  std::string text = "[";
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += (i > 0 ? ", " : "") + WriteNumber(values[i]);
  }
  return text + "]";
}

std::string WriteText(const std::string& text) {
  YAML::Emitter emitter;
  emitter << YAML::DoubleQuoted << text;
  return emitter.c_str();
}

}  // namespace touchdown::evaluation
