// SPDX-License-Identifier: BSD-3-Clause
// The cost of large worlds, with the vehicle amid the obstacles: a depth frame of 80 x 60 and a step of the physics.
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "sim/base/random_stream.h"
#include "sim/obstacles/mesh_shapes.h"
#include "sim/obstacles/true_clearance.h"
#include "sim/sensors/depth_camera.h"
#include "sim/world/world.h"

namespace touchdown::evaluation {
namespace {

constexpr double kSide = 40.0;  // of a world [m]

/// Upright boxes all over the place, none within 1 m of the start.
sim::ObstacleField Boxes(int count) {
  sim::RandomStream random(1, "world bench");
  std::vector<sim::Obstacle> boxes;
  while (static_cast<int>(boxes.size()) < count) {
    const double x = random.Uniform(-0.5, 0.5) * kSide, y = random.Uniform(-0.5, 0.5) * kSide;
    const double z = random.Uniform(0.0, 4.0), yaw = random.Uniform(-3.0, 3.0);
    if (std::hypot(x, y) > 1.0) boxes.emplace_back(sim::Box{{x, y, z}, {0.15, 0.1, 0.2}, yaw});
  }
  return sim::ObstacleField(std::move(boxes));
}

/// Hills of about so many triangles, at most 1 m high.
sim::ObstacleField Hills(int count) {
  const int side = static_cast<int>(std::lround(std::sqrt(0.5 * count))) + 1;
  sim::HeightGrid grid{side, side, {}};
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double x = kSide * column / side, y = kSide * row / side;
      grid.heights.push_back(0.5 + 0.25 * (std::sin(x) + std::cos(1.3 * y)));
    }
  }
  return sim::ObstacleField({sim::Mesh{std::make_shared<const sim::TriangleMesh>(
      sim::HeightFieldMesh(grid, {kSide, kSide}, 0.5, {}))}});
}

sim::ObstacleField Made(const std::string& kind, int count) {
  return kind == "boxes" ? Boxes(count) : Hills(count);
}

estimation::VehicleState Amid() {
  estimation::VehicleState state;
  state.p_WB.z() = 2.0;
  return state;
}

void DepthFrame(benchmark::State& state, const std::string& kind, int count) {
  sim::DepthCamera camera({}, Made(kind, count), {}, 1);
  estimation::DepthFrame frame;
  estimation::PadState pad;
  pad.p_WP = {100.0, 0.0, 0.3};
  for (auto _ : state) {
    camera.Capture(Amid(), pad, &frame);
    benchmark::DoNotOptimize(frame.depth.data());
  }
}

void WorldStep(benchmark::State& state, const std::string& kind, int count) {
  sim::WorldConfig config;
  config.obstacles = Made(kind, count);
  config.pad_motion.p_start.x() = 100.0;
  config.start = Amid();
  sim::World world(config);
  const double hover = 0.25 * world.model().HoverThrust();
  for (auto _ : state) world.Step(Eigen::Vector4d(hover, hover, hover, hover));
}

void TrueClearance(benchmark::State& state, const std::string& kind, int count) {
  const sim::TrueClearance clearance(Made(kind, count), {});
  for (auto _ : state) benchmark::DoNotOptimize(clearance.Distance(Amid()));
}

const bool kRegistered = [] {
  for (const auto& [kind, counts] : {std::pair<std::string, std::vector<int>>{"boxes", {10, 5000}},
                                     {"triangles", {1000, 100000}}}) {
    for (const int count : counts) {
      const std::string name = "/" + kind + "/" + std::to_string(count);
      const auto add = [&](const char* what, auto* run) {
        benchmark::RegisterBenchmark((what + name).c_str(),
                                     [run, kind = kind, count](benchmark::State& state) {
                                       run(state, kind, count);
                                     })
            ->Unit(benchmark::kMicrosecond);
      };
      add("DepthFrame", &DepthFrame);
      add("WorldStep", &WorldStep);
      add("TrueClearance", &TrueClearance);
    }
  }
  return true;
}();

}  // namespace
}  // namespace touchdown::evaluation
