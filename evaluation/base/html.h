// SPDX-License-Identifier: BSD-3-Clause
// Pages of reports, which need nothing outside of them.
#pragma once

#include <string>

namespace touchdown::evaluation {

/// A text with what HTML would take for its own written out.
std::string Escaped(const std::string& text);

/// A path as an address: what is none of letters, digits and -._~/ written out in percent.
std::string Address(const std::string& path);

/// A whole page of that title, with the style that our reports have.
std::string HtmlPage(const std::string& title, const std::string& body);

/// Writes a page, whole or not at all. @throws BadInput naming `option`, std::filesystem::filesystem_error
void WriteHtml(const std::string& option, const std::string& path, const std::string& page);

}  // namespace touchdown::evaluation
