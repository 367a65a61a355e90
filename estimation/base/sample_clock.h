// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::estimation {

/// Says when a sensor of a given rate takes a sample: at first_s, first_s + 1/rate, ... Times are
/// counted, not accumulated, so that no drift builds up.
class SampleClock {
 public:
  /// @param rate_hz in (0, 1000]. @param first_s time of the first sample [s], >= 0.
  /// Throws std::invalid_argument naming the value and the range.
  explicit SampleClock(double rate_hz, double first_s = 0.0);

  /// True once for each sample time passed by `t` [s]; t does not go back. Samples that a long step
  /// skips are lost.
  bool Due(double t);

 private:
  double rate_hz_;
  double first_s_;
  long next_ = 0;
};

}  // namespace touchdown::estimation
