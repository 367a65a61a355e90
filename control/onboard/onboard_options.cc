// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/control/onboard/onboard_options.h"

#include <stdexcept>

#include "estimation/base/argument_check.h"

namespace touchdown::control {

using estimation::CheckAbove;
using estimation::CheckWithin;

void Validate(const Envelope& envelope) {
  CheckAbove("envelope.speed", envelope.speed, 0.0, 100.0);
  CheckAbove("envelope.acceleration", envelope.acceleration, 0.0, 100.0);
  CheckAbove("envelope.tilt_deg", envelope.tilt_deg, 0.0, 60.0);
  CheckAbove("envelope.ceiling", envelope.ceiling, 0.0, 1000.0);
}

void Validate(const OnboardOptions& options) {
  Validate(options.model);
  Validate(options.envelope);
  CheckWithin("descent", static_cast<int>(options.descent), static_cast<int>(DescentStyle::kNone),
              static_cast<int>(DescentStyle::kPlanned));
  if (options.to_goal && options.descent != DescentStyle::kNone) {
    throw std::invalid_argument("descent is to land; with to_goal allowed is DescentStyle::kNone");
  }
  CheckAbove("deck_size", options.deck_size, 2.0 * options.model.foot_radius,
             100.0);  // for the feet
  CheckAbove("corridor_radius", options.corridor_radius, 0.0, 100.0);
  CheckAbove("mission_rate", options.mission_rate, 0.0, 1000.0);
  CheckAbove("replan_rate", options.replan_rate, 0.0, 1000.0);
  CheckAbove("close_rate", options.close_rate, 0.0, 1000.0);
  CheckWithin("latency.time", options.latency.time, 0.0, 10.0);
  CheckWithin("latency.longest", options.latency.longest, 1e-3, 10.0);
  CheckAbove("shortest_contact_plan", options.shortest_contact_plan, 0.0, 100.0);
  CheckWithin("own_clock_ahead", options.own_clock_ahead, -1e6, 1e6);
  CheckAbove("history", options.history, 0.0, 100.0);
  CheckWithin("start_free", options.start_free, 0.0, 100.0);
}

}  // namespace touchdown::control
