// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::evaluation {

/// Where the time of sensing goes: thread CPU time, summed over a trial [s].
struct SensingTimes {
  double depth_image = 0.0;  ///< rendering depth images, or casting their rays
  double pad_image = 0.0;    ///< rendering images of the pad; none in fast sensing
  double pad_finding = 0.0;  ///< finding the pad in them, or the model that stands in for both
  double pad_filter = 0.0;   ///< taking in fixes and sightings
  double own_state = 0.0;    ///< the vehicle's own sensors and filter, where own_state is estimated
};

}  // namespace touchdown::evaluation
