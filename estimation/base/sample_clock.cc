// SPDX-License-Identifier: BSD-3-Clause
// Sample k is due at first + k / rate. A tolerance far below any time step keeps a sample on the
// step it belongs to although neither time is exact in binary.

#include "estimation/base/sample_clock.h"

#include <cmath>

#include "estimation/base/argument_check.h"

namespace touchdown::estimation {

SampleClock::SampleClock(double rate_hz, double first_s) : rate_hz_(rate_hz), first_s_(first_s) {
  CheckAbove("sample rate [Hz]", rate_hz, 0.0, 1000.0);
  CheckWithin("time of the first sample [s]", first_s, 0.0, 1.0e6);
}

bool SampleClock::Due(double t) {
  constexpr double kTolerance = 1.0e-7;  // [s]
  const double samples = (t - first_s_ + kTolerance) * rate_hz_;
  if (samples < static_cast<double>(next_)) return false;
  next_ = static_cast<long>(std::floor(samples)) + 1;
  return true;
}

}  // namespace touchdown::estimation
