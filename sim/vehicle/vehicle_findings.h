// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace touchdown::sim {

/// A problem of a vehicle's file, and its remedy; each a clause without a full stop.
struct VehicleFinding {
  std::string what;
  std::string remedy;
};

/// A figure for a sentence: four digits.
std::string Figure(double value);

/// All problems of a vehicle's file, so that a user can fix them in one go.
class VehicleFindings {
 public:
  /// The vehicle cannot be flown before this is fixed.
  void Fault(std::string what, std::string remedy) {
    faults_.push_back({std::move(what), std::move(remedy)});
  }
  /// It flies, but not quite as the file says.
  void Warn(std::string what, std::string remedy) {
    warnings_.push_back({std::move(what), std::move(remedy)});
  }

  const std::vector<VehicleFinding>& faults() const { return faults_; }
  const std::vector<VehicleFinding>& warnings() const { return warnings_; }

  /// Throws std::invalid_argument with every fault and its remedy, if there is one.
  void ThrowFaults() const;

 private:
  std::vector<VehicleFinding> faults_;
  std::vector<VehicleFinding> warnings_;
};

}  // namespace touchdown::sim
