// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "touchdown/planning/map/persistent_map.h"

namespace touchdown::planning {

/// How the first line of a file begins.
inline constexpr std::string_view kOctomapBinaryHead = "# Octomap OcTree binary file";
inline constexpr std::string_view kOctomapLogOddsHead = "# Octomap OcTree file";

/// An OctoMap file of type OcTree.
struct OctomapFile {
  MapFormat format;
  double resolution;       ///< [m]
  std::string_view nodes;  ///< sound data for OctoMap's reader; empty: an empty tree
};

/// Reads the head of an OctoMap file and walks its nodes. OctoMap's own reader trusts a file: given
/// nodes that are cut short or mangled, it recurses without end.
/// @throws std::invalid_argument that says what is wrong.
OctomapFile CheckOctomapFile(std::string_view file);

}  // namespace touchdown::planning
