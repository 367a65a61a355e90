// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace touchdown::planning {

/// A part of a plan in which its control points are bound to free space; one without extent is a corner.
struct BoundPart {
  double from = 0.0;  ///< [s]
  double to = 0.0;    ///< [s]
};

/// What a plan was bound to, in no order: the next step binds the same again, on its own map.
using BoundParts = std::vector<BoundPart>;

}  // namespace touchdown::planning
