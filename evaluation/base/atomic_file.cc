// SPDX-License-Identifier: BSD-3-Clause
// rename(2) replaces a file in one step within a file system. So the working file lies in the same
// directory, under a name that no other process takes.
#include "evaluation/base/atomic_file.h"

#include <filesystem>
#include <utility>

#include <unistd.h>

namespace touchdown::evaluation {

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  working_path_ = path_ + ".partial-" + std::to_string(getpid());
  std::error_code ignored;
  std::filesystem::remove(working_path_, ignored);
}

AtomicFile::~AtomicFile() {
  if (committed_) return;
  std::error_code ignored;
  std::filesystem::remove(working_path_, ignored);
}

void AtomicFile::Commit() {
  std::filesystem::rename(working_path_, path_);
  committed_ = true;
}

bool AtomicFile::CommitNew() {
  // Unlike rename(2), link(2) never replaces; the destructor removes the other name.
  std::error_code error;
  std::filesystem::create_hard_link(working_path_, path_, error);
  if (error == std::errc::file_exists) return false;
  if (error) {
    throw std::filesystem::filesystem_error("a file cannot be put in its place", path_, error);
  }
  return true;
}

}  // namespace touchdown::evaluation
