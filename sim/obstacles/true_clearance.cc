// SPDX-License-Identifier: BSD-3-Clause
// FCL 0.7: the obstacles in a dynamic AABB tree, the vehicle as one cylinder. First the colliding
// pairs with their depth (libccd's MPR); only if there is none, the distance (libccd's GJK).
//
// Traps of Debian's build, all met:
// - It is compiled with assertions, so a state it dislikes ends the process. Poses are checked
//   here.
// - GST_INDEP together with signed distance or nearest points aborts on some shapes. GST_LIBCCD is
//   used throughout.
// - Signed distance by libccd costs 10 to 20 times the unsigned one, and its EPA can fail on face
//   contacts. It is not used.
// - The default tolerance, 1e-6, is a change per iteration, not an error. With it libccd's distance
//   to a cylinder is up to 3 mm too LARGE. With 1e-12 it is within 1e-9 m, for 2 instead of 1.5 us
//   a pair (3000 random poses over a box).

#include "sim/obstacles/true_clearance.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
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
#include "sim/obstacles/fcl_objects.h"

namespace touchdown::sim {
namespace {

constexpr double kGjkTolerance = 1.0e-12;  // change of the distance at which GJK stops [m]

struct Search {
  Clearance best{std::numeric_limits<double>::infinity(), -1};
  bool collided = false;
};

// Called for each pair whose bounds overlap; false goes on with the others.
bool VisitOverlap(FclObject* a, FclObject* b, void* data) {
  auto* search = static_cast<Search*>(data);
  fcl::CollisionRequestd request(1, true);
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::CollisionResultd result;
  if (fcl::collide(a, b, request, result) == 0) return false;
  const bool is_mesh = a->getObjectType() == fcl::OT_BVH || b->getObjectType() == fcl::OT_BVH;
  const double depth = is_mesh ? 0.0 : std::abs(result.getContact(0).penetration_depth);
  if (!search->collided || -depth < search->best.distance) {
    search->best = {-depth, ObstacleOf(*a, *b)};
  }
  search->collided = true;
  return false;
}

// Called for each pair whose bounds are nearer than `bound`, which it lowers; true ends the search.
bool VisitPair(FclObject* a, FclObject* b, void* data, double& bound) {
  auto* search = static_cast<Search*>(data);
  fcl::DistanceRequestd request;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  request.distance_tolerance = kGjkTolerance;
  fcl::DistanceResultd result;
  // A pair that touches gives -1. Nothing collides here, so the distance is 0.
  const double distance = std::max(0.0, fcl::distance(a, b, request, result));
  if (distance < search->best.distance) {
    search->best = {distance, ObstacleOf(*a, *b)};
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
                                               model.hull_top + model.foot_depth)),
        objects_(obstacles) {}

  Clearance Nearest(const estimation::VehicleState& vehicle) const {
    Search search;
    const Eigen::Matrix3d R_WB = vehicle.q_WB.toRotationMatrix();
    FclObject hull(hull_, R_WB, vehicle.p_WB + R_WB * center_B_);
    hull.computeAABB();
    objects_.tree().collide(&hull, &search, VisitOverlap);
    if (!search.collided) objects_.tree().distance(&hull, &search, VisitPair);
    return search.best;
  }

 private:
  Eigen::Vector3d center_B_;
  std::shared_ptr<fcl::Cylinderd> hull_;
  FclObstacles objects_;
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

LeastClearance::LeastClearance(const ObstacleField& obstacles,
                               const estimation::VehicleModel& model)
    : clearance_(obstacles, model),
      reach_(std::hypot(model.hull_radius, std::max(model.hull_top, model.foot_depth))) {}

void LeastClearance::Add(const estimation::VehicleState& vehicle) {
  double way = 0.0;
  if (!poses_.empty()) {
    const estimation::VehicleState& before = poses_.back().vehicle;
    way = poses_.back().way + (vehicle.p_WB - before.p_WB).norm() +
          reach_ * vehicle.q_WB.angularDistance(before.q_WB);
  }
  poses_.push_back({vehicle, way});
}

double LeastClearance::Least() const {
  if (poses_.empty()) return std::numeric_limits<double>::infinity();
  const double at_first = clearance_.Distance(poses_.front().vehicle);
  const double at_last = clearance_.Distance(poses_.back().vehicle);
  double least = std::min(at_first, at_last);
  Search(0, at_first, poses_.size() - 1, at_last, &least);
  return least;
}

// Between two poses the clearance is no less than where the ways from both would meet. Where the hull is in an
// obstacle all are asked: FCL's depths are no distances.
void LeastClearance::Search(std::size_t first, double at_first, std::size_t last, double at_last,
                            double* least) const {
  constexpr double kInexact = 1e-6;  // a distance is to be had [m]
  if (last - first < 2) return;
  const double way = poses_[last].way - poses_[first].way;
  if (0.5 * (at_first + at_last - way) - kInexact > std::max(*least, 0.0)) return;
  const std::size_t middle = first + (last - first) / 2;
  const double at_middle = clearance_.Distance(poses_[middle].vehicle);
  *least = std::min(*least, at_middle);
  Search(first, at_first, middle, at_middle, least);
  Search(middle, at_middle, last, at_last, least);
}

}  // namespace touchdown::sim
