// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace touchdown::evaluation {

/// The first file of this name on PATH that can be executed; empty: there is none.
std::string FindOnPath(const std::string& program);

/// The end of a program that was run.
struct ChildEnd {
  std::string failure;    ///< why it did not end well, in words; empty: it ended well
  std::string last_line;  ///< of what it wrote to stdout and stderr; blank lines are none
};

/// Runs a program to its end, with nothing on its stdin. There is no shell: words are arguments, not text.
/// @param words its path, and its arguments
/// @param environment "NAME=value"; replaces this process's values of these names
/// @param limit_s the program is ended after this time [s]
ChildEnd RunChild(const std::vector<std::string>& words,
                  const std::vector<std::string>& environment, double limit_s);

}  // namespace touchdown::evaluation
