// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/video/flight_video.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/output_path.h"
#include "evaluation/base/rendering_check.h"
#include "evaluation/base/words.h"
#include "evaluation/flight/pad_sensor.h"
#include "evaluation/scenario/scenario_check.h"
#include "evaluation/scenario/scenario_world.h"
#include "evaluation/video/camera_insets.h"
#include "evaluation/video/caption.h"
#include "evaluation/video/chase_camera.h"
#include "evaluation/video/flight_track.h"
#include "evaluation/video/picture.h"
#include "evaluation/video/video_encoder.h"
#include "sim/rendering/flight_renderer.h"

namespace touchdown::evaluation {
namespace {

constexpr char kVideo[] = "a video";
constexpr int kHeld =
    3 * kVideoRate / 2;  // so often the last picture is shown, which tells the outcome
constexpr double kFovDeg = 52.0;
constexpr double kFar = 250.0;       // [m]
constexpr double kNear = 0.1;        // [m]
constexpr int kDesignHeight = 720;   // sizes below are for a picture of this height [pixel]
constexpr double kTrailStep = 0.08;  // between points of the way flown [s]
constexpr double kPlanStep = 0.05;   // between points of a plan [s]
constexpr double kLineWidth = 0.03;  // [m]
constexpr std::array<float, 4> kTrailColor = {1.0F, 0.52F, 0.08F, 1.0F};
constexpr std::array<float, 4> kPlanColor = {0.10F, 0.85F, 1.0F, 1.0F};
constexpr std::array<float, 4> kGoalColor = {1.0F, 0.2F, 0.6F, 1.0F};
constexpr Rgb kWhite = {255, 255, 255}, kDim = {188, 200, 216}, kBar = {16, 22, 32};
constexpr double kBarOpacity = 0.72;

Rgb RgbOf(const std::array<float, 4>& color) {
  Rgb rgb;
  for (std::size_t c = 0; c < 3; ++c) {
    rgb[c] = static_cast<std::uint8_t>(std::lround(255.0F * color[c]));
  }
  return rgb;
}

sim::ViewConfig ViewOf(VideoSize size) {
  sim::ViewConfig view;
  view.width = size.width;
  view.height = size.height;
  view.fov_y_deg = kFovDeg;
  view.near = kNear;
  view.far = kFar;
  return view;
}

int FontSize(int design, int height) {
  return std::clamp(static_cast<int>(std::lround(1.0 * design * height / kDesignHeight)), 1, 6);
}

RecordedFlight Drawable(RecordedFlight flight, const std::string& path) {
  RequireSheetRoom(flight.scenario, path, kVideo);
  return flight;
}

}  // namespace

class FlightPictures::Impl {
 public:
  Impl(const std::string& record_path, const Registries& registries, VideoSize size)
      : size_(size),
        flight_(Drawable(ReadRecord(record_path, {}, registries), record_path)),
        track_(record_path),
        world_(WorldOf(flight_.scenario, DrawTrial(flight_.scenario, flight_.scenario.seed),
                       registries)),
        scene_(VisualSceneOf(flight_.scenario, world_)),
        renderer_(scene_, world_.vehicle_mjcf, ViewOf(size)),
        insets_(flight_.scenario, scene_),
        caption_font_(FontSize(5, size.height)),
        inset_font_(FontSize(4, size.height)),
        picture_(size.width, size.height) {
    if (flight_.scenario.task == TaskKind::kGoTo) goal_ = GoalOf(flight_.scenario);
    std::vector<ChaseSubject> subjects;
    for (int i = 0; i < count(); ++i) {
      const TrackSample sample = track_.At(TimeOf(i));
      subjects.push_back({sample.vehicle.p_WB, TargetOf(sample)});
    }
    cameras_ = ChaseFlight(subjects, 1.0 / kVideoRate, world_.obstacles, renderer_.intrinsics());
  }

  int count() const { return static_cast<int>(std::floor(track_.t_end() * kVideoRate + 1e-6)) + 1; }

  const std::vector<std::uint8_t>& Next() {
    const TrackSample now = track_.At(TimeOf(next_));
    moment_.camera = cameras_[static_cast<std::size_t>(next_)];
    moment_.vehicle = now.vehicle;
    moment_.pad = now.pad;
    moment_.lines = {Plan(now), Trail(now)};
    moment_.marks.clear();
    if (goal_) moment_.marks.push_back({TargetOf(now), 0.12, kGoalColor});
    renderer_.Render(moment_, &picture_.rgb);
    picture_.SmoothEdges();
    insets_.Look(now);
    const int margin = Scaled(16), width = Scaled(288);
    insets_.Draw({size_.width - margin - width, margin, width, 0}, margin, inset_font_, &picture_);
    DrawLegend(margin);
    DrawCaption(CaptionOf(flight_, track_, now, TimeOf(next_ + 1), TargetOf(now)));
    ++next_;
    return picture_.rgb;
  }

  Eigen::Vector2d PixelOf(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d p = moment_.camera.R_WC.transpose() * (p_W - moment_.camera.p_WC);
    const estimation::CameraIntrinsics& camera = renderer_.intrinsics();
    return {camera.cx + camera.focal * p.x() / p.z(), camera.cy + camera.focal * p.y() / p.z()};
  }

 private:
  static double TimeOf(int picture) { return static_cast<double>(picture) / kVideoRate; }

  int Scaled(int design) const { return std::max(1, design * size_.height / kDesignHeight); }

  Eigen::Vector3d TargetOf(const TrackSample& sample) const {
    return goal_ ? goal_->At(sample.vehicle.t).p_WP : sample.pad.p_WP;
  }

  // From now on back: of a long flight the beginning is left out.
  sim::FlightLine Trail(const TrackSample& now) {
    while (trail_.size() * kTrailStep <= now.vehicle.t) {
      trail_.push_back(track_.At(static_cast<double>(trail_.size()) * kTrailStep).vehicle.p_WB);
    }
    sim::FlightLine line{{now.vehicle.p_WB}, kLineWidth, kTrailColor};
    line.points_W.insert(line.points_W.end(), trail_.rbegin(), trail_.rend());
    return line;
  }

  sim::FlightLine Plan(const TrackSample& now) const {
    sim::FlightLine line{{}, kLineWidth, kPlanColor};
    const RecordPlan* const plan = PlanAt(flight_.plans, now.vehicle.t);
    if (plan == nullptr) return line;
    const planning::UniformBspline& curve = plan->result.curve;
    for (double t = std::max(now.vehicle.t, curve.t0()); t < curve.t_end(); t += kPlanStep) {
      line.points_W.push_back(curve.Position(t));
    }
    if (!line.points_W.empty()) line.points_W.push_back(curve.Position(curve.t_end()));
    return line;
  }

  void DrawLegend(int margin) {
    int top = margin;
    for (const auto& [words, color] :
         {std::pair("flown", kTrailColor), std::pair("planned", kPlanColor)}) {
      const int height = inset_font_.height(), bar = 2 * height;
      picture_.Fill({margin, top, bar + height + inset_font_.WidthOf("planned"), height}, kBar,
                    kBarOpacity);
      picture_.Fill(
          {margin + height / 4, top + (height - Scaled(4)) / 2, bar - height / 4, Scaled(4)},
          RgbOf(color), 1.0);
      picture_.Text(margin + bar + height / 2, top, words, inset_font_, kWhite);
      top += height;
    }
  }

  void DrawCaption(const Caption& caption) {
    const int line = caption_font_.height() + Scaled(4), margin = Scaled(16);
    const int top = size_.height - 2 * line - Scaled(10);
    picture_.Fill({0, top, size_.width, size_.height - top}, kBar, kBarOpacity);
    const auto write = [&](const std::string& left, const std::string& right, int row,
                           const Rgb& color) {
      const int y = top + Scaled(5) + row * line;
      const int edge = size_.width - margin - caption_font_.WidthOf(right);
      // The room between the two is a margin, too.
      picture_.Text(margin, y, Fitting(left, edge - 2 * margin, caption_font_), caption_font_,
                    color);
      picture_.Text(edge, y, right, caption_font_, color);
    };
    write(caption.flight, caption.time, 0, kDim);
    write(caption.state, caption.distance, 1, kWhite);
  }

  VideoSize size_;
  RecordedFlight flight_;
  FlightTrack track_;
  sim::WorldConfig world_;
  sim::VisualScene scene_;
  sim::FlightRenderer renderer_;
  CameraInsets insets_;
  sim::Font caption_font_, inset_font_;
  std::optional<planning::MovingGoal> goal_;
  std::vector<sim::CameraPose> cameras_;
  std::vector<Eigen::Vector3d> trail_;
  sim::FlightMoment moment_;
  Picture picture_;
  int next_ = 0;
};

FlightPictures::FlightPictures(const std::string& record_path, const Registries& registries,
                               VideoSize size)
    : impl_(std::make_unique<Impl>(record_path, registries, size)) {}
FlightPictures::~FlightPictures() = default;

int FlightPictures::count() const { return impl_->count(); }

const std::vector<std::uint8_t>& FlightPictures::Next() { return impl_->Next(); }

Eigen::Vector2d FlightPictures::PixelOf(const Eigen::Vector3d& p_W) const {
  return impl_->PixelOf(p_W);
}

void CheckVideo(const std::string& option, const std::string& path) {
  if (std::filesystem::path(path).extension() != ".mp4") {
    throw BadInput(fmt::format("{} {}: the name must end in .mp4.", option, path));
  }
  CheckOutputPath(option, path);
  RequireEncoder(fmt::format("{} {}", option, path));
  RequireRendering(fmt::format("{} {}", option, path), "");
}

void CheckVideo(const std::string& option, const std::string& path, const Scenario& scenario) {
  CheckVideo(option, path);
  RequireSheetRoom(scenario, fmt::format("{} {}", option, path), kVideo);
}

void WriteVideo(const std::string& record_path, const std::string& video_path,
                const Registries& registries, const VideoProgress& progress, VideoSize size) {
  try {
    FlightPictures pictures(record_path, registries, size);
    AtomicFile file(video_path);
    VideoEncoder encoder(file.working_path(), size.width, size.height, kVideoRate);
    for (int i = 1; i <= pictures.count(); ++i) {
      const std::vector<std::uint8_t>& picture = pictures.Next();
      const int times = i < pictures.count() ? 1 : kHeld;
      for (int time = 0; time < times; ++time) encoder.Add(picture);
      if (progress) progress(i, pictures.count());
    }
    encoder.Finish();
    file.Commit();
  } catch (const BadInput&) {
    throw;
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("--video {}: the video was not made: {}.", video_path,
                                         WithoutStop(error.what())));
  }
}

}  // namespace touchdown::evaluation
