// SPDX-License-Identifier: BSD-3-Clause
// Messages of Foxglove's schemas, serialized.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace touchdown::evaluation {

/// The pose of a frame in another.
struct FramePose {
  std::string parent, child;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

/// foxglove.FrameTransforms.
std::string FrameTransforms(double t, const std::vector<FramePose>& frames);

/// foxglove.PoseInFrame and foxglove.PosesInFrame.
std::string PoseInFrame(double t, const std::string& frame, const Eigen::Isometry3d& pose);
std::string PosesInFrame(double t, const std::string& frame,
                         const std::vector<Eigen::Isometry3d>& poses);

/// Numbers of foxglove.Log.
enum class LogLevel { kInfo = 2, kWarning = 3, kError = 4 };

/// foxglove.Log. @param name whose words they are.
std::string Log(double t, LogLevel level, const std::string& name, const std::string& words);

}  // namespace touchdown::evaluation
