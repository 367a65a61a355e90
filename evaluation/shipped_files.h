// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace touchdown::evaluation {

/// Directories that hold the Python package touchdown_report, first hit first.
std::vector<std::string> PythonDirectories();

/// The path of a file of measured data. @throws BadInput if it is neither installed nor in the source tree.
std::string DataPath(const std::string& file);

}  // namespace touchdown::evaluation
