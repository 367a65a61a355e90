// SPDX-License-Identifier: BSD-3-Clause
#include "sim/mujoco/mujoco_call.h"

#include <mujoco/mujoco.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/mujoco/mujoco_model.h"
#include "sim/test/scenes.h"
#include "sim/vehicle/vehicle_file.h"

namespace touchdown::sim {
namespace {

using test::MessageOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

// mju_error, from the top of the library or from deep within a step, becomes an exception and does
// not end the process. The library is usable afterwards.
TEST(MujocoCall, AFatalErrorIsAnException) {
  const MujocoModel model = CompileMjcf(DefaultVehicleMjcf());
  const MujocoData data = MakeMujocoData(*model);
  EXPECT_THAT(MessageOf<std::runtime_error>(
                  [&] { CallMujoco([&] { mj_stackAlloc(data.get(), data->nstack + 1); }); }),
              AllOf(HasSubstr("MuJoCo: "), HasSubstr("Stack overflow")));
  const int whole = data->nstack;
  data->nstack = 4;
  EXPECT_THAT(
      MessageOf<std::runtime_error>([&] { CallMujoco([&] { mj_step(model.get(), data.get()); }); }),
      HasSubstr("Stack overflow"));
  data->nstack = whole;
  mj_resetData(model.get(), data.get());
  CallMujoco([&] { mj_step(model.get(), data.get()); });
  EXPECT_GT(data->time, 0.0);
}

TEST(MujocoCall, ErrorsOfOneThreadLeaveCompilationInAnotherAlone) {
  std::atomic<int> wrong = 0;
  const auto errors = [&] {
    const MujocoModel model = CompileMjcf(DefaultVehicleMjcf());
    const MujocoData data = MakeMujocoData(*model);
    for (int i = 0; i < 300; ++i) {
      try {
        CallMujoco([&] { mj_stackAlloc(data.get(), data->nstack + 1); });
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

// A user's own calls in the same process end as they would without us.
TEST(MujocoCallDeathTest, OutsideOfACallTheHandlerThatWasThereIsAsked) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // in a process without an earlier call
  EXPECT_EXIT(
      {
        mju_user_error = [](const char* message) {
          std::fprintf(stderr, "theirs: %s", message);
          std::exit(7);
        };
        const MujocoModel model = CompileMjcf(DefaultVehicleMjcf());
        const MujocoData data = MakeMujocoData(*model);
        mj_stackAlloc(data.get(), data->nstack + 1);
      },
      ::testing::ExitedWithCode(7), "theirs: .*verflow");
}

TEST(MujocoCall, TheInnermostCallAnswers) {
  const MujocoModel model = CompileMjcf(DefaultVehicleMjcf());
  const MujocoData data = MakeMujocoData(*model);
  bool caught = false;
  CallMujoco([&] {
    try {
      CallMujoco([&] { mj_stackAlloc(data.get(), data->nstack + 1); });
    } catch (const std::runtime_error&) {
      caught = true;
    }
  });
  EXPECT_TRUE(caught);
}

}  // namespace
}  // namespace touchdown::sim
