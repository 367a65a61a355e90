// SPDX-License-Identifier: BSD-3-Clause
// libapriltag 3.3 (J. Wang and E. Olson, "AprilTag 2: efficient and robust fiducial detection",
// 2016) for the family TAG36H11: no decimation, one thread, edges refined on the grey image.
// Only the pad's five codes are searched for. They differ from each other, however they are turned,
// in 11 bits or more. So three wrong bits, the library's most, may be forgiven. A random square of
// 36 bits passes as a tag with probability 5 * 4 * 7807 / 2^36 = 2e-6. Cells of one pixel are also
// sharpened harder than the library does by itself. Both let tags be read down to 8 pixels a side.
// The library's corners follow (-1,1), (1,1), (1,-1), (-1,-1) of a tag whose y axis points down,
// which is the order of PadTag::Corners().

#include "touchdown/estimation/tags/tag_detector.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "estimation/tags/enlarge.h"
#include "estimation/tags/pad_tags.h"

namespace touchdown::estimation {
namespace {

constexpr int kMinSide = 8;      // [pixel]
constexpr double kBorder = 1.0;  // [pixel]
constexpr int kForgivenBits = 3;
constexpr double kSharpening = 4.0;

void Check(const GrayImageView& image) {
  if (image.data == nullptr) throw std::invalid_argument("image.data is null");
  if (image.width < kMinSide || image.height < kMinSide || image.stride < image.width) {
    throw std::invalid_argument("image is " + std::to_string(image.width) + " x " +
                                std::to_string(image.height) + " with a stride of " +
                                std::to_string(image.stride) +
                                "; allowed is at least 8 x 8 and a stride of at least the width");
  }
}

// Of a tag that the image's border cuts, the corners are where the border is.
bool Whole(const apriltag_detection_t& tag, const GrayImageView& image) {
  return std::all_of(tag.p, tag.p + 4, [&image](const double* corner) {
    return corner[0] >= kBorder && corner[0] <= image.width - kBorder && corner[1] >= kBorder &&
           corner[1] <= image.height - kBorder;
  });
}

}  // namespace

class TagDetector::Impl {
 public:
  explicit Impl(const TagDetectorOptions& options)
      : enlarge_(options.enlarge),
        family_(tag36h11_create(), tag36h11_destroy),
        detector_(apriltag_detector_create(), apriltag_detector_destroy) {
    detector_->quad_decimate = 1.0F;
    detector_->quad_sigma = 0.0F;
    detector_->nthreads = 1;
    detector_->refine_edges = true;
    detector_->decode_sharpening = kSharpening;
    family_->ncodes = kPadTagCount;
    apriltag_detector_add_family_bits(detector_.get(), family_.get(), kForgivenBits);
  }

  std::vector<TagDetection> Detect(GrayImageView image) {
    if (enlarge_ == 2) {
      EnlargeTwice(image, &enlarged_);
      image = enlarged_.View();
    }
    // libapriltag does not write to the image it is given.
    image_u8_t borrowed = {image.width, image.height, image.stride,
                           const_cast<std::uint8_t*>(image.data)};
    const std::unique_ptr<zarray_t, void (*)(zarray_t*)> found(
        apriltag_detector_detect(detector_.get(), &borrowed), apriltag_detections_destroy);
    std::vector<TagDetection> tags;
    for (int i = 0; i < zarray_size(found.get()); ++i) {
      apriltag_detection_t* one = nullptr;
      zarray_get(found.get(), i, &one);
      if (Whole(*one, image)) Add(*one, &tags);
    }
    return tags;
  }

 private:
  void Add(const apriltag_detection_t& one, std::vector<TagDetection>* tags) const {
    TagDetection tag;
    tag.id = one.id;
    tag.decision_margin = one.decision_margin;
    tag.hamming = one.hamming;
    for (int k = 0; k < 4; ++k) tag.corners.col(k) << one.p[k][0], one.p[k][1];
    tag.corners /= enlarge_;
    const auto place =
        std::lower_bound(tags->begin(), tags->end(), tag.id,
                         [](const TagDetection& other, int id) { return other.id < id; });
    if (place == tags->end() || place->id != tag.id) {
      tags->insert(place, tag);
    } else if (place->decision_margin < tag.decision_margin) {
      *place = tag;
    }
  }

  int enlarge_;
  GrayImage enlarged_;
  std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family_;
  std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector_;
};

TagDetector::TagDetector(const TagDetectorOptions& options) {
  if (options.enlarge != 1 && options.enlarge != 2) {
    throw std::invalid_argument("tag_detector.enlarge is " + std::to_string(options.enlarge) +
                                "; allowed is 1 or 2");
  }
  impl_ = std::make_unique<Impl>(options);
}
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;
TagDetector::~TagDetector() = default;

std::vector<TagDetection> TagDetector::Detect(const GrayImageView& image) {
  Check(image);
  return impl_->Detect(image);
}

}  // namespace touchdown::estimation
