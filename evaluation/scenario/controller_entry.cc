// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/scenario/controller_entry.h"

namespace touchdown::evaluation {
namespace {

ControllerEntry Law(const char* name, const char* summary, bool compensates) {
  ControllerEntry entry;
  entry.name = name;
  entry.summary = summary;
  entry.compensates = compensates;
  entry.make = [name](const ControllerSetup& setup) {
    return control::MakeController(name, setup.model, setup.options);
  };
  return entry;
}

}  // namespace

std::vector<ControllerEntry> StandardControllers() {
  return {
      Law("geometric", "on SE(3), with the estimated disturbance compensated", true),
      Law("paper", "as published, without an estimate of the disturbance", false),
  };
}

}  // namespace touchdown::evaluation
