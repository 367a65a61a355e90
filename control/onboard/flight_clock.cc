// SPDX-License-Identifier: BSD-3-Clause
// One time that leaps says nothing of a clock, but a few in a row that go on from each other do. If they are later by no
// more than a process may stall, that time has passed: all that is known gets as old. Otherwise the clock is another
// one, or the stall was longer. What has passed is not known then, and counts as the longest stall.
#include "control/onboard/flight_clock.h"

#include "control/onboard/stamps.h"

namespace touchdown::control {
namespace {

constexpr int kEnough = 5;              // 10 ms of steps: far less than a set-point counts
constexpr double kLongestStall = 10.0;  // after which nothing is remembered by its age [s]

}  // namespace

std::string_view ToString(StepTime time) {
  switch (time) {
    case StepTime::kGood:
      return "good";
    case StepTime::kResumed:
      return "resumed";
    case StepTime::kStands:
      return "stands";
    case StepTime::kBack:
      return "back";
    case StepTime::kLeap:
      return "leap";
    case StepTime::kInvalid:
      break;
  }
  return "invalid";
}

StepTime FlightClock::Step(double t) {
  if (!IsTime(t)) return StepTime::kInvalid;
  const double ahead = At(t) - now_;
  if (ahead == 0.0 && stepped_) return StepTime::kStands;
  if (ahead >= 0.0 && ahead <= kCounts) return Fly(t, StepTime::kGood);
  const bool repeats = agree_ > 0 && t == last_;
  const bool goes_on = agree_ > 0 && t > last_ && t <= last_ + kCounts;
  if (!repeats && !goes_on) agree_ = 0;
  last_ = t;
  if (!repeats) ++agree_;
  if (agree_ < kEnough) return ahead < 0.0 ? StepTime::kBack : StepTime::kLeap;
  if (ahead < 0.0 || ahead > kLongestStall) offset_ = now_ + kLongestStall - t;
  return Fly(t, StepTime::kResumed);
}

StepTime FlightClock::Fly(double t, StepTime judged) {
  stepped_ = true;
  agree_ = 0;
  now_ = At(t);
  return judged;
}

}  // namespace touchdown::control
