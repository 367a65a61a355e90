// SPDX-License-Identifier: BSD-3-Clause
// The hover is a flight like any other: to a goal beside the start, and then there for five seconds. What holds there is
// what will fly.

#include "evaluation/flight/vehicle_check.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "estimation/base/degrees.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/vehicle/vehicle_file.h"
#include "sim/vehicle/vehicle_import.h"
#include "sim/vehicle/vehicle_outline.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kHoverTime = 5.0;  // [s]
constexpr double kSettling = 1.0;   // from 0.15 m off, where the task's time begins [s]

// MuJoCo's own words may have several lines.
std::string OneLine(std::string text) {
  text.erase(text.find_last_not_of(" \n.") + 1);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

void Read(const Scenario& scenario, VehicleCheck* check) {
  try {
    const std::string mjcf =
        scenario.vehicle == "default"
            ? sim::DefaultVehicleMjcf()
            : sim::ImportVehicle(scenario.vehicle, AirframeOf(scenario), &check->findings);
    if (scenario.vehicle != "default") check->outlines = sim::VehicleOutlines(scenario.vehicle);
    if (mjcf.empty()) return;
    check->model = sim::ReadVehicleModel(mjcf, &check->findings);
  } catch (const std::invalid_argument& error) {
    check->findings.Fault(OneLine(error.what()), "look at the path and at the file's text");
  }
}

HoverCheck Hover(const std::string& file, const std::vector<std::string>& overrides,
                 const Registries& registries) {
  // In JSON's notation, which is YAML, any path is a text.
  const std::string text = "vehicle: " + Json(file).dump() +
                           "\ntask: go_to\nstart: {position: [-1, 0, 3], yaw_deg: 60}\n"
                           "go_to: {goal: [0, 0, 3], time: " +
                           std::to_string(kSettling + kHoverTime) + "}\ntimeout: 20\n";
  const Scenario scenario = ParseScenario(text, "hover", "check-vehicle", overrides, registries);
  TrialRecord record;
  const TrialResult result = RunTrial(scenario, scenario.seed, registries, &record);
  HoverCheck hover;
  hover.held = result.succeeded();
  hover.outcome = ToString(result.outcome);
  hover.seconds = result.simulated_s;
  for (const RecordSample& sample : record.samples) {
    hover.greatest_tilt = std::max(hover.greatest_tilt, estimation::Tilt(sample.vehicle.q_WB));
    if (sample.t < hover.seconds - kHoverTime) continue;
    hover.farthest_m =
        std::max(hover.farthest_m, (sample.vehicle.p_WB - scenario.go_to.goal).norm());
  }
  return hover;
}

template <class Matrix>
Json Numbers(const Matrix& m) {
  Json numbers = Json::array();
  for (const double value : m.reshaped()) numbers.push_back(value);
  return numbers;
}

Json ModelJson(const estimation::VehicleModel& model) {
  const estimation::Allocation allocation = estimation::AllocationOf(model);
  Json actuators = Json::array();
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const estimation::Actuator& a = model.actuators[i];
    actuators.push_back(
        {{"p_BR", Numbers(a.p_BR)},
         {"thrust", a.thrust},
         {"moment_B", Numbers(a.moment_B)},
         {"range", {a.min, a.max}},
         {"hover", allocation.Shares()(static_cast<Eigen::Index>(i)) * model.HoverThrust()}});
  }
  return {
      {"mass_kg", model.mass_kg},
      {"moments_of_inertia", Numbers(model.inertia)},
      {"axes_of_inertia",
       {Numbers(model.R_BI.col(0)), Numbers(model.R_BI.col(1)), Numbers(model.R_BI.col(2))}},
      {"actuators", actuators},
      {"rotor_lag_s", model.rotor_lag_s},
      {"rotor_radius_m", model.rotor_radius},
      {"rotor_drag", Numbers(model.rotor_drag)},
      {"body_drag_area", model.body_drag_area},
      {"thrust_to_weight", allocation.thrust_max / model.HoverThrust()},
      {"hover_turn", Numbers(estimation::HoverTurn(model))},
      {"hull",
       {{"radius", model.hull_radius}, {"top", model.hull_top}, {"bottom", -model.hull_bottom}}},
      {"feet",
       {{"radius", model.foot_radius},
        {"bottom", -model.foot_depth},
        {"azimuths", model.foot_azimuths}}}};
}

Json FindingsJson(const std::vector<sim::VehicleFinding>& findings) {
  Json list = Json::array();
  for (const sim::VehicleFinding& f : findings) {
    list.push_back({{"what", f.what}, {"remedy", f.remedy}});
  }
  return list;
}

}  // namespace

VehicleCheck CheckVehicle(const std::string& file, const std::vector<std::string>& overrides,
                          const Registries& registries) {
  for (const std::string& text : overrides) {
    for (const char* own : {"vehicle", "task", "go_to", "start", "pad", "timeout", "seed"}) {
      const std::string key = text.substr(0, text.find_first_of("=."));
      if (key == own)
        throw BadInput(fmt::format("--set {}: check-vehicle sets {} itself.", text, own));
    }
  }
  VehicleCheck check;
  check.file = file;
  check.airframe_file = AirframeFile(file);
  Read(UncheckedVehicleScenario(file, overrides, registries), &check);
  if (!check.model) return check;
  try {
    check.hover = Hover(file, overrides, registries);
  } catch (const BadInput& error) {
    check.findings.Fault(OneLine(error.what()), "look at the hull and at the keys that were set");
  }
  return check;
}

Json VehicleCheckJson(const VehicleCheck& check) {
  Json document = {{"file", check.file},
                   {"airframe_file", check.airframe_file},
                   {"passed", check.passed()},
                   {"faults", FindingsJson(check.findings.faults())},
                   {"warnings", FindingsJson(check.findings.warnings())},
                   {"model", nullptr},
                   {"hover", nullptr},
                   {"outlines", Json::array()}};
  if (check.model) document["model"] = ModelJson(*check.model);
  if (check.hover) {
    document["hover"] = {
        {"held", check.hover->held},
        {"outcome", check.hover->outcome},
        {"seconds", check.hover->seconds},
        {"farthest_m", check.hover->farthest_m},
        {"greatest_tilt_deg", check.hover->greatest_tilt * estimation::kDegPerRad}};
  }
  for (const auto& outline : check.outlines) {
    Json points = Json::array();
    for (const Eigen::Vector3d& p : outline) points.push_back(Numbers(p));
    document["outlines"].push_back(points);
  }
  return document;
}

}  // namespace touchdown::evaluation
