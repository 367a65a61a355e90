// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/hostile/hostile_tally.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace touchdown::evaluation {
namespace {

constexpr double kSeeingRate = 1.0;  // [Hz]

bool Begins(const std::string& text, const char* with) { return text.rfind(with, 0) == 0; }

int Sum(const std::map<std::string, int>& counts) {
  return std::accumulate(counts.begin(), counts.end(), 0,
                         [](int sum, const auto& entry) { return sum + entry.second; });
}

}  // namespace

const std::string& LabelOf(const SweepTrial& trial, const std::string& key) {
  for (const auto& [name, value] : trial.varied) {
    if (name == key) return value;
  }
  throw std::out_of_range("a trial has no label " + key);
}

bool HitWhatStands(const TrialResult& result) {
  return result.outcome == Outcome::kCollision &&
         (Begins(result.cause, "obstacle") || Begins(result.cause, "ground"));
}

bool WrongContact(const TrialResult& result) {
  switch (result.outcome) {
    case Outcome::kCollision:
      return !HitWhatStands(result);
    case Outcome::kOffPad:
    case Outcome::kHardTouchdown:
    case Outcome::kTiltedTouchdown:
    case Outcome::kBouncedOff:
    case Outcome::kTipOver:
      return true;
    default:
      return false;
  }
}

bool CameToNothing(const TrialResult& result) {
  switch (result.outcome) {
    case Outcome::kStood:
    case Outcome::kTimeout:
    case Outcome::kLostPad:
    case Outcome::kInfeasible:
    case Outcome::kFollowed:
    case Outcome::kArrived:
      return true;
    default:
      return false;
  }
}

bool EndedOtherwise(const TrialResult& result) {
  return !result.landed() && !HitWhatStands(result) && !WrongContact(result) &&
         !CameToNothing(result);
}

bool ViolatesGuarantee(const std::vector<SweepRow>& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const SweepRow& row) {
    if (!row.result.safety) return false;  // its planner promises nothing
    const bool unproven = row.result.safety->uncertified_steps > 0;
    return LabelOf(row.trial, "beyond") == "none" && (HitWhatStands(row.result) || unproven);
  });
}

std::string ContactKind(const TrialResult& result) {
  if (result.outcome != Outcome::kCollision) return ToString(result.outcome);
  return result.cause.substr(0, result.cause.find(' '));
}

void HostileTally::Add(const SweepRow& row) {
  const TrialResult& result = row.result;
  const bool way = LabelOf(row.trial, "way") == "yes";
  const Scenario::Depth& depth = row.trial.scenario.depth;
  const bool sees = way && row.trial.scenario.depth_rate * (1.0 - depth.drop) >= kSeeingRate;
  ++flights;
  ways += way ? 1 : 0;
  seeing += sees ? 1 : 0;
  if (result.safety) AddSafety(*result.safety);
  if (result.landed()) {
    ++landed;
    seeing_landed += sees ? 1 : 0;
  } else if (HitWhatStands(result)) {
    ++collisions;
  } else if (WrongContact(result)) {
    ++contacts[ContactKind(result)];
  } else if (result.outcome == Outcome::kStood) {
    ++stood[result.cause];
  } else if (IsLost(result.outcome)) {
    ++lost;
  } else if (CameToNothing(result)) {
    ++timeouts;
  } else {
    ++other;
  }
}

void HostileTally::AddSafety(const SafetyFigures& figures) {
  safety.uncertified_steps += figures.uncertified_steps;
  safety.escaping_steps += figures.escaping_steps;
  safety.escaping_hit_steps += figures.escaping_hit_steps;
  safety.escaping_unknown_steps += figures.escaping_unknown_steps;
  safety.narrow_steps += figures.narrow_steps;
  safety.stops_flown += figures.stops_flown;
  safety.map_errors += figures.map_errors;
  safety.tracking_events += figures.tracking_events;
  safety.tracking_max_m = std::max(safety.tracking_max_m, figures.tracking_max_m);
  safety.margin_max_m = std::max(safety.margin_max_m, figures.margin_max_m);
  margins_m.push_back(figures.margin_mean_m);
  safety.drift_events += figures.drift_events;
  safety.drift_max_m = std::max(safety.drift_max_m, figures.drift_max_m);
  safety.free_cells += figures.free_cells;
  safety.falsely_free_cells += figures.falsely_free_cells;
  escaping_flights += figures.escaping_steps > 0 ? 1 : 0;
  escaping_hit_flights += figures.escaping_hit_steps > 0 ? 1 : 0;
  escaping_unknown_flights += figures.escaping_unknown_steps > 0 ? 1 : 0;
}

int HostileTally::all_contacts() const { return Sum(contacts); }
int HostileTally::all_stood() const { return Sum(stood); }

HostileTally TallyOf(const std::vector<SweepRow>& rows, const std::string& family, bool within) {
  HostileTally tally;
  for (const SweepRow& row : rows) {
    if (!family.empty() && LabelOf(row.trial, "family") != family) continue;
    if ((LabelOf(row.trial, "assumptions") == "within") == within) tally.Add(row);
  }
  return tally;
}

}  // namespace touchdown::evaluation
