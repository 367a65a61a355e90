// SPDX-License-Identifier: BSD-3-Clause
// Numbers are read by std::from_chars, which knows no locale. What is asked of the points themselves
// is sim/waypoint_drive's to say.
#include "evaluation/scenario/waypoint_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "evaluation/base/words.h"
#include "sim/base/input_file.h"

namespace touchdown::evaluation {
namespace {

constexpr std::size_t kMostCsvBytes = 16 << 20;
constexpr double kFarthest = 1e4;  // [m], [s]
constexpr double kFastest = 20.0;  // [m/s]

std::string Trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> Columns(const std::string& line) {
  std::vector<std::string> columns = Split(line, ',');
  for (std::string& column : columns) column = Trimmed(column);
  return columns;
}

class WaypointReader {
 public:
  std::vector<sim::PadWaypoint> Read(std::istream& file) {
    std::string text;
    while (std::getline(file, text)) {
      ++line_;
      text = Trimmed(text);
      if (text.empty() || text.front() == '#') continue;
      const std::vector<std::string> columns = Columns(text);
      if (names_.empty()) {
        TakeNames(columns);
      } else {
        TakePoint(columns);
      }
    }
    // Half a file would be a shorter drive.
    if (file.bad())
      throw std::invalid_argument(fmt::format("reading it ends in line {}", line_ + 1));
    if (names_.empty()) Refuse("there must be a first line `t,x,y` or `x,y,speed`");
    return points_;
  }

 private:
  [[noreturn]] void Refuse(const std::string& what) const {
    throw std::invalid_argument(fmt::format("line {}: {}", line_, what));
  }

  void TakeNames(const std::vector<std::string>& columns) {
    const std::vector<std::string> timed = {"t", "x", "y"}, paced = {"x", "y", "speed"};
    if (columns != timed && columns != paced) {
      Refuse("the first line must be `t,x,y` or `x,y,speed`");
    }
    names_ = columns;
    timed_ = columns == timed;
  }

  double Number(const std::string& text, const std::string& name, double lo, double hi) const {
    double value = NAN;
    const auto end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, value);
    if (read.ec != std::errc{} || read.ptr != end || !(value >= lo && value <= hi)) {
      const bool is_place = name == "x" || name == "y";
      const bool is_number = read.ec == std::errc{} && read.ptr == end;
      Refuse(fmt::format("{} must be a number in [{:g}, {:g}], not '{}'{}", name, lo, hi, text,
                         is_place && is_number ? OriginAdvice(value) : ""));
    }
    return value;
  }

  double WayFromLast(const Eigen::Vector2d& p) const {
    const double way = (p - points_.back().p).norm();
    if (way < sim::kSamePlace) {
      Refuse("the point is the one before; a stop needs the columns `t,x,y`");
    }
    return way;
  }

  void TakePoint(const std::vector<std::string>& columns) {
    if (columns.size() != names_.size()) {
      Refuse(fmt::format("there must be {} columns, not {}", names_.size(), columns.size()));
    }
    std::array<double, 3> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool speed = names_[i] == "speed";
      values[i] =
          Number(columns[i], names_[i], speed ? 0.01 : -kFarthest, speed ? kFastest : kFarthest);
    }
    sim::PadWaypoint point;
    point.line = line_;
    if (timed_) {
      point.t = values[0];
      point.p = {values[1], values[2]};
    } else {
      point.p = {values[0], values[1]};
      if (!points_.empty()) point.t = points_.back().t + WayFromLast(point.p) / speed_;
      speed_ = values[2];
    }
    points_.push_back(point);
  }

  int line_ = 0;
  std::vector<std::string> names_;
  bool timed_ = true;
  double speed_ = 0.0;  // from the last point on [m/s]
  std::vector<sim::PadWaypoint> points_;
};

}  // namespace

std::vector<sim::PadWaypoint> ReadWaypoints(std::istream& text) {
  return WaypointReader().Read(text);
}

std::vector<sim::PadWaypoint> ReadWaypointFile(const std::string& path) {
  std::istringstream file(sim::ReadInputFile(path, kMostCsvBytes));
  try {
    return ReadWaypoints(file);
  } catch (const std::invalid_argument& error) {
    sim::RefuseFile(path, error.what());
  }
}

std::string WaypointText(const std::vector<sim::PadWaypoint>& points) {
  std::string text;
  for (const sim::PadWaypoint& point : points) {
    text += fmt::format("{} {} {}\n", point.t, point.p.x(), point.p.y());
  }
  return text;
}

}  // namespace touchdown::evaluation
