// SPDX-License-Identifier: BSD-3-Clause
// Checks docs/record.md against the files that the program writes. The section of a file's format must name every
// table, every column, and every key of its manifest except keys of the build.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/base/build_info.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/campaign/trial_store.h"
#include "evaluation/compare/compare_table.h"
#include "evaluation/profile/profile_report.h"
#include "evaluation/record/record.h"
#include "evaluation/studies/pad/pad_report.h"
#include "evaluation/studies/replan/forest_flight_report.h"
#include "evaluation/studies/replan/replan_report.h"
#include "evaluation/studies/tags/tag_report.h"

namespace touchdown::evaluation {
namespace {

/// The expected content of one file. `writer` writes it with as little data as possible.
struct ResultFile {
  const char* name;
  std::function<void(const std::string& path)> writer;
};

Campaign OneTrial() {
  Campaign campaign;
  campaign.trials.emplace_back();
  campaign.facts = {{"set", "[]"}, {"vary", "[]"}};
  return campaign;
}

std::vector<ResultFile> ResultFiles() {
  PadStudyOptions pad;
  pad.scenarios.clear();
  pad.overrides = {"gps.rate=5", "seed=2"};
  return {{"record", [](auto& path) { WriteRecord(path, {}, {}, {}); }},
          {"trials", [](auto& path) { WriteTrials(path, OneTrial(), {}); }},
          {"comparison", [](auto& path) { WriteCompareTable(path, {}, {}, {}); }},
          {"profile", [](auto& path) { WriteProfileTable(path, {}, {}); }},
          {"replan study", [](auto& path) { WriteReplanStudy(path, {}, {}); }},
          {"forest flights", [](auto& path) { WriteForestFlights(path, {}); }},
          {"pad study", [pad](auto& path) { WritePadStudy(path, pad, {}); }},
          {"tag study", [](auto& path) { WriteTagStudy(path, {}); }}};
}

/// The columns' text of the table row that begins with `table`, in the section with `format`; empty
/// where there is no such row.
std::string RowOf(const std::string& format, const std::string& table) {
  std::ifstream file(TOUCHDOWN_SOURCE_DIR "/docs/record.md");
  std::ostringstream text;
  text << file.rdbuf();
  const std::string all = text.str();
  const std::size_t named = all.find("`format` (`" + format + "`)");
  if (named == std::string::npos) return {};
  const std::size_t section = all.rfind("\n## ", named);
  const std::size_t end = std::min(all.find("\n## ", named), all.size());
  const std::string head = "\n| `" + table + "` |";
  const std::size_t begin = all.find(head, section);
  if (begin == std::string::npos || begin >= end) return {};
  const std::size_t columns = begin + head.size();
  return all.substr(columns, all.find('\n', columns) - columns);
}

/// The words in backquotes of that row.
std::set<std::string> Documented(const std::string& format, const std::string& table) {
  std::istringstream row(RowOf(format, table));
  std::set<std::string> words;
  std::string part;
  for (bool quoted = false; std::getline(row, part, '`'); quoted = !quoted) {
    std::istringstream spaced(part);
    for (std::string word; quoted && spaced >> word;) words.insert(word);
  }
  return words;
}

std::vector<std::string> Texts(SqliteDb& db, const std::string& query) {
  std::vector<std::string> texts;
  SqliteStatement statement = db.Prepare(query);
  while (statement.Step()) texts.push_back(statement.Text(0));
  return texts;
}

TEST(ResultDocs, EveryTableAndColumnIsNamed) {
  const std::string path = ::testing::TempDir() + "touchdown_result_docs.db";
  std::set<std::string> build;
  for (const auto& [key, value] : BuildManifest()) build.insert(key);
  for (const ResultFile& result : ResultFiles()) {
    SCOPED_TRACE(result.name);
    std::filesystem::remove(path);
    result.writer(path);
    SqliteDb db(path, SqliteDb::Mode::kReadOnly);
    const std::string format = std::string("touchdown ") + result.name;
    const std::vector<std::string> tables =
        Texts(db, "SELECT name FROM sqlite_master WHERE type = 'table'");
    EXPECT_GE(tables.size(), 2U);
    const std::string facts_table = tables.front();
    const std::string version =
        Texts(db, "SELECT value FROM " + facts_table + " WHERE key = 'version'").at(0);
    EXPECT_NE(RowOf(format, facts_table).find("`version` (" + version + ")"), std::string::npos)
        << version;
    for (const std::string& table : tables) {
      const std::set<std::string> words = Documented(format, table);
      EXPECT_FALSE(words.empty()) << "no row of the table " << table;
      const bool facts = table == "manifest" || table == "meta";
      const std::vector<std::string> names =
          Texts(db, facts ? "SELECT key FROM " + table
                          : "SELECT name FROM pragma_table_info('" + table + "')");
      for (const std::string& name : names) {
        if (facts && build.count(name) > 0) continue;
        EXPECT_EQ(words.count(name), 1U) << table << "." << name;
      }
    }
  }
  std::filesystem::remove(path);
}

/// FNV-1a, 32 bits.
std::uint32_t Fingerprint(const std::vector<std::string>& texts) {
  std::uint32_t hash = 2166136261U;
  for (const std::string& text : texts) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  }
  return hash;
}

// A reader knows a format only by its version. So other columns need another version. A change of a
// table raises the format's version; both are entered here.
TEST(ResultDocs, OtherColumnsAreAnotherVersion) {
  const std::map<std::string, std::string> known = {
      {"record", "20 1010998410"},      {"trials", "9 4185419714"},
      {"comparison", "3 1794598769"},   {"profile", "2 3081091663"},
      {"replan study", "4 3330845746"}, {"forest flights", "1 1622777177"},
      {"pad study", "2 3143308301"},    {"tag study", "1 1906377180"}};
  const std::string path = ::testing::TempDir() + "touchdown_result_versions.db";
  for (const ResultFile& result : ResultFiles()) {
    std::filesystem::remove(path);
    result.writer(path);
    SqliteDb db(path, SqliteDb::Mode::kReadOnly);
    std::vector<std::string> columns;
    std::string facts = "manifest";
    for (const std::string& table :
         Texts(db, "SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name")) {
      columns.push_back(table);
      if (table == "meta") facts = table;
      for (const std::string& name :
           Texts(db, "SELECT name FROM pragma_table_info('" + table + "')")) {
        columns.push_back(name);
      }
    }
    const std::string version =
        Texts(db, "SELECT value FROM " + facts + " WHERE key = 'version'").at(0);
    EXPECT_EQ(known.at(result.name), version + " " + std::to_string(Fingerprint(columns)))
        << result.name;
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace touchdown::evaluation
