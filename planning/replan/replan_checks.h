// SPDX-License-Identifier: BSD-3-Clause
// What the replanner refuses before it plans.
#pragma once

#include "touchdown/planning/replan/replanner.h"

namespace touchdown::planning {

/// Throws std::invalid_argument naming the first option out of its range, its value and the range.
void Validate(const ReplannerOptions& options);

// Each returns what is wrong in some words, or nullptr. They do not allocate.

/// The times and the vehicle's state can be used: finite, ordered, and within a vehicle's possible range and speed.
const char* WrongInState(const ReplanInput& input);

/// The pad is known, and its states at the start and `horizon` [s] after it, the latest end of a plan, can be used. Those
/// between are not asked for.
const char* WrongInPad(const ReplanInput& input, double horizon);

/// The pad and the endpoint can be used.
const char* WrongInTarget(const ReplanInput& input, double horizon);

/// The curve is slower than a fault, so that its cells are few enough to be walked one by one. Does not allocate.
bool IsWalkable(const UniformBspline& curve);

}  // namespace touchdown::planning
