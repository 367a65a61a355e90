// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace touchdown::sim {

/// The steepest slope of the smooth step 3u^2 - 2u^3, over its mean.
inline constexpr double kSteepestStep = 1.5;

/// A point of a plane path, by arc length.
struct PathPoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();  ///< [m]
  double yaw = 0.0;                             ///< direction of the path, not wrapped [rad]
  double curvature = 0.0;                       ///< left positive [1/m]
  double curvature_slope = 0.0;                 ///< its derivative by arc length [1/m^2]
};

/// Steepest curvature and steepest change of it along a path.
struct PathBounds {
  double curvature = 0.0;        ///< [1/m]
  double curvature_slope = 0.0;  ///< [1/m^2]
};

/// A plane path of straights, arcs and smooth turns, in arc length. It is a chain of segments. Within a segment the
/// curvature goes from one value to another along the smooth step 3u^2 - 2u^3. So curvature and its slope are
/// continuous over the chain if its values are. The first segment continues backwards and the last one forwards without
/// end, if their curvature is constant.
class CurvatureChain {
 public:
  CurvatureChain(const Eigen::Vector2d& start, double heading) : start_(start), heading_(heading) {}

  /// Adds a segment whose curvature goes from k0 to k1 [1/m] over `length` [m]. Throws std::invalid_argument unless
  /// the length is >= 0 and all is finite.
  void Append(double length, double k0, double k1);

  /// Any s [m]; s = 0 is the start. Does not allocate. The chain must have a segment.
  PathPoint At(double s) const noexcept;

  bool empty() const { return segments_.empty(); }
  double length() const;  ///< of all segments [m]
  PathBounds bounds() const;

 private:
  struct Segment {
    double s0 = 0.0;      ///< arc length at its beginning [m]
    double length = 0.0;  ///< [m]
    double k0 = 0.0;      ///< curvature at its beginning [1/m]
    double k1 = 0.0;      ///< and at its end
    Eigen::Vector2d p0 = Eigen::Vector2d::Zero();
    double yaw0 = 0.0;
  };
  static PathPoint PointOn(const Segment& segment, double s) noexcept;

  Eigen::Vector2d start_;
  double heading_;
  std::vector<Segment> segments_;
};

}  // namespace touchdown::sim
