// SPDX-License-Identifier: BSD-3-Clause
// The inner map of speed_limit and acceleration_limit. With d a derivative control point of order
// n = 1 or 2 (eq. 15 of the paper)
//   u = (|d|^2 - L^2) / (2 d_max),  d = (sum_i r_i Q_i) / h^n.
// It is smooth, zero on the limit, and has the slope of |d| there. L is d_max, except for hard rows
// of a start beyond the limit: they follow the recovery profile of the certificate.
#pragma once

#include <stdexcept>
#include <string>

#include "touchdown/planning/problem/landing_term.h"
#include "touchdown/planning/problem/term_kinematics.h"

namespace touchdown::planning {

template <int kOrder>
class DerivativeNorm {
 public:
  static constexpr int kBlockSize = 3, kWindow = kOrder + 1, kOutputs = 1;
  static constexpr bool kUsesInterval = true;
  static constexpr bool kLinearInBlocks = false;

  /// `share` of the context's limit is where it acts from.
  DerivativeNorm(int windows, double limit, double share, bool may_recover)
      : windows_(windows), share_(share), may_recover_(may_recover) {
    SetLimit(limit);
  }

  int windows() const { return windows_; }
  // No rows for what the start state fixes: V_0 (no Bezier point either), V_1 and A_0.
  int first_block(int k) const { return k + kFirst; }

  void Update(const LandingContext& context) {
    t0_ = context.t0;
    start_ = kOrder == 1 ? context.start.v.norm() : context.start.a.norm();
    SetLimit(kOrder == 1 ? context.limits.speed : context.limits.acceleration);
    decay_ = kOrder == 1 ? RecoveryProfile::kSpeedShare * context.limits.acceleration
                         : RecoveryProfile::kAccelerationDecay * start_;
    recovers_ = may_recover_ && start_ > limit_;
  }

  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& t, T* u) const {
    T norm2(0.0);
    for (int c = 0; c < 3; ++c) {
      const T d = Difference(q + c);
      norm2 += d * d;
    }
    const T inverse_h2 = 1.0 / (h * h);
    for (int i = 0; i < kOrder; ++i) norm2 = norm2 * inverse_h2;
    T limit(limit_);
    if (recovers_) {
      const T left = Recovering(h, t);
      if (left > limit) limit = left;
    }
    u[0] = (norm2 - limit * limit) * (0.5 * inverse_);
  }

  void Jacobian(int k, const double* q, double h, double t, double* u, double* du,
                double* du_dh) const {
    const double scale = Scale(h);
    const double factor = scale * inverse_;
    double norm2 = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double d = Difference(q + c);
      norm2 += d * d;
      for (int i = 0; i <= kOrder; ++i) du[3 * i + c] = d * kRow[i] * factor;
    }
    u[0] = 0.5 * inverse_ * (norm2 * scale - limit_ * limit_);
    du_dh[0] = -kOrder * norm2 * factor / h;
    const Allowed allowed = AllowedAt(k, h, t);
    if (!allowed.recovers) return;
    u[0] += 0.5 * inverse_ * (limit_ * limit_ - allowed.value * allowed.value);
    du_dh[0] -= inverse_ * allowed.value * allowed.slope;
  }

  void Curvature(int k, const double* q, double h, double t, bool free_interval, const double* m,
                 double* d2) const {
    constexpr int n = 3 * kWindow + 1;
    const double factor = m[0] * Scale(h) * inverse_;
    for (int i = 0; i <= kOrder; ++i) {
      for (int j = i; j <= kOrder; ++j) {
        const double entry = factor * kRow[i] * kRow[j];
        for (int c = 0; c < 3; ++c) d2[(3 * i + c) * n + 3 * j + c] += entry;
      }
    }
    if (!free_interval) return;
    const double inverse_h = 1.0 / h;
    double norm2 = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double d = Difference(q + c);
      norm2 += d * d;
      for (int i = 0; i <= kOrder; ++i) {
        d2[(3 * i + c) * n + n - 1] -= 2.0 * kOrder * inverse_h * factor * kRow[i] * d;
      }
    }
    d2[n * n - 1] += kOrder * (2.0 * kOrder + 1.0) * inverse_h * inverse_h * factor * norm2;
    const Allowed allowed = AllowedAt(k, h, t);
    if (allowed.recovers) d2[n * n - 1] -= m[0] * inverse_ * allowed.slope * allowed.slope;
  }

 private:
  static constexpr int kFirst = kOrder == 1 ? 2 : 1;
  static constexpr double kRow[3] = {kOrder == 1 ? -1.0 : 1.0, kOrder == 1 ? 1.0 : -2.0, 1.0};

  /// The limit of one window where it recovers, with its derivative with respect to h.
  struct Allowed {
    bool recovers = false;
    double value = 0.0;
    double slope = 0.0;
  };

  void SetLimit(double limit) {
    limit_ = share_ * limit;
    inverse_ = 1.0 / limit_;
  }

  template <class T>
  static T Difference(const T* q) {
    T d(0.0);
    for (int i = 0; i <= kOrder; ++i) d += kRow[i] * q[3 * i];
    return d;
  }

  static double Scale(double h) {
    const double inverse_h2 = 1.0 / (h * h);
    return kOrder == 1 ? inverse_h2 : inverse_h2 * inverse_h2;
  }

  /// The remaining excess of a start beyond the limit. A speed begins to fall after one interval,
  /// and after the certificate's lag at the earliest. An acceleration falls at once.
  template <class T>
  T Recovering(const T& h, const T& t) const {
    T since = t - t0_;
    if (kOrder == 1) since = ValueOf(h) > kLag ? since - h : since - kLag;
    return ValueOf(since) > 0.0 ? start_ - decay_ * since : T(start_);
  }

  Allowed AllowedAt(int k, double h, double t) const {
    if (!recovers_) return {};
    const double value = Recovering(h, t);
    if (!(value > limit_)) return {};
    const double lag = kOrder == 1 && h > kLag ? 1.0 : 0.0;
    return {true, value, value < start_ ? -decay_ * (first_block(k) - lag) : 0.0};
  }

  static constexpr double kLag = RecoveryProfile::kLag;
  int windows_;
  double share_;
  double limit_ = 1.0;
  double inverse_ = 1.0;
  bool may_recover_;
  bool recovers_ = false;
  double t0_ = 0.0;
  double start_ = 0.0;  // norm at the start
  double decay_ = 0.0;  // of the profile, per second
};

/// The term of one norm limit. Rows and costs end with V_{N-3} and A_{N-3} where the end moves
/// them; a fixed end acceleration fixes them, and then they are facts.
template <int kOrder>
std::shared_ptr<solvers::Term> MakeNormLimit(const solvers::TermInfo& info, const TermSetup& setup,
                                             double limit) {
  if (!(limit > 0.0)) {
    throw std::invalid_argument(info.name + ": limit is " + std::to_string(limit) +
                                ", it must be > 0");
  }
  const double share = setup.hard ? 1.0 : setup.Get("margin");
  const int windows =
      setup.control_points - (kOrder == 1 ? 4 : 3) - (setup.free_end_acceleration ? 0 : 1);
  return MakeLandingTerm(info, DerivativeNorm<kOrder>(windows, limit, share, setup.hard),
                         setup.Hinge(), windows);
}

}  // namespace touchdown::planning
