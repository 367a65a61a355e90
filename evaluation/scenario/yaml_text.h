// SPDX-License-Identifier: BSD-3-Clause
// The one way in which YAML is read.
#pragma once

#include <string>

namespace YAML {
class Node;
}

namespace touchdown::evaluation {

/// The document in `text`; a null node where there is none. `name` stands in every sentence: of a file, with its line.
/// @throws BadInput where it is no YAML, or holds more than one document or a million values.
YAML::Node ParseYaml(const std::string& text, const std::string& name, bool with_line = true);

/// The same of the file at `path`, of 4 MiB at most. `what` it is: "scenario". @throws BadInput, also where it is empty.
YAML::Node ReadYamlFile(const std::string& path, const std::string& what);

}  // namespace touchdown::evaluation
