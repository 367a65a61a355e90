// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/sim/mujoco_model.h"

#include <mujoco/mujoco.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "touchdown/sim/test/scenes.h"
#include "touchdown/sim/vehicle_file.h"
#include "touchdown/sim/world_mjcf.h"

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

// mju_error from the top of the library and from deep within a step: an exception, not the end of
// the process, and the library is usable afterwards.
TEST(MujocoModel, FatalErrorIsAnException) {
  const MujocoModel model = CompileMjcf(DefaultVehicleMjcf());
  const MujocoData data = MakeMujocoData(*model);
  EXPECT_THAT(MessageOf<std::runtime_error>([&] { mj_stackAlloc(data.get(), data->nstack + 1); }),
              AllOf(HasSubstr("MuJoCo: "), HasSubstr("Stack overflow")));
  const int whole = data->nstack;
  data->nstack = 4;
  EXPECT_THAT(MessageOf<std::runtime_error>([&] { mj_step(model.get(), data.get()); }),
              HasSubstr("Stack overflow"));
  data->nstack = whole;
  mj_resetData(model.get(), data.get());
  mj_step(model.get(), data.get());
  EXPECT_GT(data->time, 0.0);
}

TEST(MujocoModel, ErrorsOfOneThreadLeaveCompilationInAnotherAlone) {
  std::atomic<int> wrong = 0;
  const auto errors = [&] {
    const MujocoModel model = CompileMjcf(DefaultVehicleMjcf());
    const MujocoData data = MakeMujocoData(*model);
    for (int i = 0; i < 300; ++i) {
      try {
        mj_stackAlloc(data.get(), data->nstack + 1);
        ++wrong;
      } catch (const std::runtime_error&) {
      }
    }
  };
  const auto compilations = [&] {
    for (int i = 0; i < 15; ++i) {
      try {
        CompileMjcf("<mujoco><worldbody><body><freejoint/></body></worldbody></mujoco>");
        ++wrong;
      } catch (const std::invalid_argument&) {
      }
      if (CompileMjcf(DefaultVehicleMjcf())->nu != 4) ++wrong;
    }
  };
  std::vector<std::thread> threads;
  threads.emplace_back(errors);
  threads.emplace_back(compilations);
  threads.emplace_back(errors);
  threads.emplace_back(compilations);
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
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
  EXPECT_EQ(model->nbody, 3);  // world, pad, vehicle: obstacles are in worldbody
  const int box = mj_name2id(model.get(), mjOBJ_GEOM, "obstacle0");
  EXPECT_EQ(model->geom_bodyid[box], 0);
  EXPECT_NEAR(model->geom_quat[4 * box + 3], std::sin(0.25), 1e-12);
}

}  // namespace
}  // namespace touchdown::sim
