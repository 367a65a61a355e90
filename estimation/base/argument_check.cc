// SPDX-License-Identifier: BSD-3-Clause
// The one sentence a wrong argument is answered with: the thing, its value, the allowed range.

#include "estimation/base/argument_check.h"

#include <array>
#include <charconv>
#include <stdexcept>

namespace touchdown::estimation {

std::string NumberText(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

namespace {

// In a sentence 7 digits say enough, and a computed value is not shown with its rounding.
std::string SentenceNumber(double value) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 7);
  return {text.data(), end.ptr};
}

}  // namespace

void ThrowOutOfRange(std::string_view name, double value, std::string_view allowed) {
  throw std::invalid_argument(std::string(name) + " is " + SentenceNumber(value) + "; allowed is " +
                              std::string(allowed));
}

void CheckWithin(std::string_view name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  ThrowOutOfRange(name, value, "[" + SentenceNumber(low) + ", " + SentenceNumber(high) + "]");
}

void CheckAbove(std::string_view name, double value, double low, double high) {
  if (value > low && value <= high) return;
  ThrowOutOfRange(name, value, "(" + SentenceNumber(low) + ", " + SentenceNumber(high) + "]");
}

}  // namespace touchdown::estimation
