// SPDX-License-Identifier: BSD-3-Clause
// Where shipped files are: relative to the program first (a build tree or an installation can be
// moved), then where this build's source tree was.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/scenario.h"
#include "touchdown/evaluation/scenario_value.h"
#include "touchdown/evaluation/shipped_files.h"

namespace touchdown::evaluation {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> ExistingDirectories(const std::vector<fs::path>& candidates) {
  std::vector<std::string> found;
  for (const fs::path& path : candidates) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
      found.push_back(fs::weakly_canonical(path, ignored).string());
  }
  return found;
}

fs::path ProgramDirectory() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path(".") : program.parent_path();
}

}  // namespace

std::vector<std::string> ScenarioDirectories() {
  return ExistingDirectories({ProgramDirectory() / "../share/touchdown/scenarios",
                              fs::path(TOUCHDOWN_EVALUATION_SOURCE) / "scenarios"});
}

std::vector<std::string> PythonDirectories() {
  return ExistingDirectories({ProgramDirectory() / "../share/touchdown/python",
                              fs::path(TOUCHDOWN_EVALUATION_SOURCE) / "python"});
}

std::vector<std::string> DataDirectories() {
  return ExistingDirectories({ProgramDirectory() / "../share/touchdown/data",
                              fs::path(TOUCHDOWN_EVALUATION_SOURCE) / "data"});
}

std::string FindScenario(const std::string& name_or_path) {
  std::error_code ignored;
  if (fs::is_regular_file(name_or_path, ignored)) return name_or_path;
  if (name_or_path.find('/') == std::string::npos) {
    for (const std::string& directory : ScenarioDirectories()) {
      for (const char* extension : {".yaml", ""}) {
        const fs::path path = fs::path(directory) / (name_or_path + extension);
        if (fs::is_regular_file(path, ignored)) return path.string();
      }
    }
  }
  if (fs::is_directory(name_or_path, ignored)) {
    throw BadInput(fmt::format("{}: a scenario is a file, and this is a directory.", name_or_path));
  }
  throw BadInput(fmt::format("{}: there is no such scenario file; shipped are {}.", name_or_path,
                             Enumerate(ListScenarios())));
}

std::vector<std::string> ListScenarios() {
  std::vector<std::string> names;
  const std::vector<std::string> directories = ScenarioDirectories();
  if (directories.empty()) return names;
  for (const auto& entry : fs::directory_iterator(directories.front())) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace touchdown::evaluation
