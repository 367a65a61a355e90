// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace touchdown::evaluation {

/// Where scenarios, studies and the report's package are installed. For a program that is not installed beside them.
bool UseShare(const std::string& directory);

/// Path of the scenario file called `name_or_path`: an existing path, or the name of a shipped one
/// with or without .yaml, of the installation or the build tree that the program belongs to.
/// @throws BadInput naming what is there.
std::string FindScenario(const std::string& name_or_path);

/// Names of the shipped scenarios, sorted.
std::vector<std::string> ListScenarios();

/// The same of study files.
std::string FindStudyFile(const std::string& name_or_path);
std::vector<std::string> ListStudyFiles();

/// Directories that hold the Python package touchdown_report, first hit first.
std::vector<std::string> PythonDirectories();

/// The path of a file of measured data. @throws BadInput if it is neither installed nor in the build tree.
std::string DataPath(const std::string& file);

}  // namespace touchdown::evaluation
