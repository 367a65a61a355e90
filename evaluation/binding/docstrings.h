// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string_view>

namespace touchdown::binding {

/// What the public headers say, by "Class::member": made by docstrings.py when the module is built.
const std::map<std::string_view, const char*>& Docstrings();

/// Of one name; nothing of one whose name says all. A test sees to it that all else is told.
const char* Doc(std::string_view name);

}  // namespace touchdown::binding
