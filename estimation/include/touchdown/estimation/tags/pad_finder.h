// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "touchdown/estimation/tags/pad_alignment.h"
#include "touchdown/estimation/tags/pad_pose.h"
#include "touchdown/estimation/tags/tag_detector.h"

namespace touchdown::estimation {

struct PadFinderOptions {
  /// If the image itself is not enough, search it enlarged: finds tags down to 8 pixels a side.
  bool enlarge = true;
  PadPoseOptions pose;
  bool align = true;  ///< the whole sheet with the image, once tags are found
  PadAlignmentOptions alignment;
};

/// The pad in an image.
struct PadView {
  std::vector<TagDetection> tags;
  PadPose pose;
  bool aligned = false;  ///< the pose is that of the whole sheet, not of the tags' corners
};

/// From an image to the pad's pose: detects tags, solves for one pose of all their corners, aligns
/// the printed sheet with the image. A frame without a pad costs the most time. One PadFinder belongs to one thread.
class PadFinder {
 public:
  /// Throws std::invalid_argument for an option out of its range.
  explicit PadFinder(const PadFinderOptions& options = {});

  /// @param normal what is known of the deck's normal (LevelPadNormal). Throws as TagDetector and
  /// SolvePadPose do. Allocates.
  PadView Find(const GrayImageView& image, const CameraIntrinsics& camera,
               const std::optional<PadNormal>& normal = std::nullopt);

 private:
  PadView FindAt(TagDetector* detector, const GrayImageView& image, const CameraIntrinsics& camera,
                 const std::optional<PadNormal>& normal);

  PadFinderOptions options_;
  TagDetector detector_;
  TagDetector enlarging_;
  PadAlignment alignment_;
};

}  // namespace touchdown::estimation
