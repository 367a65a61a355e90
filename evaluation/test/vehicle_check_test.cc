// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/flight/vehicle_check.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/flight/closed_loop.h"
#include "touchdown/evaluation/program/program.h"
#include "touchdown/evaluation/scenario/registries.h"

namespace touchdown::evaluation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::string kVehicles = std::string(TOUCHDOWN_SOURCE_DIR) + "/docs/examples/vehicles/";

struct Checked {
  int status = 0;
  std::string out, err;
};

Checked Call(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "touchdown");
  Checked checked;
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  checked.status =
      RunProgram(static_cast<int>(arguments.size()), arguments.data(), StandardRegistries());
  checked.out = ::testing::internal::GetCapturedStdout();
  checked.err = ::testing::internal::GetCapturedStderr();
  return checked;
}

std::string Copied(const std::string& name, const std::string& airframe) {
  const std::string path = ::testing::TempDir() + "checked_" + name;
  std::ifstream from(kVehicles + name + ".xml");
  std::ofstream(path + ".xml") << from.rdbuf();
  std::ofstream(path + ".airframe.yaml") << airframe;
  return path + ".xml";
}

TEST(VehicleCheck, ExamplesHoverAndLand) {
  for (const std::string name : {"nano", "cargo", "hexa", "survey", "wrench"}) {
    const std::string file = kVehicles + name + ".xml";
    const VehicleCheck check = CheckVehicle(file, {}, StandardRegistries());
    EXPECT_TRUE(check.passed()) << name;
    EXPECT_EQ(check.findings.warnings().size(), name == "survey" ? 1u : 0u) << name;  // its senses
    ASSERT_TRUE(check.hover.has_value()) << name;
    EXPECT_LT(check.hover->farthest_m, 0.1) << name;
    EXPECT_GT(check.hover->greatest_tilt, 0.1) << name;  // it went somewhere
    EXPECT_GE(check.outlines.size(), 9u) << name;
    const Scenario scenario =
        ParseScenario("vehicle: " + file, name, "test", {}, StandardRegistries());
    EXPECT_TRUE(RunTrial(scenario, 1, StandardRegistries()).landed()) << name;
  }
}

TEST(VehicleCheck, AirframeFileCountsAfterTheScenario) {
  const std::string file = Copied("hexa", "rotor_lag: 0.05\nrotor_drag: 0.3\n");
  const VehicleCheck beside = CheckVehicle(file, {}, StandardRegistries());
  EXPECT_EQ(beside.model->rotor_lag_s, 0.05);
  const VehicleCheck given = CheckVehicle(file, {"airframe.rotor_lag=0.02"}, StandardRegistries());
  EXPECT_EQ(given.model->rotor_lag_s, 0.02);
  EXPECT_EQ(given.model->rotor_drag.x(), 0.3);
  // The flown vehicle is the same, and its record says so.
  const Scenario scenario = ParseScenario("vehicle: " + file, "s", "s", {}, StandardRegistries());
  EXPECT_EQ(scenario.airframe.rotor_lag, 0.05);
  EXPECT_THAT(DumpScenario(scenario), HasSubstr("rotor_lag: 0.05"));
}

TEST(VehicleCheck, AirframeFileIsReadAsScenariosAre) {
  const auto refusal = [](const std::string& airframe) -> std::string {
    try {
      CheckVehicle(Copied("hexa", airframe), {}, StandardRegistries());
    } catch (const BadInput& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(
      refusal("rotor_lag: 0.05\ndrag: 1\n"),
      AllOf(HasSubstr("checked_hexa.airframe.yaml:2"), HasSubstr("unknown key airframe.drag")));
  EXPECT_THAT(refusal("rotor_lag: 5\n"),
              AllOf(HasSubstr("airframe.yaml:1"), HasSubstr("rotor_lag")));
  EXPECT_THAT(refusal("rotor_senses: [1, 0, 1, 1, 1, 1]\n"), HasSubstr("list of 1 and -1"));
  EXPECT_THAT(refusal("- 1\n"), HasSubstr("airframe.yaml"));
}

// Cells that the hull nearly reaches used not to be given as free. No stop was in free cells, and the vehicle never
// left its start.
TEST(VehicleCheck, LargeVehiclesLeaveTheirStart) {
  const VehicleCheck check = CheckVehicle(
      kVehicles + "hexa.xml", {"airframe.hull=[0.5, -0.06, 0.08]", "airframe.feet=[0.3, 0.16]"},
      StandardRegistries());
  EXPECT_TRUE(check.passed());
}

TEST(VehicleCheck, WhatCannotBeFlownIsAFaultAmongOthers) {
  const VehicleCheck check = CheckVehicle(
      kVehicles + "hexa.xml", {"airframe.hull=[1.5, -0.06, 0.08]"}, StandardRegistries());
  ASSERT_EQ(check.findings.faults().size(), 1u);
  EXPECT_THAT(check.findings.faults()[0].what, HasSubstr("hull"));
  EXPECT_TRUE(check.model.has_value());
  EXPECT_THROW(CheckVehicle(kVehicles + "hexa.xml", {"task=land"}, StandardRegistries()), BadInput);
  EXPECT_FALSE(CheckVehicle(kVehicles, {}, StandardRegistries()).passed());  // a folder
}

// As the studies do that draw a scenario and override keys of it.
TEST(VehicleCheck, AnOverriddenVehicleBringsItsAirframe) {
  Scenario scenario;
  ApplyOverride("vehicle=" + kVehicles + "hexa.xml", StandardRegistries(), &scenario);
  EXPECT_EQ(scenario.airframe.rotor_drag, 0.384);
}

TEST(VehicleCheck, ProgramSaysWhatIsWrongAndWhatMendsIt) {
  const std::string file = Copied("wrench", "rotor_lag: 0.03\n");  // without its moments
  const Checked faulty = Call({"check-vehicle", file.c_str()});
  EXPECT_EQ(faulty.status, 2);
  EXPECT_THAT(faulty.err, AllOf(StartsWith("touchdown: fault: from hover it can be turned"),
                                HasSubstr("remedy: "), HasSubstr("airframe.moment_max")));
  EXPECT_THAT(faulty.out, Not(HasSubstr("fault")));
  const Checked good = Call(
      {"check-vehicle", file.c_str(), "--set", "airframe.moment_max=[0.4, 0.4, 0.1]", "--json"});
  EXPECT_EQ(good.status, 0);
  const auto document = nlohmann::json::parse(good.out);
  EXPECT_TRUE(document.at("passed").get<bool>());
  EXPECT_EQ(document.at("model").at("actuators").size(), 4u);
  const Checked missing = Call({"check-vehicle", "/no/such/vehicle.xml"});
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, HasSubstr("/no/such/vehicle.xml"));
}

}  // namespace
}  // namespace touchdown::evaluation
