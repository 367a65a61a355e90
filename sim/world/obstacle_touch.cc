// SPDX-License-Identifier: BSD-3-Clause
// MuJoCo 2.2 collides meshes as their convex hulls, and thousands of boxes slow its every step. So it has only ground,
// deck and vehicle. For most of a flight nothing is within the vehicle's reach. The field's tree finds that in a
// microsecond.
#include "sim/world/obstacle_touch.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <mujoco/mujoco.h>

#include "sim/obstacles/fcl_objects.h"

namespace touchdown::sim {
namespace {

using Shape = std::shared_ptr<fcl::CollisionGeometryd>;
using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Shape MeshOf(const mjModel& m, int mesh) {
  std::vector<Eigen::Vector3d> corners;
  std::vector<Eigen::Vector3i> triangles;
  const float* vert = m.mesh_vert + 3 * m.mesh_vertadr[mesh];
  const int* face = m.mesh_face + 3 * m.mesh_faceadr[mesh];
  for (int i = 0; i < m.mesh_vertnum[mesh]; ++i, vert += 3) {
    corners.emplace_back(vert[0], vert[1], vert[2]);
  }
  for (int i = 0; i < m.mesh_facenum[mesh]; ++i, face += 3) {
    triangles.emplace_back(face[0], face[1], face[2]);
  }
  return FclSurface(corners, triangles);
}

Shape ShapeOf(const mjModel& m, int geom) {
  const mjtNum* size = m.geom_size + 3 * geom;
  switch (m.geom_type[geom]) {
    case mjGEOM_SPHERE:
      return std::make_shared<fcl::Sphered>(size[0]);
    case mjGEOM_CAPSULE:
      return std::make_shared<fcl::Capsuled>(size[0], 2.0 * size[1]);
    case mjGEOM_CYLINDER:
      return std::make_shared<fcl::Cylinderd>(size[0], 2.0 * size[1]);
    case mjGEOM_ELLIPSOID:
      return std::make_shared<fcl::Ellipsoidd>(size[0], size[1], size[2]);
    case mjGEOM_BOX:
      return std::make_shared<fcl::Boxd>(2.0 * size[0], 2.0 * size[1], 2.0 * size[2]);
    case mjGEOM_MESH:
      return MeshOf(m, m.geom_dataid[geom]);
    default:
      throw std::invalid_argument("a part of the vehicle is a plane or a height field; allowed are solids");
  }
}

bool VisitOverlap(FclObject* a, FclObject* b, void* data) {
  auto* found = static_cast<std::optional<Touch>*>(data);
  fcl::CollisionRequestd request(1, true);
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::CollisionResultd result;
  if (fcl::collide(a, b, request, result) == 0) return false;
  *found = Touch{ObstacleOf(*a, *b), result.getContact(0).pos};
  return true;  // it ends the search
}

}  // namespace

class ObstacleTouch::Impl {
 public:
  Impl(const ObstacleField& obstacles, const mjModel& m, const std::vector<int>& geoms)
      : field_(obstacles), objects_(obstacles), geoms_(geoms) {
    for (const int geom : geoms) {
      parts_.emplace_back(ShapeOf(m, geom));
      const Eigen::Map<const Eigen::Vector3d> p_B(m.geom_pos + 3 * geom);
      reach_ = std::max(reach_, p_B.norm() + m.geom_rbound[geom]);
    }
  }

  std::optional<Touch> Find(const mjData& d, const Eigen::Vector3d& p_W) {
    std::optional<Touch> touch;
    if (field_.SignedDistance(p_W) > reach_) return touch;
    for (std::size_t i = 0; i < parts_.size() && !touch; ++i) {
      const Eigen::Map<const RowMajor3> R_WG(d.geom_xmat + 9 * geoms_[i]);
      const Eigen::Map<const Eigen::Vector3d> p_WG(d.geom_xpos + 3 * geoms_[i]);
      parts_[i].setTransform(Eigen::Matrix3d(R_WG), p_WG);
      parts_[i].computeAABB();
      objects_.tree().collide(&parts_[i], &touch, VisitOverlap);
    }
    return touch;
  }

 private:
  ObstacleField field_;
  FclObstacles objects_;
  std::vector<int> geoms_;
  std::vector<FclObject> parts_;
  double reach_ = 0.0;  // of any part, from the vehicle's origin [m]
};

ObstacleTouch::ObstacleTouch(const ObstacleField& obstacles, const mjModel_& model,
                             const std::vector<int>& geoms)
    : impl_(std::make_unique<Impl>(obstacles, model, geoms)) {}
ObstacleTouch::ObstacleTouch(ObstacleTouch&&) noexcept = default;
ObstacleTouch& ObstacleTouch::operator=(ObstacleTouch&&) noexcept = default;
ObstacleTouch::~ObstacleTouch() = default;

std::optional<Touch> ObstacleTouch::Find(const mjData_& data, const Eigen::Vector3d& p_W) const {
  return impl_->Find(data, p_W);
}

}  // namespace touchdown::sim
