// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace touchdown::evaluation {

/// What stands between the `separator`s in `text`, in order: one more than there are of them, empty ones
/// too.
std::vector<std::string> Split(const std::string& text, char separator);

/// "a, b or c".
std::string Enumerate(const std::vector<std::string>& words);

}  // namespace touchdown::evaluation
