// SPDX-License-Identifier: BSD-3-Clause
// Planners, controllers and pad predictors that are written in Python.
#pragma once

#include <pybind11/pybind11.h>

#include "touchdown/evaluation/scenario/registries.h"

namespace touchdown::binding {

/// The entries of classes that derive from touchdown.Planner, Controller and PadPredictor. Raise errors of their
/// attributes.
evaluation::PlannerEntry PythonPlannerEntry(const pybind11::object& type);
evaluation::ControllerEntry PythonControllerEntry(const pybind11::object& type);
evaluation::PredictorEntry PythonPredictorEntry(const pybind11::object& type);

}  // namespace touchdown::binding
