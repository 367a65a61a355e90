// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/vehicle_import.h"

#include <cmath>
#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/test/scenes.h"
#include "sim/vehicle/vehicle_file.h"
#include "sim/world/world.h"

namespace touchdown::sim {
namespace {

using ::testing::HasSubstr;

const std::string kModels = std::string(TOUCHDOWN_SOURCE_DIR) + "/sim/models/";
const std::string kExamples = std::string(TOUCHDOWN_SOURCE_DIR) + "/docs/examples/vehicles/";

estimation::VehicleModel Imported(const std::string& file, const AirframeExtras& extras = {}) {
  return LoadVehicleModel(ImportVehicle(kModels + file, extras));
}

// Path of the model mini with `from` replaced by `to`.
std::string ChangedMini(const std::string& from, const std::string& to) {
  std::string text = ReadVehicleFile(kModels + "mini.xml");
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  const std::string path = ::testing::TempDir() + "changed_mini.xml";
  std::ofstream(path) << text;
  return path;
}

// The message for that.
std::string Refusal(const std::string& from, const std::string& to) {
  const std::string path = ChangedMini(from, to);
  return test::MessageOf<std::invalid_argument>([&] { LoadVehicleModel(ImportVehicle(path, {})); });
}

TEST(VehicleImport, OwnFormStaysAsItIs) {
  EXPECT_EQ(ImportVehicle(kModels + "quadrotor.xml", {}), DefaultVehicleMjcf());
  EXPECT_TRUE(IsInOwnForm(kModels + "quadrotor.xml"));
  EXPECT_FALSE(IsInOwnForm(kModels + "mini.xml"));
}

TEST(VehicleImport, MiniIsReadAboutItsCentreOfMass) {
  const estimation::VehicleModel model = Imported("mini.xml");
  EXPECT_NEAR(model.mass_kg, 0.030, 1e-12);
  EXPECT_TRUE(model.inertia.isApprox(Eigen::Vector3d(1.6e-5, 1.7e-5, 2.9e-5), 1e-9));
  const std::array<Eigen::Vector3d, 4> hubs = {{{0.031, -0.033, 0.007},
                                                {-0.035, -0.033, 0.007},
                                                {-0.035, 0.033, 0.007},
                                                {0.031, 0.033, 0.007}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const estimation::Actuator& rotor = model.actuators[i];
    EXPECT_TRUE(rotor.p_BR.isApprox(hubs[i], 1e-9)) << i;
    EXPECT_TRUE(
        rotor.moment_B.isApprox(Eigen::Vector3d(0.0, 0.0, i % 2 == 0 ? -0.006 : 0.006), 1e-9));
    EXPECT_EQ(rotor.min, 0.0);
    EXPECT_NEAR(rotor.max, 0.17, 1e-12);
  }
  EXPECT_EQ(model.rotor_lag_s, 0.03);
  // The plate's corners, 2 mm off the centre of mass; the battery below.
  EXPECT_NEAR(model.hull_radius, std::hypot(0.047, 0.045), 1e-6);
  EXPECT_NEAR(model.hull_top, 0.007, 1e-6);
  // From the battery's lower face on; the feet reach below it.
  EXPECT_NEAR(model.hull_bottom, 0.008 + 0.005, 1e-6);
  EXPECT_NEAR(model.foot_depth, 0.013 + 0.35 * 0.6 * model.hull_radius, 1e-6);
  EXPECT_EQ(model.rotor_drag, Eigen::Vector3d::Zero());
}

TEST(VehicleImport, CarrierIsPutTogether) {
  const estimation::VehicleModel model = Imported("carrier.xml");
  EXPECT_NEAR(model.mass_kg, 1.30, 1e-12);
  const double height = (-0.03 * 0.32 + 0.02 * 0.28) / 1.3;  // of the centre of mass
  const double low = 0.7 * height * height + 0.32 * std::pow(-0.03 - height, 2) +
                     0.28 * std::pow(0.02 - height, 2);
  EXPECT_NEAR(model.inertia.x(), 0.0030 + 0.0002 + 2 * 0.0028 + low, 1e-9);
  EXPECT_NEAR(model.inertia.y(), 0.0034 + 0.0005 + 2 * 0.0001 + low + 0.28 * 0.14 * 0.14, 1e-9);
  EXPECT_NEAR(model.inertia.z(), 0.0050 + 0.0006 + 2 * 0.0028 + 0.28 * 0.14 * 0.14, 1e-9);
  // The boom at the back is turned about.
  EXPECT_TRUE(model.actuators[0].p_BR.isApprox(Eigen::Vector3d(-0.14, 0.18, 0.04 - height), 1e-9));
  EXPECT_TRUE(model.actuators[1].p_BR.isApprox(Eigen::Vector3d(-0.14, -0.18, 0.04 - height), 1e-9));
  EXPECT_NEAR(model.hull_bottom, 0.11 + height, 1e-6);  // the frame's legs
  EXPECT_NEAR(model.foot_depth, 0.11 + height + 0.35 * 0.6 * model.hull_radius, 1e-6);
  EXPECT_GT(model.hull_radius, std::hypot(0.14, 0.18));
}

TEST(VehicleImport, WhatTheFileDoesNotSayIsTheCallers) {
  AirframeExtras extras;
  extras.rotor_lag = 0.05;
  extras.rotor_drag = 0.02;
  extras.body_drag_area = 0.003;
  extras.hull = {0.08, -0.01, 0.03};
  extras.feet = {0.04, 0.03};
  const estimation::VehicleModel model = Imported("mini.xml", extras);
  EXPECT_EQ(model.rotor_lag_s, 0.05);
  EXPECT_TRUE(model.rotor_drag.isApprox(Eigen::Vector3d(0.02, 0.02, 0.0)));
  EXPECT_EQ(model.body_drag_area, 0.003);
  EXPECT_NEAR(model.hull_radius, 0.08, 1e-12);
  EXPECT_NEAR(model.hull_top, 0.03, 1e-12);
  EXPECT_NEAR(model.foot_radius, 0.04, 1e-12);
  EXPECT_NEAR(model.foot_depth, 0.03, 1e-12);
}

// The force is limited before the gear, as the control is: 0.8 of 0.17 N.
TEST(VehicleImport, ThrustKeepsEveryRangeOfTheActuator) {
  const auto limited = [](const std::string& attributes) {
    const std::string path =
        ChangedMini("<motor ctrlrange=\"0 1\"/>", "<motor ctrlrange=\"0 1\" " + attributes + "/>");
    return LoadVehicleModel(ImportVehicle(path, {}));
  };
  EXPECT_NEAR(limited("forcerange=\"0.1 0.8\"").actuators[0].max, 0.136, 1e-12);
  EXPECT_NEAR(limited("forcerange=\"0.1 0.8\"").actuators[0].min, 0.017, 1e-12);
  EXPECT_NEAR(limited("forcerange=\"0 7\"").actuators[0].max, 0.17, 1e-12);
  EXPECT_NEAR(limited("forcelimited=\"false\" forcerange=\"0 0.8\"").actuators[0].max, 0.17, 1e-12);
}

TEST(VehicleImport, HoversInTheWorld) {
  for (const char* file : {"mini.xml", "carrier.xml"}) {
    WorldConfig config = test::OpenSky();
    config.vehicle_mjcf = ImportVehicle(kModels + file, {});
    World world(config);
    const Eigen::Vector3d start = world.vehicle().p_WB;
    // Each rotor's share in pure thrust, which they have at the start: moments cancel.
    const estimation::Commands thrusts =
        estimation::AllocationOf(world.model()).Shares() * world.model().HoverThrust();
    EXPECT_TRUE(world.rotor_thrusts().isApprox(thrusts, 1e-12));
    for (int i = 0; i < 60; ++i) world.Step(thrusts);
    EXPECT_LT((world.vehicle().p_WB - start).norm(), 3e-3) << file;
    EXPECT_LT(world.vehicle().w_WB_B.norm(), 0.02) << file;
  }
}

// The tensor about the centre of mass, in the body's axes, comes through whole.
TEST(VehicleImport, InertiaMayBeAboutAnyAxes) {
  const std::string path =
      ChangedMini("diaginertia=\"1.6e-5 1.7e-5 2.9e-5\"",
                  "fullinertia=\"1.6e-5 1.7e-5 2.9e-5 0.3e-5 -0.2e-5 0.1e-5\"");
  const estimation::VehicleModel model = LoadVehicleModel(ImportVehicle(path, {}));
  Eigen::Matrix3d inertia;
  inertia << 1.6e-5, 0.3e-5, -0.2e-5, 0.3e-5, 1.7e-5, 0.1e-5, -0.2e-5, 0.1e-5, 2.9e-5;
  const Eigen::Vector3d axis(0.3, -0.5, 0.7);
  EXPECT_TRUE(model.MomentFor(axis).isApprox(inertia * axis, 1e-6));
  EXPECT_TRUE(model.AccelerationUnder(inertia * axis).isApprox(axis, 1e-6));
  // The physics turns it so, too.
  WorldConfig config = test::OpenSky();
  config.vehicle_mjcf = ImportVehicle(path, {});
  World world(config);
  const estimation::Allocation allocation = estimation::AllocationOf(model);
  Eigen::Vector4d wrench(model.HoverThrust(), 1e-5, 0.0, 0.0);
  const estimation::Commands thrusts = allocation.commands_of_wrench * wrench;
  while (world.time() < 0.3) world.Step(thrusts);  // the lag is over
  const Eigen::Vector3d w = world.vehicle().w_WB_B;
  const Eigen::Vector3d expected = model.AccelerationUnder(
      allocation.wrench_of_commands.bottomRows<3>() * world.rotor_thrusts() -
      model.GyroscopicMoment(w));
  world.Step(thrusts);
  EXPECT_TRUE(((world.vehicle().w_WB_B - w) / world.timestep()).isApprox(expected, 0.01));
}

TEST(VehicleImport, RotorsMayBeSix) {
  const std::string mjcf = ImportVehicle(kExamples + "hexa.xml", {});
  const estimation::VehicleModel model = LoadVehicleModel(mjcf);
  ASSERT_EQ(model.actuators.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(model.actuators[i].thrust, 1.0);
    EXPECT_EQ(model.actuators[i].moment_B.z() > 0.0, i % 2 == 0);
  }
  WorldConfig config = test::OpenSky();
  config.vehicle_mjcf = mjcf;
  World world(config);
  const estimation::VehicleState start = world.vehicle();
  const estimation::Commands thrusts =
      estimation::AllocationOf(model).Shares() * model.HoverThrust();
  for (int i = 0; i < 500; ++i) world.Step(thrusts);
  EXPECT_LT((world.vehicle().p_WB - start.p_WB).norm(), 1e-3);
}

// Gears of -1 reverse the moments. The caller sets how large each can be.
TEST(VehicleImport, OneThrustAndThreeMomentsAreAVehicle) {
  AirframeExtras extras;
  EXPECT_THAT(test::MessageOf<std::invalid_argument>(
                  [&] { LoadVehicleModel(ImportVehicle(kExamples + "wrench.xml", extras)); }),
              HasSubstr("airframe.moment_max"));
  extras.moment_max = {0.4, 0.5, 0.1};
  const std::string mjcf = ImportVehicle(kExamples + "wrench.xml", extras);
  const estimation::VehicleModel model = LoadVehicleModel(mjcf);
  ASSERT_EQ(model.actuators.size(), 4u);
  EXPECT_EQ(model.actuators[0].thrust, 1.0);
  for (int axis = 0; axis < 3; ++axis) {
    const estimation::Actuator& moment = model.actuators[static_cast<std::size_t>(axis) + 1];
    EXPECT_EQ(moment.thrust, 0.0);
    EXPECT_TRUE(moment.moment_B.isApprox(-Eigen::Vector3d::Unit(axis)));
    EXPECT_EQ(moment.max, extras.moment_max(axis));
    EXPECT_EQ(moment.min, -extras.moment_max(axis));
  }
  WorldConfig config = test::OpenSky();
  config.vehicle_mjcf = mjcf;
  World world(config);
  for (int i = 0; i < 100; ++i) {
    world.Step(Eigen::Vector4d(model.HoverThrust(), -0.01, 0.0, 0.0));  // a moment of 0.01 about x
  }
  EXPECT_GT(world.vehicle().w_WB_B.x(), 0.3);
  EXPECT_LT(world.vehicle().w_WB_B.tail<2>().norm(), 1e-6);
}

TEST(VehicleImport, SensesOfRotationCanBeGiven) {
  const std::string path =
      ChangedMini("0 0 0.17 0 0 -0.00102\"/>\n    <motor class=\"mini\" name=\"m2\"",
                  "0 0 0.17 0 0 0.00102\"/>\n    <motor class=\"mini\" name=\"m2\"");
  AirframeExtras extras;
  extras.alternate_senses = true;
  VehicleFindings findings;
  const auto signs = [](const estimation::VehicleModel& model) {
    std::vector<double> found;
    for (const estimation::Actuator& rotor : model.actuators) {
      found.push_back(std::copysign(1.0, rotor.moment_B.z()));
    }
    return found;
  };
  const std::vector<double> alternating = {1.0, -1.0, 1.0,
                                           -1.0};  // as the first one of the file is
  EXPECT_EQ(signs(LoadVehicleModel(ImportVehicle(path, extras, &findings))), alternating);
  ASSERT_EQ(findings.warnings().size(), 1u);
  EXPECT_THAT(findings.warnings()[0].remedy, HasSubstr("[1, -1, 1, -1]"));
  // A file that can steer is left alone.
  VehicleFindings none;
  EXPECT_EQ(signs(LoadVehicleModel(ImportVehicle(kModels + "mini.xml", extras, &none))),
            std::vector<double>({-1.0, 1.0, -1.0, 1.0}));
  EXPECT_TRUE(none.warnings().empty());
  extras.alternate_senses = false;
  extras.rotor_senses = {-1.0, 1.0, -1.0, 1.0};
  EXPECT_EQ(signs(LoadVehicleModel(ImportVehicle(path, extras))), extras.rotor_senses);
  extras.rotor_senses = {1.0, -1.0};
  EXPECT_THAT(test::MessageOf<std::invalid_argument>([&] { ImportVehicle(path, extras); }),
              HasSubstr("2 senses, the vehicle 4 rotors"));
}

// Hubs that are not quite square make a little yaw, even with senses that cannot. It is too little.
TEST(VehicleImport, SensesThatHardlySteerAreCorrectedToo) {
  const std::string path =
      ChangedMini("pos=\" 0.033 -0.033 0.012\"", "pos=\" 0.0335 -0.0325 0.012\"");
  std::string text = ReadVehicleFile(path);
  const std::string first = "-0.00102\"/>\n    <motor class=\"mini\" name=\"m2\"";
  text.replace(text.find(first), 8, "0.00102");
  const std::string last = "0 0 0.17 0 0 0.00102\"/>\n  </actuator>";
  text.replace(text.find(last), last.size(), "0 0 0.17 0 0 -0.00102\"/>\n  </actuator>");
  std::ofstream(path) << text;
  EXPECT_THAT(
      test::MessageOf<std::invalid_argument>([&] { LoadVehicleModel(ImportVehicle(path, {})); }),
      HasSubstr("senses of rotation"));
  AirframeExtras extras;
  extras.alternate_senses = true;
  EXPECT_GT(estimation::HoverTurn(LoadVehicleModel(ImportVehicle(path, extras))).z(), 5.0);
}

// In the words of the user's file, not of the text that is made from it.
TEST(VehicleImport, FaultsSpeakOfTheFileAndTheAirframe) {
  const auto said = [](const AirframeExtras& extras) {
    return test::MessageOf<std::invalid_argument>(
        [&] { LoadVehicleModel(ImportVehicle(kModels + "mini.xml", extras)); });
  };
  AirframeExtras feet, hull, moments;
  feet.feet = {0.065, 0.03};
  EXPECT_THAT(said(feet), HasSubstr("airframe.feet"));
  hull.hull = {6.0, -0.1, 0.1};
  EXPECT_THAT(said(hull), HasSubstr("airframe.hull"));
  moments.moment_max = {1.0, 1.0, 1.0};
  EXPECT_THAT(said(moments), HasSubstr("airframe.moment_max has no effect"));
  EXPECT_THAT(Refusal("0 0 0.17 0 0 -0.00102", "0 0 0.17 0 0 0"),
              HasSubstr("actuator \"m1\" has no reaction torque"));
}

TEST(VehicleImport, AllFaultsAreSaidAtOnce) {
  const std::string path = ChangedMini("<freejoint/>", "<joint type=\"free\" damping=\"0.1\"/>");
  std::string text = ReadVehicleFile(path);
  const std::string site = "<site name=\"back_left\"",
                    gear = "0 0 0.17 0 0 0.00102\"/>\n  </actuator>";
  text.replace(text.find(site), site.size(), "<site euler=\"0 30 0\" name=\"back_left\"");
  text.replace(text.find(gear), gear.size(), "0 0 -0.17 0 0 0.00102\"/>\n  </actuator>");
  std::ofstream(path) << text;
  const std::string all = test::MessageOf<std::invalid_argument>([&] { ImportVehicle(path, {}); });
  EXPECT_THAT(all, ::testing::AllOf(HasSubstr("3 faults"), HasSubstr("(1) joint 0 has damping"),
                                    HasSubstr("(2) actuator \"m3\" does not push"),
                                    HasSubstr("(3) actuator \"m4\" pushes with -0.17")));
}

TEST(VehicleImport, RefusesWhatCannotBeFlown) {
  EXPECT_THAT(Refusal("<freejoint/>", ""), HasSubstr("0 free joints"));
  EXPECT_THAT(Refusal("<freejoint/>", "<joint name=\"lift\" type=\"slide\"/>"),
              HasSubstr("joint \"lift\" moves"));
  EXPECT_THAT(Refusal("<motor class=\"mini\" name=\"m4\" site=\"front_left\" gear=\"0 0 0.17 0 0 "
                      "0.00102\"/>",
                      ""),
              HasSubstr("it has 3 actuators: allowed are 4 to 8"));
  EXPECT_THAT(Refusal("gear=\"0 0 0.17 0 0 -0.00102\"", "gear=\"0.1 0 0.17 0 0 -0.00102\""),
              HasSubstr("actuator \"m1\" does not push along the z axis"));
  EXPECT_THAT(Refusal("0 0 0.17 0 0 -0.00102", "0 0 -0.17 0 0 -0.00102"),
              HasSubstr("allowed is a range above 0"));
  EXPECT_THAT(Refusal("0 0 0.17 0 0 -0.00102", "0 0 0.17 0 0 0.00102"),
              HasSubstr("thrust and three moments"));
  EXPECT_THAT(Refusal("<site name=\"back_left\"", "<site euler=\"0 10 0\" name=\"back_left\""),
              HasSubstr("actuator \"m3\" does not push along the z axis"));
  EXPECT_THAT(Refusal("name=\"m1\"", "name=\"m1\" refsite=\"back_left\""),
              HasSubstr("actuator \"m1\" has a refsite"));
  for (const std::string has : {"damping", "armature", "frictionloss", "stiffness"}) {
    EXPECT_THAT(Refusal("<freejoint/>", "<joint type=\"free\" " + has + "=\"0.01\"/>"),
                HasSubstr("joint 0 has " + has))
        << has;
  }
  EXPECT_THAT(Refusal("ctrlrange=\"0 1\"", "gear=\"1\""), HasSubstr("has no ctrlrange"));
  EXPECT_THAT(Refusal("mass=\"0.030\"", "mass=\"0.066\""), HasSubstr("carry its weight"));
  EXPECT_THAT(Refusal("mass=\"0.030\"", "mass=\"light\""), HasSubstr("MJCF"));
  EXPECT_THAT(
      test::MessageOf<std::invalid_argument>([] { ImportVehicle("/no/such/vehicle.xml", {}); }),
      HasSubstr("/no/such/vehicle.xml"));
}

}  // namespace
}  // namespace touchdown::sim
