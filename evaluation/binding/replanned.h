// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <pybind11/pybind11.h>

#include "touchdown/planning/replan/replan_result.h"

namespace touchdown::binding {

/// The answer of a replanning step, kept.
struct Replanned {
  planning::ReplanResult result;
  std::string detail;    ///< the result's, which is a view
  std::string attempts;  ///< JSON; empty: not asked for

  void Keep() {
    detail = std::string(result.detail);
    result.detail = result.forbidden_by = {};  // views
  }
};

}  // namespace touchdown::binding
