// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace touchdown::evaluation {

/// Directories that hold the Python package touchdown_report, first hit first.
std::vector<std::string> PythonDirectories();

/// Directories that hold measured data, first hit first.
std::vector<std::string> DataDirectories();

}  // namespace touchdown::evaluation
