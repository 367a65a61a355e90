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
  /// @param thrifty do not search images in which the expected pad cannot be. This saves time and
  /// changes nothing as long as the expectation's error is within its stated bound.
  explicit PadSearch(bool thrifty = true) : thrifty_(thrifty) {}

  /// The sighting that the image shows, if any. `believed` is the own state at the image's time,
  /// `expected` predicts the pad. The image is possible (estimation::IsPossible). Allocates.
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

/// Whether a tag may show in the image. p_C is the pad's expected centre in the camera's frame [m];
/// all of its sheet is within `radius` of it.
bool MayShowPad(const Eigen::Vector3d& p_C, double radius,
                const estimation::CameraIntrinsics& camera);

}  // namespace touchdown::control
