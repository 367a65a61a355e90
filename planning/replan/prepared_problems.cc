// SPDX-License-Identifier: BSD-3-Clause
// Landing problems by number of segments, in steps of four. So for a plan of any duration there is
// one whose segments are about as long as wanted.

#include "planning/replan/prepared_problems.h"

#include <algorithm>
#include <cmath>

#include "planning/replan/pair_binder.h"

namespace touchdown::planning {

namespace {

constexpr double kSlow = 2.5;  // slower vehicles have no longer segments in time [m/s]
constexpr int kFewestSegments = 12;
constexpr int kMostSegments = PairBinder::kMostControlPoints - 3;
constexpr int kSegmentStep = 4;  // keeps the number of prepared problems small

PreparedProblem Prepare(const ReplannerOptions& options, const solvers::BackendRegistry& backends,
                        int segments, ArrivalMode arrival) {
  PreparedProblem prepared;
  prepared.problem = std::make_unique<LandingProblem>(segments, ProblemOptions(options, arrival));
  prepared.backend = solvers::MakeBackend(backends, options.backend);
  for (const auto& [name, value] : options.solver_options) {
    prepared.backend->options().Set(name, value);
  }
  prepared.backend->Prepare(prepared.problem->view());
  prepared.start.y.resize(prepared.problem->view().num_variables());
  prepared.first_guess = prepared.start.y;
  solvers::SolverBackend::Reserve(prepared.problem->view(), &prepared.solver);
  return prepared;
}

}  // namespace

int SegmentsFor(double duration, const Limits& limits, double share, double longest) {
  const double interval = share * (longest / std::max(kSlow, limits.speed));
  const int wanted = static_cast<int>(std::ceil(duration / interval));
  const int rounded = (wanted + kSegmentStep - 1) / kSegmentStep * kSegmentStep;
  return std::clamp(rounded, kFewestSegments, kMostSegments);
}

LandingProblemOptions ProblemOptions(const ReplannerOptions& options, ArrivalMode arrival) {
  LandingProblemOptions problem;
  static_cast<Formulation&>(problem) = options.problem;
  problem.arrival = arrival;
  problem.limits = options.limits;
  problem.min_duration = options.min_duration;
  problem.max_duration = options.max_duration;
  return problem;
}

PreparedProblems::PreparedProblems(const ReplannerOptions& options,
                                   const solvers::BackendRegistry& backends) {
  for (int segments = kFewestSegments; segments <= kMostSegments; segments += kSegmentStep) {
    for (const ArrivalMode arrival : {ArrivalMode::kFixed, ArrivalMode::kFree}) {
      if (arrival == ArrivalMode::kFree && options.arrival != ArrivalMode::kFree) continue;
      prepared_.emplace(std::pair(segments, arrival),
                        Prepare(options, backends, segments, arrival));
    }
  }
}

}  // namespace touchdown::planning
