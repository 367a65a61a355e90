// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "estimation/base/argument_check.h"
#include "sim/base/input_file.h"
#include "sim/obstacles/mesh_shapes.h"
#include "sim/obstacles/world_files.h"

namespace touchdown::sim {
namespace {

constexpr std::size_t kMostTriangles = 2'000'000;

}  // namespace

std::vector<Obstacle> ObstaclesOfMeshFile(const std::string& path, double scale,
                                          const Placement& placement) {
  estimation::CheckAbove("scale of a mesh", scale, 0.0, 1e6);
  // What its name does not hold could change unseen.
  if (path.ends_with(".gltf")) RefuseFile(path, "it keeps its mesh in another file; allowed is .glb");
  const std::string bytes = ReadInputFile(path, kMostInputBytes);
  if (bytes.empty()) RefuseFile(path, "it is empty");
  Assimp::Importer importer;
  // The parts of a scene at their places, each polygon in triangles. Points and lines are left out: they are no solids.
  const aiScene* scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(),
      aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_PreTransformVertices,
      std::filesystem::path(path).extension().c_str());
  if (scene == nullptr) RefuseFile(path, importer.GetErrorString());
  std::vector<Eigen::Vector3d> corners;
  std::vector<Eigen::Vector3i> triangles;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    const int first = static_cast<int>(corners.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      corners.push_back(placement(scale * Eigen::Vector3d(v.x, v.y, v.z)));
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) continue;
      triangles.emplace_back(first + static_cast<int>(face.mIndices[0]),
                             first + static_cast<int>(face.mIndices[1]),
                             first + static_cast<int>(face.mIndices[2]));
    }
    if (triangles.size() > kMostTriangles) RefuseFile(path, "it has more than two million triangles");
  }
  if (triangles.empty()) RefuseFile(path, "there is no triangle in it");
  std::vector<Obstacle> obstacles;
  try {
    for (TriangleMesh& solid : SolidsOf(corners, triangles)) {
      obstacles.emplace_back(Mesh{std::make_shared<const TriangleMesh>(std::move(solid))});
    }
  } catch (const std::invalid_argument& error) {
    RefuseFile(path, error.what());
  }
  return obstacles;
}

}  // namespace touchdown::sim
