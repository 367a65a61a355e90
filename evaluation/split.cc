// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/split.h"

#include <algorithm>

namespace touchdown::evaluation {

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace touchdown::evaluation
