// SPDX-License-Identifier: BSD-3-Clause
// Least squares over SE(3) of the corners' distances in the image, by Levenberg and Marquardt's
// method (K. Madsen, H. Nielsen and O. Tingleff, Methods for Non-linear Least Squares Problems,
// 2004, alg. 3.16). It starts from the homography's pose and from the mirrored one; the lower cost
// wins. The corners' noise is the mean of a scaled inverse chi-squared law with corner_sigma as
// prior (A. Gelman et al., Bayesian Data Analysis, section 2.6). So one tag, which has two
// residuals more than unknowns, does not give a noise of zero. The covariance is that of the
// mixture of both poses, about the one chosen.

#include "touchdown/estimation/tags/pad_pose.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "estimation/tags/pad_tags.h"
#include "touchdown/estimation/tags/pad_reprojection.h"

namespace touchdown::estimation {
namespace {

constexpr int kMaxIterations = 60;
constexpr double kShortStep = 1e-9;        // [m] and [rad]
constexpr double kSamePose = 1e-3;         // two solutions are one if nearer [m], [rad]
constexpr double kMinInformation = 1e-12;  // least over largest eigenvalue of J^T J

void CheckPositive(const char* name, double value) {
  if (value > 0.0 && value < 1e6) return;
  throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) +
                              "; allowed is (0, 1e6)");
}

void Check(std::span<const TagDetection> tags, const PadPoseOptions& options,
           const std::optional<PadNormal>& normal) {
  CheckPositive("corner_sigma", options.corner_sigma);
  CheckPositive("corner_sigma_weight", options.corner_sigma_weight);
  CheckPositive("corner_sigma_floor", options.corner_sigma_floor);
  CheckPositive("outlier_rms", options.outlier_rms);
  if (tags.size() > kPadTagCount) {
    throw std::invalid_argument("number of tags is " + std::to_string(tags.size()) +
                                "; allowed is at most 5");
  }
  for (const TagDetection& tag : tags) {
    if (tag.id >= 0 && tag.id < kPadTagCount) continue;
    throw std::invalid_argument("tag id is " + std::to_string(tag.id) + "; allowed is 0 to 4");
  }
  if (!normal) return;
  CheckPositive("sigma of the pad's normal", normal->sigma);
  CheckPositive("length of the pad's normal", normal->z_P_C.norm());
}

struct Problem {
  PadCorners corners;
  const CameraIntrinsics& camera;
  const std::optional<PadNormal>& normal;
  double corner_sigma;

  // Corners count by their noise, as the normal does.
  NormalEquations At(const PoseCP& pose, double sigma) const {
    NormalEquations sums = Assemble(corners, camera, pose);
    if (!sums.in_front) return sums;
    const double weight = 1.0 / (sigma * sigma);
    sums.squares *= weight;
    sums.gradient *= weight;
    sums.hessian *= weight;
    if (normal) {
      const NormalEquations prior = Assemble(*normal, pose);
      sums.squares += prior.squares;
      sums.gradient += prior.gradient;
      sums.hessian += prior.hessian;
    }
    return sums;
  }
};

struct Solution {
  bool found = false;
  bool converged = false;
  PoseCP pose;
  NormalEquations sums;
};

Solution Minimise(const Problem& problem, const PoseCP& start) {
  Solution solution{false, false, start, problem.At(start, problem.corner_sigma)};
  solution.found = solution.sums.in_front;
  if (!solution.found) return solution;
  double damping = 1e-3;
  double growth = 2.0;
  for (int i = 0; i < kMaxIterations; ++i) {
    Matrix6d matrix = solution.sums.hessian;
    matrix.diagonal() *= 1.0 + damping;
    const Vector6d step = matrix.ldlt().solve(-solution.sums.gradient);
    if (!step.allFinite()) return solution;
    if (step.norm() < kShortStep) {
      solution.converged = true;
      return solution;
    }
    const PoseCP moved = solution.pose.Moved(step);
    const NormalEquations sums = problem.At(moved, problem.corner_sigma);
    const double drop = solution.sums.squares - sums.squares;
    if (sums.in_front && drop > 0.0) {
      solution.pose = moved;
      solution.sums = sums;
      damping = std::max(0.1 * damping, 1e-12);
      growth = 2.0;
    } else if (sums.in_front && std::abs(drop) <= 1e-12 * solution.sums.squares) {
      solution.converged = true;  // at the end of the arithmetic's resolution
      return solution;
    } else {
      damping *= growth;
      growth *= 2.0;
    }
  }
  return solution;
}

// Both minima that a plane's image may have, the lower one first.
struct Minima {
  Solution best;
  Solution other;
};

Minima SolveBoth(const Problem& problem, const PoseCP& start) {
  Minima minima{Minimise(problem, start), Minimise(problem, MirroredPose(problem.corners, start))};
  if (minima.best.found) {
    // From the first minimum the mirrored guess is a better one.
    const Solution again = Minimise(problem, MirroredPose(problem.corners, minima.best.pose));
    if (again.found && (!minima.other.found || again.sums.squares < minima.other.sums.squares)) {
      minima.other = again;
    }
  }
  const bool swap = minima.other.found &&
                    (!minima.best.found || minima.other.sums.squares < minima.best.sums.squares);
  if (swap) std::swap(minima.best, minima.other);
  return minima;
}

Vector6d Difference(const PoseCP& from, const PoseCP& to) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(to.R * from.R.transpose()));
  Vector6d difference;
  difference << to.p - from.p, turn.angle() * turn.axis();
  return difference;
}

bool Determined(const Matrix6d& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(information, Eigen::EigenvaluesOnly);
  return eigen.info() == Eigen::Success &&
         eigen.eigenvalues()(0) > kMinInformation * eigen.eigenvalues()(5);
}

double CornerSquares(const Problem& problem, const PoseCP& pose) {
  return Assemble(problem.corners, problem.camera, pose).squares;
}

void SetCovariance(const Problem& problem, const Minima& minima, const PadPoseOptions& options,
                   PadPose* pose) {
  const double unknowns = problem.normal ? 4.0 : 6.0;
  const double residuals = std::max(2.0 * problem.corners.count - unknowns, 0.0);
  const double variance =
      (options.corner_sigma_weight * options.corner_sigma * options.corner_sigma +
       CornerSquares(problem, minima.best.pose)) /
      (options.corner_sigma_weight + residuals);
  pose->corner_sigma = std::max(std::sqrt(variance), options.corner_sigma_floor);
  const NormalEquations best = problem.At(minima.best.pose, pose->corner_sigma);
  pose->cov = best.hessian.ldlt().solve(Matrix6d::Identity());
  if (!minima.other.found || !minima.other.converged) return;
  const Vector6d between = Difference(minima.best.pose, minima.other.pose);
  if (between.norm() < kSamePose) return;
  const NormalEquations other = problem.At(minima.other.pose, pose->corner_sigma);
  // Likelihoods times the volumes over which they hold.
  const Matrix6d other_cov = other.hessian.ldlt().solve(Matrix6d::Identity());
  const double ratio = std::exp(-0.5 * (other.squares - best.squares)) *
                       std::sqrt(other_cov.determinant() / pose->cov.determinant());
  if (!std::isfinite(ratio)) return;
  pose->other_probability = std::min(ratio / (1.0 + ratio), 0.5);
  pose->cov = ((1.0 - pose->other_probability) * pose->cov +
               pose->other_probability * (other_cov + between * between.transpose()))
                  .eval();
}

double TagRms(const TagDetection& tag, const PoseCP& pose, const CameraIntrinsics& camera) {
  const PadCorners corners(std::span(&tag, 1));
  const NormalEquations sums = Assemble(corners, camera, pose);
  return sums.in_front ? std::sqrt(sums.squares / 8.0) : HUGE_VAL;
}

struct Attempt {
  Minima minima;
  double worst_rms = HUGE_VAL;  // of a tag [pixel]
  int left_out = -1;            // index
};

Attempt Try(std::span<const TagDetection> tags, Problem* problem, int left_out) {
  Attempt attempt;
  attempt.left_out = left_out;
  problem->corners = PadCorners(tags, left_out);
  const std::optional<PoseCP> start = PoseFromHomography(problem->corners, problem->camera);
  if (!start) return attempt;
  attempt.minima = SolveBoth(*problem, *start);
  if (!attempt.minima.best.found) return attempt;
  attempt.worst_rms = 0.0;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    if (static_cast<int>(i) == left_out) continue;
    attempt.worst_rms =
        std::max(attempt.worst_rms, TagRms(tags[i], attempt.minima.best.pose, problem->camera));
  }
  return attempt;
}

}  // namespace

const char* Sentence(PadPoseStatus status) {
  switch (status) {
    case PadPoseStatus::kSolved:
      return "The pad's pose was found.";
    case PadPoseStatus::kNoTag:
      return "There is no tag in the image.";
    case PadPoseStatus::kDegenerate:
      return "The tags' corners do not determine a pose.";
    case PadPoseStatus::kNotConverged:
      return "The pad's pose did not come to rest.";
    case PadPoseStatus::kInconsistent:
      return "No pose of the pad explains the tags' corners.";
  }
  return "unknown";
}

PadPose SolvePadPose(std::span<const TagDetection> tags, const CameraIntrinsics& camera,
                     const PadPoseOptions& options, const std::optional<PadNormal>& normal) {
  Check(tags, options, normal);
  PadPose pose;
  if (tags.empty()) return pose;
  const auto failed = [&pose](PadPoseStatus status) {
    pose.status = status;
    return pose;
  };
  for (const TagDetection& tag : tags) {
    if (!tag.corners.allFinite()) return failed(PadPoseStatus::kDegenerate);
  }
  Problem problem{{}, camera, normal, options.corner_sigma};
  const double limit = options.outlier_rms * options.corner_sigma;
  Attempt attempt = Try(tags, &problem, -1);
  if (attempt.worst_rms > limit && tags.size() >= 3) {
    for (int i = 0; i < static_cast<int>(tags.size()); ++i) {
      const Attempt without = Try(tags, &problem, i);
      if (without.worst_rms < attempt.worst_rms) attempt = without;
    }
    problem.corners = PadCorners(tags, attempt.left_out);
  }
  const Solution& best = attempt.minima.best;
  if (!best.found || !Determined(best.sums.hessian)) return failed(PadPoseStatus::kDegenerate);
  if (!best.converged) return failed(PadPoseStatus::kNotConverged);
  if (attempt.worst_rms > limit) return failed(PadPoseStatus::kInconsistent);
  pose.status = PadPoseStatus::kSolved;
  pose.p_CP = best.pose.p;
  pose.R_CP = best.pose.R;
  pose.tags_used = problem.corners.count / 4;
  if (attempt.left_out >= 0) pose.dropped_id = tags[static_cast<std::size_t>(attempt.left_out)].id;
  SetCovariance(problem, attempt.minima, options, &pose);
  return pose;
}

PadSighting ToSighting(const PadPose& pose, double t, const Eigen::Matrix3d& R_BC,
                       const Eigen::Vector3d& p_BC) {
  if (pose.status != PadPoseStatus::kSolved) {
    throw std::invalid_argument("ToSighting: the pose is not solved");
  }
  PadSighting sighting;
  sighting.t = t;
  sighting.p_BP_B = p_BC + R_BC * pose.p_CP;
  const Eigen::Vector3d x_P_B = R_BC * pose.R_CP.col(0);
  sighting.yaw_BP = std::atan2(x_P_B.y(), x_P_B.x());
  const Eigen::Matrix3d cov_p = R_BC * pose.cov.topLeftCorner<3, 3>() * R_BC.transpose();
  sighting.sigma_p = cov_p.diagonal().cwiseSqrt();
  // A rotation r moves x by r x x; the heading by the part across it in the plane.
  const Eigen::Matrix3d cov_r = R_BC * pose.cov.bottomRightCorner<3, 3>() * R_BC.transpose();
  const double flat = x_P_B.head<2>().squaredNorm();
  const Eigen::Vector3d by_rotation(-x_P_B.z() * x_P_B.x() / flat, -x_P_B.z() * x_P_B.y() / flat,
                                    1.0);
  sighting.sigma_yaw = std::sqrt(by_rotation.dot(cov_r * by_rotation));
  sighting.tags_seen = pose.tags_used;
  return sighting;
}

PadNormal LevelPadNormal(const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& R_BC, double sigma) {
  return {(R_WB * R_BC).transpose() * Eigen::Vector3d::UnitZ(), sigma};
}

}  // namespace touchdown::estimation
