// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

struct mjModel_;
struct mjData_;

namespace touchdown::sim {

struct MujocoModelDeleter {
  void operator()(mjModel_* model) const noexcept;
};
struct MujocoDataDeleter {
  void operator()(mjData_* data) const noexcept;
};
using MujocoModel = std::unique_ptr<mjModel_, MujocoModelDeleter>;
using MujocoData = std::unique_ptr<mjData_, MujocoDataDeleter>;

/// Name under which a scene's text includes the vehicle's: <include file="vehicle.xml"/>.
inline constexpr char kVehicleIncludeName[] = "vehicle.xml";

/// Compiles MJCF text; no file is read. One compilation runs at a time in a process, the caller
/// waits. Throws std::invalid_argument with MuJoCo's message.
/// @param vehicle_mjcf text that `mjcf` may include under kVehicleIncludeName; may be empty. It is asked as
/// CompileVehicleMjcf asks.
MujocoModel CompileMjcf(const std::string& mjcf, const std::string& vehicle_mjcf = "");

/// Compiles a vehicle's own text. Throws as CheckMjcf, too.
MujocoModel CompileVehicleMjcf(const std::string& mjcf);

/// Compiles the MJCF file at `path` with the meshes it names. Throws as ReadMjcf, too.
MujocoModel CompileMjcfFile(const std::string& path);

/// Throws std::runtime_error if MuJoCo cannot allocate.
MujocoData MakeMujocoData(const mjModel_& model);

}  // namespace touchdown::sim
