// SPDX-License-Identifier: BSD-3-Clause
// The finder takes longest for an image without the pad, and far from the pad all images are such.
// So an image is searched only if a ball about the expected pad reaches into the camera's pyramid
// of view, near enough for a tag to be read. The ball has room for the sheet, for five standard
// deviations of the expectation and for half a metre. The expectation may be wrong without any sign
// of it, so every tenth image is searched anyway.
#include "control/onboard/pad_search.h"

#include <algorithm>
#include <cmath>

#include "estimation/base/degrees.h"
#include "estimation/tags/pad_sheet.h"
#include "estimation/tags/pad_tags.h"

namespace touchdown::control {
namespace {

constexpr double kAttitudeSigma = estimation::Radians(1.0);  // claimed [rad]
constexpr double kMargin = 0.5;                              // about the expected pad [m]
constexpr double kSigmas = 5.0;                              // of its position
constexpr int kMostPassedOver = 9;     // images in a row that are not searched
constexpr double kLeastTagPixels = 4;  // half a pixel to a cell: far below what is ever read

}  // namespace

std::optional<estimation::PadSighting> PadSearch::Find(const estimation::PadImage& image,
                                                       const estimation::VehicleState& believed,
                                                       const estimation::PadFilter& expected) {
  const bool search = !thrifty_ || passed_over_ == kMostPassedOver || !expected.initialized() ||
                      MayShow(image, believed, expected);
  passed_over_ = search ? 0 : passed_over_ + 1;
  if (!search) return std::nullopt;
  if (!finder_) finder_.emplace();
  const estimation::PadView view = finder_->Find(
      image.gray.View(), image.intrinsics,
      estimation::LevelPadNormal(believed.q_WB.toRotationMatrix(), image.R_BC, kAttitudeSigma));
  if (view.pose.status != estimation::PadPoseStatus::kSolved) return std::nullopt;
  estimation::PadSighting sighting =
      estimation::ToSighting(view.pose, image.t, image.R_BC, image.p_BC);
  sighting.tags_seen = static_cast<int>(view.tags.size());
  return sighting;
}

bool PadSearch::MayShow(const estimation::PadImage& image, const estimation::VehicleState& believed,
                        const estimation::PadFilter& expected) const {
  const Eigen::Vector3d p_BP =
      believed.q_WB.conjugate() * (expected.Estimate(believed.t).p_WP - believed.p_WB);
  const Eigen::Vector3d p_C = image.R_BC.transpose() * (p_BP - image.p_BC);
  const double radius = estimation::kPadSheetSide * std::sqrt(0.5) + kMargin +
                        kSigmas * expected.PositionSigma(believed.t);
  return MayShowPad(p_C, radius, image.intrinsics);
}

bool MayShowPad(const Eigen::Vector3d& p_C, double radius,
                const estimation::CameraIntrinsics& camera) {
  double largest = 0.0;  // side of a tag [m]
  for (const estimation::PadTag& tag : estimation::PadTags()) {
    const Eigen::Matrix<double, 2, 4> corners = tag.Corners();
    largest = std::max(largest, (corners.col(1) - corners.col(0)).norm());
  }
  if (p_C.norm() - radius > camera.focal * largest / kLeastTagPixels) return false;
  // How far outside a side of the pyramid of view, each a plane through the camera.
  const auto beyond = [&](double across, double half_size) {
    return (std::abs(across) * camera.focal - p_C.z() * half_size) /
           std::hypot(camera.focal, half_size);
  };
  return beyond(p_C.x(), 0.5 * camera.width) <= radius &&
         beyond(p_C.y(), 0.5 * camera.height) <= radius;
}

}  // namespace touchdown::control
