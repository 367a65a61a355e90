// SPDX-License-Identifier: BSD-3-Clause
// Direct alignment of the printed sheet with the image (B. Lucas and T. Kanade, 1981; S. Baker and I. Matthews,
// "Lucas-Kanade 20 years on", 2004): Gauss-Newton on the grey levels, I = gain * model + offset, with Huber's
// weights. The unknowns are the six of the pose, gain and offset. The first blur is wide, and converges from farther.
// The second one is the camera's own. If motion has blurred the image, it is the best fit of a few. The model of a
// pixel is the sheet's mean over what the pixel sees of it. That is four rectangles along the pad's axes with the
// variances of the pixel's projected quarters.

#include "touchdown/estimation/tags/pad_alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "estimation/tags/pad_sheet.h"
#include "touchdown/estimation/tags/pad_reprojection.h"

namespace touchdown::estimation {
namespace {

using Matrix8d = Eigen::Matrix<double, 8, 8>;
using Vector8d = Eigen::Matrix<double, 8, 1>;

constexpr double kWideBlur = 3.0;    // [pixel]
constexpr double kSmallDoubt = 0.5;  // that needs no wide blur [pixel]
constexpr double kBlurGrowth = 1.4;  // from one blur that is tried to the next
constexpr int kIterations = 10;
constexpr double kStepEnd = 1e-2;  // square of a step, in variances of the solution
constexpr double kHuber = 3.0;     // standard deviations
constexpr double kMinSigma = 1.0;  // of a grey level: it is a whole number
constexpr int kMinPixels = 100;
constexpr int kMargin = 2;         // around the part that is looked at [pixel]
constexpr double kMaxTurn = 0.35;  // that the alignment may make of the pose [rad]

void CheckWithin(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(std::string("pad_alignment.") + name + " is " +
                              std::to_string(value) + "; allowed is [" + std::to_string(low) +
                              ", " + std::to_string(high) + "]");
}

}  // namespace

/// What is looked for.
struct PadAlignment::State {
  PoseCP pose;
  double gain = 1.0;
  double offset = 0.0;
  double sigma = 0.0;  ///< of a residual; 0: not known yet
};

/// Sums over the pixels of the sheet.
struct PadAlignment::Sums {
  Matrix8d hessian = Matrix8d::Zero();
  Vector8d gradient = Vector8d::Zero();
  int pixels = 0;
  double weights = 0.0;
  double squares = 0.0;  ///< weighted, of the residuals
  double image = 0.0;    ///< weighted, of the image's levels
  double image_squares = 0.0;

  double Sigma() const {
    return std::max(kMinSigma, std::sqrt(squares / std::max(1.0, weights - 8.0)));
  }
  double Correlation() const {
    const double spread = image_squares - image * image / weights;
    return spread > 0.0 ? std::sqrt(std::max(0.0, 1.0 - squares / spread)) : 0.0;
  }
  /// `scale` puts the prior into the units of these sums.
  void Add(const PadNormal& normal, const PoseCP& pose, double scale) {
    const NormalEquations prior = Assemble(normal, pose);
    hessian.topLeftCorner<6, 6>() += scale * prior.hessian;
    gradient.head<6>() += scale * prior.gradient;
  }
};

PadAlignment::PadAlignment(const PadAlignmentOptions& options) : options_(options) {
  CheckWithin("blur", options.blur, 1.0, 2.0);
  CheckWithin("max_pixels", options.max_pixels, 0, 1e8);
  CheckWithin("correlation", options.correlation, 0.0, 1.0);
  CheckWithin("neighbors", options.neighbors, 1.0, 1000.0);
}

bool PadAlignment::SetWindow(const GrayImageView& image, const CameraIntrinsics& camera,
                             const PadPose& pose) {
  constexpr double kHalf = 0.5 * kPadSheetSide;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d high = -low;
  for (const double x : {-kHalf, kHalf}) {
    for (const double y : {-kHalf, kHalf}) {
      const Eigen::Vector3d corner = pose.R_CP * Eigen::Vector3d(x, y, 0.0) + pose.p_CP;
      if (!(corner.z() > 0.05)) return false;
      const Eigen::Vector2d pixel =
          camera.focal * corner.head<2>() / corner.z() + Eigen::Vector2d(camera.cx, camera.cy);
      low = low.cwiseMin(pixel);
      high = high.cwiseMax(pixel);
    }
  }
  const auto clamped = [](double value, int last) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(last)));
  };
  left_ = clamped(std::floor(low.x()) - kMargin, image.width);
  top_ = clamped(std::floor(low.y()) - kMargin, image.height);
  width_ = clamped(std::ceil(high.x()) + kMargin, image.width) - left_;
  height_ = clamped(std::ceil(high.y()) + kMargin, image.height) - top_;
  image_ = image;
  camera_ = camera;
  return width_ * height_ <= options_.max_pixels;
}

bool PadAlignment::TooLarge(const GrayImageView& image, const CameraIntrinsics& camera,
                            const PadPose& pose) {
  return !SetWindow(image, camera, pose);
}

// Standard deviation of where the pose puts the worst of the sheet's corners [pixel].
double PadAlignment::Doubt(const PadPose& pose) const {
  constexpr double kHalf = 0.5 * kPadSheetSide;
  PadCorners corners;
  corners.count = 4;
  corners.on_pad = {{{-kHalf, -kHalf}, {kHalf, -kHalf}, {kHalf, kHalf}, {-kHalf, kHalf}}};
  corners.in_image.fill(Eigen::Vector2d::Zero());
  double worst = 0.0;
  for (int i = 0; i < corners.count; ++i) {
    const auto residual = ResidualOf(corners, i, {pose.p_CP, pose.R_CP}, camera_);
    if (!residual) return kWideBlur;
    const Eigen::Matrix2d cov = residual->jacobian * pose.cov * residual->jacobian.transpose();
    worst = std::max(worst, std::sqrt(cov.trace()));
  }
  return worst;
}

double PadAlignment::ModelAt(double u, double v, const Eigen::Matrix3d& from_ray,
                             double blur) const {
  constexpr double kHalf = 0.5 * kPadSheetSide;
  const Eigen::Vector3d ray((u - camera_.cx) / camera_.focal, (v - camera_.cy) / camera_.focal,
                            1.0);
  const Eigen::Vector3d h = from_ray * ray;
  const Eigen::Vector2d x_P = h.head<2>() / h.z();
  const double scale = blur / (camera_.focal * h.z());
  const Eigen::Vector2d by_u = scale * (from_ray.col(0).head<2>() - from_ray(2, 0) * x_P);
  const Eigen::Vector2d by_v = scale * (from_ray.col(1).head<2>() - from_ray(2, 1) * x_P);
  const Eigen::Vector2d half_size =
      0.25 * (by_u.array().square() + by_v.array().square()).sqrt().matrix();
  if (!((x_P.cwiseAbs() + 2.0 * half_size).maxCoeff() < kHalf)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double sum = 0.0;
  for (const double a : {-0.25, 0.25}) {
    for (const double b : {-0.25, 0.25}) sum += sheet_.Over(x_P + a * by_u + b * by_v, half_size);
  }
  return 0.25 * sum;
}

void PadAlignment::FillModel(const PoseCP& pose, double blur) {
  Eigen::Matrix3d to_ray;
  to_ray << pose.R.col(0), pose.R.col(1), pose.p;
  const Eigen::Matrix3d from_ray = to_ray.inverse();
  double* level = model_.data();
  for (int v = 0; v < height_; ++v) {
    for (int u = 0; u < width_; ++u) {
      *level++ = ModelAt(left_ + u + 0.5, top_ + v + 0.5, from_ray, blur);
    }
  }
}

PadAlignment::Sums PadAlignment::SumsAt(const State& state, double blur) {
  FillModel(state.pose, blur);
  const Eigen::Vector3d normal_C = state.pose.R.col(2);
  const double to_plane = normal_C.dot(state.pose.p);
  Sums sums;
  for (int v = 1; v + 1 < height_; ++v) {
    for (int u = 1; u + 1 < width_; ++u) {
      const double* const m = &model_[static_cast<std::size_t>(v * width_ + u)];
      const Eigen::Vector2d slope(0.5 * (m[1] - m[-1]), 0.5 * (m[width_] - m[-width_]));
      if (!std::isfinite(m[0] + slope.sum())) continue;
      const double level = image_.data[(top_ + v) * image_.stride + left_ + u];
      const double residual = state.gain * m[0] + state.offset - level;
      const double weight =
          state.sigma > 0.0 ? std::min(1.0, kHuber * state.sigma / std::abs(residual)) : 1.0;
      // When the pose moves the point that this pixel sees, its level moves in the image.
      const Eigen::Vector3d ray((left_ + u + 0.5 - camera_.cx) / camera_.focal,
                                (top_ + v + 0.5 - camera_.cy) / camera_.focal, 1.0);
      const double depth = to_plane / normal_C.dot(ray);
      const Eigen::Vector3d arm_C = depth * ray - state.pose.p;
      const double scale = -state.gain * camera_.focal / depth;
      const Eigen::Vector3d by_point =
          scale * Eigen::Vector3d(slope.x(), slope.y(), -slope.dot(ray.head<2>()));
      Vector8d row;
      row << by_point, arm_C.cross(by_point), m[0], 1.0;
      sums.hessian += weight * row * row.transpose();
      sums.gradient += weight * residual * row;
      sums.squares += weight * residual * residual;
      sums.weights += weight;
      sums.image += weight * level;
      sums.image_squares += weight * level * level;
      ++sums.pixels;
    }
  }
  return sums;
}

bool PadAlignment::Converge(const std::optional<PadNormal>& normal, double blur, State* state) {
  state->sigma = 0.0;
  for (int i = 0; i < kIterations; ++i) {
    Sums sums = SumsAt(*state, blur);
    if (sums.pixels < kMinPixels) return false;
    state->sigma = sums.Sigma();
    const double unit = options_.neighbors * state->sigma * state->sigma;
    if (normal) sums.Add(*normal, state->pose, unit);
    const Vector8d step = sums.hessian.ldlt().solve(-sums.gradient);
    if (!step.allFinite() || step.head<6>().norm() > 1.0) return false;
    state->pose = state->pose.Moved(step.head<6>());
    state->gain += step(6);
    state->offset += step(7);
    if (step.dot(sums.hessian * step) < kStepEnd * unit) break;
  }
  return true;
}

bool PadAlignment::Refine(const GrayImageView& image, const CameraIntrinsics& camera,
                          const std::optional<PadNormal>& normal, PadPose* pose) {
  if (pose->status != PadPoseStatus::kSolved || !SetWindow(image, camera, *pose)) return false;
  if (width_ < 3 || height_ < 3) return false;
  model_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  State state{{pose->p_CP, pose->R_CP}};
  {  // Light first: it is not known at all.
    const Sums sums = SumsAt(state, kWideBlur);
    if (sums.pixels < kMinPixels) return false;
    const Eigen::Vector2d light =
        sums.hessian.bottomRightCorner<2, 2>().ldlt().solve(-sums.gradient.tail<2>());
    state.gain += light.x();
    state.offset += light.y();
  }
  if (Doubt(*pose) > kSmallDoubt && !Converge(normal, kWideBlur, &state)) return false;
  if (!Converge(normal, options_.blur, &state)) return false;
  Sums sums = SumsAt(state, options_.blur);
  for (double blur = kBlurGrowth * options_.blur; blur < kWideBlur; blur *= kBlurGrowth) {
    if (SumsAt(state, blur).squares >= sums.squares) break;
    if (!Converge(normal, blur, &state)) return false;
    sums = SumsAt(state, blur);
  }
  const double turn =
      Eigen::AngleAxisd(Eigen::Matrix3d(state.pose.R * pose->R_CP.transpose())).angle();
  if (sums.pixels < kMinPixels || state.gain <= 0.0 || turn > kMaxTurn ||
      !(sums.Correlation() > options_.correlation)) {
    return false;
  }
  const double unit = options_.neighbors * sums.Sigma() * sums.Sigma();
  if (normal) sums.Add(*normal, state.pose, unit);
  const Matrix8d cov = unit * sums.hessian.ldlt().solve(Matrix8d::Identity());
  if (!cov.allFinite() || !(cov.diagonal().minCoeff() > 0.0)) return false;
  pose->p_CP = state.pose.p;
  pose->R_CP = state.pose.R;
  pose->cov = cov.topLeftCorner<6, 6>();
  return true;
}

}  // namespace touchdown::estimation
