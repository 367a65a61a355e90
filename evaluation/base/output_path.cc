// SPDX-License-Identifier: BSD-3-Clause
// A directory is tested by writing into it. Permissions alone do not show a read-only file system,
// and root may write in spite of them.
#include "evaluation/base/output_path.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/sqlite_db.h"

namespace touchdown::evaluation {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Refuse(const std::string& option, const std::string& path,
                         const std::string& why) {
  throw BadInput(fmt::format("{} {}: {}.", option, path, why));
}

}  // namespace

void CheckOutputPath(const std::string& option, const std::string& path) {
  std::error_code ignored;
  const fs::path directory = fs::path(path).parent_path();
  if (!directory.empty() && !fs::is_directory(directory, ignored)) {
    Refuse(option, path, fmt::format("there is no directory {}", directory.string()));
  }
  if (fs::is_directory(path, ignored) || fs::path(path).filename().empty()) {
    Refuse(option, path, "a file must be named, and this is a directory");
  }
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    Refuse(option, path, "the path exists and is no regular file");
  }
  const AtomicFile probe(path);
  errno = 0;
  if (!std::ofstream(probe.working_path())) {
    Refuse(option, path, fmt::format("it cannot be written ({})", std::strerror(errno)));
  }
}

void CheckRecordPath(const std::string& option, const std::string& path) {
  CheckOutputPath(option, path);
  std::error_code ignored;
  if (!fs::exists(path, ignored) || fs::file_size(path, ignored) == 0) return;
  if (!IsSqliteFile(path)) Refuse(option, path, "the file exists and is no SQLite file");
  try {
    SqliteDb db(path, SqliteDb::Mode::kReadOnly);
    SqliteStatement trials = db.Prepare("SELECT 1 FROM sqlite_master WHERE name = 'manifest'");
    if (trials.Step()) Refuse(option, path, "the file exists and holds trials");
  } catch (const SqliteError&) {
    // What cannot be read is no campaign.
  }
}

void CheckPicturePath(const std::string& option, const std::string& path) {
  CheckOutputPath(option, path);
  const std::string kind = fs::path(path).extension().string();
  if (kind != ".png" && kind != ".pdf" && kind != ".svg") {
    throw BadInput(fmt::format("{} {}: the name must end in .png, .pdf or .svg.", option, path));
  }
}

void CheckPagePath(const std::string& option, const std::string& path) {
  CheckOutputPath(option, path);
  if (fs::path(path).extension() != ".html") Refuse(option, path, "the name must end in .html");
}

void CheckApart(const std::vector<std::pair<std::string, std::string>>& files) {
  std::error_code ignored;
  for (auto one = files.begin(); one != files.end(); ++one) {
    for (auto other = files.begin(); other != one; ++other) {
      if (one->second.empty() || other->second.empty()) continue;
      if (fs::weakly_canonical(one->second, ignored) !=
          fs::weakly_canonical(other->second, ignored)) {
        continue;
      }
      throw BadInput(
          fmt::format("{} and {} are the same file, {}.", other->first, one->first, one->second));
    }
  }
}

}  // namespace touchdown::evaluation
