// SPDX-License-Identifier: BSD-3-Clause
// The inner map of the smoothness term. On a segment the acceleration is linear and the jerk j
// constant, so that int |a|^2 dt = h |mean a|^2 + h^3 |j|^2 / 12 and
//   u = (s_a(h) A, s_j(h) J),  s_a = h^-1.5 / 2,  s_j = sqrt(g) h^-2.5,  g = w_j + h^2 / 12.
// A = Q_k - Q_{k+1} - Q_{k+2} + Q_{k+3} and J = -Q_k + 3 Q_{k+1} - 3 Q_{k+2} + Q_{k+3}.
#pragma once

#include <cmath>

#include "touchdown/planning/problem/landing_term.h"

namespace touchdown::planning {

class SegmentDerivatives {
 public:
  static constexpr int kBlockSize = 3, kWindow = 4, kOutputs = 6;
  static constexpr bool kUsesInterval = true;
  static constexpr bool kLinearInBlocks = true;
  static constexpr bool kSeparable = true;

  SegmentDerivatives(int segments, double jerk_weight)
      : segments_(segments), jerk_weight_(jerk_weight), at_(ScalesAt(1.0)) {}

  int windows() const { return segments_; }
  int first_block(int k) const { return k; }
  void Update(const LandingContext& context) { at_ = ScalesAt(context.interval); }

  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& /*t*/, T* u) const {
    using std::sqrt;
    const T scale_a = sqrt(h) / (2.0 * h * h);
    const T scale_j = sqrt(h * (jerk_weight_ + h * h / 12.0)) / (h * h * h);
    for (int c = 0; c < 3; ++c) {
      u[c] = scale_a * Row(kMeanAcceleration, q + c);
      u[3 + c] = scale_j * Row(kJerk, q + c);
    }
  }

  void operator()(int /*k*/, const double* q, double h, double /*t*/, double* u) const {
    const Scales s = At(h);
    for (int c = 0; c < 3; ++c) {
      u[c] = s.a * Row(kMeanAcceleration, q + c);
      u[3 + c] = s.j * Row(kJerk, q + c);
    }
  }

  void Jacobian(int /*k*/, const double* q, double h, double /*t*/, double* u, double* du,
                double* du_dh) const {
    const Scales s = At(h);
    for (int i = 0; i < 6 * 12; ++i) du[i] = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double a = Row(kMeanAcceleration, q + c), j = Row(kJerk, q + c);
      for (int i = 0; i < 4; ++i) {
        du[c * 12 + 3 * i + c] = s.a * kMeanAcceleration[i];
        du[(3 + c) * 12 + 3 * i + c] = s.j * kJerk[i];
      }
      u[c] = s.a * a;
      u[3 + c] = s.j * j;
      du_dh[c] = s.da * a;
      du_dh[3 + c] = s.dj * j;
    }
  }

  void Curvature(int /*k*/, const double* q, double h, double /*t*/, bool free_interval,
                 const double* m, double* d2) const {
    if (!free_interval) return;  // linear in the blocks
    const Scales s = At(h);
    for (int c = 0; c < 3; ++c) {
      const double by_a = m[c] * s.da, by_j = m[3 + c] * s.dj;
      for (int i = 0; i < 4; ++i) {
        d2[(3 * i + c) * 13 + 12] += by_a * kMeanAcceleration[i] + by_j * kJerk[i];
      }
      d2[12 * 13 + 12] +=
          m[c] * s.d2a * Row(kMeanAcceleration, q + c) + m[3 + c] * s.d2j * Row(kJerk, q + c);
    }
  }

 private:
  static constexpr double kMeanAcceleration[4] = {1.0, -1.0, -1.0, 1.0};
  static constexpr double kJerk[4] = {-1.0, 3.0, -3.0, 1.0};

  /// s_a and s_j with their derivatives with respect to h.
  struct Scales {
    double h, a, j, da, dj, d2a, d2j;
  };

  template <class T>
  static T Row(const double (&row)[4], const T* q) {
    return row[0] * q[0] + row[1] * q[3] + row[2] * q[6] + row[3] * q[9];
  }

  Scales ScalesAt(double h) const {
    const double inverse = 1.0 / h;
    const double g = jerk_weight_ + h * h * (1.0 / 12.0), inverse_g = 1.0 / g;
    const double root = std::sqrt(inverse);
    const double a = 0.5 * inverse * root;
    const double j = std::sqrt(g) * inverse * inverse * root;
    // (log s)' and (log s)'' of the two.
    const double la = -1.5 * inverse, l2a = 1.5 * inverse * inverse;
    const double slope = h * (1.0 / 12.0) * inverse_g;
    const double lj = slope - 2.5 * inverse;
    const double l2j = (1.0 / 12.0) * inverse_g - 2.0 * slope * slope + 2.5 * inverse * inverse;
    return {h, a, j, a * la, j * lj, a * (la * la + l2a), j * (lj * lj + l2j)};
  }

  /// Saves two roots and two divisions per window where h is the expected one.
  Scales At(double h) const { return h == at_.h ? at_ : ScalesAt(h); }

  int segments_;
  double jerk_weight_;
  Scales at_;
};

}  // namespace touchdown::planning
