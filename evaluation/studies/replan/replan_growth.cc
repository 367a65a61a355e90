// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/replan/replan_growth.h"

#include <algorithm>
#include <stdexcept>

namespace touchdown::evaluation {
namespace {

constexpr int kFirstClass = 4;  // pairs

struct Varied {
  const char* name;
  double SceneOptions::*option;
  std::vector<double> values;
};

const std::vector<Varied>& AllVaried() {
  static const std::vector<Varied> all = {
      {"horizon_m", &SceneOptions::horizon, {5.0, 7.5, 10.0, 15.0, 20.0, 30.0}},
      {"density_per_m2", &SceneOptions::density, {0.06, 0.125, 0.25, 0.375, 0.5}},
      {"resolution_m", &SceneOptions::resolution, {0.05, 0.1, 0.2}}};
  return all;
}

}  // namespace

double VariedValue(const std::string& varied, const SceneOptions& scenes) {
  for (const Varied& one : AllVaried()) {
    if (one.name == varied) return scenes.*one.option;
  }
  throw std::invalid_argument("VariedValue: " + varied + " is not varied");
}

std::vector<GrowthPoint> GrowthPoints(const ReplanStudyOptions& usual) {
  std::vector<GrowthPoint> points;
  for (const Varied& one : AllVaried()) {
    for (const double value : one.values) {
      GrowthPoint& point = points.emplace_back(GrowthPoint{one.name, usual});
      point.options.check = point.options.later = point.options.oracle = false;
      point.options.scenes.*one.option = value;
    }
  }
  return points;
}

std::vector<PairClass> TimesByPairs(const std::vector<ReplanRow>& rows) {
  int most = 0;
  for (const ReplanRow& row : rows) most = std::max(most, row.pairs);
  std::vector<PairClass> classes;
  for (int from = 0, to = 0; from <= most; from = to + 1, to = std::max(kFirstClass, 2 * to)) {
    std::vector<const ReplanRow*> inside;
    for (const ReplanRow& row : rows) {
      if (row.pairs >= from && row.pairs <= to) inside.push_back(&row);
    }
    if (!inside.empty()) classes.push_back({from, to, TimesOf(inside)});
  }
  return classes;
}

}  // namespace touchdown::evaluation
