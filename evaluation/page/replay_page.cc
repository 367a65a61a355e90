// SPDX-License-Identifier: BSD-3-Clause
// The page's own parts are made from evaluation/page/web (its README) and installed as data; each flight goes into it as a
// packed document.
#include "evaluation/page/replay_page.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/output_path.h"
#include "evaluation/page/flight_document.h"
#include "evaluation/page/packed_text.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

std::string PagePart(const char* name) {
  const std::string path = DataPath(std::string("replay/").append(name));
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file || text.empty()) throw std::runtime_error(fmt::format("{}: cannot be read", path));
  return text;
}

// `place` stands once in the frame.
void Put(const std::string& place, const std::string& text, std::string* page) {
  const std::size_t at = page->find(place);
  if (at == std::string::npos) throw std::runtime_error(fmt::format("replay.html lacks {}", place));
  page->replace(at, place.size(), text);
}

std::string PackedFlight(const ShownRecord& record, const Registries& registries,
                         const ReplayProgress& progress) {
  nlohmann::ordered_json document =
      FlightDocument(record.path, record.name, registries, [&](int done, int all) {
        if (progress) progress(record.name, done, all);
      });
  document["kept"] = record.kept;
  // Names come from files. Bytes that are no UTF-8 are shown as such.
  return PackText(document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace

void CheckReplayPage(const std::string& option, const std::string& path) {
  CheckPagePath(option, path);
  for (const char* part : {"replay.html", "replay.css", "replay.js", "LICENCES.txt"})
    PagePart(part);
}

void WriteReplayPage(const std::string& path, const std::vector<ShownRecord>& records,
                     const Registries& registries, const ReplayProgress& progress) {
  std::string page = PagePart("replay.html");
  Put("/*style*/", PagePart("replay.css"), &page);
  Put("/*script*/", PagePart("replay.js"), &page);
  Put("<!--licences-->", PagePart("LICENCES.txt"), &page);
  std::string flights;
  for (const ShownRecord& record : records) {
    flights += fmt::format("<script type=\"text/plain\" class=\"flight\">{}</script>\n",
                           PackedFlight(record, registries, progress));
  }
  Put("<!--flights-->", flights, &page);
  AtomicFile file(path);
  {
    std::ofstream out(file.working_path(), std::ios::binary);
    out << page << std::flush;
    if (!out) throw std::runtime_error(fmt::format("{}: the page could not be written", path));
  }
  file.Commit();
}

}  // namespace touchdown::evaluation
