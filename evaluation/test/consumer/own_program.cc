// SPDX-License-Identifier: BSD-3-Clause
// The program `touchdown` with a term that the library does not know: an inner map, one line of
// registration, and every sub-command.
#include "touchdown/evaluation/program.h"

namespace {

/// Height above a soft floor of 1 m, for the control points that are free to move.
struct FloorMap {
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = true;
  int points;
  int windows() const { return points - 6; }
  int first_block(int k) const { return k + 3; }
  template <class T>
  void operator()(int, const T* q, const T&, const T&, T* u) const {
    u[0] = 1.0 - q[2];
  }
};

touchdown::planning::TermEntry SoftFloor() {
  namespace planning = touchdown::planning;
  planning::TermEntry entry;
  entry.info = {"soft_floor", "w sum hinge(1 m - z)", "m", "this file", true};
  entry.default_weight = 10.0;
  entry.parameters = {planning::HingeWidth(0.5, "m")};
  entry.make = [info = entry.info](const planning::TermSetup& setup) {
    const FloorMap map{setup.control_points};
    return planning::MakeLandingTerm(info, map, setup.Hinge(), map.windows());
  };
  return entry;
}

}  // namespace

int main(int argc, char** argv) {
  touchdown::evaluation::Registries registries{touchdown::solvers::StandardBackends(),
                                               touchdown::planning::StandardTerms()};
  registries.terms.push_back(SoftFloor());
  return touchdown::evaluation::RunProgram(argc, argv, registries);
}
