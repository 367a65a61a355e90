// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "touchdown/evaluation/scenario/registries.h"

namespace touchdown::evaluation {

/// Checks before the work that WriteMcap will be able to write: the name (it must end in .mcap), the place, and the
/// descriptions of the messages. @throws BadInput; std::runtime_error naming a description that the installation lacks
void CheckMcap(const std::string& option, const std::string& path);

using ExportProgress = std::function<void(int done, int all)>;

/// Writes a recorded flight as an MCAP file for Foxglove and Rerun (docs/mcap.md). The same record gives the same
/// bytes. The file appears whole or not at all. `progress`, if not empty, gets the number of written messages. If it
/// throws, the work ends.
/// @throws BadInput as ReadRecord, and if required images cannot be rendered; std::runtime_error naming a file that
/// cannot be written
void WriteMcap(const std::string& record_path, const std::string& mcap_path,
               const Registries& registries, const ExportProgress& progress);

}  // namespace touchdown::evaluation
