// SPDX-License-Identifier: BSD-3-Clause
// FCL 0.7: the obstacles in a dynamic AABB tree, the vehicle as one cylinder. First the colliding
// pairs with their depth (libccd's MPR); only if there is none, the distance (libccd's GJK).
//
// Traps of Debian's build, all met: it is compiled with assertions, so a state it dislikes ends the
// process: poses are checked here. GST_INDEP together with signed distance or nearest points aborts
// on some shapes: GST_LIBCCD throughout. Signed distance by libccd costs 10 to 20 times the
// unsigned one and its EPA can fail on face contacts: not asked for. The default tolerance, 1e-6,
// is a change per iteration, not an error: with it libccd's distance to a cylinder is up to 3 mm
// too LARGE; with 1e-12 it is within 1e-9 m, for 2 instead of 1.5 us a pair (3000 random poses over
// a box).

#include "sim/obstacles/true_clearance.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "estimation/base/argument_check.h"
#include "estimation/base/rotation_vector.h"

namespace touchdown::sim {
namespace {

using Object = fcl::CollisionObjectd;

constexpr double kGjkTolerance = 1.0e-12;  // change of the distance at which GJK stops [m]

/// The shapes that make up an obstacle.
class ObjectMaker {
 public:
  explicit ObjectMaker(std::vector<std::unique_ptr<Object>>* objects) : objects_(objects) {}

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
    objects_->push_back(std::make_unique<Object>(shape, R, p));
  }

  std::vector<std::unique_ptr<Object>>* objects_;
};

int IndexOf(const Object& object) { return *static_cast<const int*>(object.getUserData()); }

// One of the pair is the vehicle, which carries no index.
const Object& ObstacleOf(const Object& a, const Object& b) {
  return a.getUserData() != nullptr ? a : b;
}

struct Search {
  Clearance best{std::numeric_limits<double>::infinity(), -1};
  bool collided = false;
};

// Called for each pair whose bounds overlap; false goes on with the others.
bool VisitOverlap(Object* a, Object* b, void* data) {
  auto* search = static_cast<Search*>(data);
  fcl::CollisionRequestd request(1, true);
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::CollisionResultd result;
  if (fcl::collide(a, b, request, result) == 0) return false;
  const double depth = std::abs(result.getContact(0).penetration_depth);
  if (!search->collided || -depth < search->best.distance) {
    search->best = {-depth, IndexOf(ObstacleOf(*a, *b))};
  }
  search->collided = true;
  return false;
}

// Called for each pair whose bounds are nearer than `bound`, which it lowers; true ends the search.
bool VisitPair(Object* a, Object* b, void* data, double& bound) {
  auto* search = static_cast<Search*>(data);
  fcl::DistanceRequestd request;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  request.distance_tolerance = kGjkTolerance;
  fcl::DistanceResultd result;
  // A pair in touch gives -1: nothing collides here, so it is the touch itself.
  const double distance = std::max(0.0, fcl::distance(a, b, request, result));
  if (distance < search->best.distance) {
    search->best = {distance, IndexOf(ObstacleOf(*a, *b))};
  }
  bound = search->best.distance;
  return bound <= 0.0;
}

}  // namespace

class TrueClearance::Impl {
 public:
  Impl(const ObstacleField& obstacles, const estimation::VehicleModel& model)
      : center_B_(0.0, 0.0, 0.5 * (model.hull_top - model.foot_depth)),
        hull_(std::make_shared<fcl::Cylinderd>(model.hull_radius,
                                               model.hull_top + model.foot_depth)) {
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

  Clearance Nearest(const estimation::VehicleState& vehicle) const {
    Search search;
    if (objects_.empty()) return search.best;
    const Eigen::Matrix3d R_WB = vehicle.q_WB.toRotationMatrix();
    Object hull(hull_, R_WB, vehicle.p_WB + R_WB * center_B_);
    hull.computeAABB();
    tree_.collide(&hull, &search, VisitOverlap);
    if (!search.collided) tree_.distance(&hull, &search, VisitPair);
    return search.best;
  }

 private:
  Eigen::Vector3d center_B_;
  std::shared_ptr<fcl::Cylinderd> hull_;
  std::vector<int> indices_;  // what the objects' user data points to
  std::vector<std::unique_ptr<Object>> objects_;
  fcl::DynamicAABBTreeCollisionManagerd tree_;
};

TrueClearance::TrueClearance(const ObstacleField& obstacles,
                             const estimation::VehicleModel& model) {
  estimation::CheckAbove("hull_radius [m]", model.hull_radius, 0.0, 10.0);
  estimation::CheckAbove("hull height (hull_top + foot_depth) [m]",
                         model.hull_top + model.foot_depth, 0.0, 10.0);
  impl_ = std::make_unique<Impl>(obstacles, model);
}
TrueClearance::TrueClearance(TrueClearance&&) noexcept = default;
TrueClearance& TrueClearance::operator=(TrueClearance&&) noexcept = default;
TrueClearance::~TrueClearance() = default;

double TrueClearance::Distance(const estimation::VehicleState& vehicle) const {
  return Nearest(vehicle).distance;
}

Clearance TrueClearance::Nearest(const estimation::VehicleState& vehicle) const {
  if (!vehicle.p_WB.allFinite()) {
    throw std::invalid_argument("vehicle position: not finite; allowed are finite numbers");
  }
  estimation::CheckWithin("norm of q_WB", vehicle.q_WB.norm(), 1.0 - 1e-6, 1.0 + 1e-6);
  return impl_->Nearest(vehicle);
}

}  // namespace touchdown::sim
