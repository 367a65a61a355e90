// SPDX-License-Identifier: BSD-3-Clause
// Delivery of frames from a sensor to its user: some are lost, the others are late.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>
#include <utility>

#include "estimation/base/argument_check.h"
#include "sim/base/random_stream.h"

namespace touchdown::sim {

struct FrameDeliveryConfig {
  double latency_ms = 0.0;        ///< from the time stamp to the delivery [ms], in [0, 10000]
  double drop_probability = 0.0;  ///< of each frame, in [0, 1]
  double outage_begin_s = 0.0;    ///< from here on no frame is taken ... [s]
  double outage_end_s = 0.0;      ///< ... until here; no outage if not after its begin [s]
};

/// Holds frames, or their results, back until they would arrive. Ask Admit first: a dropped frame needs no image. The
/// same seed gives the same frames.
template <typename Frame>
class FrameDelivery {
 public:
  /// `seed` and `name` feed the stream that drops frames. Throws std::invalid_argument naming key,
  /// value and range.
  FrameDelivery(const FrameDeliveryConfig& config, std::uint64_t seed, std::string_view name)
      : config_(config), random_(seed, name) {
    estimation::CheckWithin("delivery.latency_ms", config.latency_ms, 0.0, 1.0e4);
    estimation::CheckWithin("delivery.drop_probability", config.drop_probability, 0.0, 1.0);
  }

  /// Whether the frame taken at t [s] will arrive at all. Takes one draw, so an outage does not
  /// change which later frames are lost.
  bool Admit(double t) {
    const bool kept = random_.Uniform(0.0, 1.0) >= config_.drop_probability;
    return kept && !(t >= config_.outage_begin_s && t < config_.outage_end_s);
  }

  /// Takes an admitted frame; stamps [s] do not go back.
  void Hold(double stamp, Frame frame) { held_.emplace_back(stamp, std::move(frame)); }

  /// The oldest frame that has arrived by the time t [s]; call until there is none.
  std::optional<Frame> Poll(double t) {
    constexpr double kTolerance = 1.0e-7;  // [s], far below a time step
    if (held_.empty() || held_.front().first + 1e-3 * config_.latency_ms > t + kTolerance) {
      return std::nullopt;
    }
    Frame frame = std::move(held_.front().second);
    held_.pop_front();
    return frame;
  }

 private:
  FrameDeliveryConfig config_;
  RandomStream random_;
  std::deque<std::pair<double, Frame>> held_;
};

}  // namespace touchdown::sim
