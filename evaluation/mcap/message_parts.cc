// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/mcap/message_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace touchdown::evaluation {

std::uint64_t Nanoseconds(double t) {
  return static_cast<std::uint64_t>(std::llround(1e9 * std::max(t, 0.0)));
}

void AddTime(protozero::pbf_writer* to, unsigned field, double t) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  const std::uint64_t ns = Nanoseconds(t);
  protozero::pbf_writer time(*to, field);
  time.add_int64(1, static_cast<std::int64_t>(ns / kSecond));
  time.add_int32(2, static_cast<std::int32_t>(ns % kSecond));
}

void AddVector(protozero::pbf_writer* to, unsigned field, const Eigen::Vector3d& v) {
  protozero::pbf_writer vector(*to, field);
  vector.add_double(1, v.x());
  vector.add_double(2, v.y());
  vector.add_double(3, v.z());
}

void AddQuaternion(protozero::pbf_writer* to, unsigned field, const Eigen::Quaterniond& q) {
  protozero::pbf_writer quaternion(*to, field);
  quaternion.add_double(1, q.x());
  quaternion.add_double(2, q.y());
  quaternion.add_double(3, q.z());
  quaternion.add_double(4, q.w());
}

void AddPose(protozero::pbf_writer* to, unsigned field, const Eigen::Isometry3d& pose) {
  protozero::pbf_writer part(*to, field);
  AddVector(&part, 1, pose.translation());
  AddQuaternion(&part, 2, Eigen::Quaterniond(pose.linear()));
}

void AddColor(protozero::pbf_writer* to, unsigned field, const Color& color) {
  protozero::pbf_writer part(*to, field);
  part.add_double(1, color.r);
  part.add_double(2, color.g);
  part.add_double(3, color.b);
  part.add_double(4, color.a);
}

Eigen::Isometry3d PoseOf(const Eigen::Vector3d& p, const Eigen::Quaterniond& q) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(p).rotate(q);
  return pose;
}

}  // namespace touchdown::evaluation
