// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "evaluation/campaign/campaign.h"

namespace touchdown::evaluation {

/// The label of a flight by its name. @throws std::out_of_range
const std::string& LabelOf(const SweepTrial& trial, const std::string& key);

/// It touched something that stands: an obstacle, or the ground far from the pad.
bool HitWhatStands(const TrialResult& result);
/// It touched the pad outside of the landing rule, or came down beside it.
bool WrongContact(const TrialResult& result);
/// It stood, or its time ran out.
bool CameToNothing(const TrialResult& result);
/// None of these, and no landing: the program or the physics failed, the rotors were stopped in the air.
bool EndedOtherwise(const TrialResult& result);
/// The kind of a wrong contact in one word: the outcome, or for a collision the touched thing.
std::string ContactKind(const TrialResult& result);

/// The results of a number of flights.
struct HostileTally {
  int flights = 0;
  int ways = 0;                         ///< flights in which a way exists
  int collisions = 0;                   ///< with what stands
  std::map<std::string, int> contacts;  ///< other contacts, by kind
  int landed = 0;
  int seeing = 0;         ///< a way exists and depth.rate x (1 - depth.drop) is at least 1 Hz
  int seeing_landed = 0;  ///< of those
  std::map<std::string, int> stood;  ///< by reason
  int timeouts = 0;                  ///< time ran out, for whatever reason
  int lost = 0;                      ///< error, crashed, hung
  int other = 0;                     ///< unstable, disarmed in the air, ...
  SafetyFigures safety;              ///< sums over the flights; of what ends in max_m the largest
  std::vector<double> margins_m;     ///< mean margin of each flight
  int escaping_flights = 0;          ///< with a step that escapes
  int escaping_hit_flights = 0;      ///< ... from occupied cells
  int escaping_unknown_flights = 0;  ///< ... from cells that are not known

  void Add(const SweepRow& row);
  void AddSafety(const SafetyFigures& figures);
  int all_contacts() const;
  int all_stood() const;
};

/// A flight within the assumptions collided, or made a step without a proven flight pair: a defect.
bool ViolatesGuarantee(const std::vector<SweepRow>& rows);

/// The rows of one family, of all if it is empty; within or beyond.
HostileTally TallyOf(const std::vector<SweepRow>& rows, const std::string& family, bool within);

}  // namespace touchdown::evaluation
