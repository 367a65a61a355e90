// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace touchdown::evaluation {

/// Shows other processes that this process writes a file. Ends with the process, however it ends.
class FileLock {
 public:
  /// @throws BadInput if another process has it or it cannot be opened
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace touchdown::evaluation
