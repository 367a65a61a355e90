// SPDX-License-Identifier: BSD-3-Clause
// Facts about build and machine: compile-time constants from CMake, library versions from their
// headers, the CPU from /proc/cpuinfo.
#include "touchdown/evaluation/build_info.h"

#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/utsname.h>
#include <Eigen/Core>

namespace touchdown::evaluation {
namespace {

std::string CpuInfo(const std::string& field) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || line.rfind(field, 0) != 0) continue;
    const std::size_t begin = line.find_first_not_of(" \t", colon + 1);
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return "unknown";
}

std::string Kernel() {
  utsname name{};
  return uname(&name) == 0 ? fmt::format("{} {} {}", name.sysname, name.release, name.machine)
                           : "unknown";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> BuildManifest() {
  return {
      {"touchdown_version", TOUCHDOWN_VERSION},
      {"build_type", TOUCHDOWN_BUILD_TYPE},
      {"compiler", __VERSION__},
      {"compiler_flags", TOUCHDOWN_CXX_FLAGS},
      {"eigen",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"ceres", TOUCHDOWN_CERES_VERSION},
      {"mujoco", TOUCHDOWN_MUJOCO_VERSION},
      {"sqlite", sqlite3_libversion()},
      {"cpu", CpuInfo("model name")},
      {"cpu_flags", CpuInfo("flags")},
      {"cpus", std::to_string(std::thread::hardware_concurrency())},
      {"kernel", Kernel()},
  };
}

}  // namespace touchdown::evaluation
