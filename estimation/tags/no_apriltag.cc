// SPDX-License-Identifier: BSD-3-Clause
// Stands in for the AprilTag sources where the build has no AprilTag: sightings of the pad come from elsewhere.
#include <stdexcept>

#include "estimation/tags/tag_code.h"
#include "touchdown/estimation/tags/tag_detector.h"

namespace touchdown::estimation {
namespace {

[[noreturn]] void RefuseTags() {
  throw std::invalid_argument("tags are neither printed nor found: built without AprilTag");
}

}  // namespace

class TagDetector::Impl {};

TagDetector::TagDetector(const TagDetectorOptions&) {}
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;
TagDetector::~TagDetector() = default;

std::vector<TagDetection> TagDetector::Detect(const GrayImageView&) { RefuseTags(); }

TagCode TagCodeOf(int) { RefuseTags(); }

}  // namespace touchdown::estimation
