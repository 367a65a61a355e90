// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/html.h"

#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/bad_input.h"

namespace touchdown::evaluation {

constexpr char kReportStyle[] =
    "body{font:15px/1.45 sans-serif;margin:2em auto;max-width:75em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0}td,th{border-bottom:1px solid #ccc;padding:.25em "
    ".7em;text-align:right}td:first-child,th:first-child{text-align:left}tr.bad "
    "td{background:#fde4dc}"
    "code{font-size:85%;word-break:break-all}pre{background:#f6f6f4;padding:.6em;overflow-x:auto}"
    "figure{display:inline-block;margin:.6em;vertical-align:top;width:290px}"
    "figcaption{font-size:85%}svg{border:1px solid #ddd;background:#fafafa}";

std::string Escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string Address(const std::string& path) {
  constexpr std::string_view kPlain = "-._~/";
  std::string address;
  for (const char c : path) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (letter || kPlain.find(c) != kPlain.npos) {
      address += c;
    } else {
      address += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return address;
}

std::string HtmlPage(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><title>{}</title>"
      "<style>{}</style></head><body>\n{}</body></html>\n",
      Escaped(title), kReportStyle, body);
}

void WriteHtml(const std::string& option, const std::string& path, const std::string& page) {
  AtomicFile file(path);
  std::ofstream stream(file.working_path(), std::ios::binary);
  stream << page;
  stream.close();
  if (!stream) throw BadInput(fmt::format("{} {}: it cannot be written.", option, path));
  file.Commit();
}

}  // namespace touchdown::evaluation
