// SPDX-License-Identifier: BSD-3-Clause
// A cone that stands on the predicted, moving pad: in the last seconds before arrival the vehicle
// comes from above. At knot k, with the pad's state at that knot's own time,
//   u = sqrt(dx^2 + dy^2 + eps^2) - r0 - tan(angle) (height over the pad).
// Convex at fixed h. A start outside the cone would leave hard rows without an interior: what it is
// outside by is allowed to it, falling to zero on half of the way. Source: docs/formulation.md.

#include <algorithm>

#include "touchdown/planning/term_kinematics.h"

namespace touchdown::planning {

namespace {

constexpr double kSmoothing = 0.02;  // [m]
constexpr double kReliefShare = 0.5;

struct OutsideCorridor {
  static constexpr int kBlockSize = 3, kWindow = 3, kOutputs = 1;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = false;

  double radius, slope, span;
  bool may_recover;
  const estimation::PadPrediction* pad = nullptr;
  LastKnots knots;
  double excess = 0.0, relieved_knots = 1.0;

  int windows() const { return knots.count; }
  int first_block(int k) const { return knots.first + k; }

  void Update(const LandingContext& context) {
    pad = context.pad;
    knots.Update(context, span);
    const Eigen::Vector3d& p = context.start.p;
    const double outside = Outside<double>({p.x(), p.y(), p.z()}, context.t0);
    excess = may_recover ? std::max(0.0, outside) : 0.0;
    relieved_knots = kReliefShare * context.segments;
  }

  template <class T>
  void operator()(int k, const T* q, const T& /*h*/, const T& t, T* u) const {
    // By the knot and not by its time: a free interval must not move a knot across the relief's end.
    const double relief = excess * std::max(0.0, 1.0 - first_block(k) / relieved_knots);
    u[0] = Outside(KnotPosition(q), t) - relief;
  }

 private:
  template <class T>
  T Outside(const Triple<T>& p, const T& t) const {
    using std::sqrt;
    const Triple<T> on_pad = PadPosition(*pad, t);
    const T x = p[0] - on_pad[0], y = p[1] - on_pad[1];
    return sqrt(x * x + y * y + kSmoothing * kSmoothing) - radius - slope * (p[2] - on_pad[2]);
  }
};

}  // namespace

TermEntry ApproachCorridorTerm() {
  TermEntry entry;
  entry.info = {"approach_corridor",
                "w sum hinge(sqrt(|p_xy - P_xy|^2 + eps^2) - r0 - tan(angle) (p_z - P_z))", "m",
                "docs/formulation.md; descent: planned asks for it", true};
  entry.parameters = {HingeWidth(0.3, "m"),
                      {"radius", 0.3, 0.05, 10.0, "r0, of the cone at the deck [m]"},
                      {"angle_deg", 45.0, 5.0, 85.0, "between the cone's side and its axis [deg]"},
                      {"span", 2.0, 0.1, 60.0, "acts this long before arrival [s]"}};
  entry.is_limit = true;
  entry.make = [info = entry.info](const TermSetup& setup) {
    constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;
    const OutsideCorridor map{setup.Get("radius"), std::tan(kRadPerDeg * setup.Get("angle_deg")),
                              setup.Get("span"), setup.hard};
    return MakeLandingTerm(info, map, setup.Hinge(), setup.segments() - 1);
  };
  return entry;
}

}  // namespace touchdown::planning
