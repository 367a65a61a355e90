// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace touchdown::evaluation {

/// The user's input cannot be used: a scenario file, a --set or another argument. The message is
/// one sentence. It names file, line, key and allowed range, where they apply. Exit status 2.
struct BadInput : std::runtime_error {
  /// The middle of a sentence that quotes very long words is left out.
  explicit BadInput(const std::string& sentence) : std::runtime_error(Shortened(sentence)) {}

 private:
  static std::string Shortened(const std::string& sentence) {
    constexpr std::size_t kEachEnd = 2000;
    if (sentence.size() <= 2 * kEachEnd) return sentence;
    std::size_t begin = kEachEnd, end = sentence.size() - kEachEnd;
    const auto inside = [&](std::size_t i) { return (sentence[i] & 0xc0) == 0x80; };  // of UTF-8
    while (begin > 0 && inside(begin)) --begin;
    while (end < sentence.size() && inside(end)) ++end;
    return sentence.substr(0, begin) + " [...] " + sentence.substr(end);
  }
};

}  // namespace touchdown::evaluation
