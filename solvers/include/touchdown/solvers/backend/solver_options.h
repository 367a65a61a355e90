// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace touchdown::solvers {

/// One option of a backend: named, ranged, documented, so that a caller can offer it to
/// people and sweep it like any other number.
struct OptionSpec {
  std::string name;
  double value = 0.0;  ///< default
  double lo = 0.0;
  double hi = 0.0;
  bool integer = false;
  std::string help;
};

/// The options of one backend instance with their present values.
class SolverOptions {
 public:
  SolverOptions() = default;
  explicit SolverOptions(std::vector<OptionSpec> specs) : specs_(std::move(specs)) {}

  const std::vector<OptionSpec>& specs() const { return specs_; }
  /// Throws std::invalid_argument naming the option, the value and the allowed range or names.
  void Set(std::string_view name, double value);
  /// Throws std::invalid_argument if there is no such option.
  double Get(std::string_view name) const;

 private:
  std::vector<OptionSpec> specs_;
};

}  // namespace touchdown::solvers
