// SPDX-License-Identifier: BSD-3-Clause
// Code that runs at every step or frame allocates nothing. MuJoCo's own allocations count too.
#include <mujoco/mujoco.h>

#include <gtest/gtest.h>

#include "sim/sensors/depth_camera.h"
#include "sim/sensors/gps.h"
#include "sim/sensors/tag_sensor.h"
#include "sim/test/own_state_source.h"
#include "sim/world/world.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::sim {
namespace {

TEST(Allocation, NoneInStepsAndMeasurements) {
  if (solvers::AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  const long at_first = solvers::AllocationCount();
  mju_free(mju_malloc(64));
  ASSERT_GT(solvers::AllocationCount(), at_first);
  WorldConfig config;
  config.pad_motion.kind = PadMotionConfig::Kind::kCircle;
  config.start.p_WB = {0.0, 0.0, 1.0};
  config.obstacles = ObstacleField(
      {Box{{2.5, 0.0, 1.5}, {0.3, 1.0, 1.5}, 0.4}, Cylinder{{2.0, 2.0, 1.5}, 0.3, 3.0}});
  World world(config);
  DepthCamera camera({}, config.obstacles, config.pad, 1);
  PadGps gps({}, 1);
  TagSensor tags({}, config.obstacles, 1);
  const OraclePadPrediction oracle(world.pad_course());
  estimation::DepthFrame frame;
  camera.Capture(world.vehicle(), world.pad(), &frame);

  // Every sensor is on, and measurements come late.
  OwnStateSourceConfig own_config;
  own_config.sensors.odometry.rate_hz = 30.0;
  OwnStateSource own(own_config, 1, world.vehicle(), world.timestep());

  const long before = solvers::AllocationCount();
  long contacts = 0;
  long sightings = 0;
  for (int i = 0; i < 1000; ++i) {
    world.Step(Eigen::Vector4d(0.0, 0.0, 0.0, 0.0), {1.0, 0.0, 0.0});
    contacts += static_cast<long>(world.contacts().size());
    gps.Poll(world.time(), world.pad());
    own.Step(world.vehicle());
    if (i % 25 == 0) own.EstimateAt(world.time() - 0.02);
    sightings += tags.Poll(world.time(), world.vehicle(), world.pad()).has_value() ? 1 : 0;
    if (i % 100 == 0) camera.Capture(world.vehicle(), world.pad(), &frame);
    oracle.At(world.time() + 2.0);
  }
  const long during = solvers::AllocationCount() - before;
  EXPECT_EQ(during, 0);
  EXPECT_GT(contacts, 0);   // it fell on the pad
  EXPECT_GT(sightings, 0);  // and saw it
  EXPECT_GT(own.filter().diagnostics().late_accepted, 0);
}

}  // namespace
}  // namespace touchdown::sim
