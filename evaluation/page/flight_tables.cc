// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/page/flight_tables.h"

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/page/rounded.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

// A column of numbers, and how many decimals of it are wanted.
struct Column {
  const char* name;
  int decimals;
  bool may_lack = false;
};
using Columns = std::vector<Column>;

constexpr int kTurn = 4, kNewtons = 2, kSquareMetres = 5;

const Columns kPlace = {{"t", kMilli}, {"px", kMilli}, {"py", kMilli}, {"pz", kMilli}};
const Columns kVelocity = {{"vx", kMilli}, {"vy", kMilli}, {"vz", kMilli}};
const Columns kAttitude = {{"qw", kTurn}, {"qx", kTurn}, {"qy", kTurn}, {"qz", kTurn}};
const Columns kDeck = {{"yaw", kTurn},
                       {"cov_xx", kSquareMetres},
                       {"cov_xy", kSquareMetres},
                       {"cov_yy", kSquareMetres}};
const Columns kThrusts = {{"thrust0", kNewtons, true}, {"thrust1", kNewtons, true},
                          {"thrust2", kNewtons, true}, {"thrust3", kNewtons, true},
                          {"thrust4", kNewtons, true}, {"thrust5", kNewtons, true},
                          {"thrust6", kNewtons, true}, {"thrust7", kNewtons, true}};

// Rows in the order in which they were written, as one array a column.
Json Table(SqliteDb& db, const std::string& from, const std::vector<Columns>& groups) {
  std::string sql;
  Columns columns;
  for (const Columns& group : groups) {
    for (const Column& column : group) {
      sql.append(columns.empty() ? "SELECT " : ", ").append(column.name);
      columns.push_back(column);
    }
  }
  SqliteStatement rows = db.Prepare(sql.append(" FROM ").append(from).append(" ORDER BY rowid"));
  std::vector<Json> arrays(columns.size(), Json::array());
  while (rows.Step()) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const int at = static_cast<int>(i);
      if (rows.IsNull(at) && !columns[i].may_lack) {
        throw std::invalid_argument(fmt::format("a row of {} lacks {}", from, columns[i].name));
      }
      arrays[i].push_back(rows.IsNull(at) ? Json() : Rounded(rows.Real(at), columns[i].decimals));
    }
  }
  Json json;
  for (std::size_t i = 0; i < columns.size(); ++i) json[columns[i].name] = std::move(arrays[i]);
  return json;
}

Json Modes(SqliteDb& db) {
  SqliteStatement rows = db.Prepare("SELECT mode FROM mode ORDER BY rowid");
  Json names = Json::array(), of = Json::array();
  while (rows.Step()) {
    const std::string mode = rows.Text(0);
    std::size_t index = 0;
    while (index < names.size() && names[index] != mode) ++index;
    if (index == names.size()) names.push_back(mode);
    of.push_back(index);
  }
  return {{"names", names}, {"of", of}};
}

// All of them are taken at the same times.
void CheckSamples(const Json& samples) {
  const std::size_t count = samples["vehicle"]["t"].size();
  if (count == 0) throw std::invalid_argument("it holds no states");
  const std::pair<const char*, const char*> columns[] = {{"believed", "t"},  {"pad", "t"},
                                                         {"reference", "t"}, {"rotor", "thrust0"},
                                                         {"air", "vx"},      {"mode", "of"}};
  for (const auto& [table, column] : columns) {
    const std::size_t rows = samples[table][column].size();
    if (rows == count) continue;
    throw std::invalid_argument(
        fmt::format("it holds {} states of the vehicle and {} of {}", count, rows, table));
  }
  if (samples["pad_believed"]["t"].size() > count) {
    throw std::invalid_argument("it holds more estimates of the pad than states");
  }
}

Json Events(SqliteDb& db) {
  SqliteStatement rows = db.Prepare("SELECT t, kind, text FROM event ORDER BY rowid");
  Json events = Json::array();
  while (rows.Step()) {
    events.push_back(
        {{"t", Rounded(rows.Real(0), 3)}, {"kind", rows.Text(1)}, {"text", rows.Text(2)}});
  }
  return events;
}

std::string OneOfWords(const std::string& word, std::initializer_list<std::string_view> words,
                       const char* table) {
  if (std::find(words.begin(), words.end(), word) != words.end()) return word;
  throw std::invalid_argument(
      fmt::format("its table {} holds the unknown word \"{}\"", table, word));
}

// Little-endian, as this machine is.
template <class Value>
std::vector<Value> Values(const std::string& bytes, const char* what, std::size_t of_each) {
  if (bytes.size() % (of_each * sizeof(Value)) != 0) {
    throw std::invalid_argument(fmt::format("its table {} holds {} bytes", what, bytes.size()));
  }
  std::vector<Value> values(bytes.size() / sizeof(Value));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

Json Surfaces(SqliteDb& db) {
  SqliteStatement rows = db.Prepare("SELECT obstacle, corners, triangles FROM surface");
  Json surfaces = Json::object();
  while (rows.Step()) {
    Json corners = Json::array();
    for (const float x : Values<float>(rows.Text(1), "surface", 3)) {
      corners.push_back(Rounded(static_cast<double>(x), kMilli));
    }
    const auto triangles = Values<std::int32_t>(rows.Text(2), "surface", 3);
    const auto count = static_cast<std::int32_t>(corners.size() / 3);
    for (const std::int32_t corner : triangles) {
      if (corner < 0 || corner >= count) {
        throw std::invalid_argument(fmt::format("its table surface names the corner {}", corner));
      }
    }
    surfaces[std::to_string(rows.Integer(0))] = {{"corners", corners}, {"triangles", triangles}};
  }
  return surfaces;
}

Json Obstacles(SqliteDb& db) {
  const Json surfaces = Surfaces(db);
  SqliteStatement rows = db.Prepare(
      "SELECT id, key, kind, cx, cy, cz, size_x, size_y, size_z, yaw FROM obstacle ORDER BY id");
  Json obstacles = Json::array();
  while (rows.Step()) {
    const auto number = [&rows](int column) { return Rounded(rows.Real(column), kMilli); };
    Json obstacle = {
        {"key", rows.Text(1)},
        {"kind", OneOfWords(rows.Text(2), {"box", "cylinder", "sphere", "mesh"}, "obstacle")},
        {"centre", {number(3), number(4), number(5)}},
        {"size", {number(6), number(7), number(8)}},
        {"yaw", Rounded(rows.Real(9), kTurn)}};
    const auto surface = surfaces.find(std::to_string(rows.Integer(0)));
    if (surface != surfaces.end()) {
      obstacle["surface"] = *surface;
    } else if (obstacle["kind"] == "mesh") {
      throw std::invalid_argument("its table surface lacks a mesh");
    }
    obstacles.push_back(std::move(obstacle));
  }
  return obstacles;
}

Json Zones(SqliteDb& db) {
  SqliteStatement rows =
      db.Prepare("SELECT term, shape, cx, cy, cz, size_x, size_y, size_z FROM zone ORDER BY id");
  Json zones = Json::array();
  while (rows.Step()) {
    const auto number = [&rows](int column) { return Rounded(rows.Real(column), kMilli); };
    zones.push_back({{"term", rows.Text(0)},
                     {"shape", OneOfWords(rows.Text(1), {"sphere", "box", "cylinder"}, "zone")},
                     {"centre", {number(2), number(3), number(4)}},
                     {"size", {number(5), number(6), number(7)}}});
  }
  return zones;
}

Json Prior(SqliteDb& db) {
  SqliteStatement rows = db.Prepare("SELECT state, cubes FROM prior");
  Json prior = Json::object();
  while (rows.Step()) {
    const std::string state = OneOfWords(rows.Text(0), {"occupied", "gone", "new"}, "prior");
    prior[state] = Values<std::int32_t>(rows.Text(1), "prior", 4);
  }
  return prior;
}

std::string MetaText(SqliteDb& db, const char* key) {
  SqliteStatement row = db.Prepare("SELECT value FROM meta WHERE key = ?");
  row.Bind(0, key);
  if (!row.Step()) throw std::invalid_argument(fmt::format("its table meta lacks {}", key));
  return row.Text(0);
}

}  // namespace

Json FlightTables(SqliteDb& db) {
  Json json;
  json["scenario_yaml"] = MetaText(db, "scenario_yaml");
  json["result"] = Json::parse(MetaText(db, "result_json"), nullptr, false);
  const Json& result = json["result"];
  if (!result.is_object() || !result.contains("outcome") || !result["outcome"].is_string() ||
      !result.contains("detail") || !result["detail"].is_string() ||
      !result.contains("simulated_s") || !result["simulated_s"].is_number()) {
    throw std::invalid_argument("its result_json is no document of a flight");
  }
  Json& build = json["build"];
  for (const char* key : {"touchdown_version", "revision", "build_type"}) {
    build[key] = MetaText(db, key);
  }
  Json& samples = json["samples"];
  samples["vehicle"] = Table(db, "vehicle WHERE source = 'true'", {kPlace, kVelocity, kAttitude});
  samples["believed"] = Table(db, "vehicle WHERE source = 'estimate'", {kPlace});
  samples["pad"] = Table(db, "pad WHERE source = 'true'", {kPlace, kVelocity, kDeck});
  samples["pad_believed"] = Table(db, "pad WHERE source = 'estimate'", {kPlace, kDeck});
  samples["reference"] = Table(db, "reference", {kPlace});
  samples["rotor"] = Table(db, "rotor", {kThrusts});
  samples["air"] = Table(db, "air", {kVelocity});
  samples["mode"] = Modes(db);
  CheckSamples(samples);
  json["events"] = Events(db);
  json["obstacles"] = Obstacles(db);
  json["zones"] = Zones(db);
  json["prior"] = Prior(db);
  return json;
}

}  // namespace touchdown::evaluation
