// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "evaluation/studies/replan/replan_study.h"

namespace touchdown::evaluation {

/// One point of a growth curve: one setting differs from the usual ones.
struct GrowthPoint {
  std::string varied;  ///< horizon_m, density_per_m2 or resolution_m
  ReplanStudyOptions options;
};

/// What is varied in the scenes of a point.
double VariedValue(const std::string& varied, const SceneOptions& scenes);

/// The settings of the growth study, around `usual`: horizons of 5 to 30 m, pillars from 0.06 to
/// 0.5 a square metre, cells of 0.05 to 0.2 m. Plans are not checked again.
std::vector<GrowthPoint> GrowthPoints(const ReplanStudyOptions& usual);

/// Times of rows by the number of {p, v} pairs that the plan was bound to. The classes are none, 1
/// to 4, 5 to 8 and so on by doubling. Classes without a row are left out.
struct PairClass {
  int from = 0;  ///< pairs
  int to = 0;    ///< pairs, the largest of the class
  RowTimes time;
};
std::vector<PairClass> TimesByPairs(const std::vector<ReplanRow>& rows);

}  // namespace touchdown::evaluation
