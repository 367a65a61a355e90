// SPDX-License-Identifier: BSD-3-Clause
// A cone that stands on the predicted, moving pad: in the last seconds before arrival the vehicle
// comes from above. At knot k, with the pad's state at that knot's own time,
//   u = sqrt(dx^2 + dy^2 + eps^2) - r0 - tan(angle) (height over the pad).
// Convex at fixed h. A start outside the cone would leave hard rows without an interior. So its
// excess is allowed, falling to zero on half of the way. Source: docs/formulation.md.

#include <algorithm>
#include <array>
#include <cmath>

#include "estimation/base/degrees.h"
#include "touchdown/planning/problem/term_kinematics.h"

namespace touchdown::planning {

namespace {

constexpr double kSmoothing = 0.02;  // [m]
constexpr double kRecoveryShare = 0.5;

struct OutsideCorridor {
  static constexpr int kBlockSize = 3, kWindow = 3, kOutputs = 1;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = false;

  double radius, slope, span;
  bool may_recover;
  const estimation::PadPrediction* pad = &estimation::UnknownPad();
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
    relieved_knots = kRecoveryShare * context.segments;
  }

  template <class T>
  void operator()(int k, const T* q, const T& /*h*/, const T& t, T* u) const {
    u[0] = Outside(KnotPosition(q), t) - Relief(k);
  }

  void Jacobian(int k, const double* q, double /*h*/, double t, double* u, double* du,
                double* du_dh) const {
    const At at(KnotPosition(q), pad->MeanAt(t));
    u[0] = at.distance - radius - slope * at.d.z() - Relief(k);
    const Eigen::Vector3d g(at.n.x(), at.n.y(), -slope);  // du/dd
    for (int i = 0; i < kWindow; ++i) Eigen::Vector3d::Map(du + 3 * i) = kRow[i] * g;
    du_dh[0] = -g.dot(at.pad.v_WP) * first_block(k);
  }

  void Curvature(int k, const double* q, double /*h*/, double t, bool free_interval,
                 const double* m, double* d2) const {
    constexpr int n = 3 * kWindow + 1;
    const At at(KnotPosition(q), pad->MeanAt(t));
    const Eigen::Matrix2d bend =  // d2u/dd2
        m[0] / at.distance * (Eigen::Matrix2d::Identity() - at.n * at.n.transpose());
    for (int i = 0; i < kWindow; ++i) {
      for (int j = i; j < kWindow; ++j) {
        for (int row = 0; row < 2; ++row) {
          for (int column = 0; column < 2; ++column) {
            d2[(3 * i + row) * n + 3 * j + column] += kRow[i] * kRow[j] * bend(row, column);
          }
        }
      }
    }
    if (!free_interval) return;
    const double knot = first_block(k);
    const Eigen::Vector2d v = at.pad.v_WP.head<2>(), cross = -knot * (bend * v);
    for (int i = 0; i < kWindow; ++i) {
      for (int row = 0; row < 2; ++row) d2[(3 * i + row) * n + n - 1] += kRow[i] * cross[row];
    }
    const double a = at.n.dot(at.pad.a_WP.head<2>()) - slope * at.pad.a_WP.z();
    d2[n * n - 1] += knot * knot * (v.dot(bend * v) - m[0] * a);
  }

 private:
  static constexpr std::array<double, kWindow> kRow = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};

  /// A knot seen from the pad.
  struct At {
    At(const Triple<double>& p, const estimation::PadState& state)
        : pad(state),
          d(Eigen::Vector3d(p[0], p[1], p[2]) - state.p_WP),
          distance(std::sqrt(d.head<2>().squaredNorm() + kSmoothing * kSmoothing)),
          n(d.head<2>() / distance) {}
    estimation::PadState pad;
    Eigen::Vector3d d;
    double distance;  // level, smoothed; its slope is n
    Eigen::Vector2d n;
  };

  // By the knot, not by its time: a free interval must not move a knot across the relief's end.
  double Relief(int k) const {
    return excess * std::max(0.0, 1.0 - first_block(k) / relieved_knots);
  }

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
                      {"angle_deg", 60.0, 5.0, 85.0, "between the cone's side and its axis [deg]"},
                      {"span", 2.0, 0.1, 60.0, "acts this long before arrival [s]"}};
  entry.is_limit = true;
  entry.make = [info = entry.info](const TermSetup& setup) {
    const OutsideCorridor map{setup.Get("radius"),
                              std::tan(estimation::kRadPerDeg * setup.Get("angle_deg")),
                              setup.Get("span"), setup.hard};
    return MakeLandingTerm(info, map, setup.Hinge(), setup.segments() - 1);
  };
  return entry;
}

}  // namespace touchdown::planning
