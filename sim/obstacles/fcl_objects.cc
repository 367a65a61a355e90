// SPDX-License-Identifier: BSD-3-Clause
#include "sim/obstacles/fcl_objects.h"

#include <cstddef>
#include <map>
#include <mutex>
#include <variant>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

#include "estimation/base/rotation_vector.h"

namespace touchdown::sim {
namespace {

/// In FCL every object computes its shape's bounds anew. For a shared model this happens once, before it is shared.
class Model : public fcl::BVHModel<fcl::OBBRSSd> {
 public:
  void computeLocalAABB() override {
    if (!bounded_) BVHModel::computeLocalAABB();
    bounded_ = true;
  }

 private:
  bool bounded_ = false;
};

// Made once for a surface while it is held, because checks, touches and clearances of many flights use it.
std::shared_ptr<fcl::CollisionGeometryd> ModelOf(
    const std::shared_ptr<const TriangleMesh>& surface) {
  using Surface = std::weak_ptr<const TriangleMesh>;
  static std::mutex one_at_a_time;
  static std::map<Surface, std::shared_ptr<fcl::CollisionGeometryd>, std::owner_less<>> models;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  std::erase_if(models, [](const auto& entry) { return entry.first.expired(); });
  std::shared_ptr<fcl::CollisionGeometryd>& model = models[surface];
  if (model == nullptr) model = FclSurface(surface->corners(), surface->triangles());
  return model;
}

/// The shapes that make up an obstacle.
class ObjectMaker {
 public:
  explicit ObjectMaker(std::vector<std::unique_ptr<FclObject>>* objects) : objects_(objects) {}

  void operator()(const Box& box) {
    const Eigen::Vector3d sides = 2.0 * box.half_extents;
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(box.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    Add(std::make_shared<fcl::Boxd>(sides), turn, box.center);
  }
  void operator()(const Cylinder& cylinder) {
    Add(std::make_shared<fcl::Cylinderd>(cylinder.radius, cylinder.height),
        Eigen::Matrix3d::Identity(), cylinder.center);
  }
  void operator()(const Sphere& sphere) {
    Add(std::make_shared<fcl::Sphered>(sphere.radius), Eigen::Matrix3d::Identity(), sphere.center);
  }
  void operator()(const Mesh& mesh) {
    Add(ModelOf(mesh.surface), Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  }
  // Neighbours along x of one height are one box.
  void operator()(const VoxelColumns& columns) {
    for (int y = 0; y < columns.count_y; ++y) {
      const double* heights = columns.heights.data() + y * columns.count_x;
      for (int from = 0, to; from < columns.count_x; from = to) {
        const double height = heights[from];
        to = from + 1;
        while (to < columns.count_x && heights[to] == height) ++to;
        if (height <= 0.0) continue;
        const Eigen::Vector3d sides((to - from) * columns.cell, columns.cell, height);
        const Eigen::Vector3d low = columns.corner + columns.cell * Eigen::Vector3d(from, y, 0.0);
        Add(std::make_shared<fcl::Boxd>(sides), Eigen::Matrix3d::Identity(), low + 0.5 * sides);
      }
    }
  }
  void operator()(const Ring& ring) {
    for (int i = 0; i < Ring::kSides; ++i) {
      const Eigen::Vector3d side = ring.Corner(i + 1) - ring.Corner(i);
      const Eigen::Matrix3d turn =
          estimation::ShortestTurn(Eigen::Vector3d::UnitZ(), side).toRotationMatrix();
      Add(std::make_shared<fcl::Capsuled>(ring.tube_radius, side.norm()), turn,
          ring.Corner(i) + 0.5 * side);
    }
  }

 private:
  void Add(const std::shared_ptr<fcl::CollisionGeometryd>& shape, const Eigen::Matrix3d& R,
           const Eigen::Vector3d& p) {
    objects_->push_back(std::make_unique<FclObject>(shape, R, p));
  }

  std::vector<std::unique_ptr<FclObject>>* objects_;
};

}  // namespace

FclObstacles::FclObstacles(const ObstacleField& obstacles) {
  indices_.reserve(obstacles.size());
  for (const Obstacle& obstacle : obstacles.obstacles()) {
    indices_.push_back(static_cast<int>(indices_.size()));
    const std::size_t first = objects_.size();
    std::visit(ObjectMaker(&objects_), obstacle);
    for (std::size_t i = first; i < objects_.size(); ++i) {
      objects_[i]->setUserData(&indices_.back());
      objects_[i]->computeAABB();
      tree_.registerObject(objects_[i].get());
    }
  }
  tree_.setup();
}

std::shared_ptr<fcl::CollisionGeometryd> FclSurface(const std::vector<Eigen::Vector3d>& corners,
                                                    const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<fcl::Triangle> indices;
  indices.reserve(triangles.size());
  for (const Eigen::Vector3i& of : triangles) {
    indices.emplace_back(static_cast<std::size_t>(of[0]), static_cast<std::size_t>(of[1]),
                         static_cast<std::size_t>(of[2]));
  }
  auto model = std::make_shared<Model>();
  model->beginModel(static_cast<int>(indices.size()), static_cast<int>(corners.size()));
  model->addSubModel(corners, indices);
  model->endModel();
  model->computeLocalAABB();
  return model;
}

int ObstacleOf(const FclObject& a, const FclObject& b) {
  return *static_cast<const int*>(a.getUserData() != nullptr ? a.getUserData() : b.getUserData());
}

}  // namespace touchdown::sim
