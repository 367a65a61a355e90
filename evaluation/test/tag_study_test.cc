// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/tags/tag_study.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/studies/tags/tag_fit.h"
#include "evaluation/studies/tags/tag_picture.h"
#include "evaluation/studies/tags/tag_report.h"

namespace touchdown::evaluation {
namespace {

TagStudyOptions Views(int poses, std::uint64_t seed) {
  TagStudyOptions options;
  options.poses = poses;
  options.seed = seed;
  options.camera.noise_sigma = 2.0;
  return options;
}

TEST(TagStudy, SameSeedSameRowsAndTheDemandIsMet) {
  const auto rows = RunTagStudy(Views(60, 3), {});
  const auto again = RunTagStudy(Views(60, 3), {});
  ASSERT_EQ(rows.size(), 60U);
  int solved = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].status, again[i].status);
    EXPECT_EQ(rows[i].position_error, again[i].position_error);
    EXPECT_EQ(rows[i].nees, again[i].nees);
    EXPECT_GE(rows[i].height, kLowestView);
    EXPECT_LT(rows[i].height, kHighestView);
    EXPECT_LE(rows[i].tilt_deg, kLargestTilt);
    solved += rows[i].Solved() ? 1 : 0;
  }
  EXPECT_GT(solved, 40);
  EXPECT_TRUE(FulfilsDemand(rows));
  const TagStudyBin all = Summarise(rows, kLowestView, kHighestView);
  EXPECT_EQ(all.views, 60);
  EXPECT_LE(all.found, all.views - all.not_in_view);
  ASSERT_TRUE(all.nees.has_value());
  EXPECT_LT(*all.nees, 1.5);
  const std::string text = TagStudyText({{Views(60, 3), rows}});
  EXPECT_NE(text.find("320x240, fov 90 deg"), std::string::npos);
  EXPECT_EQ(TagStudyJson({{Views(60, 3), rows}})["parts"][0]["heights"].size(), 7U);
}

TEST(TagStudy, NothingIsSaidOfHeightsWithoutAView) {
  const TagStudyPart none{Views(1, 3), {}};
  EXPECT_FALSE(Summarise(none.rows, kLowestView, kHighestView).nees.has_value());
  EXPECT_EQ(TagStudyText({none}).find("nan"), std::string::npos);
  EXPECT_NE(TagStudyText({none}).find("      -      -       -\n"), std::string::npos);
  const auto json = TagStudyJson({none});
  for (const auto& bin : json["parts"][0]["heights"]) {
    EXPECT_TRUE(bin["nees_per_dof"].is_null());
  }
}

// Not the views of the fit. Ranges of heights one by one take thousands of views: docs/results/tag_pose/tables.md.
TEST(TagStudy, FastCameraAgreesWithTheRenderedOne) {
  const TagStudyOptions options = Views(450, 7);
  const auto rows = RunTagStudy(options, {});
  const auto ranges = CompareTagCameras(options, rows, sim::TagModel());
  for (const TagAgreement& part : ranges) {
    EXPECT_GT(part.views, 80);
    EXPECT_NEAR(part.fast_rate, part.rendered_rate, 0.03) << part.from;
  }
  const TagAgreement all =
      CompareTagCameras(options, rows, kLowestView, kHighestView, sim::TagModel());
  EXPECT_NEAR(all.fast_rate, all.rendered_rate, 0.03);
  EXPECT_NEAR(*all.fast_mm.median / *all.rendered_mm.median, 1.0, 0.2);
  EXPECT_NEAR(*all.fast_mm.p95 / *all.rendered_mm.p95, 1.0, 0.2);
}

TEST(TagStudy, PicturesShowWhatWasFound) {
  const std::filesystem::path path =
      std::filesystem::path(::testing::TempDir()) / "touchdown_tag_picture.ppm";
  estimation::GrayImage image{20, 10, std::vector<std::uint8_t>(200, 90)};
  estimation::PadView view;
  view.tags.emplace_back().corners << 4, 14, 14, 4, 8, 8, 2, 2;
  WriteTagPicture(path.string(), image, view, {20, 10, 10.0, 10.0, 5.0});
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  const std::string head = "P6\n60 30\n255\n";
  ASSERT_EQ(bytes.size(), head.size() + 60 * 30 * 3);
  EXPECT_EQ(bytes.substr(0, head.size()), head);
  const auto at = [&](int u, int v) {
    return static_cast<std::uint8_t>(
        bytes[head.size() + static_cast<std::size_t>(3 * (60 * v + u))]);
  };
  EXPECT_EQ(at(0, 0), 90);
  EXPECT_EQ(at(30, 24), 255);  // yellow, the first side
  EXPECT_EQ(at(30, 6), 0);     // green
  std::filesystem::remove(path);
  EXPECT_THROW(WriteTagPicture("/nowhere/x.ppm", image, view, {}), std::runtime_error);
}

TEST(TagStudy, RefusesBadOptions) {
  TagStudyOptions options = Views(0, 1);
  EXPECT_THROW(RunTagStudy(options, {}), std::invalid_argument);
  options = Views(1, 1);
  options.camera.fov_y_deg = 120.0;
  EXPECT_THROW(RunTagStudy(options, {}), std::invalid_argument);
  EXPECT_THROW(FitTagModel(Views(1, 1), {}), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::evaluation
