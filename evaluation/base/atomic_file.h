// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace touchdown::evaluation {

/// A file that appears at its path only when Commit is called; until then it is built beside it and
/// removed again on destruction.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write meanwhile.
  const std::string& working_path() const { return working_path_; }

  /// Moves the finished file to its place. @throws std::filesystem::filesystem_error
  void Commit();
  /// The same where there is nothing in its place; false if there is. @throws as Commit
  bool CommitNew();

 private:
  std::string path_;
  std::string working_path_;
  bool committed_ = false;
};

}  // namespace touchdown::evaluation
