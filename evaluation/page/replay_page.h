// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::evaluation {

/// A record, and its name on the page.
struct ShownRecord {
  std::string path;
  std::string name;
  bool kept = true;  ///< it can be asked again under its name
};

/// Checks before a long run that a page can be written at `path` after it. @throws BadInput as CheckPagePath, and if
/// the page's parts are not installed.
void CheckReplayPage(const std::string& option, const std::string& path);

using ReplayProgress = std::function<void(const std::string& name, int done, int all)>;

/// Writes one self-contained page that shows one flight, or two on one clock (docs/replay.md). `progress`, if not
/// empty, gets the record's name and the number of its steps that have been asked again.
/// The file appears whole or not at all. @throws BadInput as FlightDocument and CheckReplayPage;
/// std::filesystem::filesystem_error, std::runtime_error
void WriteReplayPage(const std::string& path, const std::vector<ShownRecord>& records,
                     const Registries& registries, const ReplayProgress& progress);

}  // namespace touchdown::evaluation
