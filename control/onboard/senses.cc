// SPDX-License-Identifier: BSD-3-Clause
// Returns from the pad vehicle are no obstacles: the goal of the flight would be one. Returns that
// may come from it are kept in doubt until the tags show where it was
// (touchdown/planning/map/pad_outline.h). In the frame of an estimated own state a sighting is as
// exact as the tags are. But the frame drifts with the estimate, and the pad filter sees this drift
// as a motion of the pad. The pad's GPS is off by the estimate's whole error. So GPS leads to the
// pad, with the estimate's uncertainty added to its own. Once seen, tags guide alone: the landing
// only needs the position relative to the pad, which does not suffer from a drifted estimate.
#include "control/onboard/senses.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "touchdown/control/onboard/envelope.h"

namespace touchdown::control {
namespace {

constexpr double kTagsGuide = 0.5;      // GPS is left out while tags are younger than this [s]
constexpr double kMaxClockLead = 0.05;  // of the newest own state: no measurement is [s]
// If only the hull's space is marked free at the start, no stop lies in free cells. A vehicle whose
// hull reaches 0.52 m never left 0.8 m in wind, and always left 0.9 m.
constexpr double kAroundHull = 0.45;  // [m]

Taken TakenAs(estimation::PadUpdate update) {
  switch (update) {
    case estimation::PadUpdate::kInitialized:
    case estimation::PadUpdate::kAccepted:
    case estimation::PadUpdate::kAcceptedLate:
      return Taken::kUsed;
    case estimation::PadUpdate::kGated:
    case estimation::PadUpdate::kNotUsed:
      return Taken::kGated;
    case estimation::PadUpdate::kTooOld:
      return Taken::kTooOld;
    case estimation::PadUpdate::kInvalid:
      break;
  }
  return Taken::kInvalid;
}

}  // namespace

Senses::Senses(const OnboardOptions& options, std::optional<planning::PersistentMap> memory)
    : own_(options),
      pad_(options.pad),
      map_(options.map),
      memory_(memory ? std::move(*memory) : planning::PersistentMap(options.map)),
      deck_half_size_(0.5 * options.deck_size),
      start_free_(std::max(options.start_free, HullAtEveryTilt(options.model) + kAroundHull)),
      pad_is_obstacle_(options.to_goal) {}

void Senses::Begin() {
  depth_t_ = own_.now().t;  // a stamp of a clock that was wrong before counts for nothing
  map_.Recentre(own_.now().p_WB);
  memory_.Refill(&map_);
  map_.MarkFree(own_.now().p_WB, start_free_);
}

bool Senses::IsAhead(double t) const {
  return !IsFlightTime(t) || (own_.known() && t > own_.now().t + kMaxClockLead);
}

std::optional<Taken> Senses::Refused(double t, const Stamps& used) const {
  if (!own_.known()) return Taken::kUnasked;
  if (doubts_ || IsAhead(t)) return Taken::kInvalid;
  if (used.Has(t)) return Taken::kDoubled;
  if (!own_.Reaches(t)) return Taken::kTooOld;
  return std::nullopt;
}

bool Senses::TagsGuide(double t) const { return own_.estimated() && pad_.TagAge(t) < kTagsGuide; }

Taken Senses::Take(const estimation::PadGpsFix& fix) {
  if (const auto refused = Refused(fix.t, fixes_)) return *refused;
  if (TagsGuide(own_.now().t)) return Taken::kIgnored;
  estimation::PadGpsFix doubted = fix;
  if (!(fix.sigma >= 0.0)) return Taken::kInvalid;
  doubted.sigma = std::hypot(fix.sigma, own_.HorizontalSigma());
  if (pad_log_ != nullptr) pad_log_->push_back({own_.now().t, doubted});
  const Taken taken = TakenAs(pad_.AddGps(doubted));
  if (IsLookedAt(taken)) fixes_.Add(fix.t);
  return taken;
}

Taken Senses::Take(const estimation::PadSighting& sighting) {
  if (const auto refused = Refused(sighting.t, sightings_)) return *refused;
  const estimation::VehicleState believed = own_.At(sighting.t);
  if (pad_log_ != nullptr) {
    pad_log_->push_back({own_.now().t, estimation::BelievedSighting{sighting, believed}});
  }
  const Taken taken = TakenAs(pad_.AddSighting(sighting, believed));
  if (IsLookedAt(taken)) sightings_.Add(sighting.t);
  return taken;
}

Taken Senses::Take(const estimation::PadImage& image, double stamp) {
  if (!estimation::IsPossible(image)) return Taken::kInvalid;
  if (const auto refused = Refused(stamp, pad_images_)) return *refused;
  pad_images_.Add(stamp);
  auto sighting = look_.Find(image, own_.At(stamp), pad_);
  if (!sighting) return Taken::kEmpty;
  sighting->t = stamp;
  return Take(*sighting);
}

Taken Senses::Take(const estimation::DepthImage& image, double stamp) {
  if (!estimation::IsPossible(image)) return Taken::kInvalid;
  const std::size_t camera = CameraOf(image);
  if (const auto refused = Refused(stamp, images_[camera])) return *refused;
  if (!estimation::SaysSomething(image)) return Taken::kEmpty;
  const estimation::VehicleState from = own_.At(stamp);
  const Eigen::Matrix3d R_WB = from.q_WB.toRotationMatrix();
  frame_.t = stamp;
  frame_.intrinsics = image.intrinsics;
  frame_.max_range = image.max_range;
  frame_.R_WC = R_WB * image.R_BC;
  frame_.p_WC = from.p_WB + R_WB * image.p_BC;
  if (!estimation::IsPossible(frame_)) return Taken::kInvalid;
  frame_.depth = image.depth;
  const double t = own_.now().t;
  memory_.Recentre(own_.now().p_WB, &map_);
  map_.Integrate(frame_, Outline(t, stamp));
  const planning::PadOutline now = Outline(t, t);
  if (pad_.initialized() && now.Known()) {
    map_.ExplainDoubts([&](double at) { return Outline(t, at); });
  }
  images_[camera].Add(stamp);
  cameras_[camera].intrinsics = image.intrinsics;
  cameras_[camera].reach =
      std::min(image.max_range, map_.options().thinnest_obstacle * image.intrinsics.focal);
  ++cameras_[camera].images;
  depth_t_ = std::max(depth_t_, stamp);
  return Taken::kUsed;
}

// Which depth camera it is, by its place. A ninth takes the place of the oldest one.
std::size_t Senses::CameraOf(const estimation::DepthImage& image) {
  const auto known = std::find_if(cameras_.begin(), cameras_.end(), [&](const auto& camera) {
    return camera.p_BC == image.p_BC && camera.R_BC == image.R_BC;
  });
  const auto at = static_cast<std::size_t>(known - cameras_.begin());
  if (known != cameras_.end()) return at;
  if (at == kMostCameras) {
    cameras_.erase(cameras_.begin());
    std::rotate(images_.begin(), images_.begin() + 1, images_.end());
    images_.back() = {};
  }
  cameras_.push_back({image.intrinsics, image.p_BC, image.R_BC, 0.0, 0});
  return cameras_.size() - 1;
}

// Where the pad was at `stamp`, with its uncertainty of then and of today.
planning::PadOutline Senses::Outline(double t, double stamp) const {
  if (pad_is_obstacle_ || !pad_.initialized()) return {};
  planning::PadOutline outline = planning::OutlineOf(pad_.Estimate(stamp), deck_half_size_);
  outline.sigma = std::max(outline.sigma, pad_.PositionSigma(t));
  return outline;
}

planning::PersistentMap Senses::TakeMemory() {
  memory_.Flush(&map_);
  return std::exchange(memory_, planning::PersistentMap(map_.options()));
}

}  // namespace touchdown::control
