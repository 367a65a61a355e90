// SPDX-License-Identifier: BSD-3-Clause
// Smoothness: the exact integral of squared acceleration and jerk of a uniform cubic B-spline, one
// window of four control points per segment.

#include "touchdown/planning/terms/smoothness.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "touchdown/solvers/window_term.h"

namespace touchdown::planning {

namespace {

// Mean acceleration and jerk of a segment are these rows times the four control points, over 2 h^2
// and h^3.
constexpr double kMeanAcceleration[4] = {1.0, -1.0, -1.0, 1.0};
constexpr double kJerk[4] = {-1.0, 3.0, -3.0, 1.0};

class SegmentDerivatives {
 public:
  static constexpr int kBlockSize = 3, kWindow = 4, kOutputs = 6;
  static constexpr bool kUsesInterval = true;
  static constexpr bool kLinearInBlocks = true;

  SegmentDerivatives(int segments, double jerk_weight)
      : segments_(segments), jerk_weight_(jerk_weight) {}

  int windows() const { return segments_; }
  int first_block(int k) const { return k; }

  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& /*t*/, T* u) const {
    using std::sqrt;
    const T scale_a = sqrt(h) / (2.0 * h * h);
    const T scale_j = sqrt(h * (jerk_weight_ + h * h / 12.0)) / (h * h * h);
    for (int c = 0; c < 3; ++c) {
      T a(0.0), j(0.0);
      for (int i = 0; i < 4; ++i) {
        a += kMeanAcceleration[i] * q[3 * i + c];
        j += kJerk[i] * q[3 * i + c];
      }
      u[c] = scale_a * a;
      u[3 + c] = scale_j * j;
    }
  }

  void Jacobian(int /*k*/, const double* q, double h, double /*t*/, double* u, double* du,
                double* du_dh) const {
    const double scale_a = 0.5 * std::pow(h, -1.5);
    const double g = jerk_weight_ + h * h / 12.0;
    const double scale_j = std::sqrt(g) * std::pow(h, -2.5);
    // d/dh of h^-1.5 / 2 and of sqrt(g) h^-2.5, as multiples of the scales themselves.
    const double slope_a = -1.5 / h;
    const double slope_j = g > 0.0 ? h / (12.0 * g) - 2.5 / h : -2.5 / h;
    for (int i = 0; i < 6 * 12; ++i) du[i] = 0.0;
    for (int c = 0; c < 3; ++c) {
      double a = 0.0, j = 0.0;
      for (int i = 0; i < 4; ++i) {
        a += kMeanAcceleration[i] * q[3 * i + c];
        j += kJerk[i] * q[3 * i + c];
        du[c * 12 + 3 * i + c] = scale_a * kMeanAcceleration[i];
        du[(3 + c) * 12 + 3 * i + c] = scale_j * kJerk[i];
      }
      u[c] = scale_a * a;
      u[3 + c] = scale_j * j;
      du_dh[c] = slope_a * u[c];
      du_dh[3 + c] = slope_j * u[3 + c];
    }
  }

 private:
  int segments_;
  double jerk_weight_;
};

solvers::TermInfo Info() {
  return {"smoothness", "w int (|a|^2 + w_j |j|^2) dt", "m/s^1.5", "paper eq. 15", true};
}

}  // namespace

std::shared_ptr<solvers::Term> MakeSmoothness(int control_points, double weight,
                                              double jerk_weight) {
  if (!(jerk_weight >= 0.0)) {
    throw std::invalid_argument("smoothness: jerk_weight is " + std::to_string(jerk_weight) +
                                " s^2, it must be >= 0");
  }
  const int segments = control_points - 3;
  // The square loss is w u^2 / 2; the integral wants w u^2.
  return std::make_shared<solvers::WindowTerm<SegmentDerivatives, solvers::SquareLoss>>(
      Info(), SegmentDerivatives(segments, jerk_weight), solvers::SquareLoss(2.0 * weight),
      segments);
}

solvers::TermFactory SmoothnessFactory() {
  return {Info(), [](int blocks, std::mt19937_64& random) {
            std::uniform_real_distribution<double> draw(0.01, 2.0);
            const double weight = draw(random);
            return MakeSmoothness(blocks, weight, draw(random));
          }};
}

}  // namespace touchdown::planning
