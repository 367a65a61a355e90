// SPDX-License-Identifier: BSD-3-Clause
// What gets its input from a fuzzer. A target returns, whatever its bytes are. An exception that leaves it, a fault of
// memory, a time beyond libFuzzer's limit: each is a finding.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace touchdown::evaluation::fuzz {

struct Target {
  const char* name;
  void (*run)(std::string_view bytes);
};

/// Files of users; `Onboard` with its measurements and clocks; `Replanner` with its maps, states and pads.
std::vector<Target> ReaderTargets();
std::vector<Target> FlyingTargets();

/// A property that does not hold.
struct Finding : std::logic_error {
  using std::logic_error::logic_error;
};
inline void Require(bool holds, const std::string& what) {
  if (!holds) throw Finding(what);
}

/// Choices from the fuzzer's bytes; zeros when these are used up.
class Choices {
 public:
  explicit Choices(std::string_view bytes) : rest_(bytes) {}

  bool empty() const { return rest_.empty(); }
  template <typename T>
  T Take() {
    T value{};
    const std::size_t size = std::min(sizeof(T), rest_.size());
    if (size > 0) std::memcpy(&value, rest_.data(), size);
    rest_.remove_prefix(size);
    return value;
  }
  /// In [0, count).
  int Below(int count) { return Take<std::uint16_t>() % count; }
  /// In [low, high], in 65536 steps.
  double In(double low, double high) { return low + (high - low) * Take<std::uint16_t>() / 65535.0; }
  /// Any double at all, in one of 16 takes; else in [low, high].
  double Wild(double low, double high) { return Below(16) == 0 ? Take<double>() : In(low, high); }
  std::string Text(std::size_t most) {
    const std::string_view text = rest_.substr(0, std::min(most, rest_.size()));
    rest_.remove_prefix(text.size());
    return std::string(text);
  }

 private:
  std::string_view rest_;
};

}  // namespace touchdown::evaluation::fuzz
