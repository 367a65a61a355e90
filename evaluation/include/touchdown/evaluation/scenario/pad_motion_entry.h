// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "touchdown/evaluation/scenario/part.h"
#include "touchdown/sim/pad/pad_course.h"

namespace touchdown::evaluation {

/// What a pad motion is made from, beside the keys pad.* of the scenario.
struct PadMotionSetup : PartSetup {
  double phase = 0.0;      ///< driven along the path before t = 0 [m]
  std::uint64_t seed = 0;  ///< of the trial
};

/// How a pad motion gets into the program (docs/adding_a_pad_motion.md).
struct PadMotionEntry : Part {
  bool drawn = false;     ///< from the trial's seed: where it will drive is known for one seed only
  bool has_phase = true;  ///< pad.phase_spread may move it along its path
  /// Throws std::invalid_argument naming the key that does not suit it.
  std::function<std::shared_ptr<const sim::PadCourse>(const PadMotionSetup&)> make;
};

/// The motions of the library.
std::vector<PadMotionEntry> StandardPadMotions();

}  // namespace touchdown::evaluation
