// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/mcap/messages.h"

#include "evaluation/mcap/message_parts.h"

namespace touchdown::evaluation {

std::string FrameTransforms(double t, const std::vector<FramePose>& frames) {
  std::string bytes;
  protozero::pbf_writer transforms(bytes);
  for (const FramePose& frame : frames) {
    protozero::pbf_writer transform(transforms, 1);
    AddTime(&transform, 1, t);
    transform.add_string(2, frame.parent);
    transform.add_string(3, frame.child);
    AddVector(&transform, 4, frame.pose.translation());
    AddQuaternion(&transform, 5, Eigen::Quaterniond(frame.pose.linear()));
  }
  return bytes;
}

std::string PoseInFrame(double t, const std::string& frame, const Eigen::Isometry3d& pose) {
  return PosesInFrame(t, frame, {pose});
}

// The only difference is that one may hold several. Their fields have the same numbers.
std::string PosesInFrame(double t, const std::string& frame,
                         const std::vector<Eigen::Isometry3d>& poses) {
  std::string bytes;
  protozero::pbf_writer message(bytes);
  AddTime(&message, 1, t);
  message.add_string(2, frame);
  for (const Eigen::Isometry3d& pose : poses) AddPose(&message, 3, pose);
  return bytes;
}

std::string Log(double t, LogLevel level, const std::string& name, const std::string& words) {
  std::string bytes;
  protozero::pbf_writer log(bytes);
  AddTime(&log, 1, t);
  log.add_enum(2, static_cast<int>(level));
  log.add_string(3, words);
  log.add_string(4, name);
  return bytes;
}

}  // namespace touchdown::evaluation
