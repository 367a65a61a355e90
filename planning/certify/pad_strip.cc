// SPDX-License-Identifier: BSD-3-Clause
// The volume of the pad vehicle as a floor under plans. It lies along the straight line between the
// pad's predictions at both ends of a plan.

#include "planning/certify/pad_strip.h"

#include <algorithm>

namespace touchdown::planning {

namespace {

constexpr double kSlack = 0.15;     // of a plan over the pad below both its ends [m]
constexpr double kAboveDeck = 0.1;  // of one that is not to touch: a cell's rounding and more [m]

}  // namespace

void LayPadStrip(const estimation::PadPrediction& pad, const EndpointTarget& target,
                 const Eigen::Vector3d& p_start, double t_start, double t_end, double radius,
                 double contact_height, FreeSpace* space) noexcept {
  if (!pad.has_deck()) return;
  space->pad_from = pad.MeanAt(t_start).p_WP.head<2>();
  space->pad_to = pad.MeanAt(t_end).p_WP.head<2>();
  space->pad_radius = radius;
  const double end = EndStateAt(pad, target, t_end).state.p.z();
  const double lower = space->OverPad(p_start) ? std::min(p_start.z(), end) : end;
  const double deck = pad.MeanAt(t_end).p_WP.z() + contact_height;
  space->pad_floor = std::min(lower - kSlack, deck + kAboveDeck);
}

}  // namespace touchdown::planning
