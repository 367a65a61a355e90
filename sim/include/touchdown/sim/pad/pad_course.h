// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/sim/pad/curvature_chain.h"
#include "touchdown/sim/pad/figure_eight.h"
#include "touchdown/sim/pad/pace.h"

namespace touchdown::sim {

/// Never exceeded by a motion, at any time.
struct PadMotionBounds {
  double speed = 0.0;             ///< [m/s]
  double acceleration = 0.0;      ///< [m/s^2]
  double yaw_acceleration = 0.0;  ///< [rad/s^2]
};

/// Where the pad's drive is commanded to be: a pure function of time, on level ground.
class PadCourse {
 public:
  virtual ~PadCourse() = default;

  /// State at time t [s], any finite t, also negative. v, a, j are the exact derivatives of p. All are continuous. The
  /// height is constant. The yaw is not wrapped, so it is continuous too. A pad that drives backwards keeps its yaw.
  /// cov_p is zero. Does not allocate.
  virtual estimation::PadState At(double t) const noexcept = 0;

  virtual PadMotionBounds bounds() const = 0;
};

/// A path, and how it is driven: what every motion of the library is.
class PathCourse : public PadCourse {
 public:
  using Path = std::variant<CurvatureChain, FigureEight>;

  /// At a constant speed [m/s], `phase` metres on at t = 0; `height` is that of the deck's upper face [m].
  /// Throws std::invalid_argument if a chain has no stretch, or a number is not finite.
  PathCourse(Path path, double height, double speed, double phase);
  /// As `pace` says, from `t_phase` [s] of it on.
  PathCourse(Path path, double height, Pace pace, double t_phase);

  estimation::PadState At(double t) const noexcept override;
  PadMotionBounds bounds() const override;

 private:
  void Check() const;
  PathPoint PathAt(double s) const noexcept;
  PacePoint PaceAt(double t) const noexcept;

  Path path_;
  double height_;
  double speed_ = 0.0;
  std::optional<Pace> pace_;  ///< none: at constant speed
  double phase_;
};

/// The pad's future known exactly: the oracle of tests and studies.
class OraclePadPrediction final : public estimation::PadPrediction {
 public:
  explicit OraclePadPrediction(std::shared_ptr<const PadCourse> course)
      : course_(std::move(course)) {}
  template <std::derived_from<PadCourse> Course>
  explicit OraclePadPrediction(Course course)
      : course_(std::make_shared<Course>(std::move(course))) {}
  estimation::PadState At(double t) const noexcept override { return course_->At(t); }

 private:
  std::shared_ptr<const PadCourse> course_;
};

}  // namespace touchdown::sim
