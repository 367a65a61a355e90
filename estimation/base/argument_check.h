// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace touchdown::estimation {

/// Shortest decimal text that reads back as the same number; independent of the locale.
std::string NumberText(double value);

/// Throws std::invalid_argument "<name> is <value>; allowed is <allowed>".
[[noreturn]] void ThrowOutOfRange(std::string_view name, double value, std::string_view allowed);

/// Throws as ThrowOutOfRange unless low <= value <= high. NaN is out of every range.
void CheckWithin(std::string_view name, double value, double low, double high);

/// The same with the lower end excluded: low < value <= high.
void CheckAbove(std::string_view name, double value, double low, double high);

}  // namespace touchdown::estimation
