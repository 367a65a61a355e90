// SPDX-License-Identifier: BSD-3-Clause
// The moving endpoint (eq. 17-18): the predicted pad plus a height above it that may sink. While
// the height sinks, the approach velocity is that sinking, so that consecutive plans join. On the
// height's floor the approach velocity is that of the contact, zero if there is none. A point that
// is passed adds a velocity of its own. Only the height's own rate moves the end as the arrival
// time does.

#include "touchdown/planning/spline/endpoint.h"

namespace touchdown::planning {

EndState EndStateAt(const estimation::PadPrediction& pad, const EndpointTarget& target,
                    double t_arrival) noexcept {
  const estimation::PadState at = pad.MeanAt(t_arrival);
  const double sunk = target.height - target.sink_rate * (t_arrival - target.t_reference);
  const bool sinking = sunk > target.height_floor;
  const Eigen::Vector3d offset(0.0, 0.0, sinking ? sunk : target.height_floor);
  const Eigen::Vector3d offset_rate(0.0, 0.0, sinking ? -target.sink_rate : 0.0);
  const Eigen::Vector3d contact = target.passing_W - Eigen::Vector3d(0.0, 0.0, target.arrival_sink);

  const Eigen::Vector3d none = Eigen::Vector3d::Zero();

  EndState end;
  end.state = {at.p_WP + offset, at.v_WP + offset_rate + contact, at.a_WP};
  end.derivative = {at.v_WP + offset_rate, at.a_WP, at.j_WP};
  end.second_derivative = {at.a_WP, at.j_WP, none};
  if (target.at_rest) {  // it still has to be where the pad will be
    end.state.v = offset_rate + contact;
    end.state.a = end.derivative.v = end.derivative.a = end.second_derivative.v = none;
  }
  return end;
}

}  // namespace touchdown::planning
