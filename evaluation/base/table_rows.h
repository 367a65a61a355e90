// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Core>

#include "evaluation/base/sqlite_db.h"

namespace touchdown::evaluation {

/// Steps through a table's rows and gives their columns in order. A value that is missing or out of
/// its range throws std::invalid_argument. Its message continues the name of the file.
class TableRows {
 public:
  TableRows(SqliteDb& db, std::string table, const std::string& columns, const std::string& order)
      : table_(std::move(table)),
        statement_(db.Prepare("SELECT " + columns + " FROM " + table_ + " ORDER BY " + order)) {}

  bool Next() {
    column_ = 0;
    return statement_.Step();
  }
  double Number() {
    if (statement_.IsNull(column_)) Refuse("lacks a number");
    const double value = statement_.Real(column_);
    // No record is written with an infinite one.
    if (!statement_.IsNumber(column_++) || !std::isfinite(value)) {
      Refuse("holds what is no finite number");
    }
    return value;
  }
  /// Since a flight began [s].
  double Time() {
    constexpr double kLongest = 601.0;  // the schema's time-out, and its last step
    const double t = Number();
    if (t < 0.0 || t > kLongest) {
      Refuse(fmt::format("holds the time {:g} s where 0 to {:g} may stand", t, kLongest));
    }
    return t;
  }
  double NumberOrNan() {
    const bool missing = statement_.IsNull(column_);
    const double value = statement_.Real(column_++);
    return missing ? std::numeric_limits<double>::quiet_NaN() : value;
  }
  std::optional<double> Optional() {
    const bool missing = statement_.IsNull(column_);
    const double value = statement_.Real(column_++);
    return missing ? std::nullopt : std::optional<double>(value);
  }
  std::optional<Eigen::Vector3d> OptionalVector3() {
    const std::optional<double> x = Optional(), y = Optional(), z = Optional();
    if (!(x && y && z)) return std::nullopt;
    return Eigen::Vector3d(*x, *y, *z);
  }
  int Integer(std::int64_t low, std::int64_t high) {
    if (statement_.IsNull(column_)) Refuse("lacks a number");
    const std::int64_t value = statement_.Integer(column_++);
    if (value < low || value > high) {
      Refuse(fmt::format("holds {} where {} to {} may stand", value, low, high));
    }
    return static_cast<int>(value);
  }
  int Count() { return Integer(0, std::numeric_limits<int>::max()); }
  bool Flag() { return Integer(0, 1) != 0; }
  Eigen::Vector2d Vector2() {
    const double x = Number();
    return {x, Number()};
  }
  Eigen::Vector3d Vector3() {
    const double x = Number(), y = Number();
    return {x, y, Number()};
  }
  std::string Text() { return statement_.Text(column_++); }
  /// The enumerator that `name_of` gives this name; `last` is the last of them.
  template <typename Enum>
  Enum Named(Enum last, const char* (*name_of)(std::type_identity_t<Enum>)) {
    const std::string name = Text();
    for (int i = 0; i <= static_cast<int>(last); ++i) {
      if (name == name_of(static_cast<Enum>(i))) return static_cast<Enum>(i);
    }
    Refuse(fmt::format("holds the unknown word \"{}\"", name));
  }
  [[noreturn]] void Refuse(const std::string& what) const {
    throw std::invalid_argument(fmt::format("its table {} {}", table_, what));
  }

 private:
  std::string table_;
  SqliteStatement statement_;
  int column_ = 0;
};

}  // namespace touchdown::evaluation
