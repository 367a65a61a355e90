// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/profile/profile.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/statistics.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/record/replay.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::evaluation {
namespace {

using Span = planning::StageTimes::Span;

// Buffers grow to what a flight needs in its first steps.
constexpr int kWarmUp = 20;
// A flight of a minute has about 2 spans a depth image and 8 a replanning step; more are dropped.
constexpr std::size_t kSpansPerRun = 1 << 16;

Profile Begin(const Scenario& scenario, const ProfileOptions& options) {
  Profile profile;
  profile.scenario = scenario;
  profile.deadline_ms = options.deadline_ms.value_or(DefaultDeadlineMs(scenario));
  profile.allocations_counted = solvers::AllocationCount() >= 0;
  return profile;
}

// Runs with a log, for the CPU time of the stages. It is the given log if spans are to be kept.
template <typename Run>
void Listen(const ProfileOptions& options, planning::SpanLog* log, const Run& run) {
  planning::SpanLog unkept;
  if (options.spans) log->Reserve(log->spans().size() + kSpansPerRun);
  const planning::SpanLog::Listening listening(options.spans ? log : &unkept);
  run();
}

class StageColumn {
 public:
  explicit StageColumn(std::string stage) { summary_.stage = std::move(stage); }

  void Add(const Span& span, bool warm) {
    cpu_ms_.push_back(1e3 * span.cpu);
    wall_ms_.push_back(1e3 * span.wall);
    if (span.wall > 0.0) ++summary_.used;
    if (warm) allocations_.push_back(static_cast<double>(span.allocations));
  }

  StageSummary Summary(bool allocations_counted) {
    summary_.samples = static_cast<int>(cpu_ms_.size());
    summary_.cpu_ms = QuantilesOf(cpu_ms_);
    summary_.wall_ms = QuantilesOf(wall_ms_);
    if (allocations_counted) summary_.allocations = QuantilesOf(allocations_);
    return summary_;
  }

 private:
  StageSummary summary_;
  std::vector<double> cpu_ms_, wall_ms_, allocations_;
};

// The rest of the total beside its stages.
Span Other(const planning::StageTimes& times) {
  Span other = times.total;
  for (const Span* stage : times.Stages()) {
    other.wall -= stage->wall;
    other.cpu -= stage->cpu;
    other.allocations -= stage->allocations;
  }
  // The difference of two clocks: a step without work of its own may be a little below zero.
  other.wall = std::max(0.0, other.wall);
  other.cpu = std::max(0.0, other.cpu);
  return other;
}

std::vector<ProfileSummary::SlowStep> SlowestSteps(const Profile& profile) {
  constexpr std::size_t kMost = 3;
  using SlowStep = ProfileSummary::SlowStep;
  // Every run of a replay is a pass over the same steps. Flights have their own steps.
  std::map<std::pair<std::uint64_t, int>, std::vector<double>> times;
  std::map<std::pair<std::uint64_t, int>, int> solves;
  for (const ProfileRun& run : profile.runs) {
    int step = 0;
    for (const ReplanSample& replan : run.samples.replans) {
      const std::pair of(run.seed, step++);
      times[of].push_back(1e3 * replan.times.total.cpu);
      solves[of] = replan.solves;
    }
  }
  std::vector<SlowStep> steps;
  for (const auto& [of, own] : times) {
    steps.push_back({of.second, of.first, *Quantile(own, 0.5), solves[of]});
  }
  std::stable_sort(steps.begin(), steps.end(),
                   [](const SlowStep& a, const SlowStep& b) { return a.cpu_ms > b.cpu_ms; });
  steps.resize(std::min(steps.size(), kMost));
  return steps;
}

}  // namespace

double DefaultDeadlineMs(const Scenario& scenario) {
  const PlanningLatency& latency = scenario.planning.latency;
  return !latency.measured && latency.ms > 0.0 ? latency.ms : 1e3 / scenario.planning.rate;
}

Profile ProfileFlights(const Scenario& scenario, const ProfileOptions& options,
                       const Registries& registries, const ProfileProgress& progress) {
  Profile profile = Begin(scenario, options);
  for (int i = 0; i < options.trials; ++i) {
    ProfileRun run;
    run.seed = scenario.seed + static_cast<std::uint64_t>(i);
    run.warm_up = kWarmUp;
    run.first_span = profile.spans.spans().size();
    Listen(options, &profile.spans, [&] {
      run.outcome = ToString(
          RunTrial(scenario, run.seed, registries, nullptr, nullptr, &run.samples).outcome);
    });
    profile.runs.push_back(std::move(run));
    progress(i + 1, options.trials);
  }
  return profile;
}

Profile ProfileRecord(const RecordedFlight& flight, const ProfileOptions& options,
                      const Registries& registries, const ProfileProgress& progress) {
  if (flight.plans.empty()) {
    throw BadInput(fmt::format("{}: it holds no replanning step.", flight.path));
  }
  Profile profile = Begin(flight.scenario, options);
  profile.record = flight.path;
  Replay replay(flight, registries);
  for (int step = 0; step < replay.steps(); ++step) {
    replay.Seek(step);
    ++profile.compared;
    if (Same(OutcomeOf(replay.Solve()), replay.recorded().result)) ++profile.same;
  }
  for (int pass = 0; pass < options.repeats; ++pass) {
    ProfileRun run;
    run.seed = flight.scenario.seed;
    run.outcome = "replayed";
    run.first_span = profile.spans.spans().size();
    run.samples.replans.reserve(flight.plans.size());
    Listen(options, &profile.spans, [&] {
      for (int step = 0; step < replay.steps(); ++step) {
        replay.Seek(step);
        const planning::ReplanResult& result = replay.Solve();
        run.samples.replans.push_back(
            SampleOf(replay.recorded().request.input.t_now, result, result.times));
      }
    });
    profile.runs.push_back(std::move(run));
    progress(pass + 1, options.repeats);
  }
  return profile;
}

ProfileSummary Summarise(const Profile& profile) {
  const planning::StageTimes names;
  std::vector<StageColumn> frames = {StageColumn("sense"), StageColumn("map")};
  std::vector<StageColumn> stages;
  for (const Span* stage : names.Stages()) stages.emplace_back(stage->stage);
  stages.emplace_back("other");
  StageColumn total("total");
  ProfileSummary summary;
  bool any_frames = false;
  for (const ProfileRun& run : profile.runs) {
    for (const FrameSample& frame : run.samples.frames) {
      any_frames = true;
      frames[0].Add(frame.times.sense, true);
      frames[1].Add(frame.times.map, true);
    }
    int step = 0;
    for (const ReplanSample& replan : run.samples.replans) {
      const bool warm = step++ >= run.warm_up;
      std::size_t column = 0;
      for (const Span* stage : replan.times.Stages()) stages[column++].Add(*stage, warm);
      stages[column].Add(Other(replan.times), warm);
      total.Add(replan.times.total, warm);
      if (1e3 * replan.times.total.wall > profile.deadline_ms) ++summary.deadline_misses;
    }
  }
  const bool counted = profile.allocations_counted;
  if (any_frames) {
    for (StageColumn& frame : frames) summary.stages.push_back(frame.Summary(counted));
  }
  for (StageColumn& stage : stages) summary.stages.push_back(stage.Summary(counted));
  summary.total = total.Summary(counted);
  summary.slowest = SlowestSteps(profile);
  return summary;
}

}  // namespace touchdown::evaluation
