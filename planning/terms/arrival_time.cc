// SPDX-License-Identifier: BSD-3-Clause
// Arrival time as a term: linear in the knot interval through the square of its root.

#include "touchdown/planning/terms/arrival_time.h"

#include <cmath>

#include "touchdown/solvers/window_term.h"

namespace touchdown::planning {

namespace {

class RootOfDuration {
 public:
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = true;
  static constexpr bool kLinearInBlocks = true;

  explicit RootOfDuration(int segments) : segments_(segments) {}

  int windows() const { return 1; }
  int first_block(int /*k*/) const { return 0; }

  template <class T>
  void operator()(int /*k*/, const T* /*q*/, const T& h, const T& /*t*/, T* u) const {
    using std::sqrt;
    u[0] = sqrt(segments_ * h);
  }

 private:
  double segments_;
};

solvers::TermInfo Info() { return {"arrival_time", "w T", "s^0.5", "docs/formulation.md", false}; }

}  // namespace

std::shared_ptr<solvers::Term> MakeArrivalTime(int control_points, double weight) {
  return std::make_shared<solvers::WindowTerm<RootOfDuration, solvers::SquareLoss>>(
      Info(), RootOfDuration(control_points - 3), solvers::SquareLoss(2.0 * weight), 1);
}

solvers::TermFactory ArrivalTimeFactory() {
  return {Info(), [](int blocks, std::mt19937_64& random) {
            std::uniform_real_distribution<double> draw(0.5, 10.0);
            return MakeArrivalTime(blocks, draw(random));
          }};
}

}  // namespace touchdown::planning
