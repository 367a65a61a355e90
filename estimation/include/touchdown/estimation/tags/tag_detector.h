// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "touchdown/estimation/base/gray_image.h"
#include "touchdown/estimation/base/tag_detection.h"

namespace touchdown::estimation {

struct TagDetectorOptions {
  /// Images are enlarged by this factor before tags are looked for, 1 or 2. Finds smaller tags and
  /// sharper corners, for about three times the time.
  int enlarge = 1;
};

/// Finds the pad's tags in images. One TagDetector belongs to one thread.
class TagDetector {
 public:
  /// Throws std::invalid_argument for an option out of its range.
  explicit TagDetector(const TagDetectorOptions& options = {});
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;
  ~TagDetector();

  /// The tags of the pad (no other ids, at most three wrong bits, each id once) in the order of
  /// their ids.
  /// Allocates. Throws std::invalid_argument for an image without data, smaller than 8 x 8 pixels
  /// or with a stride below its width.
  std::vector<TagDetection> Detect(const GrayImageView& image);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchdown::estimation
