// SPDX-License-Identifier: BSD-3-Clause
// Facts about build and machine: compile-time constants from CMake and git, library versions from their
// headers, the CPU from /proc/cpuinfo.
#include "evaluation/base/build_info.h"

#include <fstream>
#include <iterator>
#include <thread>

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>
#include <sqlite3.h>
#include <sys/utsname.h>
#include <Eigen/Core>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>

#include "touchdown_revision.h"

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

/// The vector instructions that the compiler may use. Preset `native` takes the widest that the CPU
/// has.
constexpr const char* kInstructionSet =
#if defined(__AVX512F__)
    "AVX-512";
#elif defined(__AVX2__)
    "AVX2";
#elif defined(__AVX__)
    "AVX";
#elif defined(__x86_64__)
    "x86-64";
#else
    "another architecture";
#endif

std::string Kernel() {
  utsname name{};
  return uname(&name) == 0 ? fmt::format("{} {} {}", name.sysname, name.release, name.machine)
                           : "unknown";
}

using Pairs = std::vector<std::pair<std::string, std::string>>;

// The file that this code is in: the program, or the Python module.
std::string CodeFile() {
  Dl_info info{};
  void* extra = nullptr;
  const auto* here = reinterpret_cast<const void*>(&CodeFile);
  if (dladdr1(here, &info, &extra, RTLD_DL_LINKMAP) != 0 && extra != nullptr) {
    const char* name = static_cast<const link_map*>(extra)->l_name;
    if (*name != '\0') return name;  // the program itself has none
  }
  return "/proc/self/exe";
}

// Of the facts and of the program file. The program file holds the library's own code. The facts describe its linked
// libraries and its machine.
std::string Hash(const Pairs& facts) {
  std::ifstream file(CodeFile(), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  for (const auto& [key, value] : facts) {
    bytes.append(key).append(1, '\0').append(value).append(1, '\0');
  }
  return HashOf(bytes);
}

}  // namespace

std::string HashOf(const std::string& bytes) {
  return to_string(boost::uuids::name_generator_sha1(boost::uuids::ns::x500dn())(bytes));
}

std::string BuildLine() {
  return fmt::format("version {} ({}), {} for {}, {}", TOUCHDOWN_VERSION, TOUCHDOWN_REVISION,
                     TOUCHDOWN_BUILD_TYPE, kInstructionSet, CpuInfo("model name"));
}

std::string BuildHash() {
  const Pairs facts = BuildManifest();
  return std::find_if(facts.begin(), facts.end(),
                      [](const auto& fact) { return fact.first == "build_hash"; })
      ->second;
}

Pairs BuildManifest() {
  Pairs facts = {
      {"touchdown_version", TOUCHDOWN_VERSION},
      {"revision", TOUCHDOWN_REVISION},
      {"build_type", TOUCHDOWN_BUILD_TYPE},
      {"compiler", __VERSION__},
      {"compiler_flags", TOUCHDOWN_CXX_FLAGS},
      {"instruction_set", kInstructionSet},
      {"eigen",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"ceres", TOUCHDOWN_CERES_VERSION},
      {"nlopt", TOUCHDOWN_NLOPT_VERSION},
      {"ipopt", TOUCHDOWN_IPOPT_VERSION},
      {"mujoco", TOUCHDOWN_MUJOCO_VERSION},
      {"sqlite", sqlite3_libversion()},
      {"cpu", CpuInfo("model name")},
      {"cpu_flags", CpuInfo("flags")},
  };
  static const std::string hash = Hash(facts);  // of megabytes
  facts.emplace_back("build_hash", hash);
  // What no figure but those of the wall clock depends on.
  facts.emplace_back("cpus", std::to_string(std::thread::hardware_concurrency()));
  facts.emplace_back("kernel", Kernel());
  return facts;
}

}  // namespace touchdown::evaluation
