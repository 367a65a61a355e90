// SPDX-License-Identifier: BSD-3-Clause
// Pinhole projection of a plane's points with its derivatives, the homography, its decomposition H
// ~ [r1 r2 p], and the mirrored pose. The homography comes from the normalised direct linear
// transformation (R. Hartley and A. Zisserman, Multiple View Geometry, alg. 4.2). Under weak
// perspective along the unit vector d, the image only depends on the first two columns of R across
// d. (1 - 2 d d^T) R diag(1, 1, -1) leaves these unchanged (D. Oberkampf et al., "Iterative pose
// estimation using coplanar feature points", 1996).

#include "touchdown/estimation/tags/pad_reprojection.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "estimation/tags/pad_tags.h"

namespace touchdown::estimation {
namespace {

using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Row9d = Eigen::Matrix<double, 1, 9>;

constexpr double kMinDepth = 0.01;  // of a corner in front of the camera [m]

Eigen::Matrix3d Cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

Eigen::Vector3d OnPad(const PadCorners& corners, int i) {
  const Eigen::Vector2d& x = corners.on_pad[static_cast<std::size_t>(i)];
  return {x.x(), x.y(), 0.0};
}

// x -> scale (x - mean), to a mean distance of sqrt(2) from the origin.
Eigen::Matrix3d Normalising(const std::array<Eigen::Vector2d, kMaxCorners>& points, int count) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (int i = 0; i < count; ++i) mean += points[static_cast<std::size_t>(i)] / count;
  double distance = 0.0;
  for (int i = 0; i < count; ++i) {
    distance += (points[static_cast<std::size_t>(i)] - mean).norm() / count;
  }
  const double scale = std::sqrt(2.0) / distance;
  Eigen::Matrix3d map;
  map << scale, 0.0, -scale * mean.x(), 0.0, scale, -scale * mean.y(), 0.0, 0.0, 1.0;
  return map;
}

}  // namespace

PoseCP PoseCP::Moved(const Vector6d& step) const {
  const Eigen::Vector3d rotation = step.tail<3>();
  const double angle = rotation.norm();
  PoseCP moved = *this;
  moved.p += step.head<3>();
  if (angle > 0.0) {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, rotation / angle));
    moved.R = (q * Eigen::Quaterniond(R)).normalized().toRotationMatrix();
  }
  return moved;
}

PadCorners::PadCorners(std::span<const TagDetection> tags, int left_out) {
  for (std::size_t i = 0; i < tags.size(); ++i) {
    if (static_cast<int>(i) == left_out) continue;
    const auto corners = PadTags()[static_cast<std::size_t>(tags[i].id)].Corners();
    for (int k = 0; k < 4; ++k, ++count) {
      on_pad[static_cast<std::size_t>(count)] = corners.col(k);
      in_image[static_cast<std::size_t>(count)] = tags[i].corners.col(k);
    }
  }
}

std::optional<CornerResidual> ResidualOf(const PadCorners& corners, int i, const PoseCP& pose,
                                         const CameraIntrinsics& camera) {
  const Eigen::Vector3d arm_C = pose.R * OnPad(corners, i);
  const Eigen::Vector3d x_C = arm_C + pose.p;
  if (!(x_C.z() > kMinDepth)) return std::nullopt;
  const double scale = camera.focal / x_C.z();
  const Eigen::Vector2d slope = x_C.head<2>() / x_C.z();
  CornerResidual residual;
  residual.offset = camera.focal * slope + Eigen::Vector2d(camera.cx, camera.cy) -
                    corners.in_image[static_cast<std::size_t>(i)];
  Eigen::Matrix<double, 2, 3> by_point;
  by_point << scale, 0.0, -scale * slope.x(), 0.0, scale, -scale * slope.y();
  residual.jacobian.leftCols<3>() = by_point;
  residual.jacobian.rightCols<3>() = -by_point * Cross(arm_C);
  return residual;
}

NormalResidual ResidualOf(const PadNormal& normal, const PoseCP& pose) {
  const Eigen::Vector3d across = normal.z_P_C.unitOrthogonal();
  Eigen::Matrix<double, 2, 3> basis;
  basis.row(0) = across;
  basis.row(1) = normal.z_P_C.cross(across);
  NormalResidual residual;
  residual.offset = basis * pose.R.col(2);
  residual.jacobian.leftCols<3>().setZero();
  residual.jacobian.rightCols<3>() = -basis * Cross(pose.R.col(2));
  return residual;
}

NormalEquations Assemble(const PadCorners& corners, const CameraIntrinsics& camera,
                         const PoseCP& pose) {
  NormalEquations sums;
  for (int i = 0; i < corners.count; ++i) {
    const std::optional<CornerResidual> residual = ResidualOf(corners, i, pose, camera);
    if (!residual) return {};
    sums.squares += residual->offset.squaredNorm();
    sums.gradient += residual->jacobian.transpose() * residual->offset;
    sums.hessian += residual->jacobian.transpose() * residual->jacobian;
  }
  sums.in_front = true;
  return sums;
}

NormalEquations Assemble(const PadNormal& normal, const PoseCP& pose) {
  const NormalResidual residual = ResidualOf(normal, pose);
  const double weight = 1.0 / (normal.sigma * normal.sigma);
  NormalEquations sums;
  sums.in_front = true;
  // A normal that points away would have the same components across. Its distance counts as that of
  // a right angle at least.
  sums.squares = weight * residual.offset.squaredNorm();
  const double along = pose.R.col(2).dot(normal.z_P_C);
  if (along < 0.0) sums.squares = weight * (1.0 + along * along);
  sums.gradient = weight * residual.jacobian.transpose() * residual.offset;
  sums.hessian = weight * residual.jacobian.transpose() * residual.jacobian;
  return sums;
}

std::optional<PoseCP> PoseFromHomography(const PadCorners& corners,
                                         const CameraIntrinsics& camera) {
  const Eigen::Matrix3d pad_map = Normalising(corners.on_pad, corners.count);
  const Eigen::Matrix3d image_map = Normalising(corners.in_image, corners.count);
  if (!pad_map.allFinite() || !image_map.allFinite()) return std::nullopt;
  Matrix9d sums = Matrix9d::Zero();
  for (int i = 0; i < corners.count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const Eigen::RowVector3d x = (pad_map * corners.on_pad[index].homogeneous()).transpose();
    const Eigen::Vector3d y = image_map * corners.in_image[index].homogeneous();
    Row9d row;
    row << x, Eigen::RowVector3d::Zero(), -y.x() * x;
    sums += row.transpose() * row;
    row << Eigen::RowVector3d::Zero(), x, -y.y() * x;
    sums += row.transpose() * row;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix9d> eigen(sums);
  // One direction without squares is the homography; a second one leaves it undetermined.
  if (eigen.info() != Eigen::Success || !(eigen.eigenvalues()(1) > 1e-9)) return std::nullopt;
  const Row9d h = eigen.eigenvectors().col(0).transpose();
  Eigen::Matrix3d normalised;
  normalised << h.segment<3>(0), h.segment<3>(3), h.segment<3>(6);
  Eigen::Matrix3d camera_inverse;
  camera_inverse << 1.0 / camera.focal, 0.0, -camera.cx / camera.focal, 0.0, 1.0 / camera.focal,
      -camera.cy / camera.focal, 0.0, 0.0, 1.0;
  Eigen::Matrix3d columns = camera_inverse * image_map.inverse() * normalised * pad_map;
  columns /= 0.5 * (columns.col(0).norm() + columns.col(1).norm());
  if (columns(2, 2) < 0.0) columns = -columns;  // the pad is in front
  Eigen::Matrix3d axes = columns;
  axes.col(2) = columns.col(0).cross(columns.col(1));
  if (!axes.allFinite()) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  PoseCP pose;
  pose.p = columns.col(2);
  pose.R = svd.matrixU() * svd.matrixV().transpose();
  if (pose.R.determinant() < 0.0) return std::nullopt;
  return pose;
}

PoseCP MirroredPose(const PadCorners& corners, const PoseCP& pose) {
  Eigen::Vector3d center_P = Eigen::Vector3d::Zero();
  for (int i = 0; i < corners.count; ++i) center_P += OnPad(corners, i) / corners.count;
  const Eigen::Vector3d center_C = pose.R * center_P + pose.p;
  const Eigen::Vector3d d = center_C.normalized();
  PoseCP mirrored;
  mirrored.R = (Eigen::Matrix3d::Identity() - 2.0 * d * d.transpose()) * pose.R *
               Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal();
  mirrored.p = center_C - mirrored.R * center_P;
  return mirrored;
}

}  // namespace touchdown::estimation
