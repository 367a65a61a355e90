// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "estimation/tags/pad_tags.h"
#include "evaluation/base/statistics.h"
#include "sim/sensors/pad_camera.h"
#include "touchdown/estimation/tags/pad_finder.h"

namespace touchdown::evaluation {

/// Rendered views of the pad from random places: whether it is found, with which error and which claimed error.
struct TagStudyOptions {
  int poses = 500;
  std::uint64_t seed = 1;
  sim::PadCameraConfig camera;
  estimation::PadFinderOptions finder;
  /// Of the vehicle's own attitude, which tells the deck's normal [deg]; the study draws its error.
  double attitude_sigma_deg = 1.0;
  double speed = 0.0;  ///< of the vehicle over the pad, sideways, for motion blur [m/s]
};

/// Heights of the camera above the deck that are drawn from, evenly [m].
inline constexpr double kLowestView = 0.25;
inline constexpr double kHighestView = 6.0;
/// Largest tilt of the vehicle [deg].
inline constexpr double kLargestTilt = 20.0;

/// One tag of one view.
struct TagRow {
  bool in_view = false;  ///< wholly
  bool found = false;
  double size_px = 0.0;         ///< shortest side in the image
  double view_angle_deg = 0.0;  ///< of the line of sight off the deck's normal
  double corner_rms_px = 0.0;   ///< of its corners, where found
};

/// One view. Errors are those of a pose that was found.
struct TagStudyRow {
  double height = 0.0;    ///< of the camera above the deck [m]
  double distance = 0.0;  ///< from the camera to the pad's centre [m]
  double tilt_deg = 0.0;
  estimation::VehicleState vehicle;  ///< where it was seen from
  estimation::PadState pad;
  std::array<TagRow, estimation::kPadTagCount> tags;
  estimation::PadPoseStatus status = estimation::PadPoseStatus::kNoTag;
  bool aligned = false;
  double position_error = 0.0;            ///< [m]
  double rotation_error_deg = 0.0;        ///< of the whole rotation
  double nees = 0.0;                      ///< over its 6 degrees of freedom
  double sigma = 0.0;                     ///< claimed, root of the position covariance's trace [m]
  double render_ms = 0.0, find_ms = 0.0;  ///< CPU

  bool InView() const;
  bool Solved() const { return status == estimation::PadPoseStatus::kSolved; }
};

/// Called with a view's index, its image and what was found in it.
using ViewObserver =
    std::function<void(int, const estimation::GrayImage&, const estimation::PadView&,
                       const estimation::CameraIntrinsics&)>;

/// The views of `options`. They are the same for any camera, except for its field of view.
/// @throws std::invalid_argument naming the option. @param progress done, all.
std::vector<TagStudyRow> RunTagStudy(const TagStudyOptions& options,
                                     const std::function<void(int, int)>& progress,
                                     const ViewObserver& observer = {});

/// Views of one range of heights.
struct TagStudyBin {
  double from = 0.0, to = 0.0;  ///< [m]
  int views = 0;
  int not_in_view = 0;  ///< no whole tag in the image
  int found = 0;        ///< of those with one
  int aligned = 0;
  int center_in_view = 0, center_found = 0;  ///< tags
  int outer_in_view = 0, outer_found = 0;
  Quantiles position_mm, rotation_deg;
  std::optional<double> nees;  ///< mean over degrees of freedom; none without a pose
};
TagStudyBin Summarise(const std::vector<TagStudyRow>& rows, double from, double to);

/// The ranges of the table.
std::vector<TagStudyBin> TagStudyBins(const std::vector<TagStudyRow>& rows);

}  // namespace touchdown::evaluation
