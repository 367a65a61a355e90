// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "evaluation/record/record_reader.h"
#include "touchdown/evaluation/scenario/registries.h"

namespace touchdown::evaluation {

/// Pictures a second of a video; it runs in real time.
inline constexpr int kVideoRate = 25;

struct VideoSize {
  int width = 1280;  ///< [pixel], even
  int height = 720;  ///< [pixel], even
};

/// The pictures of a recorded flight: from behind the vehicle, with what its cameras see and a caption. The same record
/// gives the same bits. Belongs to the thread that made it.
class FlightPictures {
 public:
  /// @throws BadInput for a record that cannot be read, std::runtime_error if there is no off-screen rendering.
  FlightPictures(const std::string& record_path, const Registries& registries, VideoSize size = {});
  ~FlightPictures();

  int count() const;

  /// The next one, from the first on: height x width x 3, row 0 at the top. Valid until the next call.
  const std::vector<std::uint8_t>& Next();

  /// Where something is in the picture that Next gave last [pixel].
  Eigen::Vector2d PixelOf(const Eigen::Vector3d& p_W) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Checks before a long run that WriteVideo will be able to write: the name (it must end in .mp4), the place, the
/// program ffmpeg, and off-screen rendering. @throws BadInput
void CheckVideo(const std::string& option, const std::string& path);

/// The same for what is to be flown: whether it can be drawn. @throws BadInput
void CheckVideo(const std::string& option, const std::string& path, const Scenario& scenario);

using VideoProgress = std::function<void(int done, int all)>;

/// Makes a video of a record. It appears whole or not at all. `progress`, if not empty, gets the number of finished
/// pictures. If it throws something that is no std::exception, the work ends.
/// @throws BadInput as FlightPictures, std::runtime_error with one sentence.
void WriteVideo(const std::string& record_path, const std::string& video_path,
                const Registries& registries, const VideoProgress& progress, VideoSize size = {});

}  // namespace touchdown::evaluation
