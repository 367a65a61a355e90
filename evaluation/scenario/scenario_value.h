// SPDX-License-Identifier: BSD-3-Clause
// Typed reading of one YAML value, with the sentence that a mistake gets.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <Eigen/Core>

#include "evaluation/base/words.h"
#include "touchdown/evaluation/base/value_range.h"

namespace touchdown::evaluation {

/// Where a value stands: "file.yaml:12" or "--set".
struct Where {
  std::string file;
  int line = 0;  ///< from 1; 0: not in a file
  std::string ToString() const;
};

/// @throws BadInput "<where>: <key> must be <what>, not <value><advice>".
[[noreturn]] void RefuseValue(const Where& where, const std::string& key, const std::string& what,
                              const YAML::Node& node, const std::string& advice = "");

double ReadNumber(const YAML::Node& node, const Where& where, const std::string& key,
                  const ValueRange& range);
/// A whole number from `lowest` to `highest`.
int ReadWhole(const YAML::Node& node, const Where& where, const std::string& key, int lowest,
              int highest);
std::uint64_t ReadSeed(const YAML::Node& node, const Where& where, const std::string& key);
bool ReadBool(const YAML::Node& node, const Where& where, const std::string& key);
std::string ReadText(const YAML::Node& node, const Where& where, const std::string& key);
/// Index of the value in `allowed`.
int ReadChoice(const YAML::Node& node, const Where& where, const std::string& key,
               const std::vector<std::string>& allowed);
Eigen::VectorXd ReadVector(const YAML::Node& node, const Where& where, const std::string& key,
                           int size, const ValueRange& range);

/// Shortest decimal text that reads back to the same double.
std::string WriteNumber(double value);
std::string WriteVector(const Eigen::VectorXd& values);
/// In double quotes, with what YAML wants escaped.
std::string WriteText(const std::string& text);

}  // namespace touchdown::evaluation
