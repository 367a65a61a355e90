// SPDX-License-Identifier: BSD-3-Clause
// The parts of a replanning step as JSON: of `touchdown plan --json` (docs/profile.md) and of the planner in a page
// (docs/playground.md).
#pragma once

#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "touchdown/planning/certify/certificate.h"
#include "touchdown/planning/replan/replan_log.h"
#include "touchdown/planning/spline/uniform_bspline.h"

namespace touchdown::evaluation {

nlohmann::ordered_json VectorJson(const Eigen::Vector3d& v);
nlohmann::ordered_json PathJson(const std::vector<Eigen::Vector3d>& points);
nlohmann::ordered_json CurveJson(const planning::UniformBspline& curve);
nlohmann::ordered_json CertificateJson(const planning::Certificate& certificate);
/// What a step tried.
nlohmann::ordered_json AttemptsJson(const planning::ReplanLog& log);

}  // namespace touchdown::evaluation
