// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/map_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/output_path.h"

namespace touchdown::evaluation {
namespace {

namespace fs = std::filesystem;

}  // namespace

void ReadMapFile(const std::string& path, planning::PersistentMap* map) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    throw std::invalid_argument(fmt::format("{}: a map is a file, and this is a directory", path));
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw std::invalid_argument(
        fmt::format("{}: the map cannot be read ({})", path, std::strerror(errno)));
  }
  try {
    map->Read(file);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", path, error.what()));
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
