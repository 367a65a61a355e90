// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Geometry>

#include "evaluation/video/flight_track.h"
#include "sim/rendering/scene_mjcf.h"
#include "sim/sensors/pad_camera.h"
#include "sim/sensors/rendered_depth_camera.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// The cameras' frames in B.
Eigen::Isometry3d DownCameraPose(const Scenario& scenario);
Eigen::Isometry3d DepthCameraPose(const Scenario& scenario);

/// What the vehicle's cameras see, rendered again; the noise of the images in flight was different. Belongs to the
/// thread that made it; times must not go back.
class FlightCameras {
 public:
  /// @throws as sim::PadCamera and sim::RenderedDepthCamera do.
  FlightCameras(const Scenario& scenario, const sim::VisualScene& scene);

  /// Images a second: the camera's rate, or less where large images would make the file too large.
  double down_rate() const { return down_rate_; }
  double depth_rate() const { return depth_rate_; }

  /// foxglove.CompressedImage, PNG, grey.
  std::string DownImage(const TrackSample& now);
  /// foxglove.RawImage, 16 bits, millimetres along the optical axis; 0: nothing within the range.
  std::string DepthImage(const TrackSample& now);

  /// foxglove.CameraCalibration.
  std::string DownCalibration(double t) const;
  std::string DepthCalibration(double t) const;

 private:
  sim::PadCamera down_;
  sim::RenderedDepthCamera depth_;
  double down_rate_, depth_rate_;
  estimation::GrayImage gray_;
  estimation::DepthFrame frame_;
};

}  // namespace touchdown::evaluation
