// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace touchdown::evaluation {

/// Makes stderr the program's log: lines "touchdown: ...".
void LogToStderr();

/// Stderr is a terminal on which a line can be written over.
bool StderrIsTerminal();

/// Shows `text` in the terminal's last line and replaces what was shown there. The program's name precedes it if there
/// is room for both; else it stands alone, cut to the width. Lines of the log appear above it.
void ShowStatus(const std::string& text);

/// Leaves what is shown where it stands: what is written next begins a new line.
void EndStatus();

}  // namespace touchdown::evaluation
