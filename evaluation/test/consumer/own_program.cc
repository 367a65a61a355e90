// SPDX-License-Identifier: BSD-3-Clause
// The program `touchdown` with a term that the library does not know: an inner map, one line of
// registration, and every sub-command.
#include "touchdown/evaluation/program.h"
#include "touchdown/solvers/window_term.h"

namespace {

/// Height above a soft floor of 1 m.
struct FloorMap {
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = true;
  int points;
  int windows() const { return points; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int, const T* q, const T&, const T&, T* u) const {
    u[0] = 1.0 - q[2];
  }
};

touchdown::solvers::TermFactory SoftFloor() {
  namespace solvers = touchdown::solvers;
  const solvers::TermInfo info{"soft_floor", "w sum hinge(1 m - z)", "m", "this file", true};
  return {info, [info](int blocks, std::mt19937_64&) {
            return std::make_shared<solvers::WindowTerm<FloorMap, solvers::HingeLoss>>(
                info, FloorMap{blocks}, solvers::HingeLoss(10.0, 0.5), blocks);
          }};
}

}  // namespace

int main(int argc, char** argv) {
  touchdown::evaluation::Registries registries{touchdown::solvers::StandardBackends(),
                                               touchdown::planning::StandardTerms()};
  registries.terms.push_back(SoftFloor());
  return touchdown::evaluation::RunProgram(argc, argv, registries);
}
