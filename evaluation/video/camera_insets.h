// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimation/base/sample_clock.h"
#include "evaluation/video/flight_track.h"
#include "evaluation/video/picture.h"
#include "sim/sensors/pad_camera.h"
#include "sim/sensors/rendered_depth_camera.h"
#include "touchdown/estimation/tags/pad_finder.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// What the vehicle's two cameras see, as the scenario has them. The downward camera shows the tags that are found; the
/// depth camera is in colours. Always rendered, whatever `sensing` says.
class CameraInsets {
 public:
  /// @throws as sim::PadCamera and sim::RenderedDepthCamera do.
  CameraInsets(const Scenario& scenario, const sim::VisualScene& scene);

  /// Takes the images that are due. Times must not go back.
  void Look(const TrackSample& now);

  /// Draws both, one above the other. @param area how much room there is; its height is not used up.
  /// @param gap between what is drawn [pixel].
  void Draw(const PictureArea& area, int gap, const sim::Font& font, Picture* picture) const;

 private:
  void LookDown(const TrackSample& now);
  void LookAhead(const TrackSample& now);

  sim::PadCamera pad_camera_;
  sim::RenderedDepthCamera depth_camera_;
  estimation::PadFinder finder_;
  estimation::SampleClock pad_clock_, depth_clock_;
  estimation::GrayImage gray_;
  estimation::DepthFrame frame_;
  std::vector<estimation::TagDetection> tags_;
  Picture down_, ahead_;
};

}  // namespace touchdown::evaluation
