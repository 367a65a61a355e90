// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "touchdown/control/onboard/step_time.h"

namespace touchdown::control {

/// The time by which a vehicle flies. It is the caller's, as long as that goes on as a clock does, and it never goes
/// back: where the caller's clock is another one from now on, it is that plus an offset. Does not allocate.
class FlightClock {
 public:
  /// The flight begins at the caller's time t [s].
  void Begin(double t) { now_ = t; }

  /// Judges the caller's time of a step [s], after Begin. If it is flown, the flight is at this time now.
  StepTime Step(double t);

  /// Of the flight, at the caller's time t [s].
  double At(double t) const { return t + offset_; }

 private:
  StepTime Fly(double t, StepTime judged);

  double now_ = 0.0;     ///< of the flight, at the last step that was flown [s]
  double offset_ = 0.0;  ///< from the caller's time to it [s]
  bool stepped_ = false;
  int agree_ = 0;      ///< of the refused times: so many go on as a clock does, ...
  double last_ = 0.0;  ///< ... to this one, by the caller's clock [s]
};

}  // namespace touchdown::control
