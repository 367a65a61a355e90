// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/judge/failure_words.h"

#include <algorithm>

#include <fmt/format.h>

#include "touchdown/control/mission/landing_state_machine.h"

namespace touchdown::evaluation {
namespace {

int Sum(const StepCounts& counts) {
  int sum = 0;
  for (const auto& [name, count] : counts) sum += count;
  return sum;
}

// The first by name of those that are equal. There is one.
const std::string& MostFrequent(const StepCounts& counts) {
  return std::max_element(counts.begin(), counts.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

// "for NAME" of a single one, else "most for NAME".
std::string Most(const char* word, const StepCounts& counts) {
  return fmt::format("{}{} {}", counts.size() > 1 ? "most " : "", word, MostFrequent(counts));
}

}  // namespace

std::string NoPlanSentence(const TrialResult& result, std::string_view last) {
  const StepCounts& reasons = result.replans_by_reason;
  if (reasons.empty()) return {};
  std::string text = fmt::format(" No new plan in {} of {} steps, {}", Sum(reasons), result.replans,
                                 Most("for", reasons));
  if (!last.empty() && last != MostFrequent(reasons)) text += fmt::format(", at last for {}", last);
  if (const StepCounts& terms = result.replans_forbidden_by; !terms.empty()) {
    text += fmt::format("; in {} a plan was forbidden{}{}", Sum(terms),
                        terms.size() > 1 ? ", " : " ", Most("by", terms));
  }
  return text + ".";
}

std::string NoWaySentence(const TrialResult& result) {
  if (!result.no_way) return {};
  const NoWayFigures& no_way = *result.no_way;
  std::string text = fmt::format(
      " From {:.1f} s on the vehicle knew no way: after {} look{}, what it had seen closed every "
      "way.",
      no_way.since_s, no_way.looks, no_way.looks == 1 ? "" : "s");
  if (!no_way.narrowest) return text;
  const Eigen::Vector3d& at = no_way.narrowest->p_W;
  return text + fmt::format(
                    " The widest passage that may be left is {:.1f} m wide, at [{:.1f}, {:.1f}, "
                    "{:.1f}] m; {:.1f} m between seen cells are needed.",
                    no_way.narrowest->width, at.x(), at.y(), at.z(), no_way.needed_m);
}

std::string GateSentence(const TrialResult& result, std::string_view last) {
  const std::string open(control::ToString(control::Gate::kOpen));
  StepCounts closed = result.gate_steps;
  closed.erase(open);
  if (closed.empty()) return {};
  const bool ever = result.gate_steps.contains(open);
  std::string text = fmt::format(
      " The landing condition was {}, {}",
      ever ? fmt::format("closed in {} of {} steps", Sum(closed), Sum(result.gate_steps))
           : "never open",
      Most("for", closed));
  if (last == open) {
    text += ", and open at the end";
  } else if (last != MostFrequent(closed)) {
    text += fmt::format(", at the end for {}", last);
  }
  return text + ".";
}

}  // namespace touchdown::evaluation
