// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>

#include <Eigen/Core>

#include "touchdown/estimation/pad/pad_prediction.h"
#include "touchdown/planning/certify/free_space.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::planning {

/// What the hull may sweep until it rests: cells that were observed free, and the deck
/// (docs/safety.md). A view of the map, made anew for every replanning step.
struct HullSpace {
  const FreeSpace* space = nullptr;  ///< its map; its floor and ceiling for the body's origin
  double hull_radius = 0.0;          ///< of the hull at every tilt [m]
  double margin = 0.0;               ///< around it: Margins::Sum [m]
  /// Where the deck will be; nullptr: there is none.
  const estimation::PadPrediction* pad = nullptr;
  double deck_half_size = 0.0;  ///< half the deck's side [m]
  double foot_depth = 0.0;      ///< of the feet below the body's origin [m]
  /// Only cells seen to be occupied block: for a trajectory that was proven before.
  bool unseen_passes = false;
  /// The start is on a proven flight pair: the cells among which the hull starts were observed free then, or are the deck's.
  bool start_proven = false;

  double radius() const { return hull_radius + margin; }
};

/// Cells that are not observed free among which a sweep starts. It only moves away from these.
struct StartCells {
  bool occupied = false;  ///< the hull is among some that are seen to be occupied
  bool unknown = false;   ///< ... that are neither, and to which no proven flight pair has led it
  bool narrow = false;    ///< the grown hull is among either

  bool leaves() const { return occupied || unknown; }
  StartCells operator|(const StartCells& other) const {
    return {occupied || other.occupied, unknown || other.unknown, narrow || other.narrow};
  }
};

/// The result of a sweep along a curve.
struct Sweep {
  bool proven = false;
  StartCells start;
  /// First place that is not observed free, in W [m], if that is why nothing is proven.
  std::optional<Eigen::Vector3d> unseen_W;
};

/// Where and when a sweep begins.
struct HullStart {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< of the body's origin [m]
  double t = 0.0;                                 ///< [s]
};

/// What SweepHull adds to the grown hull for the way between two positions that it tests [m].
inline constexpr double kSweepRoom = 0.01;

/// A foot of a vehicle that leans by 20 degrees hangs so much lower [m].
inline constexpr double kFootLowers = 0.05;

/// What the landing rule allows at contact, relative to the deck [m/s]. A landing that is to be committed may use
/// this share of it.
inline constexpr double kSoftSink = 0.5;
inline constexpr double kSoftDrift = 0.6;
inline constexpr double kLandingRoom = 0.9;

/// Whether this velocity relative to the deck keeps to `share` of it [m/s]. Does not allocate.
inline bool IsSoft(const Eigen::Vector3d& v_PB, double share) {
  return -v_PB.z() <= share * kSoftSink && v_PB.head<2>().norm() <= share * kSoftDrift;
}

/// At any time, and at none: when the hull may touch the deck [s].
inline constexpr double kAnyTime = -std::numeric_limits<double>::infinity();
inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// Checks the curve from t_from to t_to [s], past its end at its end's velocity. The hull, grown by
/// the margins, must stay in observed-free cells, and the body's origin between floor and ceiling.
/// Exceptions:
/// - cells that end below the map's ground height;
/// - while the body's origin may be over the deck (within the error of its prediction): cells that
///   end at or below the deck's upper face, and unless occupied also cells over the deck where the
///   noise puts its returns;
/// - at the start: cells around `start` that the hull already reached there and does not approach.
///
/// Before `t_contact` [s] the feet are above the deck while the hull may be over it, and sink softly close to it. A
/// start that is lower and rises is allowed. Does not allocate.
Sweep SweepHull(const UniformBspline& curve, double t_from, double t_to, const HullStart& start,
                const HullSpace& hull, double t_contact);

}  // namespace touchdown::planning
