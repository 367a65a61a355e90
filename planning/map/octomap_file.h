// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
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

/// All that is left in `in`. @throws std::invalid_argument where that is more than kMostMapBytes.
std::string BytesOf(std::istream& in);

/// Reads the head of an OctoMap file and walks its nodes. OctoMap's own reader trusts a file: given
/// nodes that are cut short or mangled, it recurses without end.
/// @throws std::invalid_argument that says what is wrong, or that it has more than 16 million nodes.
OctomapFile CheckOctomapFile(std::string_view file);

}  // namespace touchdown::planning
