// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/video/flight_video.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/interrupt_watch.h"
#include "evaluation/base/sqlite_db.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/record/record.h"
#include "evaluation/video/caption.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr VideoSize kSmall = {320, 180};

// The first seconds of a landing, flown once.
const std::string& ShortRecord() {
  static const std::string path = [] {
    const Registries registries = StandardRegistries();
    const Scenario scenario = LoadScenario(FindScenario("forest"), {"timeout=1.2"}, registries);
    TrialRecord record;
    const TrialResult result = RunTrial(scenario, scenario.seed, registries, &record);
    const std::string file = ::testing::TempDir() + "touchdown_flight_video.db";
    WriteRecord(file, scenario, result, record);
    return file;
  }();
  return path;
}

// PATH is another one while it lives.
class PathScope {
 public:
  explicit PathScope(const std::string& path) : before_(std::getenv("PATH")) {
    setenv("PATH", path.c_str(), 1);
  }
  ~PathScope() { setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

template <typename E, typename Call>
std::string SaidBy(const Call& call) {
  try {
    call();
  } catch (const E& error) {
    return error.what();
  }
  return "";
}

// Pixels around there that are as blue as the vehicle's body.
int BlueAround(const std::vector<std::uint8_t>& rgb, const Eigen::Vector2d& pixel) {
  int blue = 0;
  for (int y = static_cast<int>(pixel.y()) - 5; y <= static_cast<int>(pixel.y()) + 5; ++y) {
    for (int x = static_cast<int>(pixel.x()) - 5; x <= static_cast<int>(pixel.x()) + 5; ++x) {
      if (x < 0 || y < 0 || x >= kSmall.width || y >= kSmall.height) continue;
      const auto p = rgb.begin() + 3 * (y * kSmall.width + x);
      if (p[2] > p[0] + 20 && p[0] < 100) ++blue;
    }
  }
  return blue;
}

TEST(FlightPictures, ShowTheVehicleWhereItIs) {
  FlightPictures pictures(ShortRecord(), StandardRegistries(), kSmall);
  const FlightTrack track(ShortRecord());
  EXPECT_EQ(pictures.count(), 31);  // 0 to 1.2 s
  std::vector<std::uint8_t> first, last;
  for (int i = 0; i < pictures.count(); ++i) {
    last = pictures.Next();
    if (i == 0) first = last;
    const Eigen::Vector3d p_WB = track.At(static_cast<double>(i) / kVideoRate).vehicle.p_WB;
    EXPECT_GT(BlueAround(last, pictures.PixelOf(p_WB)), 4) << i;
    EXPECT_EQ(BlueAround(last, pictures.PixelOf(p_WB - Eigen::Vector3d(0.0, 0.0, 0.8))), 0) << i;
  }
  std::size_t changed = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (std::abs(first[i] - last[i]) > 10) ++changed;
  }
  EXPECT_GT(changed, first.size() / 10);
}

TEST(FlightPictures, OfTheSameRecordAreTheSame) {
  FlightPictures one(ShortRecord(), StandardRegistries(), kSmall);
  FlightPictures two(ShortRecord(), StandardRegistries(), kSmall);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(one.Next(), two.Next()) << i;
}

TEST(FlightTrack, IsInterpolatedBetweenSamples) {
  const FlightTrack track(ShortRecord());
  const TrackSample a = track.At(0.60), b = track.At(0.62), middle = track.At(0.61);
  EXPECT_GT((b.vehicle.p_WB - a.vehicle.p_WB).norm(), 0.0);
  EXPECT_NEAR((middle.vehicle.p_WB - 0.5 * (a.vehicle.p_WB + b.vehicle.p_WB)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((middle.pad.p_WP - 0.5 * (a.pad.p_WP + b.pad.p_WP)).norm(), 0.0, 1e-9);
  EXPECT_EQ(middle.vehicle.t, 0.61);
  EXPECT_EQ(track.At(100.0).vehicle.t, track.t_end());
  ASSERT_FALSE(track.events().empty());
  EXPECT_EQ(track.events().front().text, "hovering");
  EXPECT_FALSE(track.touchdown().has_value());
}

TEST(FlightTrack, HasTheFiguresOfItsSamplesUnrounded) {
  const FlightTrack track(ShortRecord());
  ASSERT_EQ(track.figures().size(), track.samples().size());
  SqliteDb db(ShortRecord(), SqliteDb::Mode::kReadOnly);
  SqliteStatement rows = db.Prepare(
      "SELECT thrust3, air.vx, reference.px, vehicle.px, mode FROM rotor JOIN air USING (t) JOIN "
      "reference USING (t) JOIN mode USING (t) JOIN vehicle USING (t) WHERE source = 'estimate' "
      "ORDER BY t");
  for (const TrackFigures& figures : track.figures()) {
    ASSERT_TRUE(rows.Step());
    ASSERT_EQ(figures.thrusts.size(), 4U);
    EXPECT_EQ(figures.thrusts[3], rows.Real(0));
    EXPECT_EQ(figures.v_air_W.x(), rows.Real(1));
    EXPECT_EQ(figures.p_reference_WB.x(), rows.Real(2));
    EXPECT_EQ(figures.p_believed_WB.x(), rows.Real(3));
    EXPECT_EQ(figures.mode, rows.Text(4));
  }
}

TEST(FlightTrack, RefusesWhatCannotBe) {
  const std::string path = ::testing::TempDir() + "touchdown_flight_video_cut.db";
  const std::string last = " WHERE source = 'true' AND t = (SELECT MAX(t) FROM vehicle)";
  const std::string number = "its table vehicle holds what is no finite number";
  const std::vector<std::pair<std::string, std::string>> damages = {
      {"DELETE FROM pad WHERE t > 0.5", "its table pad does not agree with the table vehicle"},
      {"DELETE FROM rotor WHERE t > 0.5", "its table rotor does not agree with the true states"},
      {"UPDATE air SET t = t + 0.01", "its table air does not agree with the true states"},
      {"DELETE FROM vehicle", "its table vehicle holds no true state"},
      {"UPDATE vehicle SET t = 9e999" + last, number},
      {"UPDATE vehicle SET px = 9e999" + last, number},
      {"UPDATE vehicle SET px = 'abc'" + last, number},
      {"UPDATE vehicle SET px = 1e300" + last, "its table vehicle holds a place beyond 100 km"},
      {"UPDATE vehicle SET t = 2e9" + last,
       "its table vehicle holds the time 2e+09 s where 0 to 601 may stand"},
      {"UPDATE vehicle SET t = 1e6" + last,
       "its table vehicle holds the time 1e+06 s where 0 to 601 may stand"},
      {"UPDATE vehicle SET t = -1" + last,
       "its table vehicle holds the time -1 s where 0 to 601 may stand"},
      {"UPDATE event SET t = 1e12",
       "its table event holds the time 1e+12 s where 0 to 601 may stand"},
      {"UPDATE pad SET t = 602 WHERE source = 'estimate'",
       "its table pad holds the time 602 s where 0 to 601 may stand"},
      {"UPDATE vehicle SET t = 0" + last, "its table vehicle holds the time 0 s twice"},
      {"UPDATE vehicle SET qw = 0, qx = 0, qy = 0, qz = 0" + last,
       "its table vehicle holds a quaternion that is no unit one"}};
  for (const auto& [sql, why] : damages) {
    std::filesystem::copy_file(ShortRecord(), path,
                               std::filesystem::copy_options::overwrite_existing);
    SqliteDb(path, SqliteDb::Mode::kReadWrite).Execute(sql);
    EXPECT_EQ(SaidBy<BadInput>([&] { FlightTrack track(path); }), path + ": " + why + ".") << sql;
  }
}

TEST(Caption, SaysWhatHappensAndHowFarItIs) {
  const Registries registries = StandardRegistries();
  const RecordedFlight flight = ReadRecord(ShortRecord(), {}, registries);
  const FlightTrack track(ShortRecord());
  const auto at = [&](double t) {
    const TrackSample now = track.At(t);
    return CaptionOf(flight, track, now, t + 0.04, now.pad.p_WP);
  };
  EXPECT_EQ(at(0.0).flight, "forest, planner landing, seed 1");
  EXPECT_EQ(at(0.0).state, "hovering");
  EXPECT_THAT(at(0.5).state, HasSubstr("tracking (pad converged)"));
  EXPECT_THAT(at(track.t_end()).state, Not(HasSubstr("tracking")));
  EXPECT_EQ(at(0.5).time, "0.50 s");
  EXPECT_THAT(at(0.5).distance, HasSubstr(" m to the pad, 1."));
  EXPECT_EQ(PlanAt(flight.plans, 0.0), nullptr);
  EXPECT_LE(PlanAt(flight.plans, 0.5)->request.input.t_start, 0.5);
}

TEST(Caption, IsCutWhereThereIsNoRoom) {
  const sim::Font font(2);
  const std::string name(150, 'w');
  const std::string cut = Fitting(name, 300, font);
  EXPECT_LE(font.WidthOf(cut), 300);
  EXPECT_GT(font.WidthOf(cut + "w"), 300);
  EXPECT_EQ(Fitting("forest", 300, font), "forest");
  EXPECT_EQ(Fitting("forest", font.WidthOf("forest"), font), "forest");
  EXPECT_EQ(Fitting("forest", -5, font), "");
}

// The words at the right stand alone, however long those at the left are.
TEST(FlightPictures, ALongNameDoesNotReachTheTime) {
  const std::string path = ::testing::TempDir() + "touchdown_flight_video_named.db";
  std::filesystem::copy_file(ShortRecord(), path,
                             std::filesystem::copy_options::overwrite_existing);
  SqliteDb(path, SqliteDb::Mode::kReadWrite)
      .Execute("UPDATE meta SET value = '" + std::string(150, 'w') + "' WHERE key = 'scenario'");
  FlightPictures named(path, StandardRegistries(), kSmall);
  FlightPictures plain(ShortRecord(), StandardRegistries(), kSmall);
  const std::vector<std::uint8_t>& a = named.Next();
  const std::vector<std::uint8_t>& b = plain.Next();
  const auto differ = [&](int from, int to) {
    int count = 0;
    for (int y = kSmall.height - 20; y < kSmall.height; ++y) {
      for (int x = 3 * (y * kSmall.width + from); x < 3 * (y * kSmall.width + to); ++x) {
        if (a[static_cast<std::size_t>(x)] != b[static_cast<std::size_t>(x)]) ++count;
      }
    }
    return count;
  };
  EXPECT_GT(differ(100, 200), 0);
  EXPECT_EQ(differ(kSmall.width - 30, kSmall.width), 0);  // "0.00 s"
}

TEST(FlightVideo, WhatCannotBeMadeIsSaidBefore) {
  const auto said = [](const std::string& path) {
    return SaidBy<BadInput>([&] { CheckVideo("--video", path); });
  };
  const std::string good = ::testing::TempDir() + "touchdown_flight_video.mp4";
  EXPECT_EQ(said(good), "");
  EXPECT_EQ(said("flight.avi"), "--video flight.avi: the name must end in .mp4.");
  EXPECT_THAT(said("/no/such/folder/f.mp4"), HasSubstr("there is no directory"));
  const PathScope empty("/no/such/folder");
  EXPECT_EQ(said(good), "--video " + good +
                            " needs the program ffmpeg, which is not on PATH: install the package "
                            "ffmpeg.");
}

TEST(FlightVideo, ADeckWithoutRoomForItsSheetIsRefusedBeforeTheFlight) {
  Scenario scenario = LoadScenario(FindScenario("open"), {}, StandardRegistries());
  const std::string path = ::testing::TempDir() + "touchdown_flight_video.mp4";
  EXPECT_NO_THROW(CheckVideo("--video", path, scenario));
  scenario.pad.deck_size = 0.6;
  EXPECT_EQ(SaidBy<BadInput>([&] { CheckVideo("--video", path, scenario); }),
            "--video " + path +
                ": pad.deck_size must be in [1.28, 5] m with a video, which needs room for the "
                "pad's printed sheet, not '0.6'.");
}

TEST(FlightVideo, AFailureLeavesNothing) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(::testing::TempDir()) / "touchdown_broken_encoder";
  fs::remove_all(folder);
  fs::create_directories(folder / "bin");
  std::ofstream(folder / "bin" / "ffmpeg") << "#!/bin/sh\necho no space left >&2\nexit 1\n";
  fs::permissions(folder / "bin" / "ffmpeg", fs::perms::owner_all);
  const PathScope broken((folder / "bin").string());
  const std::string video = (folder / "flight.mp4").string();
  EXPECT_EQ(SaidBy<std::runtime_error>(
                [&] { WriteVideo(ShortRecord(), video, StandardRegistries(), {}, kSmall); }),
            "--video " + video + ": the video was not made: ffmpeg failed (no space left).");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

TEST(FlightVideo, TellsHowFarItIsAndCanBeEnded) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(::testing::TempDir()) / "touchdown_ended_video";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string video = (folder / "flight.mp4").string();
  std::vector<int> told;
  EXPECT_THROW(WriteVideo(
                   ShortRecord(), video, StandardRegistries(),
                   [&](int done, int all) {
                     EXPECT_EQ(all, 31);
                     told.push_back(done);
                     if (done == 3) throw Interruption{15};
                   },
                   kSmall),
               Interruption);
  EXPECT_EQ(told, (std::vector<int>{1, 2, 3}));
  EXPECT_TRUE(fs::is_empty(folder));
}

}  // namespace
}  // namespace touchdown::evaluation
