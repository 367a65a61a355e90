// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <sys/types.h>

namespace touchdown::evaluation {

/// Checks that there is a program ffmpeg on PATH. @throws BadInput naming the part that needs it and the package.
/// @param who that part, for the sentence.
void RequireEncoder(const std::string& who);

/// Writes an MP4 file, H.264, of raw pictures, by the program ffmpeg. A child process, which ends with this.
class VideoEncoder {
 public:
  /// @param path of the file; one that is there is replaced. Width and height even.
  /// @throws std::runtime_error if the program cannot be started.
  VideoEncoder(const std::string& path, int width, int height, int rate_hz);
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  /// The next picture: height x width x 3. @throws std::runtime_error with the program's own last words.
  void Add(const std::vector<std::uint8_t>& rgb);

  /// Waits until the file is whole. Nothing can be added any more. @throws as Add, and if nothing was added
  void Finish();

 private:
  [[noreturn]] void Fail();
  std::string LastWords();
  void Wait() noexcept;  // for the program's end

  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };

  std::string path_;
  std::unique_ptr<std::FILE, Close> words_;  // what the program says
  int to_child_ = -1;
  pid_t child_ = -1;
  int status_ = 0;  // with which it ended
  bool empty_ = true;
};

}  // namespace touchdown::evaluation
