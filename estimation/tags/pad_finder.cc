// SPDX-License-Identifier: BSD-3-Clause
// A pose is not aligned if its mirror image is as likely. The sheet could converge to the wrong
// one, with a small covariance.

#include "touchdown/estimation/tags/pad_finder.h"

namespace touchdown::estimation {
namespace {

constexpr double kMaxOtherProbability = 0.01;

}  // namespace

PadFinder::PadFinder(const PadFinderOptions& options)
    : options_(options),
      detector_({.enlarge = 1}),
      enlarging_({.enlarge = 2}),
      alignment_(options.alignment) {}

PadView PadFinder::FindAt(TagDetector* detector, const GrayImageView& image,
                          const CameraIntrinsics& camera, const std::optional<PadNormal>& normal) {
  PadView view;
  view.tags = detector->Detect(image);
  view.pose = SolvePadPose(view.tags, camera, options_.pose, normal);
  view.aligned = options_.align && view.pose.status == PadPoseStatus::kSolved &&
                 view.pose.other_probability <= kMaxOtherProbability &&
                 alignment_.Refine(image, camera, normal, &view.pose);
  return view;
}

PadView PadFinder::Find(const GrayImageView& image, const CameraIntrinsics& camera,
                        const std::optional<PadNormal>& normal) {
  PadView view = FindAt(&detector_, image, camera, normal);
  const bool done =
      view.pose.status == PadPoseStatus::kSolved &&
      (view.aligned || !options_.align || alignment_.TooLarge(image, camera, view.pose));
  if (!options_.enlarge || done) return view;
  PadView closer = FindAt(&enlarging_, image, camera, normal);
  return closer.tags.size() < view.tags.size() ? view : closer;
}

}  // namespace touchdown::estimation
