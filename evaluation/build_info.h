// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace touchdown::evaluation {

/// What a figure was made with: program version, compiler, flags, libraries, CPU,
/// operating system. Pairs of key and value in a fixed order. `build_hash` is one figure for
/// everything that bits depend on: only results that agree in it may be merged.
std::vector<std::pair<std::string, std::string>> BuildManifest();

/// The `build_hash` alone.
std::string BuildHash();

/// SHA-1 of any bytes, in the shape of a version 5 UUID.
std::string HashOf(const std::string& bytes);

}  // namespace touchdown::evaluation
