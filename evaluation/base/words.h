// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace touchdown::evaluation {

/// The parts of `text` between the `separator`s, in order, also empty ones: one more than there are separators.
std::vector<std::string> Split(const std::string& text, char separator);

/// "a, b or c".
std::string Enumerate(const std::vector<std::string>& words);

/// A sentence without its full stops and ends of lines, for use within another sentence.
std::string WithoutStop(std::string sentence);

/// With control characters as in a program's source: "a\n", "\x1b".
std::string InOneLine(std::string_view text);

/// What to do about a coordinate [m] as large as those of a map, such as UTM. Begins with a colon; empty for others.
std::string OriginAdvice(double coordinate);

/// "signal 9 (Killed)".
std::string SignalWords(int signal);

}  // namespace touchdown::evaluation
