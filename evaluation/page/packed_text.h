// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace touchdown::evaluation {

/// A text as a page carries it: zlib's format (RFC 1950), whose checksum tells damage, in base64.
/// @throws std::runtime_error if there is no memory for it.
std::string PackText(std::string_view text);

}  // namespace touchdown::evaluation
