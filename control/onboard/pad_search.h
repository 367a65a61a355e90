// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/estimation/pad/pad_filter.h"
#include "touchdown/estimation/tags/pad_finder.h"

namespace touchdown::control {

/// Finds the pad in the images of the camera that looks for it. Belongs to one thread.
class PadSearch {
 public:
  /// @param thrifty do not search images in which the expected pad cannot be; this saves time and
  /// changes nothing as long as the expectation is not off by more than it says it may be.
  explicit PadSearch(bool thrifty = true) : thrifty_(thrifty) {}

  /// The sighting that the image shows, if any. `believed` is the own state at the image's time, `expected` knows where
  /// the pad should be. The image is possible (estimation::IsPossible). Allocates.
  std::optional<estimation::PadSighting> Find(const estimation::PadImage& image,
                                              const estimation::VehicleState& believed,
                                              const estimation::PadFilter& expected);

  /// The last image was searched.
  bool searched() const { return passed_over_ == 0; }

 private:
  bool MayShow(const estimation::PadImage& image, const estimation::VehicleState& believed,
               const estimation::PadFilter& expected) const;

  bool thrifty_;
  int passed_over_ = 0;
  std::optional<estimation::PadFinder>
      finder_;  // since the first search: not everybody has a camera
};

/// Whether a pad at p_C, its centre in the camera's frame [m], with anything of its sheet within
/// `radius` of there, may show a tag in the image.
bool MayShowPad(const Eigen::Vector3d& p_C, double radius,
                const estimation::CameraIntrinsics& camera);

}  // namespace touchdown::control
