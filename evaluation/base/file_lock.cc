// SPDX-License-Identifier: BSD-3-Clause
// flock(2) belongs to the open file and not to the process. SQLite's own locks are of the other kind; the two do not
// affect each other. The file is kept open for as long as SQLite has it. Closing any descriptor of a file drops the
// process's locks of that other kind.
#include "evaluation/base/file_lock.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "evaluation/base/bad_input.h"

namespace touchdown::evaluation {

FileLock::FileLock(const std::string& path) : descriptor_(open(path.c_str(), O_RDWR | O_CLOEXEC)) {
  if (descriptor_ < 0) throw BadInput(fmt::format("{}: {}.", path, std::strerror(errno)));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const int error = errno;
  close(descriptor_);
  if (error == EWOULDBLOCK) {
    throw BadInput(fmt::format("{}: another process is writing this file.", path));
  }
  // Where the file system has no such locks the file is written all the same.
  descriptor_ = -1;
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace touchdown::evaluation
