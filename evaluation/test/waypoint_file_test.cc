// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/scenario/waypoint_file.h"

#include <fstream>
#include <istream>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <utility>

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
  EXPECT_THAT(Refusal("t,x,y\n0,0,nan\n"), EndsWith("not 'nan'"));
  EXPECT_THAT(Refusal("t,x,y\n0,0,5.3e6\n"),
              EndsWith("not '5.3e6': subtract an origin near the flight from all positions"));
  EXPECT_THAT(Refusal("t,x,y\n1.7e9,0,0\n"), EndsWith("not '1.7e9'"));
  EXPECT_THAT(Refusal("x,y,speed\n0,0,0\n"), HasSubstr("speed must be a number in [0.01, 20]"));
  EXPECT_THAT(Refusal("# nothing\n"), HasSubstr("must be a first line"));
  EXPECT_THAT(Refusal("x,y,speed\n0,0,1\n2,0,1\n2,0.0004,1\n4,0,1\n"),
              HasSubstr("line 4: the point is the one before; a stop needs the columns `t,x,y`"));
  EXPECT_THROW(ReadWaypointFile("/no/such/waypoints.csv"), std::invalid_argument);
}

TEST(WaypointFile, ADirectoryIsNone) {
  try {
    ReadWaypointFile(::testing::TempDir());
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("it is a directory"));
  }
}

// Lines, and then a disk that fails.
class BrokenFile : public std::streambuf {
 public:
  explicit BrokenFile(std::string text) : text_(std::move(text)) {
    setg(text_.data(), text_.data(), text_.data() + text_.size());
  }

 protected:
  int_type underflow() override { throw std::ios_base::failure("input/output error"); }

 private:
  std::string text_;
};

TEST(WaypointFile, AReadThatFailsHalfwayIsNoShorterDrive) {
  const std::string whole = "t,x,y\n0,0,0\n9,9,0\n18,18,0\n";
  for (const std::size_t read : {std::size_t{0}, std::size_t{3}, std::size_t{19}, whole.size()}) {
    BrokenFile buffer(whole.substr(0, read));
    std::istream stream(&buffer);
    try {
      ReadWaypoints(stream);
      FAIL() << read;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr("reading it ends in line")) << read;
    }
  }
}

}  // namespace
}  // namespace touchdown::evaluation
