// SPDX-License-Identifier: BSD-3-Clause
// touchdown check-vehicle: faults of a vehicle's file, its parameters, and whether it hovers.
#include <fstream>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "estimation/base/degrees.h"
#include "evaluation/base/output_path.h"
#include "evaluation/base/words.h"
#include "evaluation/flight/vehicle_check.h"
#include "evaluation/program/commands.h"
#include "evaluation/report/report_program.h"

namespace touchdown::evaluation {
namespace {

struct CheckVehicleArguments {
  std::string file;
  std::vector<std::string> set;
  std::string picture;
  bool json = false;
};

std::string ModelText(const estimation::VehicleModel& model) {
  const estimation::Allocation allocation = estimation::AllocationOf(model);
  const Eigen::Vector3d turn = estimation::HoverTurn(model);
  Eigen::Matrix3d inertia_B = model.R_BI * model.inertia.asDiagonal() * model.R_BI.transpose();
  const double product =
      (inertia_B - Eigen::Matrix3d(inertia_B.diagonal().asDiagonal())).cwiseAbs().maxCoeff();
  std::string text = fmt::format(
      "  mass                 {:.4g} kg, lag of the rotors {:.4g} s\n"
      "  inertia              {:.4g}, {:.4g}, {:.4g} kg m^2 about x, y, z, products up to {:.2g}\n"
      "  thrust               {:.2f} times the weight\n"
      "  turns from hover by  {:.4g}, {:.4g}, {:.4g} rad/s^2 about x, y, z\n"
      "  hull                 radius {:.4g} m, from {:.4g} to {:.4g} m; soles at {:.4g} m\n"
      "  drag                 {:.4g} N s/m, {:.4g} m^2\n",
      model.mass_kg, model.rotor_lag_s, inertia_B(0, 0), inertia_B(1, 1), inertia_B(2, 2), product,
      allocation.thrust_max / model.HoverThrust(), turn.x(), turn.y(), turn.z(), model.hull_radius,
      -model.hull_bottom, model.hull_top, -model.foot_depth, model.rotor_drag.x(),
      model.body_drag_area);
  for (std::size_t i = 0; i < model.actuators.size(); ++i) {
    const estimation::Actuator& a = model.actuators[i];
    if (a.thrust == 0.0) {
      text += fmt::format(
          "  actuator {}           moment {:.4g} to {:.4g} N m about ({:.3g}, {:.3g}, {:.3g})\n", i,
          a.min, a.max, a.moment_B.x(), a.moment_B.y(), a.moment_B.z());
      continue;
    }
    text += fmt::format(
        "  actuator {}           {:.4g} to {:.4g} N at ({:.3g}, {:.3g}, {:.3g}) m, torque {:+.3g} "
        "m\n",
        i, a.min, a.max, a.p_BR.x(), a.p_BR.y(), a.p_BR.z(), a.moment_B.z());
  }
  return text;
}

std::string Text(const VehicleCheck& check) {
  std::string text;
  for (const sim::VehicleFinding& f : check.findings.warnings()) {
    text += fmt::format("warning: {}\n  remedy: {}\n", f.what, f.remedy);
  }
  if (check.model) {
    text += fmt::format("{}\n  airframe file        {}\n", check.file,
                        check.airframe_file.empty() ? "none beside it" : check.airframe_file);
    text += ModelText(*check.model);
  }
  if (check.hover) {
    text += fmt::format(
        "  a metre, then hover  {} after {:.1f} s: {:.3f} m off at most, {:.1f} deg of tilt on the "
        "way\n",
        check.hover->held ? "held" : check.hover->outcome, check.hover->seconds,
        check.hover->farthest_m, check.hover->greatest_tilt * estimation::kDegPerRad);
  }
  return text;
}

int CheckVehicleFile(const CheckVehicleArguments& arguments, const Registries& registries) {
  if (!arguments.picture.empty()) CheckPicturePath("--picture", arguments.picture);
  const VehicleCheck check = CheckVehicle(arguments.file, arguments.set, registries);
  if (arguments.json) {
    std::cout << VehicleCheckJson(check).dump(2) << std::endl;
  } else {
    std::cout << Text(check) << std::flush;
  }
  for (const sim::VehicleFinding& fault : check.findings.faults()) {
    spdlog::error("fault: {}; remedy: {}", InOneLine(fault.what), InOneLine(fault.remedy));
  }
  if (!arguments.picture.empty() && check.model) {
    const auto write = [&](const std::string& path) {
      std::ofstream(path) << VehicleCheckJson(check).dump();
    };
    DrawFrom("", arguments.picture, write, DrawVehicle);
  }
  if (!check.findings.faults().empty()) return kBadInput;
  return check.passed() ? kDone : kFellShort;
}

}  // namespace

void AddCheckVehicleCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command command = app.AddCommand(
      "check-vehicle", "Check a vehicle's file, draw it and fly a test hover", "vehicles.md");
  const auto arguments = std::make_shared<CheckVehicleArguments>();
  command.Add("FILE", arguments->file, "MJCF file, or default").Required();
  command.Add("--set", arguments->set, "Change a key of the scenario; may be given again")
      .TypeName("KEY=VALUE")
      .OneWord();
  command.AddFile("--picture", &arguments->picture,
                  "Draw it with hull, rotors and axes; an older file is overwritten", "F.png");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.OnChosen([arguments, &registries, run] {
    *run = [arguments, &registries] { return CheckVehicleFile(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
