// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/map_file.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/output_path.h"
#include "sim/base/input_file.h"

namespace touchdown::evaluation {
namespace {

namespace fs = std::filesystem;

}  // namespace

void ReadMapFile(const std::string& path, planning::PersistentMap* map) {
  std::istringstream file(sim::ReadInputFile(path, planning::kMostMapBytes));
  try {
    map->Read(file);
  } catch (const std::invalid_argument& error) {
    sim::RefuseFile(path, error.what());
  }
}

void CheckMapPath(const std::string& option, const std::string& path) {
  CheckOutputPath(option, path);
  const std::string kind = fs::path(path).extension().string();
  if (kind != ".bt" && kind != ".ot") {
    throw BadInput(fmt::format("{} {}: the name must end in .bt or .ot.", option, path));
  }
}

void WriteMapFile(const std::string& path, planning::PersistentMap* map) {
  AtomicFile file(path);
  std::ofstream out(file.working_path(), std::ios::binary);
  map->Write(out, fs::path(path).extension() == ".bt" ? planning::MapFormat::kBinary
                                                      : planning::MapFormat::kLogOdds);
  out.close();
  if (!out) throw std::runtime_error(fmt::format("{}: the map cannot be written", path));
  file.Commit();
}

}  // namespace touchdown::evaluation
