// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/words.h"

#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <boost/algorithm/string/split.hpp>

namespace touchdown::evaluation {

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  boost::split(parts, text, [separator](char c) { return c == separator; });
  return parts;
}

std::string Enumerate(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

std::string WithoutStop(std::string sentence) {
  sentence.erase(sentence.find_last_not_of(" \n.") + 1);
  return sentence;
}

std::string InOneLine(std::string_view text) {
  std::string line;
  int before = 0;
  for (const char letter : text) {
    const int code = static_cast<unsigned char>(letter);
    const bool high = before == 0xc2 && code >= 0x80 && code < 0xa0;  // U+0080 to U+009F, in UTF-8
    if (high) line.pop_back();
    if (letter == '\n') {
      line += "\\n";
    } else if (code < 0x20 || code == 0x7f || high) {
      line += fmt::format("\\x{:02x}", code);
    } else {
      line += letter;
    }
    before = code;
  }
  return line;
}

std::string OriginAdvice(double coordinate) {
  constexpr double kOfMaps = 1e5;  // [m]
  if (!(std::abs(coordinate) >= kOfMaps)) return {};  // also of NaN
  return ": subtract an origin near the flight from all positions";
}

std::string SignalWords(int signal) {
  return fmt::format("signal {} ({})", signal, strsignal(signal));
}

}  // namespace touchdown::evaluation
