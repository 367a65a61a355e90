// SPDX-License-Identifier: BSD-3-Clause
// Limits on the norms of velocity and acceleration through the derivative control points of eq. 15:
// the curve's derivatives lie in their convex hull.

#include "touchdown/planning/terms/norm_limit.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "touchdown/solvers/window_term.h"

namespace touchdown::planning {

namespace {

/// Norm of the `kOrder`-th derivative control point, squared and shifted as in the header.
template <int kOrder>
class DerivativeNorm {
 public:
  static constexpr int kBlockSize = 3, kWindow = kOrder + 1, kOutputs = 1;
  static constexpr bool kUsesInterval = true;
  static constexpr bool kLinearInBlocks = false;

  DerivativeNorm(int windows, double limit) : windows_(windows), limit_(limit) {}

  int windows() const { return windows_; }
  // What the start state fixes is not limited: V_0, V_1 and A_0.
  int first_block(int k) const { return k + kFirst; }

  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& /*t*/, T* u) const {
    T norm2(0.0);
    for (int c = 0; c < 3; ++c) {
      const T d = Difference(q + c);
      norm2 += d * d;
    }
    for (int i = 0; i < kOrder; ++i) norm2 = norm2 / (h * h);
    u[0] = (norm2 - limit_ * limit_) * (0.5 / limit_);
  }

  void Jacobian(int /*k*/, const double* q, double h, double /*t*/, double* u, double* du,
                double* du_dh) const {
    const double scale = kOrder == 1 ? 1.0 / (h * h) : 1.0 / (h * h * h * h);
    double norm2 = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double d = Difference(q + c);
      norm2 += d * d;
      for (int i = 0; i <= kOrder; ++i) du[3 * i + c] = d * kRow[i] * scale / limit_;
    }
    u[0] = (norm2 * scale - limit_ * limit_) * (0.5 / limit_);
    du_dh[0] = -kOrder * norm2 * scale / (h * limit_);
  }

 private:
  static constexpr int kFirst = kOrder == 1 ? 2 : 1;
  static constexpr double kRow[3] = {kOrder == 1 ? -1.0 : 1.0, kOrder == 1 ? 1.0 : -2.0, 1.0};

  template <class T>
  static T Difference(const T* q) {
    T d(0.0);
    for (int i = 0; i <= kOrder; ++i) d += kRow[i] * q[3 * i];
    return d;
  }

  int windows_;
  double limit_;
};

template <int kOrder>
std::shared_ptr<solvers::Term> Make(const solvers::TermInfo& info, int control_points, double limit,
                                    double weight, double width) {
  if (!(limit > 0.0)) {
    throw std::invalid_argument(info.name + ": limit is " + std::to_string(limit) +
                                ", it must be > 0");
  }
  // Up to V_{N-3} and A_{N-3}, which the end state moves.
  const int windows = control_points - (kOrder == 1 ? 4 : 3);
  return std::make_shared<solvers::WindowTerm<DerivativeNorm<kOrder>, solvers::HingeLoss>>(
      info, DerivativeNorm<kOrder>(windows, limit), solvers::HingeLoss(weight, width), windows);
}

solvers::TermInfo SpeedInfo() {
  return {"speed_limit", "w sum hinge((|V|^2 - vmax^2) / (2 vmax))", "m/s", "paper eq. 15", true};
}

solvers::TermInfo AccelerationInfo() {
  return {"acceleration_limit", "w sum hinge((|A|^2 - amax^2) / (2 amax))", "m/s^2", "paper eq. 15",
          true};
}

}  // namespace

std::shared_ptr<solvers::Term> MakeSpeedLimit(int control_points, double limit, double weight,
                                              double width) {
  return Make<1>(SpeedInfo(), control_points, limit, weight, width);
}

std::shared_ptr<solvers::Term> MakeAccelerationLimit(int control_points, double limit,
                                                     double weight, double width) {
  return Make<2>(AccelerationInfo(), control_points, limit, weight, width);
}

solvers::TermFactory SpeedLimitFactory() {
  return {SpeedInfo(), [](int blocks, std::mt19937_64& random) {
            std::uniform_real_distribution<double> draw(0.5, 3.0);
            return MakeSpeedLimit(blocks, draw(random), 10.0, 0.3);
          }};
}

solvers::TermFactory AccelerationLimitFactory() {
  return {AccelerationInfo(), [](int blocks, std::mt19937_64& random) {
            std::uniform_real_distribution<double> draw(0.5, 3.0);
            return MakeAccelerationLimit(blocks, draw(random), 10.0, 0.3);
          }};
}

}  // namespace touchdown::planning
