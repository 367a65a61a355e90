// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace touchdown::sim {
namespace {

// The kind is asked of what was opened: the name could lead elsewhere by then.
class OpenFile {
 public:
  explicit OpenFile(const std::string& path)
      : file_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
    if (file_ < 0 || fstat(file_, &about_) != 0) {
      why_ = std::string("it cannot be read (") + std::strerror(errno) + ")";
    } else if (S_ISDIR(about_.st_mode)) {
      why_ = "it is a directory, and must be a file";
    } else if (!S_ISREG(about_.st_mode)) {
      why_ = "it is no regular file";
    }
  }
  ~OpenFile() {
    if (file_ >= 0) close(file_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  /// Why it cannot be read; empty: it can.
  const std::string& why() const { return why_; }
  /// Its first bytes, `most` at most. Some file systems say a size of 0, so it is not relied upon.
  std::string Read(std::size_t most) {
    std::string bytes;
    for (std::size_t size = 0;;) {
      bytes.resize(std::min(most, size + kAtATime));
      const ssize_t count = read(file_, bytes.data() + size, bytes.size() - size);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) why_ = std::string("reading it fails (") + std::strerror(errno) + ")";
      if (count > 0) size += static_cast<std::size_t>(count);
      if (count > 0 && size < most) continue;
      bytes.resize(size);
      return bytes;
    }
  }

 private:
  static constexpr std::size_t kAtATime = 1 << 20;
  int file_;
  struct stat about_ = {};
  std::string why_;
};

}  // namespace

std::string ReadInputFile(const std::string& path, std::size_t most) {
  OpenFile file(path);
  if (!file.why().empty()) RefuseFile(path, file.why());
  std::string bytes = file.Read(most + 1);
  if (!file.why().empty()) RefuseFile(path, file.why());
  if (bytes.size() > most) {
    RefuseFile(path, "it is larger than the " + std::to_string(most >> 20) + " MiB that are read");
  }
  return bytes;
}

std::string HeadOfFile(const std::string& path, std::size_t count) {
  OpenFile file(path);
  return file.why().empty() ? file.Read(count) : "";
}

void RefuseFile(const std::string& path, const std::string& why) {
  throw std::invalid_argument(path + ": " + why);
}

}  // namespace touchdown::sim
