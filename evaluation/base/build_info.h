// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace touchdown::evaluation {

/// What a figure was made with: program version, compiler, flags, libraries, CPU, operating system.
/// Pairs of key and value in a fixed order. `build_hash` is a hash of everything that bits depend
/// on. Only results with the same hash may be merged.
std::vector<std::pair<std::string, std::string>> BuildManifest();

/// The `build_hash` alone.
std::string BuildHash();

/// Of build and CPU in a line, for figures of time: "version 0.1.0 (3b4db16), Release for AVX-512, AMD EPYC".
std::string BuildLine();

/// SHA-1 of any bytes, in the shape of a version 5 UUID.
std::string HashOf(const std::string& bytes);

}  // namespace touchdown::evaluation
