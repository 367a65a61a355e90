// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::planning {

/// Limits on the norms of velocity and acceleration.
struct Limits {
  double speed = 3.0;         ///< [m/s]
  double acceleration = 6.0;  ///< [m/s^2]
};

}  // namespace touchdown::planning
