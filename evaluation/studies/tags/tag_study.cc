// SPDX-License-Identifier: BSD-3-Clause
// Views are drawn so that the pad's centre is anywhere in the image with the same probability. Many of them are partial
// and oblique for that. Heights are even over the range, the headings of vehicle and pad are any, the tilt is up to 20
// degrees in any direction. Each view's draws come first and are the same for every camera; the image's noise has its
// own stream.
#include "evaluation/studies/tags/tag_study.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "estimation/base/argument_check.h"
#include "estimation/base/degrees.h"
#include "sim/base/random_stream.h"
#include "touchdown/solvers/backend/thread_clock.h"

namespace touchdown::evaluation {
namespace {

constexpr double kMaxFov = 100.0;  // [deg]: beyond, some views would look above the horizon

struct View {
  estimation::VehicleState vehicle;
  estimation::PadState pad;
  Eigen::Matrix3d attitude_error;  // in B
  double height = 0.0;
  double tilt_deg = 0.0;
};

View DrawView(const TagStudyOptions& options, const estimation::CameraIntrinsics& camera,
              sim::RandomStream* random) {
  constexpr double kPi = std::numbers::pi;
  View view;
  view.height = random->Uniform(kLowestView, kHighestView);
  view.tilt_deg = random->Uniform(0.0, kLargestTilt);
  const double direction = random->Uniform(-kPi, kPi);
  const double heading = random->Uniform(-kPi, kPi);
  view.pad.yaw = random->Uniform(-kPi, kPi);
  view.pad.p_WP = {random->Uniform(-3.0, 3.0), random->Uniform(-3.0, 3.0), 0.3};
  const double u = camera.width * random->Uniform(0.0, 1.0);
  const double v = camera.height * random->Uniform(0.0, 1.0);
  const double course = random->Uniform(-kPi, kPi);
  const double sigma = options.attitude_sigma_deg / estimation::kDegPerRad;
  Eigen::Vector3d error;
  for (const int axis : {2, 1, 0}) error[axis] = random->Normal(sigma);

  const Eigen::Vector3d axis(std::cos(direction), std::sin(direction), 0.0);
  view.vehicle.q_WB = Eigen::AngleAxisd(view.tilt_deg / estimation::kDegPerRad, axis) *
                      Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
  Eigen::Vector3d ray_W =
      view.vehicle.q_WB *
      (sim::DownwardCameraAxes() *
       Eigen::Vector3d((u - camera.cx) / camera.focal, (v - camera.cy) / camera.focal, 1.0));
  ray_W *= -view.height / ray_W.z();
  view.vehicle.p_WB = view.pad.p_WP - ray_W - view.vehicle.q_WB * options.camera.p_BC;
  view.vehicle.v_WB = options.speed * Eigen::Vector3d(std::cos(course), std::sin(course), 0.0);
  const double angle = error.norm();
  view.attitude_error.setIdentity();
  if (angle > 0.0) view.attitude_error = Eigen::AngleAxisd(angle, error / angle);
  return view;
}

double ShortestSide(const Eigen::Matrix<double, 2, 4>& corners) {
  double shortest = (corners.col(3) - corners.col(0)).norm();
  for (int k = 0; k < 3; ++k) {
    shortest = std::min(shortest, (corners.col(k + 1) - corners.col(k)).norm());
  }
  return shortest;
}

// A tag seen from the true pose: the truth and the detection.
TagRow RowOf(const estimation::PadTag& tag, const Eigen::Vector3d& p_CP,
             const Eigen::Matrix3d& R_CP, const estimation::CameraIntrinsics& camera,
             const std::vector<estimation::TagDetection>& found) {
  TagRow row;
  const Eigen::Vector3d center_C =
      R_CP * Eigen::Vector3d(tag.center_P.x(), tag.center_P.y(), 0.0) + p_CP;
  row.view_angle_deg = estimation::kDegPerRad *
                       std::acos(std::clamp(-R_CP.col(2).dot(center_C.normalized()), -1.0, 1.0));
  Eigen::Matrix<double, 2, 4> corners = tag.Corners();
  row.in_view = true;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector3d x_C = R_CP * Eigen::Vector3d(corners(0, k), corners(1, k), 0.0) + p_CP;
    const double u = camera.focal * x_C.x() / x_C.z() + camera.cx;
    const double v = camera.focal * x_C.y() / x_C.z() + camera.cy;
    row.in_view = row.in_view && x_C.z() > 0.0 && u >= 0.0 && u <= camera.width && v >= 0.0 &&
                  v <= camera.height;
    corners.col(k) << u, v;
  }
  row.size_px = ShortestSide(corners);
  for (const estimation::TagDetection& detection : found) {
    if (detection.id != tag.id) continue;
    row.found = true;
    row.corner_rms_px = std::sqrt((detection.corners - corners).squaredNorm() / 8.0);
  }
  return row;
}

TagStudyRow Judge(const View& view, const estimation::PadView& seen, const Eigen::Vector3d& p_BC,
                  const estimation::CameraIntrinsics& camera) {
  const Eigen::Matrix3d R_WC = view.vehicle.q_WB.toRotationMatrix() * sim::DownwardCameraAxes();
  const Eigen::Vector3d p_WC = view.vehicle.p_WB + view.vehicle.q_WB * p_BC;
  const Eigen::Vector3d p_CP = R_WC.transpose() * (view.pad.p_WP - p_WC);
  const Eigen::Matrix3d R_CP =
      R_WC.transpose() * Eigen::AngleAxisd(view.pad.yaw, Eigen::Vector3d::UnitZ());
  TagStudyRow row;
  row.height = view.height;
  row.distance = p_CP.norm();
  row.tilt_deg = view.tilt_deg;
  row.vehicle = view.vehicle;
  row.pad = view.pad;
  row.status = seen.pose.status;
  row.aligned = seen.aligned;
  for (const estimation::PadTag& tag : estimation::PadTags()) {
    row.tags[static_cast<std::size_t>(tag.id)] = RowOf(tag, p_CP, R_CP, camera, seen.tags);
  }
  if (!row.Solved()) return row;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(R_CP * seen.pose.R_CP.transpose()));
  Eigen::Matrix<double, 6, 1> error;
  error << p_CP - seen.pose.p_CP, turn.angle() * turn.axis();
  row.position_error = error.head<3>().norm();
  row.rotation_error_deg = estimation::kDegPerRad * turn.angle();
  row.nees = error.dot(seen.pose.cov.ldlt().solve(error)) / 6.0;
  row.sigma = std::sqrt(seen.pose.cov.topLeftCorner<3, 3>().trace());
  return row;
}

}  // namespace

bool TagStudyRow::InView() const {
  return std::any_of(tags.begin(), tags.end(), [](const TagRow& tag) { return tag.in_view; });
}

std::vector<TagStudyRow> RunTagStudy(const TagStudyOptions& options,
                                     const std::function<void(int, int)>& progress,
                                     const ViewObserver& observer) {
  estimation::CheckWithin("poses", options.poses, 1, 1e6);
  estimation::CheckWithin("attitude_sigma_deg", options.attitude_sigma_deg, 0.01, 10.0);
  estimation::CheckWithin("speed", options.speed, 0.0, 20.0);
  estimation::CheckWithin("fov_y_deg of the study", options.camera.fov_y_deg, 10.0, kMaxFov);
  sim::PadCamera camera(options.camera, {}, options.seed);
  estimation::PadFinder finder(options.finder);
  sim::RandomStream random(options.seed, "tag study");
  std::vector<TagStudyRow> rows;
  estimation::GrayImage image;
  for (int i = 0; i < options.poses; ++i) {
    const View view = DrawView(options, camera.intrinsics(), &random);
    const double begin = solvers::ThreadCpuSeconds();
    camera.Capture(view.vehicle, view.pad, &image);
    const double rendered = solvers::ThreadCpuSeconds();
    const Eigen::Matrix3d R_WB = view.vehicle.q_WB.toRotationMatrix() * view.attitude_error;
    const estimation::PadNormal normal = estimation::LevelPadNormal(
        R_WB, sim::DownwardCameraAxes(), options.attitude_sigma_deg / estimation::kDegPerRad);
    const estimation::PadView seen = finder.Find(image.View(), camera.intrinsics(), normal);
    const double found = solvers::ThreadCpuSeconds();
    rows.push_back(Judge(view, seen, options.camera.p_BC, camera.intrinsics()));
    rows.back().render_ms = 1e3 * (rendered - begin);
    rows.back().find_ms = 1e3 * (found - rendered);
    if (observer) observer(i, image, seen, camera.intrinsics());
    if (progress) progress(i + 1, options.poses);
  }
  return rows;
}

TagStudyBin Summarise(const std::vector<TagStudyRow>& rows, double from, double to) {
  TagStudyBin bin;
  bin.from = from;
  bin.to = to;
  std::vector<double> position_mm;
  std::vector<double> rotation_deg;
  double nees = 0.0;
  for (const TagStudyRow& row : rows) {
    if (row.height < from || row.height >= to) continue;
    ++bin.views;
    if (!row.InView()) ++bin.not_in_view;
    for (std::size_t id = 0; id < row.tags.size(); ++id) {
      const TagRow& tag = row.tags[id];
      if (!tag.in_view) continue;
      ++(id == 0 ? bin.center_in_view : bin.outer_in_view);
      if (tag.found) ++(id == 0 ? bin.center_found : bin.outer_found);
    }
    if (!row.InView() || !row.Solved()) continue;
    ++bin.found;
    if (row.aligned) ++bin.aligned;
    position_mm.push_back(1e3 * row.position_error);
    rotation_deg.push_back(row.rotation_error_deg);
    nees += row.nees;
  }
  if (bin.found > 0) bin.nees = nees / bin.found;
  bin.position_mm = QuantilesOf(position_mm);
  bin.rotation_deg = QuantilesOf(rotation_deg);
  return bin;
}

std::vector<TagStudyBin> TagStudyBins(const std::vector<TagStudyRow>& rows) {
  constexpr std::array<double, 8> kEdges = {kLowestView, 0.5, 1.0, 2.0,
                                            3.0,         4.0, 5.0, kHighestView};
  std::vector<TagStudyBin> bins;
  for (std::size_t i = 0; i + 1 < kEdges.size(); ++i) {
    bins.push_back(Summarise(rows, kEdges[i], kEdges[i + 1]));
  }
  return bins;
}

}  // namespace touchdown::evaluation
