// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/waypoint_file.h"

#include <fstream>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace touchdown::evaluation {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

std::string Written(const std::string& text) {
  const std::string path = ::testing::TempDir() + "waypoints.csv";
  std::ofstream(path) << text;
  return path;
}

std::string Refusal(const std::string& text) {
  try {
    ReadWaypointFile(Written(text));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(WaypointFile, TimesAreTaken) {
  const auto points = ReadWaypointFile(Written("# drive\n\n t, x ,y\r\n0,1,2\r\n2.5,-3e1,4\r\n"));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[1].t, 2.5);
  EXPECT_EQ(points[1].p, Eigen::Vector2d(-30.0, 4.0));
  EXPECT_EQ(points[0].line, 4);
  EXPECT_EQ(points[1].line, 5);
}

TEST(WaypointFile, SpeedsBecomeTimes) {
  const auto points = ReadWaypointFile(Written("x,y,speed\n0,0,2\n6,8,0.5\n6,9,1\n"));
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[0].t, 0.0);
  EXPECT_DOUBLE_EQ(points[1].t, 5.0);
  EXPECT_DOUBLE_EQ(points[2].t, 7.0);
}

TEST(WaypointFile, EveryFaultHasItsLine) {
  EXPECT_THAT(Refusal("t,x\n"), HasSubstr("line 1: the first line must be `t,x,y`"));
  EXPECT_THAT(Refusal("t,x,y\n0,0\n"), HasSubstr("line 2: there must be 3 columns, not 2"));
  EXPECT_THAT(Refusal("t,x,y\n0,0,0\n1,far,0\n"),
              EndsWith("line 3: x must be a number in [-10000, 10000], not 'far'"));
  EXPECT_THAT(Refusal("t,x,y\n0,0,nan\n"), HasSubstr("not 'nan'"));
  EXPECT_THAT(Refusal("x,y,speed\n0,0,0\n"), HasSubstr("speed must be a number in [0.01, 20]"));
  EXPECT_THAT(Refusal("# nothing\n"), HasSubstr("must be a first line"));
  EXPECT_THROW(ReadWaypointFile("/no/such/waypoints.csv"), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::evaluation
