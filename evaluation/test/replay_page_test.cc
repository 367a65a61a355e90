// SPDX-License-Identifier: BSD-3-Clause
// The page holds what the record holds: only decimals are lost.
#include "evaluation/page/replay_page.h"

#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <boost/beast/core/detail/base64.hpp>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/page/flight_document.h"
#include "evaluation/page/packed_text.h"
#include "evaluation/record/record.h"
#include "evaluation/record/record_reader.h"
#include "evaluation/record/replay.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

std::string Unpacked(const std::string& packed) {
  namespace base64 = boost::beast::detail::base64;
  std::string bytes(base64::decoded_size(packed.size()), '\0');
  bytes.resize(base64::decode(bytes.data(), packed.data(), packed.size()).first);
  std::string text(std::size_t{1} << 26, '\0');
  uLongf length = text.size();
  const int status = uncompress(reinterpret_cast<Bytef*>(text.data()), &length,
                                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  EXPECT_EQ(status, Z_OK);
  text.resize(length);
  return text;
}

std::string ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(PackedText, ComesBackAsItWas) {
  std::string text = "a flight, 3 \xC2\xB0, ";
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(Unpacked(PackText(text)), text) << i;
    text.append(text).push_back(static_cast<char>('a' + i));
  }
  EXPECT_EQ(Unpacked(PackText("")), "");
  EXPECT_LT(PackText(text).size(), text.size() / 50);
}

class PageFlights : public ::testing::Test {
 protected:
  void TearDown() override {
    std::filesystem::remove(record_);
    std::filesystem::remove(page_);
  }

  void Fly(const std::string& scenario_name, const std::vector<std::string>& overrides) {
    const Scenario scenario = LoadScenario(FindScenario(scenario_name), overrides, registries_);
    WriteRecord(record_, scenario, RunTrial(scenario, scenario.seed, registries_, &flown_), flown_);
  }

  Json Document() {
    return FlightDocument(record_, "flight.db", registries_, [this](int done, int all) {
      done_.push_back({done, all});
    });
  }

  void Execute(const std::string& sql) {
    SqliteDb(record_, SqliteDb::Mode::kReadWrite).Execute(sql);
  }

  const Registries registries_ = StandardRegistries();
  TrialRecord flown_;
  std::vector<std::pair<int, int>> done_;
  std::string record_ = ::testing::TempDir() + "page.db";
  std::string page_ = ::testing::TempDir() + "page.html";
};

void ExpectPoint(const Json& array, int i, const Eigen::Vector3d& p) {
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(array.at(static_cast<std::size_t>(3 * i + k)).get<double>(), p[k], 0.00051);
  }
}

TEST_F(PageFlights, EveryStepIsAskedAgainAndHasItsCurveItsStopAndItsWords) {
  Fly("straight_turn", {"timeout=4"});
  const Json document = Document();
  const Json& steps = document["steps"];
  ASSERT_EQ(steps.size(), flown_.plans.size());
  ASSERT_GT(steps.size(), 20U);
  EXPECT_EQ(done_.size(), steps.size());
  EXPECT_EQ(done_.back(), std::make_pair(done_.back().second, done_.back().second));
  int lost = 0, pairs = 0, stops = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const RecordPlan& plan = flown_.plans[i];
    const Json& step = steps[i];
    EXPECT_TRUE(step["same"].get<bool>()) << i;
    EXPECT_EQ(step["status"], planning::ToString(plan.result.status));
    const auto points = plan.result.curve.control_points();
    ASSERT_EQ(step["curve"]["q"].size(), 3U * static_cast<std::size_t>(points.cols()));
    ExpectPoint(step["curve"]["q"], 2, points.col(2));
    EXPECT_NEAR(step["wall_ms"].get<double>(), 1e3 * plan.wall_s, 0.001);
    EXPECT_EQ(step["latency_ms"].get<double>(), 1e3 * plan.latency_s);
    EXPECT_THAT(step["words"].get<std::string>(),
                ::testing::HasSubstr(planning::Explain(plan.result.status)));
    EXPECT_THAT(step["words"].get<std::string>(), ::testing::HasSubstr("bit for bit"));
    lost += static_cast<int>(step["lost"].size());
    pairs += static_cast<int>(step["pairs"].size() / 6);
    // What the next step remembers is what this one committed.
    if (i + 1 < steps.size() && plan.result.status == planning::ReplanStatus::kPlanned) {
      const planning::FlightPair& next = flown_.plans[i + 1].before.next;
      ASSERT_EQ(step["stop"].is_null(), !std::isfinite(next.t_stop)) << i;
      if (step["stop"].is_null()) continue;
      ++stops;
      ExpectPoint(step["stop"]["q"], 3, next.stop.control_points().col(3));
      EXPECT_NEAR(step["t_stop"].get<double>(), next.t_stop, 0.00051);
    }
  }
  EXPECT_GT(lost, 0);
  EXPECT_GT(pairs, 50);
  EXPECT_GT(stops, 10);
}

TEST_F(PageFlights, SamplesHaveTheRecordsFiguresAndTheTrueClearance) {
  Fly("straight_turn", {"timeout=2", "own_state=estimated", "wind.mean=2"});
  const Json document = Document();
  const Json& samples = document["samples"];
  const std::size_t count = flown_.samples.size();
  ASSERT_EQ(samples["vehicle"]["t"].size(), count);
  ASSERT_EQ(samples["clearance"].size(), count);
  ASSERT_EQ(samples["rotor"]["thrust3"].size(), count);
  EXPECT_TRUE(samples["rotor"]["thrust4"][0].is_null());
  const std::size_t i = count / 2;
  const RecordSample& sample = flown_.samples[i];
  EXPECT_NEAR(samples["vehicle"]["py"][i].get<double>(), sample.vehicle.p_WB.y(), 0.00051);
  EXPECT_NEAR(samples["believed"]["py"][i].get<double>(), sample.vehicle_estimate.p_WB.y(),
              0.00051);
  EXPECT_NEAR(samples["air"]["vx"][i].get<double>(), sample.air.x(), 0.0051);
  EXPECT_NEAR(samples["rotor"]["thrust3"][i].get<double>(), sample.rotor_thrusts[3], 0.0051);
  double least = 1e9;
  for (const Json& clearance : samples["clearance"])
    least = std::min(least, clearance.get<double>());
  EXPECT_NEAR(least, document["result"]["min_clearance_m"].get<double>(), 0.01);
}

// Runs as the page reads them, against the map that the planner was asked with.
TEST_F(PageFlights, TheMapsRunsMakeTheMapOfEveryStep) {
  Fly("straight_turn", {"timeout=3"});
  const Json map = Document()["map"];
  const RecordedFlight flight = ReadRecord(record_, {}, registries_);
  Replay replay(flight, registries_);
  std::map<std::array<int, 3>, int> known;
  for (int step = 0; step < replay.steps(); ++step) {
    const Json& change = map["steps"][static_cast<std::size_t>(step)];
    const std::vector<int> runs = change["runs"];
    for (std::size_t i = 0; i + 4 < runs.size(); i += 5) {
      for (int k = 0; k < runs[i + 3]; ++k)
        known[{runs[i] + k, runs[i + 1], runs[i + 2]}] = runs[i + 4];
    }
    if (step % 10 != 9) continue;
    replay.Seek(step);
    const planning::CellIndex origin = replay.map().origin(), size = replay.map().size();
    EXPECT_EQ(change["origin"], Json({origin.x(), origin.y(), origin.z()}));
    EXPECT_EQ(map["size"], Json({size.x(), size.y(), size.z()}));
    int occupied = 0;
    for (const auto& [cell, state] : known) {
      const planning::CellIndex index(cell[0], cell[1], cell[2]);
      if ((index - origin).minCoeff() < 0 || (size - (index - origin)).minCoeff() <= 0) continue;
      const planning::CellState now =
          replay.map().IsOccupied(index)       ? planning::CellState::kOccupied
          : replay.map().IsObservedFree(index) ? planning::CellState::kFree
                                               : planning::CellState::kUnknown;
      ASSERT_EQ(static_cast<int>(now), state) << step;
      occupied += state == static_cast<int>(planning::CellState::kOccupied);
    }
    EXPECT_GT(occupied, 50);
  }
}

TEST_F(PageFlights, AnotherPlannersStepsAreToldFromTheRecord) {
  Fly("straight_turn", {"timeout=2", "planner=ego"});
  const Json document = Document();
  ASSERT_GT(document["steps"].size(), 3U);
  for (const Json& step : document["steps"]) {
    EXPECT_FALSE(step.contains("stages"));
    EXPECT_THAT(step["words"].get<std::string>(), ::testing::HasSubstr("asked at t = "));
  }
}

TEST_F(PageFlights, ThePageHoldsItsFlightsWholeAndItsLicences) {
  Fly("open", {"timeout=1"});
  WriteReplayPage(page_, {{record_, "one.db"}, {record_, "</script>"}}, registries_, {});
  const std::string page = ReadText(page_);
  const std::string begin = "<script type=\"text/plain\" class=\"flight\">";
  std::vector<std::string> names;
  for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at + 1)) {
    const std::size_t from = at + begin.size();
    const std::string packed = page.substr(from, page.find("</script>", from) - from);
    names.push_back(Json::parse(Unpacked(packed))["name"]);
  }
  EXPECT_THAT(names, ::testing::ElementsAre("one.db", "</script>"));
  EXPECT_THAT(page, ::testing::HasSubstr("Permission is hereby granted"));
  EXPECT_THAT(page,
              ::testing::Not(::testing::ContainsRegex("<(script|link)[^>]* (src|href)=.?http")));
}

TEST_F(PageFlights, AForeignOrDamagedRecordIsOneSentenceAndLeavesNothing) {
  const auto refusal = [&] {
    try {
      WriteReplayPage(page_, {{record_, record_}}, registries_, {});
    } catch (const BadInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal(), ::testing::HasSubstr("there is no such record"));
  std::ofstream(record_) << "no database";
  EXPECT_THAT(refusal(), ::testing::HasSubstr("not a record that this build reads"));
  std::filesystem::remove(record_);
  Fly("straight_turn", {"timeout=1"});
  Execute("DELETE FROM meta WHERE key = 'result_json'");
  EXPECT_THAT(refusal(), ::testing::HasSubstr("lacks result_json"));
  Execute("INSERT INTO meta VALUES('result_json', 'x')");
  EXPECT_THAT(refusal(), ::testing::HasSubstr("result_json"));
  Execute(
      "UPDATE meta SET value = '{\"outcome\":\"landed\",\"detail\":\"\",\"simulated_s\":\"x\"}' "
      "WHERE key = 'result_json'");
  EXPECT_THAT(refusal(), ::testing::HasSubstr("result_json"));
  Execute(
      "UPDATE meta SET value = '{\"outcome\":\"landed\",\"detail\":\"\",\"simulated_s\":1}' WHERE "
      "key = 'result_json'");
  EXPECT_EQ(refusal(), "");
  std::filesystem::remove(page_);
  const std::pair<const char*, const char*> damages[] = {
      {"INSERT INTO surface VALUES(0, x'00', x'00')", "table surface"},
      {"UPDATE obstacle SET kind = 'mesh' WHERE id = 0", "table surface lacks a mesh"},
      {"UPDATE obstacle SET kind = 'cloud' WHERE id = 0", "\"cloud\""},
      {"INSERT INTO prior VALUES('odd', x'')", "\"odd\""},
      {"INSERT INTO zone VALUES(9, 'a', 'cone', 0, 0, 0, 1, 1, 1)", "\"cone\""},
      {"UPDATE vehicle SET px = NULL WHERE t > 0.5", "lacks px"},
      {"DELETE FROM air WHERE t > 0.5", "of air"},
      {"DELETE FROM vehicle", "no states"},
      {"UPDATE map_change SET ix = 900000", "outside of the map's window"},
      {"DROP TABLE air", "air"}};
  const std::string whole = ReadText(record_);
  for (const auto& [damage, said] : damages) {
    Execute(damage);
    EXPECT_THAT(refusal(), ::testing::HasSubstr(said)) << damage;
    std::ofstream(record_, std::ios::binary) << whole;
  }
  EXPECT_FALSE(std::filesystem::exists(page_));
}

}  // namespace
}  // namespace touchdown::evaluation
