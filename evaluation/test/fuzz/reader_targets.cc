// SPDX-License-Identifier: BSD-3-Clause
// Readers of files. Each is given the bytes as a file. It takes them, or refuses them with a sentence that names the file.
// Of records and files of trials the bytes are changes of a sound one: libFuzzer would not find SQLite's format.
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/map_file.h"
#include "evaluation/base/words.h"
#include "evaluation/campaign/study_file.h"
#include "evaluation/campaign/sweep.h"
#include "evaluation/campaign/trial_merge.h"
#include "evaluation/campaign/trial_store.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/page/flight_document.h"
#include "evaluation/record/record.h"
#include "evaluation/record/replay.h"
#include "evaluation/scenario/scenario_world.h"
#include "evaluation/scenario/waypoint_file.h"
#include "evaluation/scenario/world_obstacles.h"
#include "evaluation/test/fuzz/fuzz_target.h"
#include "evaluation/video/flight_track.h"
#include "planning/map/octomap_cells.h"
#include "sim/obstacles/world_files.h"
#include "sim/vehicle/vehicle_file.h"
#include "touchdown/evaluation/base/shipped_files.h"
#include "touchdown/evaluation/program/program.h"

namespace touchdown::evaluation::fuzz {
namespace {

namespace fs = std::filesystem;

const Registries& Parts() {
  static const Registries parts = StandardRegistries();
  return parts;
}

// A folder of this process, gone with it.
const fs::path& Folder() {
  struct Temporary {
    fs::path path = fs::temp_directory_path() / fmt::format("touchdown_fuzz_{}", getpid());
    Temporary() { fs::create_directories(path); }
    ~Temporary() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
  };
  static const Temporary folder;
  return folder.path;
}

std::string Written(const char* name, std::string_view bytes) {
  const std::string path = (Folder() / name).string();
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

// A sentence that names the file, or none at all. Only the input may put the words of a raw exception into it.
void Refusable(const std::string& path, std::string_view bytes, const std::function<void()>& read) {
  std::string sentence;
  try {
    return read();
  } catch (const BadInput& error) {
    sentence = error.what();
  } catch (const std::invalid_argument& error) {
    sentence = error.what();
  }
  for (const char* raw : {"std::", "basic_string", "vector::", "json.exception", "map::at"}) {
    Require(sentence.find(raw) == sentence.npos || bytes.find(raw) != bytes.npos,
            "raw: " + sentence);
  }
  Require(sentence.find(path) != sentence.npos, "no file: " + sentence);
}

Scenario Open(const std::vector<std::string>& set) {
  return LoadScenario(FindScenario("open"), set, Parts());
}

void FuzzScenario(std::string_view bytes) {
  const std::string path = Written("scenario.yaml", bytes);
  Refusable(path, bytes, [&] {
    const Scenario scenario = LoadScenario(path, {}, Parts());
    ParseScenario(DumpScenario(scenario), "dump", path, {}, Parts());
  });
}

void FuzzOverride(std::string_view bytes) {
  const std::string text(bytes);
  try {
    Open({text});
  } catch (const BadInput& error) {
    Require(std::string(error.what()).find("--set ") != std::string::npos, error.what());
  }
}

void FuzzAirframe(std::string_view bytes) {
  static const std::string vehicle =
      Written("air.xml", sim::DefaultVehicleMjcf());
  const std::string path = Written("air.airframe.yaml", bytes);
  Refusable("/air.", bytes, [&] { Open({"vehicle=" + vehicle}); });
}

void FuzzStudy(std::string_view bytes) {
  const std::string path = Written("study.yaml", bytes);
  Refusable(path, bytes, [&] { LoadStudyFile(path, Parts()); });
}

void FuzzWaypoints(std::string_view bytes) {
  const std::string path = Written("way.csv", bytes);
  Refusable(path, bytes, [&] { Open({"pad.motion=waypoints", "pad.waypoints=" + path}); });
}

void FuzzOctomap(std::string_view bytes) {
  const std::string path = Written("map.bt", bytes);
  Refusable(path, bytes, [&] {
    planning::PersistentMap map{planning::OccupancyMapOptions{}};
    ReadMapFile(path, &map);
  });
  Refusable(path, bytes, [&] {
    Scenario scenario;
    scenario.octomaps.emplace_back().file = path;
    ObstaclesOf(scenario);
  });
}

void FuzzMesh(std::string_view bytes) {
  static const char* const kKinds[] = {".obj", ".stl", ".ply", ".dae", ".glb", ".off", ".3ds"};
  Choices choices(bytes);
  const std::string path =
      Written((std::string("mesh") + kKinds[choices.Below(7)]).c_str(), choices.Text(bytes.size()));
  Refusable(path, bytes, [&] { sim::ObstaclesOfMeshFile(path, 1.0, {}); });
}

void FuzzHeights(std::string_view bytes) {
  const std::string path = Written("heights.png", bytes);
  Refusable(path, bytes, [&] { sim::ObstacleOfHeightFile(path, {9.0, 9.0}, 2.0, {}); });
}

void FuzzVehicle(std::string_view bytes) {
  const std::string path = Written("vehicle.xml", bytes);
  Refusable(path, bytes, [&] { Open({"vehicle=" + path}); });
}

// Words that change nothing outside of the folder, and take no long flight.
void FuzzCommandLine(std::string_view bytes) {
  static const std::set<std::string> kCommands = {"list", "check-term", "plan",   "merge",
                                                  "replay", "export",   "--help", "--version"};
  if (bytes.find('/') != bytes.npos || bytes.find('\0') != bytes.npos) return;
  std::vector<std::string> words = Split(std::string(bytes), '\n');
  if (kCommands.count(words.front()) == 0 || words.size() > 20) return;
  fs::current_path(Folder());
  // With the sanitizers a plan takes half a minute.
  if (words.front() == "plan") words.insert(words.end(), {"--from", "none"});
  words.insert(words.begin(), "touchdown");
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  RunProgram(static_cast<int>(argv.size()), argv.data(), Parts());
}

// A sound database, and changes of its rows and bytes.
void Change(const std::string& path, std::string_view bytes) {
  Choices choices(bytes);
  {
    SqliteDb db(path, SqliteDb::Mode::kReadWrite);
    std::vector<std::pair<std::string, std::vector<std::string>>> tables;
    SqliteStatement columns = db.Prepare(
        "SELECT m.name, c.name FROM sqlite_master AS m, pragma_table_info(m.name) AS c "
        "WHERE m.type = 'table' ORDER BY m.name, c.cid");
    while (columns.Step()) {
      if (tables.empty() || tables.back().first != columns.Text(0)) {
        tables.push_back({columns.Text(0), {}});
      }
      tables.back().second.push_back(columns.Text(1));
    }
    while (choices.Below(4) != 0) {
      const auto& [table, names] = tables[static_cast<std::size_t>(choices.Below(static_cast<int>(tables.size())))];
      const std::string& name = names[static_cast<std::size_t>(choices.Below(static_cast<int>(names.size())))];
      const std::string where = fmt::format(" WHERE {} IN (SELECT {} FROM {} LIMIT {} OFFSET {})",
                                            names.front(), names.front(), table,
                                            1 + choices.Below(3), choices.Below(64));
      try {
        switch (choices.Below(8)) {
          case 0:
            db.Execute("DELETE FROM " + table + where);
            break;
          case 1:
            db.Prepare("UPDATE " + table + " SET " + name + " = ?" + where).Run(choices.Text(12));
            break;
          case 2:
            db.Prepare("UPDATE " + table + " SET " + name + " = ?" + where)
                .Run(choices.Take<std::int64_t>());
            break;
          case 3:
            db.Execute("UPDATE " + table + " SET " + name + " = NULL" + where);
            break;
          case 4:
            db.Execute(fmt::format("UPDATE {} SET {} = {} + {}{}", table, name, name,
                                   choices.In(-2.0, 2.0), where));
            break;
          default:
            db.Prepare("UPDATE " + table + " SET " + name + " = ?" + where)
                .Run(choices.Wild(-100.0, 100.0));
        }
      } catch (const SqliteError&) {
        // Of a column that must be unique, say: then it stays as it is.
      }
    }
  }
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  const auto size = static_cast<double>(fs::file_size(path));
  for (int i = choices.Below(4); i > 1; --i) {
    file.seekp(static_cast<std::streamoff>(choices.In(0.0, size - 1.0)));
    file.put(static_cast<char>(choices.Below(256)));
  }
}

void FuzzRecord(std::string_view bytes) {
  static const std::string sound = [] {
    const Scenario scenario = LoadScenario(
        FindScenario("straight_turn"), {"timeout=1", "depth.width=32", "depth.height=24"}, Parts());
    TrialRecord record;
    const TrialResult result = RunTrial(scenario, 1, Parts(), &record);
    const std::string path = (Folder() / "sound.db").string();
    WriteRecord(path, scenario, result, record);
    return path;
  }();
  const std::string path = (Folder() / "record.db").string();
  fs::copy_file(sound, path, fs::copy_options::overwrite_existing);
  Change(path, bytes);
  Refusable(path, bytes, [&] { FlightTrack track(path); });
  Refusable(path, bytes, [&] { FlightDocument(path, path, Parts(), [](int, int) {}); });
  Refusable(path, bytes, [&] {
    const RecordedFlight flight = ReadRecord(path, {}, Parts());
    Replay replay(flight, Parts());
    for (int step = 0; step < replay.steps(); ++step) {
      replay.Seek(step);
      replay.Solve();
    }
  });
}

void FuzzTrials(std::string_view bytes) {
  static const Campaign campaign = SweepCampaign(
      {FindScenario("open"), {"timeout=1"}, {Variation::Parse("pad.speed=0.5,1", Parts())}, 4, 1},
      Parts());
  static const std::string sound = [] {
    std::vector<SweepRow> rows;
    for (const SweepTrial& trial : campaign.trials) {
      rows.push_back({trial, RunTrial(trial.scenario, trial.seed, Parts())});
    }
    const std::string path = (Folder() / "sound_trials.db").string();
    WriteTrials(path, campaign, rows);
    return path;
  }();
  const std::string path = (Folder() / "trials.db").string();
  fs::copy_file(sound, path, fs::copy_options::overwrite_existing);
  Change(path, bytes);
  Refusable(path, bytes, [&] {
    const std::string merged = (Folder() / "merged.db").string();
    fs::remove(merged);
    MergeTrials(merged, {path}, true);
  });
  Refusable(path, bytes, [&] {
    TrialStore store(path, campaign, {});
    store.Results();
  });
}

}  // namespace

std::vector<Target> ReaderTargets() {
  return {{"scenario", FuzzScenario},     {"override", FuzzOverride},   {"airframe", FuzzAirframe},
          {"study", FuzzStudy},           {"waypoints", FuzzWaypoints}, {"octomap", FuzzOctomap},
          {"mesh", FuzzMesh},             {"heights", FuzzHeights},     {"vehicle", FuzzVehicle},
          {"command_line", FuzzCommandLine}, {"record", FuzzRecord},    {"trials", FuzzTrials}};
}

}  // namespace touchdown::evaluation::fuzz
