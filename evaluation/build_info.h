// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace touchdown::evaluation {

/// What a figure was made with: program version, compiler, flags, libraries, CPU,
/// operating system. Pairs of key and value in a fixed order. Results that depend on bits may only
/// be merged when all of these agree.
std::vector<std::pair<std::string, std::string>> BuildManifest();

}  // namespace touchdown::evaluation
