// SPDX-License-Identifier: BSD-3-Clause
// Where shipped files are: in the installation that was named, or relative to the program, which can be moved.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/suggestion.h"
#include "touchdown/evaluation/base/shipped_files.h"

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

std::string& ShareDirectory() {
  static std::string directory;
  return directory;
}

fs::path ProgramDirectory() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path(".") : program.parent_path();
}

// Of the installation that was named, then of the installation or build tree that the program belongs to.
std::vector<std::string> Shipped(const char* folder) {
  std::vector<fs::path> candidates;
  if (!ShareDirectory().empty()) candidates.push_back(fs::path(ShareDirectory()) / folder);
  candidates.push_back(ProgramDirectory() / "../share/touchdown" / folder);
  return ExistingDirectories(candidates);
}

std::vector<std::string> StudyDirectories() { return Shipped("studies"); }

// Names of the YAML files in the first of these directories, sorted.
std::vector<std::string> NamesIn(const std::vector<std::string>& directories) {
  std::vector<std::string> names;
  if (directories.empty()) return names;
  for (const auto& entry : fs::directory_iterator(directories.front())) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// A path that exists, or a shipped file. `what` says what kind of file it is.
std::string FindYaml(const std::string& name_or_path, const std::vector<std::string>& directories,
                     const std::string& what) {
  std::error_code ignored;
  if (fs::is_regular_file(name_or_path, ignored)) return name_or_path;
  if (name_or_path.find('/') == std::string::npos) {
    for (const std::string& directory : directories) {
      for (const char* extension : {".yaml", ""}) {
        const fs::path path = fs::path(directory) / (name_or_path + extension);
        if (fs::is_regular_file(path, ignored)) return path.string();
      }
    }
  }
  if (fs::is_directory(name_or_path, ignored)) {
    throw BadInput(fmt::format("{}: a {} is a file, and this is a directory.", name_or_path, what));
  }
  throw BadInput(fmt::format("{}: there is no such {} file{}.", name_or_path, what,
                             Instead(name_or_path, NamesIn(directories), "shipped are")));
}

}  // namespace

bool UseShare(const std::string& directory) {
  ShareDirectory() = directory;
  return true;
}

std::vector<std::string> ScenarioDirectories() { return Shipped("scenarios"); }

std::vector<std::string> PythonDirectories() { return Shipped("python"); }

std::string DataPath(const std::string& file) {
  for (const std::string& directory : Shipped("data")) {
    std::error_code ignored;
    const fs::path path = fs::path(directory) / file;
    if (fs::is_regular_file(path, ignored)) return path.string();
  }
  throw BadInput(fmt::format("{}: is neither installed nor in the build tree.", file));
}

std::string FindScenario(const std::string& name_or_path) {
  return FindYaml(name_or_path, ScenarioDirectories(), "scenario");
}

std::vector<std::string> ListScenarios() { return NamesIn(ScenarioDirectories()); }

std::string FindStudyFile(const std::string& name_or_path) {
  return FindYaml(name_or_path, StudyDirectories(), "study");
}

std::vector<std::string> ListStudyFiles() { return NamesIn(StudyDirectories()); }

}  // namespace touchdown::evaluation
