// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/vehicle_file.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/test/scenes.h"

namespace touchdown::sim {
namespace {

using test::MessageOf;
using ::testing::HasSubstr;

// The default's text with `from` replaced by `to` where it first stands.
std::string Changed(const std::string& from, const std::string& to) {
  std::string text = DefaultVehicleMjcf();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return text;
}

std::string Refusal(const std::string& from, const std::string& to) {
  return MessageOf<std::invalid_argument>([&] { LoadVehicleModel(Changed(from, to)); });
}

TEST(VehicleFile, ModelIsWhatTheFileSays) {
  const estimation::VehicleModel model = LoadVehicleModel(DefaultVehicleMjcf());
  EXPECT_DOUBLE_EQ(model.mass_kg, 1.18);
  EXPECT_TRUE(model.inertia.isApprox(Eigen::Vector3d(0.010, 0.010, 0.018), 1e-12));
  const std::array<Eigen::Vector3d, 4> hubs = {
      {{0.12, 0.12, 0.04}, {-0.12, 0.12, 0.04}, {-0.12, -0.12, 0.04}, {0.12, -0.12, 0.04}}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(model.actuators[i].p_BR.isApprox(hubs[i], 1e-12));
    EXPECT_EQ(model.actuators[i].moment_B.z(), i % 2 == 0 ? 0.016 : -0.016);
    EXPECT_EQ(model.actuators[i].min, 0.0);
    EXPECT_EQ(model.actuators[i].max, 7.0);
  }
  EXPECT_EQ(model.rotor_lag_s, 0.035);
  EXPECT_TRUE(model.rotor_drag.isApprox(Eigen::Vector3d(0.19, 0.19, 0.0)));
  EXPECT_EQ(model.body_drag_area, 0.03);
  EXPECT_DOUBLE_EQ(model.hull_radius, 0.30);
  EXPECT_DOUBLE_EQ(model.hull_top, 0.08);
  EXPECT_DOUBLE_EQ(model.foot_depth, 0.12);
  EXPECT_NEAR(model.foot_radius, 0.16, 1e-6);
  EXPECT_NEAR(model.foot_reach, std::hypot(0.16, 0.105) + 0.015, 1e-6);
}

TEST(VehicleFile, ChangesInTheFileAreRead) {
  EXPECT_EQ(LoadVehicleModel(Changed("mass=\"1.18\"", "mass=\"1.5\"")).mass_kg, 1.5);
  EXPECT_EQ(LoadVehicleModel(Changed("pos=\" 0.12  0.12 0.04\"", "pos=\" 0.13  0.12 0.04\""))
                .actuators[0]
                .p_BR.x(),
            0.13);
}

TEST(VehicleFile, EmbeddedTextIsTheFile) {
  const std::string path = std::string(TOUCHDOWN_SOURCE_DIR) + "/sim/models/quadrotor.xml";
  EXPECT_EQ(ReadVehicleFile(path), DefaultVehicleMjcf());
}

TEST(VehicleFile, RefusesWhatIsMissingOrDifferent) {
  EXPECT_THAT(Refusal("<geom name=\"hull\"", "<geom name=\"shell\""), HasSubstr("\"hull\""));
  EXPECT_THAT(Refusal("<body name=\"vehicle\"", "<body name=\"drone\""), HasSubstr("\"vehicle\""));
  EXPECT_THAT(Refusal("<site name=\"rotor2\"", "<site name=\"rotor7\""), HasSubstr("rotor2"));
  EXPECT_THAT(Refusal("gear=\"0 0 1 0 0  0.016\"", "gear=\"0 1 1 0 0  0.016\""), HasSubstr("gear"));
  EXPECT_THAT(Refusal("dynprm=\"0.035\"", "dynprm=\"0.04\""),
              HasSubstr("differs from that of rotor0"));
  EXPECT_THAT(Refusal("dynprm=\"0.035\"", "dynprm=\"0\""),
              HasSubstr("lag of rotor0 is 0 s: allowed is 0.005 to 1 s"));
  EXPECT_THAT(Refusal("<inertial pos=\"0 0 0\"", "<inertial pos=\"0.01 0 0\""),
              HasSubstr("<inertial>"));
  EXPECT_THAT(Refusal("mass=\"1.18\"", "mass=\"4\""),
              HasSubstr("does not carry its weight 1.2 times"));
  EXPECT_THAT(Refusal("gear=\"0 0 1 0 0  0.016\"", "gear=\"0 0 1 0 0 -0.016\""),
              HasSubstr("thrust and three moments"));
  EXPECT_THAT(Refusal("\"body_drag_area\"", "\"drag_area\""), HasSubstr("body_drag_area"));
  EXPECT_THAT(Refusal("name=\"foot0\"", "name=\"toe0\""), ::testing::IsEmpty());
  EXPECT_THAT(Refusal("0.113137  0.113137 -0.105", "0.113137  0.113137 -0.1"),
              HasSubstr("they must reach down equally far"));
  EXPECT_THAT(Refusal("mass=\"1.18\"", "mass=\"heavy\""), HasSubstr("MJCF"));
}

TEST(VehicleFile, MissingFileIsNamed) {
  EXPECT_THAT(MessageOf<std::invalid_argument>([] { ReadVehicleFile("/no/such/vehicle.xml"); }),
              HasSubstr("/no/such/vehicle.xml"));
}

}  // namespace
}  // namespace touchdown::sim
