// SPDX-License-Identifier: BSD-3-Clause
// Ownership of MuJoCo 2.2.2's C structures.
//
// mj_loadXML reports a faulty model in its message. Only when memory runs out does it leave by an error; what its C++
// parts hold is then lost. It keeps the model parsed last in a global, so it is locked. mjVFS is megabytes large, so it
// is on the heap. mj_deleteVFS frees the text in it, so the text is allocated by mju_malloc.

#include "sim/mujoco/mujoco_model.h"

#include <mujoco/mujoco.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <stdexcept>

#include <fcntl.h>
#include <unistd.h>

#include "sim/mujoco/mjcf_source.h"
#include "sim/mujoco/mujoco_call.h"

namespace touchdown::sim {
namespace {

constexpr char kSceneName[] = "scene.xml";

struct VfsDeleter {
  void operator()(mjVFS* vfs) const noexcept {
    mj_deleteVFS(vfs);
    delete vfs;
  }
};

using Vfs = std::unique_ptr<mjVFS, VfsDeleter>;

Vfs MakeVfs() {
  Vfs vfs(new mjVFS);
  mj_defaultVFS(vfs.get());
  return vfs;
}

void AddText(const char* name, const std::string& text, mjVFS* vfs) {
  if (text.empty()) throw std::invalid_argument(std::string("MJCF: ") + name + " is empty");
  const int size = static_cast<int>(text.size());
  if (mj_makeEmptyFileVFS(vfs, name, size) != 0) {
    throw std::runtime_error(std::string("MuJoCo: no room in memory for the text of ") + name);
  }
  std::memcpy(vfs->filedata[mj_findFileVFS(vfs, name)], text.data(), text.size());
}

MujocoModel Load(const char* name, const mjVFS* vfs) {
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  std::array<char, 1024> message{};
  MujocoModel model;
  CallMujoco([&] {
    model.reset(mj_loadXML(name, vfs, message.data(), static_cast<int>(message.size())));
  });
  if (!model) {
    for (char& c : message) {
      if (c == '\n') c = ' ';
    }
    throw std::invalid_argument(std::string("MJCF: ") + message.data());
  }
  return model;
}

}  // namespace

void MujocoModelDeleter::operator()(mjModel_* model) const noexcept { mj_deleteModel(model); }
void MujocoDataDeleter::operator()(mjData_* data) const noexcept { mj_deleteData(data); }

MujocoModel CompileMjcf(const std::string& mjcf, const std::string& vehicle_mjcf) {
  const Vfs vfs = MakeVfs();
  AddText(kSceneName, mjcf, vfs.get());
  if (!vehicle_mjcf.empty()) {
    CheckMjcf(vehicle_mjcf);
    AddText(kVehicleIncludeName, vehicle_mjcf, vfs.get());
  }
  return Load(kSceneName, vfs.get());
}

MujocoModel CompileVehicleMjcf(const std::string& mjcf) {
  CheckMjcf(mjcf);
  return CompileMjcf(mjcf);
}

namespace {

/// MuJoCo's qhull writes pages to stderr where a mesh is flat. What it reports, MuJoCo returns as well.
class QuietErrors {
 public:
  QuietErrors() : before_(dup(STDERR_FILENO)), nowhere_(open("/dev/null", O_WRONLY | O_CLOEXEC)) {
    if (before_ >= 0 && nowhere_ >= 0) dup2(nowhere_, STDERR_FILENO);
  }
  ~QuietErrors() {
    if (before_ >= 0) dup2(before_, STDERR_FILENO);
    for (const int file : {before_, nowhere_}) {
      if (file >= 0) close(file);
    }
  }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  int before_, nowhere_;
};

}  // namespace

// Its text counts as a file of that folder, in which MuJoCo looks for meshes.
MujocoModel CompileMjcfFile(const std::string& path) {
  const Vfs vfs = MakeVfs();
  AddText(kSceneName, ReadMjcf(path), vfs.get());
  const QuietErrors quiet;
  return Load((std::filesystem::path(path).parent_path() / kSceneName).c_str(), vfs.get());
}

MujocoData MakeMujocoData(const mjModel_& model) {
  MujocoData data;
  CallMujoco([&] { data.reset(mj_makeData(&model)); });
  if (!data) throw std::runtime_error("MuJoCo: no memory for the simulation's state");
  return data;
}

}  // namespace touchdown::sim
