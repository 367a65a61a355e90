// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "sim/base/random_stream.h"

namespace touchdown::sim {

/// Figures of the low-altitude form at one height.
struct DrydenScales {
  double along = 0.0;           ///< scale length of both horizontal components [m]
  double up = 0.0;              ///< of the vertical one [m]
  double vertical_ratio = 0.0;  ///< sigma of the vertical over that of a horizontal component
};

/// At `height` above the ground [m], which is brought within the form's range, 10 to 1000 ft.
DrydenScales DrydenScalesAt(double height);

/// Dryden turbulence as the specification's low-altitude form has it, with a standard deviation of
/// one in each horizontal component. Stationary from the first value on. Not to be shared between
/// threads.
class DrydenTurbulence {
 public:
  /// `seed` feeds the stream "turbulence".
  explicit DrydenTurbulence(std::uint64_t seed);

  /// The air's velocity at the end of the next `dt` > 0 [s]: x along the mean wind, y to its left,
  /// z up. Multiply it by the standard deviation [m/s]. `airspeed` > 0 [m/s] and `height` [m] are
  /// held over dt. Does not allocate.
  Eigen::Vector3d Step(double dt, double airspeed, double height);

 private:
  RandomStream noise_;
  double along_;          ///< state of the first-order filter
  Eigen::Vector2d left_;  ///< of the second-order ones
  Eigen::Vector2d up_;
};

}  // namespace touchdown::sim
