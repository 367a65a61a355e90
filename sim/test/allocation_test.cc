// SPDX-License-Identifier: BSD-3-Clause
// What runs at every step or frame allocates nothing: operator new is counted, and so is
// mju_malloc.
#include <mujoco/mujoco.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "touchdown/sim/depth_camera.h"
#include "touchdown/sim/gps.h"
#include "touchdown/sim/tag_sensor.h"
#include "touchdown/sim/world.h"

namespace {

std::atomic<long> allocations = 0;

void* CountedAllocation(std::size_t size) {
  ++allocations;
  void* const memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return CountedAllocation(size); }
void* operator new[](std::size_t size) { return CountedAllocation(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace touchdown::sim {
namespace {

TEST(Allocation, NoneInStepsAndMeasurements) {
  WorldConfig config;
  config.pad_motion.kind = PadMotionConfig::Kind::kCircle;
  config.start.p_WB = {0.0, 0.0, 1.0};
  config.obstacles = ObstacleField(
      {Box{{2.5, 0.0, 1.5}, {0.3, 1.0, 1.5}, 0.4}, Cylinder{{2.0, 2.0, 1.5}, 0.3, 3.0}});
  World world(config);
  DepthCamera camera({}, config.obstacles, config.pad, 1);
  PadGps gps({}, 1);
  TagSensor tags({}, config.obstacles, 1);
  const OraclePadPrediction oracle(world.pad_motion());
  estimation::DepthFrame frame;
  camera.Capture(world.vehicle(), world.pad(), &frame);

  // mju_user_malloc, where MuJoCo's own allocations would go, is counted too.
  mju_user_malloc = [](std::size_t size) {
    ++allocations;
    return std::aligned_alloc(64, (size + 63) / 64 * 64);
  };
  const long before = allocations;
  long contacts = 0;
  long sightings = 0;
  for (int i = 0; i < 1000; ++i) {
    world.Step({0.0, 0.0, 0.0, 0.0}, {1.0, 0.0, 0.0});
    contacts += static_cast<long>(world.contacts().size());
    gps.Poll(world.time(), world.pad());
    sightings += tags.Poll(world.time(), world.vehicle(), world.pad()).has_value() ? 1 : 0;
    if (i % 100 == 0) camera.Capture(world.vehicle(), world.pad(), &frame);
    oracle.At(world.time() + 2.0);
  }
  const long during = allocations - before;
  mju_user_malloc = nullptr;
  EXPECT_EQ(during, 0);
  EXPECT_GT(contacts, 0);   // it fell on the pad
  EXPECT_GT(sightings, 0);  // and saw it
}

}  // namespace
}  // namespace touchdown::sim
