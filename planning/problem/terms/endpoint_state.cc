// SPDX-License-Identifier: BSD-3-Clause
// The boundary of the explicit endpoint formulation as rows u = 0. At knot 0, p, v, a are the
// start's. At knot M, p, v, and a where it is fixed, are those wanted at arrival, and move with it
// (eq. 17-18). Affine in the blocks. With a fixed end acceleration second derivatives with respect
// to a free h lack the pad's snap, which is not predicted.

#include "touchdown/planning/problem/term_kinematics.h"

namespace touchdown::planning {

namespace {

struct OffBoundary {
  static constexpr int kBlockSize = 3, kWindow = 3, kOutputs = 3;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = true;

  int count;
  int segments;
  LandingContext context = {};

  int windows() const { return count; }
  int first_block(int k) const { return k < 3 ? 0 : segments; }
  void Update(const LandingContext& now) { context = now; }

  template <class T>
  void operator()(int k, const T* q, const T& h, const T& t, T* u) const {
    const Triple<T> is = State(k % 3, q, h), wanted = Wanted(k, t);
    for (int c = 0; c < 3; ++c) u[c] = is[c] - wanted[c];
  }

 private:
  template <class T>
  static Triple<T> State(int order, const T* q, const T& h) {
    return order == 0 ? KnotPosition(q)
                      : (order == 1 ? KnotVelocity(q, h) : KnotAcceleration(q, h));
  }

  template <class T>
  Triple<T> Wanted(int k, const T& t) const {
    constexpr Eigen::Vector3d SplineState::*kPart[3] = {&SplineState::p, &SplineState::v,
                                                        &SplineState::a};
    const auto part = kPart[k % 3];
    const Eigen::Vector3d still = Eigen::Vector3d::Zero();
    if (k < 3) return AtTime(T(0.0), context.start.*part, still, still);
    const EndState end = EndStateAt(*context.pad, context.target, ValueOf(t));
    return AtTime(t, end.state.*part, end.derivative.*part, end.second_derivative.*part);
  }
};

}  // namespace

TermEntry EndpointStateTerm() {
  TermEntry entry;
  entry.info = {"endpoint_state", "start p, v, a and end p, v (a) minus those wanted = 0",
                "m, m/s, m/s^2", "paper eq. 17-18", true};
  entry.default_weight = 1000.0;
  entry.use = TermUse::kExplicitEndpoint;
  entry.make = [info = entry.info](const TermSetup& setup) {
    const OffBoundary map{setup.free_end_acceleration ? 5 : 6, setup.segments()};
    return MakeLandingTerm(info, map, solvers::SquareLoss(setup.weight), map.count);
  };
  return entry;
}

}  // namespace touchdown::planning
