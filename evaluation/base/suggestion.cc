// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/suggestion.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <Eigen/Core>

#include "evaluation/base/words.h"

namespace touchdown::evaluation {
namespace {

constexpr std::size_t kLongList = 12;  // names
constexpr int kLettersPerTypo = 3;     // one in so many is near
constexpr int kMostErrors = 2;

using Parts = std::vector<std::string>;  // of a dotted name

// Where the two differ in one part alone: which it is.
std::optional<std::size_t> TheOneThatDiffers(const Parts& a, const Parts& b) {
  if (a.size() != b.size()) return std::nullopt;
  const auto [from, to] = std::mismatch(a.begin(), a.end(), b.begin());
  if (from == a.end() || !std::equal(from + 1, a.end(), to + 1)) return std::nullopt;
  return static_cast<std::size_t>(from - a.begin());
}

// `same_group`: among those that differ in the last part; else among the others.
const std::string* Nearest(const Parts& word, const std::vector<std::string>& names,
                           bool same_group) {
  const std::string* nearest = nullptr;
  int least = kMostErrors + 1;
  for (const std::string& name : names) {
    const Parts parts = Split(name, '.');
    const std::optional<std::size_t> at = TheOneThatDiffers(word, parts);
    if (!at || (*at + 1 == word.size()) != same_group) continue;
    if (word[*at].size() > parts[*at].size() + kMostErrors)
      continue;  // its distance would take long
    const int distance = EditDistance(word[*at], parts[*at]);
    const int most =
        std::clamp(static_cast<int>(word[*at].size()) / kLettersPerTypo, 1, kMostErrors);
    // Not every word of one letter is near every other.
    if (distance > most || distance >= least || distance >= static_cast<int>(parts[*at].size())) {
      continue;
    }
    least = distance;
    nearest = &name;
  }
  return nearest;
}

}  // namespace

int EditDistance(std::string_view a, std::string_view b) {
  const int rows = static_cast<int>(a.size()), columns = static_cast<int>(b.size());
  Eigen::ArrayXXi steps(rows + 1, columns + 1);  // from the first i letters to the first j
  steps.col(0) = Eigen::ArrayXi::LinSpaced(rows + 1, 0, rows);
  steps.row(0) = Eigen::ArrayXi::LinSpaced(columns + 1, 0, columns).transpose();
  const auto at = [](std::string_view word, int i) { return word[static_cast<std::size_t>(i)]; };
  for (int i = 1; i <= rows; ++i) {
    for (int j = 1; j <= columns; ++j) {
      const int replaced = steps(i - 1, j - 1) + (at(a, i - 1) != at(b, j - 1) ? 1 : 0);
      steps(i, j) = std::min({steps(i - 1, j) + 1, steps(i, j - 1) + 1, replaced});
      const bool changed =
          i > 1 && j > 1 && at(a, i - 1) == at(b, j - 2) && at(a, i - 2) == at(b, j - 1);
      if (changed) steps(i, j) = std::min(steps(i, j), steps(i - 2, j - 2) + 1);
    }
  }
  return steps(rows, columns);
}

std::string DidYouMean(std::string_view word, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), word) != names.end()) return {};
  for (const bool same_group : {true, false}) {
    const std::string* const nearest = Nearest(Split(std::string(word), '.'), names, same_group);
    if (nearest != nullptr) return fmt::format(" (did you mean {}?)", *nearest);
  }
  return {};
}

std::string Instead(std::string_view word, const std::vector<std::string>& names,
                    const std::string& lead) {
  const std::string meant = DidYouMean(word, names);
  if (names.size() > kLongList && !meant.empty()) return meant;
  return fmt::format("{}; {} {}", meant, lead, Enumerate(names));
}

std::string WithSuggestion(const std::string& sentence, std::string_view word,
                           const std::vector<std::string>& names) {
  const std::size_t list = sentence.find("; known:");
  if (list == sentence.npos) return sentence;
  return sentence.substr(0, list).append(Instead(word, names, "known:"));
}

}  // namespace touchdown::evaluation
