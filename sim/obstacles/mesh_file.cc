// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include "estimation/base/argument_check.h"
#include "sim/base/input_file.h"
#include "sim/obstacles/mesh_shapes.h"
#include "sim/obstacles/world_files.h"

namespace touchdown::sim {
namespace {

constexpr std::size_t kMostTriangles = 2'000'000;

// Others of assimp's are archives, which a bomb may fill, or keep their mesh in a second file.
constexpr std::array kKinds = {".obj", ".stl", ".ply", ".off", ".dae", ".glb"};

// Materials and pictures that a mesh names: it has none.
class NoOtherFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char* /*path*/) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* /*path*/, const char* /*mode*/) override { return nullptr; }
  void Close(Assimp::IOStream* /*file*/) override {}
};

/// "obj" of "a/b.OBJ".
std::string KindOf(const std::string& path) {
  std::string kind = std::filesystem::path(path).extension().string();
  for (char& letter : kind)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  if (std::find(kKinds.begin(), kKinds.end(), kind) == kKinds.end()) {
    RefuseFile(path, "its name must end with .obj, .stl, .ply, .off, .dae or .glb");
  }
  return kind.substr(1);
}

}  // namespace

std::vector<Obstacle> ObstaclesOfMeshFile(const std::string& path, double scale,
                                          const Placement& placement) {
  estimation::CheckAbove("scale of a mesh", scale, 0.0, 1e6);
  const std::string kind = KindOf(path);
  const std::string bytes = ReadInputFile(path, kMostInputBytes);
  if (bytes.empty()) RefuseFile(path, "it is empty");
  Assimp::Importer importer;
  importer.SetIOHandler(new NoOtherFiles);  // owned by the importer
  // The parts of a scene at their places, each polygon in triangles. Points and lines are left out: they are no solids.
  const aiScene* scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(),
      aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_PreTransformVertices,
      kind.c_str());
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
