// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/campaign/campaign.h"
#include "evaluation/studies/hostile/hostile_way.h"

namespace touchdown::evaluation {

struct HostileOptions {
  std::uint64_t seed = 1;
  int flights = 120;
  std::vector<std::string> families;  ///< drawn from; empty: all
  double share_beyond = 0.2;          ///< of the flights goes beyond the assumptions
  std::vector<std::string> set;       ///< "depth.drop=0.9": fixed in every flight
};

/// A flight of the study: its draws, and whether a way exists.
struct HostileFlight {
  int index = 0;
  std::string family;
  std::vector<std::string> beyond;  ///< conditions out of the assumed range; empty: within
  HostileWay way;
  SweepTrial trial;  ///< its place in a campaign is the index
};

/// Flight `index`: a pure function of index and options, except `flights`.
/// @throws BadInput for options that are wrong, or for a --set that no world fits
HostileFlight DrawHostileFlight(const HostileOptions& options, int index,
                                const Registries& registries);

/// Flights 0, 1, ..., drawn by `jobs` threads at a time, which does not change them.
/// @throws BadInput as DrawHostileFlight
std::vector<HostileFlight> DrawHostileFlights(const HostileOptions& options, int jobs,
                                              const Registries& registries);

/// The campaign of these flights, with labels `family`, `assumptions` (within or beyond), `beyond`, `way`
/// (yes or no), `way_clearance_m` and `way_length_m`.
Campaign HostileCampaign(const HostileOptions& options, const std::vector<HostileFlight>& flights);

/// The words of the command that flies the study, without its outputs.
std::string HostileCommand(const HostileOptions& options);

}  // namespace touchdown::evaluation
