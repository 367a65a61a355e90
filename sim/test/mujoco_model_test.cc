// SPDX-License-Identifier: BSD-3-Clause
#include "sim/mujoco/mujoco_model.h"

#include <mujoco/mujoco.h>

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/test/scenes.h"
#include "sim/vehicle/vehicle_file.h"
#include "sim/world/world_mjcf.h"

namespace touchdown::sim {
namespace {

using test::MessageOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(MujocoModel, BadMjcfIsASentence) {
  EXPECT_THAT(MessageOf<std::invalid_argument>([] { CompileMjcf("<mujoco><worldbdy/></mujoco>"); }),
              AllOf(HasSubstr("MJCF"), HasSubstr("worldbdy"), HasSubstr("line 1")));
  EXPECT_THROW(CompileMjcf("no xml at all"), std::invalid_argument);
  EXPECT_THROW(CompileMjcf(""), std::invalid_argument);
  // An error of the compiler, not of the parser: it has its own way of reporting.
  EXPECT_THAT(MessageOf<std::invalid_argument>([] {
                CompileMjcf("<mujoco><worldbody><body><freejoint/></body></worldbody></mujoco>");
              }),
              HasSubstr("mass"));
}

TEST(WorldMjcf, HasTheMeasuredSettingsWhateverTheVehicleSays) {
  std::string vehicle = DefaultVehicleMjcf();
  const std::string open = "<mujoco model=\"touchdown quadrotor\">";
  vehicle.replace(vehicle.find(open), open.size(),
                  open +
                      "<compiler angle='degree'/><option timestep='0.01' integrator='RK4' "
                      "density='1.2' cone='pyramidal'/>");
  WorldConfig config = test::OpenSky();
  config.obstacles = ObstacleField({Box{{0.0, 8.0, 1.0}, {1.0, 2.0, 1.0}, 0.5}});
  const MujocoModel model = CompileMjcf(WorldMjcf(config), vehicle);
  EXPECT_EQ(model->opt.timestep, 0.002);
  EXPECT_EQ(model->opt.gravity[2], -estimation::kGravity);
  EXPECT_EQ(model->opt.integrator, mjINT_EULER);
  EXPECT_EQ(model->opt.solver, mjSOL_NEWTON);
  EXPECT_EQ(model->opt.cone, mjCONE_ELLIPTIC);
  EXPECT_EQ(model->opt.impratio, 10.0);
  EXPECT_EQ(model->opt.density, 0.0);
  EXPECT_EQ(model->nconmax, 100);
  EXPECT_EQ(model->njmax, 500);
  EXPECT_EQ(model->nbody, 3);  // world, pad, vehicle
  EXPECT_EQ(model->body_geomnum[0], 1);  // the ground: obstacles are none of MuJoCo's
}

}  // namespace
}  // namespace touchdown::sim
