// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace touchdown::evaluation {

/// Checks before a long run that a file can be written at `path` after it. Leaves nothing behind.
/// Directories are not created. `option` is the one that named the path, for the sentence.
/// @throws BadInput
void CheckOutputPath(const std::string& option, const std::string& path);

/// The same for a record, which replaces an older one but nothing that is no SQLite file. @throws BadInput
void CheckRecordPath(const std::string& option, const std::string& path);

/// The same for a picture, whose name says what it is: .png, .pdf or .svg. @throws BadInput
void CheckPicturePath(const std::string& option, const std::string& path);

/// The same for a page, whose name ends in .html. @throws BadInput
void CheckPagePath(const std::string& option, const std::string& path);

/// The files that a command writes or reads, by the option that names them; empty paths are none. @throws BadInput
/// naming two that are the same file.
void CheckApart(const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace touchdown::evaluation
