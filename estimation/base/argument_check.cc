// SPDX-License-Identifier: BSD-3-Clause
// The sentence for a wrong argument: the thing, its value, the allowed range.

#include "estimation/base/argument_check.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace touchdown::estimation {
namespace {

std::string WithDigits(double value, int digits) {
  std::array<char, 32> text;
#ifdef __cpp_lib_to_chars
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::general, digits);
  return {text.data(), end.ptr};
#else  // the library of the browsers' compiler has none for floating point, and a single locale
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
#endif
}

// In a sentence 7 digits are enough, and a computed value is shown without its rounding.
std::string SentenceNumber(double value) { return WithDigits(value, 7); }

}  // namespace

std::string NumberText(double value) {
#ifdef __cpp_lib_to_chars
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
#else
  int digits = 15;
  while (digits < 17 && std::strtod(WithDigits(value, digits).c_str(), nullptr) != value) ++digits;
  return WithDigits(value, digits);
#endif
}

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
