// SPDX-License-Identifier: BSD-3-Clause
// The library's parts, with those that Python adds.
#include "evaluation/binding/bind.h"
#include "evaluation/binding/call.h"
#include "evaluation/binding/part_registries.h"
#include "evaluation/binding/predictions.h"
#include "evaluation/binding/python_parts.h"
#include "touchdown/control/tracking/controller.h"
#include "touchdown/estimation/base/vehicle_model.h"
#include "touchdown/estimation/pad/pad_predictor.h"
#include "touchdown/planning/problem/term_check.h"

namespace touchdown::binding {

using namespace pybind11::literals;
using evaluation::Registries;

namespace {

std::string NameOf(const planning::TermEntry& entry) { return entry.info.name; }
std::string NameOf(const evaluation::Part& part) { return part.name; }

/// The registry is as before where something is wrong.
template <class Entry>
void Enter(PartRegistries& self, std::vector<Entry> Registries::*registry, Entry entry,
           bool replace) {
  Registries changed = self.all;
  const std::string name = NameOf(entry);
  const bool there = self.own.count(name) > 0;
  if (there && !replace) {
    throw py::value_error(name + " is registered already: with replace=True this takes its place");
  }
  if (there) {
    std::erase_if(changed.*registry, [&](const Entry& old) { return NameOf(old) == name; });
  }
  (changed.*registry).push_back(std::move(entry));
  evaluation::RequireDistinct(changed);
  self.all = std::move(changed);
  self.own.insert(name);
}

void EnterTerm(PartRegistries& self, const py::object& type, bool check, bool replace) {
  auto time = std::make_shared<TermTime>();
  const planning::TermEntry entry = PythonTermEntry(type, time);
  const std::string name = entry.info.name;
  if (check && (replace || self.own.count(name) == 0)) {
    planning::TermCheckOptions options;
    options.trials = 2;
    const auto rows = WithoutLock([&] { return planning::CheckTerm(entry, options); });
    const std::string complaint = planning::Complaint(rows);
    if (!complaint.empty()) {
      throw py::value_error(WhatIsWrong(type, name, complaint, rows));
    }
  }
  Enter(self, &Registries::terms, entry, replace);
  *time = {};
  self.term_times[name] = time;
}

void Add(PartRegistries& self, const py::object& type, bool check, bool replace) {
  const InUse::Claim claim(self.use);
  const py::module_ parts = py::module_::import("touchdown._parts");
  const auto derives = [&](const py::object& base) {
    return PyType_Check(type.ptr()) && PyObject_IsSubclass(type.ptr(), base.ptr()) == 1;
  };
  if (derives(py::module_::import("touchdown._terms").attr("Term"))) {
    return EnterTerm(self, type, check, replace);
  }
  if (derives(parts.attr("Planner"))) {
    return Enter(self, &Registries::planners, PythonPlannerEntry(type), replace);
  }
  if (derives(parts.attr("Controller"))) {
    return Enter(self, &Registries::controllers, PythonControllerEntry(type), replace);
  }
  if (derives(parts.attr("PadPredictor"))) {
    return Enter(self, &Registries::predictors, PythonPredictorEntry(type), replace);
  }
  throw py::type_error(std::string(py::repr(type)) +
                       " is no class that derives from Term, Planner, Controller or PadPredictor");
}

py::dict TermTimes(const PartRegistries& self) {
  py::dict times;
  for (const auto& [name, time] : self.term_times) {
    times[py::str(name)] =
        py::dict("calls"_a = time->calls, "windows"_a = time->windows, "wall_s"_a = time->wall_s);
  }
  return times;
}

void BindPartTypes(py::module_& m) {
  using control::ControlOutput;
  using control::Disturbance;
  using control::Wrench;
  Plain<Wrench>(m, "Wrench")
      .Field("thrust", &Wrench::thrust)
      .Field("moment_B", &Wrench::moment_B)
      .Done();
  Plain<Disturbance>(m, "Disturbance")
      .Field("force_W", &Disturbance::force_W)
      .Field("moment_B", &Disturbance::moment_B)
      .Field("thrust_gain", &Disturbance::thrust_gain)
      .Done();
  Plain<ControlOutput>(m, "ControlOutput")
      .Field("wrench", &ControlOutput::wrench)
      .Field("R_WB_desired", &ControlOutput::R_WB_desired)
      .Field("w_WB_B_desired", &ControlOutput::w_WB_B_desired)
      .Field("tilt_limited", &ControlOutput::tilt_limited)
      .Field("thrust_limited", &ControlOutput::thrust_limited)
      .Done();
  using estimation::Actuator;
  Plain<Actuator>(m, "Actuator")
      .Field("p_BR", &Actuator::p_BR)
      .Field("thrust", &Actuator::thrust)
      .Field("moment_B", &Actuator::moment_B)
      .Field("min", &Actuator::min)
      .Field("max", &Actuator::max)
      .Done();
  m.def("rotor_at", &estimation::RotorAt, "p_BR"_a, "torque_per_thrust"_a, "thrust_max"_a,
        "thrust_min"_a = 0.0, Doc("RotorAt"));
  using estimation::VehicleModel;
  Plain<VehicleModel>(m, "VehicleModel")
      .Field("mass_kg", &VehicleModel::mass_kg)
      .Field("inertia", &VehicleModel::inertia)
      .Field("R_BI", &VehicleModel::R_BI)
      .Field("actuators", &VehicleModel::actuators, "A list of Actuator, 4 to 8 of them.")
      .Field("rotor_lag_s", &VehicleModel::rotor_lag_s)
      .Field("rotor_radius", &VehicleModel::rotor_radius)
      .Field("rotor_drag", &VehicleModel::rotor_drag)
      .Field("body_drag_area", &VehicleModel::body_drag_area)
      .Field("hull_radius", &VehicleModel::hull_radius)
      .Field("hull_top", &VehicleModel::hull_top)
      .Field("hull_bottom", &VehicleModel::hull_bottom)
      .Field("foot_depth", &VehicleModel::foot_depth)
      .Field("foot_radius", &VehicleModel::foot_radius)
      .Field("foot_reach", &VehicleModel::foot_reach)
      .Field("foot_azimuths", &VehicleModel::foot_azimuths)
      .Look("hover_thrust", &VehicleModel::HoverThrust, "[N]")
      .Done();
  using estimation::PadKnowledge;
  py::class_<PadKnowledge>(m, "PadKnowledge", Doc("PadKnowledge"))
      .def_property_readonly(
          "t", [](const PadKnowledge& k) { return k.belief.t; }, "Of the belief [s].")
      .def_property_readonly(
          "motion", [](const PadKnowledge& k) { return estimation::ToString(k.belief.motion); },
          "\"velocity\", \"heading\" or \"turn\": what the belief's mean holds.")
      .def_property_readonly(
          "mean", [](const PadKnowledge& k) { return Eigen::VectorXd(k.belief.mean); },
          Doc("PadBelief::mean"))
      .def_property_readonly(
          "covariance", [](const PadKnowledge& k) { return Eigen::MatrixXd(k.belief.cov); },
          "Of the mean, shape (5, 5).")
      .def_readonly("height", &PadKnowledge::height, Doc("PadKnowledge::height"))
      .def(
          "predict",
          [](const PadKnowledge& k) {
            return std::make_shared<Prediction>(
                std::make_shared<estimation::BeliefPrediction>(k.belief, k.height, k.noise));
          },
          Doc("BeliefPrediction"));
}

}  // namespace

void BindRegistries(py::module_& m) {
  BindPartTypes(m);
  const auto names = [](const auto& registry) {
    std::vector<std::string> all;
    for (const auto& entry : registry) all.push_back(entry.name);
    return all;
  };
  py::class_<PartRegistries>(
      m, "Registries",
      "What scenarios can ask for: the parts of the library, and what `add` enters. Parts of "
      "Python fly in this process, one flight at a time.")
      .def(py::init<>())
      .def("add", &Add, "part"_a, "check"_a = true, "replace"_a = false,
           "Enters a class that derives from Term, Planner, Controller or PadPredictor. The "
           "derivatives of a term are "
           "checked at once, unless `check` is False. Raises ValueError that says what is wrong, "
           "or whose name there "
           "is already, unless `replace` is True and it was entered here.")
      .def_property_readonly(
          "backends", [=](const PartRegistries& r) { return names(r.all.backends); }, "Names.")
      .def_property_readonly(
          "terms",
          [](const PartRegistries& r) {
            std::vector<std::string> all;
            for (const auto& entry : r.all.terms) all.push_back(entry.info.name);
            return all;
          },
          "Names.")
      .def_property_readonly(
          "planners", [=](const PartRegistries& r) { return names(r.all.planners); }, "Names.")
      .def_property_readonly(
          "controllers", [=](const PartRegistries& r) { return names(r.all.controllers); },
          "Names.")
      .def_property_readonly(
          "predictors", [=](const PartRegistries& r) { return names(r.all.predictors); }, "Names.")
      .def_property_readonly(
          "pad_motions", [=](const PartRegistries& r) { return names(r.all.pad_motions); },
          "Names.")
      .def_property_readonly("term_times", &TermTimes,
                             "What terms of Python cost since they were entered, by name: `calls`, "
                             "`windows`, `wall_s`.");
}

}  // namespace touchdown::binding
