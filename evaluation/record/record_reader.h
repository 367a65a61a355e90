// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "evaluation/flight/trial_record.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// The part of a record from which replanning steps are asked again.
struct RecordedFlight {
  std::string path;
  Scenario scenario;  ///< the effective one, its seed that of the flight
  std::string build_hash;
  std::string revision;
  Eigen::Vector3d hover_W = Eigen::Vector3d::Zero();           ///< before the first of them [m]
  double map_resolution = 0.1;                                 ///< [m]
  planning::CellIndex map_size = planning::CellIndex::Ones();  ///< of the map's window
  int idle_steps = 0;                                          ///< that are not among them
  std::vector<RecordPlan> plans;  ///< in the order in which they were made
  std::vector<planning::CellCube> prior;  ///< near the flight, what map.prior held occupied
};

/// The keys of a recorded flight that can be changed, as a help text says it.
inline constexpr const char* kReplayKeys =
    "solver.*, terms.*, planning.guides, planning.max_work and planning.warm_start";

/// Reads a record that WriteRecord wrote. `overrides` change the recorded scenario.
/// @throws BadInput with one sentence. An override is none of kReplayKeys. Or the file is missing, is no record, has
/// another version, lacks a value or has one out of range; then the sentence names the file.
RecordedFlight ReadRecord(const std::string& path, const std::vector<std::string>& overrides,
                          const Registries& registries);

}  // namespace touchdown::evaluation
