// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "touchdown/estimation/base/gray_image.h"
#include "touchdown/estimation/base/measurements.h"
#include "touchdown/estimation/tags/pad_pose.h"
#include "touchdown/estimation/tags/pad_reprojection.h"
#include "touchdown/estimation/tags/sheet_average.h"

namespace touchdown::estimation {

struct PadAlignmentOptions {
  double blur = 1.2;         ///< side of the square that one pixel sees at least [pixel], in [1, 2]
  int max_pixels = 8000;     ///< a pad that covers more is left alone: its corners are sharp enough
  double correlation = 0.9;  ///< of image and model, demanded, in [0, 1]
  double neighbors = 1.0;    ///< one of so many pixels with the same error counts, >= 1
};

/// Makes the pose of a pad that is small in the image more exact. It uses every pixel of the
/// printed sheet, in found tags or not, instead of the corners of the found tags.
class PadAlignment {
 public:
  /// Throws std::invalid_argument for an option out of its range.
  explicit PadAlignment(const PadAlignmentOptions& options = {});

  /// Replaces pose and covariance if the printed sheet is found in the image near the pose.
  /// Otherwise leaves them as they are. `pose` must be kSolved. Allocates at the first images.
  /// @param normal what is known of the deck's normal, as in SolvePadPose.
  /// @returns whether the pose was replaced.
  bool Refine(const GrayImageView& image, const CameraIntrinsics& camera,
              const std::optional<PadNormal>& normal, PadPose* pose);

  /// Whether a pad there covers too much of the image to be aligned, or is too near for it.
  bool TooLarge(const GrayImageView& image, const CameraIntrinsics& camera, const PadPose& pose);

 private:
  struct Sums;
  struct State;
  bool SetWindow(const GrayImageView& image, const CameraIntrinsics& camera, const PadPose& pose);
  double Doubt(const PadPose& pose) const;
  double ModelAt(double u, double v, const Eigen::Matrix3d& from_ray, double blur) const;
  void FillModel(const PoseCP& pose, double blur);
  Sums SumsAt(const State& state, double blur);
  bool Converge(const std::optional<PadNormal>& normal, double blur, State* state);

  PadAlignmentOptions options_;
  SheetAverage sheet_;
  // Of the image at hand:
  GrayImageView image_;
  CameraIntrinsics camera_;
  int left_ = 0, top_ = 0, width_ = 0, height_ = 0;  ///< the part that is looked at
  std::vector<double> model_;                        ///< of that part; NaN: not of the sheet alone
};

}  // namespace touchdown::estimation
