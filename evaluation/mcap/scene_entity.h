// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "evaluation/mcap/message_parts.h"
#include "evaluation/mcap/solid.h"

namespace touchdown::evaluation {

/// Makes a foxglove.SceneEntity, shape by shape. It stays until one of its name takes its place, and moves with its frame.
class SceneEntity {
 public:
  SceneEntity(double t, const std::string& frame, const std::string& name);

  void Add(const Solid& solid);
  /// @param thickness [m]. @param closed its last point is joined to its first.
  void AddLine(const std::vector<Eigen::Vector3d>& points, double thickness, const Color& color,
               bool closed = false);

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// foxglove.SceneUpdate.
std::string SceneUpdate(const std::vector<SceneEntity>& entities);

}  // namespace touchdown::evaluation
