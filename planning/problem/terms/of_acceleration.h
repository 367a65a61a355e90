// SPDX-License-Identifier: BSD-3-Clause
// Inner maps u = f(A_i) of one acceleration control point, i = 1..N-3 (the start fixes A_0). A map
// gives f with its gradient g and Hessian H. The chain rule through A = (r . Q)/h^2 is here:
//   u_q = r g / h^2,  u_h = -2/h A.g,  u_qq = r r^T H / h^4,  u_qh = -2/h^3 r (g + H A),
//   u_hh = (6 A.g + 4 A^T H A) / h^2.
#pragma once

#include <Eigen/Core>

#include "touchdown/planning/problem/landing_term.h"

namespace touchdown::planning {

/// A map derives from this as `struct Map : OfAcceleration<Map>` and has
///   double At(const Eigen::Vector3d& a, Eigen::Vector3d* g, Eigen::Matrix3d* H) const;
/// If it is convex in A it is convex in the control points at fixed h.
template <class Map>
struct OfAcceleration {
  static constexpr int kBlockSize = 3, kWindow = 3, kOutputs = 1;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = false;

  int count = 0;

  int windows() const { return count; }
  int first_block(int k) const { return k + 1; }

  void operator()(int /*k*/, const double* q, double h, double /*t*/, double* u) const {
    Eigen::Vector3d g;
    Eigen::Matrix3d H;
    u[0] = map().At(Acceleration(q, h), &g, &H);
  }

  void Jacobian(int /*k*/, const double* q, double h, double /*t*/, double* u, double* du,
                double* du_dh) const {
    const Eigen::Vector3d a = Acceleration(q, h);
    Eigen::Vector3d g;
    Eigen::Matrix3d H;
    u[0] = map().At(a, &g, &H);
    for (int i = 0; i < 3; ++i) {
      for (int c = 0; c < 3; ++c) du[3 * i + c] = kRow[i] / (h * h) * g[c];
    }
    du_dh[0] = -2.0 / h * a.dot(g);
  }

  void Curvature(int /*k*/, const double* q, double h, double /*t*/, bool free_interval,
                 const double* m, double* d2) const {
    const Eigen::Vector3d a = Acceleration(q, h);
    Eigen::Vector3d g;
    Eigen::Matrix3d H;
    map().At(a, &g, &H);
    const double inverse_h2 = 1.0 / (h * h);
    const Eigen::Matrix3d scaled = m[0] * inverse_h2 * inverse_h2 * H;
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) {
        for (int r = 0; r < 3; ++r) {
          for (int s = 0; s < 3; ++s) {
            d2[(3 * i + r) * 10 + 3 * j + s] += kRow[i] * kRow[j] * scaled(r, s);
          }
        }
      }
    }
    if (!free_interval) return;
    const Eigen::Vector3d Ha = H * a, slope = -2.0 * m[0] / h * inverse_h2 * (g + Ha);
    for (int i = 0; i < 3; ++i) {
      for (int c = 0; c < 3; ++c) d2[(3 * i + c) * 10 + 9] += kRow[i] * slope[c];
    }
    d2[99] += m[0] * inverse_h2 * (6.0 * a.dot(g) + 4.0 * a.dot(Ha));
  }

 private:
  static constexpr double kRow[3] = {1.0, -2.0, 1.0};
  const Map& map() const { return static_cast<const Map&>(*this); }
  static Eigen::Vector3d Acceleration(const double* q, double h) {
    Eigen::Vector3d a;
    for (int c = 0; c < 3; ++c) a[c] = (q[c] - 2.0 * q[3 + c] + q[6 + c]) / (h * h);
    return a;
  }
};

/// Number of A_i that are free to move: a fixed end acceleration fixes the last one.
inline int FreeAccelerations(const TermSetup& setup) {
  return setup.control_points - (setup.free_end_acceleration ? 3 : 4);
}

}  // namespace touchdown::planning
