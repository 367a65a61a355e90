// SPDX-License-Identifier: BSD-3-Clause
// The piecewise linear way, convolved with a quadratic B-spline K of width three times w. A knot at which the speed
// changes by d adds d (R(x) - max(0, x)). Here R'' = K, and x is the time since the knot. Farther than 1.5 w from it
// R(x) = max(0, x). The smoothed speed is an average of the speeds of the stretches nearby: it stays between the
// slowest and the fastest. With r their difference (integrate the convolution by parts):
//   |acceleration| <= r max K = 0.75 r / w,  |jerk| <= r times the integral of the positive part of K'' = 2 r / w^2.

#include "touchdown/sim/pad/pace.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "estimation/base/argument_check.h"

namespace touchdown::sim {
namespace {

// The smoothed ramp R at x = y w with derivatives, less the sharp one, by truncated powers.
void AddRamp(double x, double w, double d, PacePoint* sum) {
  constexpr double kBinomial[4] = {1.0, -3.0, 3.0, -1.0};
  const double y = x / w;
  double p4 = 0.0, p3 = 0.0, p2 = 0.0, p1 = 0.0;
  for (int j = 0; j < 4; ++j) {
    const double z = y + 1.5 - j;
    if (z <= 0.0) break;
    p1 += kBinomial[j] * z;
    p2 += kBinomial[j] * z * z / 2.0;
    p3 += kBinomial[j] * z * z * z / 6.0;
    p4 += kBinomial[j] * z * z * z * z / 24.0;
  }
  sum->s += d * (w * p4 - std::max(0.0, x));
  sum->speed += d * (p3 - (x >= 0.0 ? 1.0 : 0.0));  // a knot begins its stretch
  sum->acceleration += d * p2 / w;
  sum->jerk += d * p1 / (w * w);
}

}  // namespace

Pace::Pace(std::vector<Knot> knots, double smoothing)
    : knots_(std::move(knots)), smoothing_(smoothing) {
  estimation::CheckAbove("smoothing of the pace [s]", smoothing, 0.0, 1e6);
  if (knots_.size() < 2) throw std::invalid_argument("a pace needs two knots");
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    if (!(knots_[i + 1].t > knots_[i].t)) {
      throw std::invalid_argument("times of a pace must rise, and " +
                                  std::to_string(knots_[i + 1].t) + " s follows " +
                                  std::to_string(knots_[i].t) + " s");
    }
    const double speed = SlopeAfter(i);
    slowest_ = i == 0 ? speed : std::min(slowest_, speed);
    fastest_ = i == 0 ? speed : std::max(fastest_, speed);
  }
}

// A change reaches into the neighbouring periods only, so that three of them serve for the middle one.
Pace Pace::Periodic(const std::vector<Knot>& knots, double smoothing) {
  if (knots.size() < 2) throw std::invalid_argument("a pace needs two knots");
  const Knot& first = knots.front();
  const Knot period = {knots.back().t - first.t, knots.back().s - first.s};
  std::vector<Knot> three;
  for (const double shift : {-1.0, 0.0, 1.0}) {
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      three.push_back({knots[i].t + shift * period.t, knots[i].s + shift * period.s});
    }
  }
  three.push_back({first.t + 2.0 * period.t, first.s + 2.0 * period.s});
  Pace pace(std::move(three), smoothing);
  estimation::CheckWithin("smoothing of the pace [s]", smoothing, 0.0, period.t / 1.5);
  pace.period_ = period;
  return pace;
}

double Pace::SlopeAfter(std::size_t knot) const {
  const Knot& a = knots_[knot];
  const Knot& b = knots_[knot + 1];
  return (b.s - a.s) / (b.t - a.t);
}

double Pace::SmoothingFor(double range, double acceleration, double jerk) {
  return std::max(0.75 * range / acceleration, std::sqrt(2.0 * range / jerk));
}

PacePoint Pace::At(double t) const noexcept {
  if (period_.t == 0.0) return AmongKnots(t);
  const double middle = knots_.front().t + period_.t;
  const double past = std::floor((t - middle) / period_.t);
  PacePoint point = AmongKnots(t - past * period_.t);
  point.s += past * period_.s;
  return point;
}

PacePoint Pace::AmongKnots(double t) const noexcept {
  const auto later = [](double at, const Knot& knot) { return at < knot.t; };
  // Inner knots alone: the outer two end no stretch.
  const auto first = knots_.begin() + 1, last = knots_.end() - 1;
  const auto next = std::upper_bound(first, last, t, later);
  const Knot& from = *(next - 1);
  PacePoint point;
  point.speed = SlopeAfter(static_cast<std::size_t>(next - 1 - knots_.begin()));
  point.s = from.s + point.speed * (t - from.t);
  const double far = 1.5 * smoothing_;
  for (auto knot = std::upper_bound(first, last, t - far, later); knot < last && knot->t < t + far;
       ++knot) {
    const auto i = static_cast<std::size_t>(knot - knots_.begin());
    AddRamp(t - knot->t, smoothing_, SlopeAfter(i) - SlopeAfter(i - 1), &point);
  }
  return point;
}

}  // namespace touchdown::sim
