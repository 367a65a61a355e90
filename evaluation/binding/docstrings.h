// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string_view>

namespace touchdown::binding {

/// The doc comments of the public headers, by "Class::member": made by docstrings.py when the module is built.
const std::map<std::string_view, const char*>& Docstrings();

/// The doc of one name; empty if the name says all. A test checks that all others have one.
const char* Doc(std::string_view name);

}  // namespace touchdown::binding
