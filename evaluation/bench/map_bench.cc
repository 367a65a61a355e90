// SPDX-License-Identifier: BSD-3-Clause
// The cost of fusing a depth frame. It compares the planner's rolling map, with inflation, and
// octomap::OcTree::insertPointCloud, plain and discretised, without inflation. Both get the same
// frames in turn, from an empty map on; times are thread CPU times, OctoMap's without making the
// point cloud. Counters: ms a frame of both, how many times OctoMap's is longer, and how far they
// agree in the end.

#include <benchmark/benchmark.h>

#include "evaluation/bench/map_flight.h"
#include "touchdown/solvers/backend/thread_clock.h"

namespace touchdown::evaluation {
namespace {

void InsertDepth(benchmark::State& state, MapFlight (*make_flight)(), int width, int height,
                 bool discretised) {
  const std::vector<estimation::DepthFrame> frames = DepthFrames(make_flight(), width, height, 2.0);
  std::vector<octomap::Pointcloud> clouds;
  for (const estimation::DepthFrame& frame : frames) clouds.push_back(CloudOf(frame));
  const planning::OccupancyMapOptions options = EqualOptions();
  double rolling_s = 0.0, octomap_s = 0.0;
  Agreement agreement;
  for (auto _ : state) {
    planning::OccupancyMap map(options);
    octomap::OcTree tree = EqualTree(options);
    map.Recentre(frames[frames.size() / 2].p_WC);
    double inserting = 0.0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const double begin = solvers::ThreadCpuSeconds();
      map.Integrate(frames[i], {});
      const double between = solvers::ThreadCpuSeconds();
      tree.insertPointCloud(clouds[i], OriginOf(frames[i]), frames[i].max_range, false,
                            discretised);
      inserting += solvers::ThreadCpuSeconds() - between;
      rolling_s += between - begin;
    }
    state.SetIterationTime(inserting);
    octomap_s += inserting;
    agreement = Compare(map, tree);
  }
  const double count = static_cast<double>(state.iterations()) * static_cast<double>(frames.size());
  state.counters["octomap_ms"] = 1e3 * octomap_s / count;
  state.counters["rolling_ms"] = 1e3 * rolling_s / count;
  state.counters["times"] = octomap_s / rolling_s;
  state.counters["equal_percent"] = 100.0 * agreement.share();
}

void Register(const char* size, int width, int height) {
  for (const auto& [world, flight] :
       {std::pair{"straight_turn", &StraightTurnFlight}, std::pair{"forest_B", &ForestFlight}}) {
    for (const bool discretised : {false, true}) {
      const std::string name = std::string("InsertDepth/") + world + "/" + size +
                               (discretised ? "/discretised" : "/plain");
      benchmark::RegisterBenchmark(name.c_str(), InsertDepth, flight, width, height, discretised)
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
}

const bool registered = [] {
  Register("80x60", 80, 60);
  Register("160x120", 160, 120);
  return true;
}();

}  // namespace
}  // namespace touchdown::evaluation
