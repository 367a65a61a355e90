// SPDX-License-Identifier: BSD-3-Clause
// Failures stay in the sample as infinite times: a backend that solves only the easy problems must
// not look fast.
#include "evaluation/compare/compare_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace touchdown::evaluation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kAgreement = 1e-4;
constexpr std::size_t kLeastOfASize = 5;

double Median(const std::vector<double>& values) { return *QuantilesOf(values).median; }

struct Timed {
  std::vector<double> cpu, wall, iterations, evaluations;
};

ShareSummary Mean(const std::vector<solvers::SolveShares>& all) {
  ShareSummary sum;
  for (const solvers::SolveShares& s : all) {
    sum.evaluation += s.evaluation_s;
    sum.whitening += s.whitening_s;
    sum.native += s.native_s;
    sum.adapter += s.adapter_s;
  }
  const double whole = sum.evaluation + sum.whitening + sum.native + sum.adapter;
  if (whole > 0.0) {
    for (double* part : {&sum.evaluation, &sum.whitening, &sum.native, &sum.adapter}) {
      *part /= whole;
    }
  }
  return sum;
}

const ProblemRow& ProblemOf(const BenchResult& result, const SolveRow& row) {
  return result.problems[static_cast<std::size_t>(row.problem)];
}

// Without a reference a solve has nothing to be compared with.
bool IsRated(const ProblemRow& problem) { return std::isfinite(problem.reference_cost); }

BackendSummary SummariseOne(const std::vector<const SolveRow*>& solves,
                            const std::string& backend) {
  BackendSummary summary;
  summary.backend = backend;
  std::map<int, Timed> timed;  // by problem
  std::vector<double> tight_gaps, tight_cpu, per_iteration, deadline_wall, deadline_gaps;
  std::vector<solvers::SolveShares> shares;
  DeadlineSummary deadline;
  for (const SolveRow* row : solves) {
    const bool feasible = row->max_violation <= solvers::Evaluator::kFeasible;
    const double gap = feasible && std::isfinite(row->gap) ? row->gap : kInfinity;
    if (row->reached) summary.violation_max = std::max(summary.violation_max, row->max_violation);
    switch (row->phase) {
      case SolvePhase::kTight:
        tight_gaps.push_back(gap);
        tight_cpu.push_back(row->cpu_ms);
        if (row->iterations > 0) per_iteration.push_back(row->cpu_ms / row->iterations);
        if (row->status == solvers::SolveStatus::kConverged) {
          ++summary.reported_success;
          summary.agreeing += gap <= kAgreement;
        }
        break;
      case SolvePhase::kGap: {
        Timed& of_problem = timed[row->problem];
        of_problem.cpu.push_back(row->reached ? row->cpu_ms : kInfinity);
        of_problem.wall.push_back(row->reached ? row->wall_ms : kInfinity);
        of_problem.iterations.push_back(row->iterations);
        of_problem.evaluations.push_back(row->evaluations);
        break;
      }
      case SolvePhase::kShares:
        shares.push_back(row->shares);
        break;
      case SolvePhase::kDeadline:
        ++deadline.solves;
        deadline.best_returned += row->best_returned;
        deadline_wall.push_back(row->wall_ms);
        deadline_gaps.push_back(gap);
        break;
    }
  }
  std::vector<double> cpu, wall, iterations, evaluations;
  for (const auto& [key, of_problem] : timed) {
    cpu.push_back(Median(of_problem.cpu));
    wall.push_back(Median(of_problem.wall));
    if (!std::isfinite(cpu.back())) continue;
    ++summary.solved;
    iterations.push_back(Median(of_problem.iterations));
    evaluations.push_back(Median(of_problem.evaluations));
  }
  summary.problems = static_cast<int>(timed.size());
  if (summary.problems > 0) {
    summary.solved_interval = ClopperPearson(summary.solved, summary.problems);
  }
  summary.cpu_ms = QuantilesOf(cpu);
  summary.wall_ms = QuantilesOf(wall);
  summary.iterations = QuantilesOf(iterations);
  summary.evaluations = QuantilesOf(evaluations);
  summary.tight_gap = QuantilesOf(tight_gaps);
  summary.tight_cpu_ms = QuantilesOf(tight_cpu);
  summary.ms_per_iteration = Quantile(per_iteration, 0.5);
  if (!shares.empty()) summary.shares = Mean(shares);
  if (deadline.solves > 0) {
    deadline.wall_ms = QuantilesOf(deadline_wall);
    deadline.gap = QuantilesOf(deadline_gaps);
    summary.deadline = deadline;
  }
  return summary;
}

}  // namespace

std::vector<BackendSummary> Summarise(const BenchResult& result) {
  std::vector<BackendSummary> summaries;
  for (const std::string& backend : result.backends) {
    std::vector<const SolveRow*> solves;
    int wrong = 0;  // converged, as it says, at no feasible point of a problem without a reference
    for (const SolveRow& row : result.solves) {
      if (row.backend != backend) continue;
      if (IsRated(ProblemOf(result, row))) {
        solves.push_back(&row);
      } else {
        wrong += row.phase == SolvePhase::kTight &&
                 row.status == solvers::SolveStatus::kConverged &&
                 !(row.max_violation <= solvers::Evaluator::kFeasible);
      }
    }
    summaries.push_back(SummariseOne(solves, backend));
    summaries.back().reported_success += wrong;
    summaries.back().ran_all = summaries.back().problems == TimedProblems(result);
  }
  return summaries;
}

int TimedProblems(const BenchResult& result) {
  return static_cast<int>(
      std::count_if(result.problems.begin(), result.problems.end(),
                    [](const ProblemRow& row) { return IsRated(row) && !row.standing; }));
}

std::map<int, double> TimePerIteration(const BenchResult& result, const std::string& backend) {
  std::map<int, std::vector<double>> times;
  for (const SolveRow& row : result.solves) {
    const ProblemRow& problem = ProblemOf(result, row);
    if (!IsRated(problem) || row.backend != backend || row.phase != SolvePhase::kTight ||
        row.iterations == 0)
      continue;
    times[problem.points].push_back(row.cpu_ms / row.iterations);
  }
  std::map<int, double> medians;
  for (const auto& [points, of_size] : times) {
    if (of_size.size() >= kLeastOfASize) medians[points] = Median(of_size);
  }
  return medians;
}

}  // namespace touchdown::evaluation
