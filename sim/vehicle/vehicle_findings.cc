// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/vehicle_findings.h"

#include <sstream>
#include <stdexcept>

namespace touchdown::sim {

std::string Figure(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value;
  return text.str();
}

void VehicleFindings::ThrowFaults() const {
  if (faults_.empty()) return;
  std::string text = "vehicle file: ";
  if (faults_.size() > 1) text += std::to_string(faults_.size()) + " faults: ";
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    if (i > 0) text += "; ";
    if (faults_.size() > 1) text.append("(").append(std::to_string(i + 1)).append(") ");
    text.append(faults_[i].what).append(": ").append(faults_[i].remedy);
  }
  throw std::invalid_argument(text);
}

}  // namespace touchdown::sim
