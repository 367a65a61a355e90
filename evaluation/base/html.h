// SPDX-License-Identifier: BSD-3-Clause
// Pages of reports that need no other file.
#pragma once

#include <string>

namespace touchdown::evaluation {

/// A text with HTML's special characters escaped.
std::string Escaped(const std::string& text);

/// A path as an address: all but letters, digits and -._~/ written in percent.
std::string Address(const std::string& path);

/// A whole page of that title, with the style that our reports have.
std::string HtmlPage(const std::string& title, const std::string& body);

/// Writes a page, whole or not at all. @throws BadInput naming `option`, std::filesystem::filesystem_error
void WriteHtml(const std::string& option, const std::string& path, const std::string& page);

}  // namespace touchdown::evaluation
