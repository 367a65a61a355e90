// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace touchdown::evaluation {

/// What stands between the `separator`s in `text`, in order: one more than there are of them, empty ones
/// too.
std::vector<std::string> Split(const std::string& text, char separator);

/// "a, b or c".
std::string Enumerate(const std::vector<std::string>& words);

/// A sentence without the full stops and ends of lines behind it, to stand in another one.
std::string WithoutStop(std::string sentence);

/// With control characters as a program's source has them: "a\n", "\x1b".
std::string InOneLine(std::string_view text);

/// "signal 9 (Killed)".
std::string SignalWords(int signal);

}  // namespace touchdown::evaluation
