// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/compare/reference_compare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/statistics.h"
#include "sim/base/random_stream.h"
#include "touchdown/solvers/backend/evaluator.h"
#include "touchdown/solvers/problem/view.h"
#include "touchdown/solvers/problems/hock_schittkowski.h"
#include "touchdown/solvers/problems/more_garbow_hillstrom.h"
#include "touchdown/solvers/problems/shooting.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

using solvers::ReferenceProblem;
using solvers::SolverResult;
using solvers::SolveStatus;

constexpr double kRight = 1e-6;     // of the optimum's cost, and absolutely
constexpr double kFeasible = 1e-5;  // of what is believed without asking the backend

std::vector<ReferenceProblem> Problems(const std::string& set) {
  if (set == "shooting") return solvers::ShootingProblems();
  if (set == "mgh") return solvers::MoreGarbowHillstrom();
  return solvers::HockSchittkowski(set == "hs-pairs" ? solvers::EqualityForm::kPairs
                                                     : solvers::EqualityForm::kRows);
}

/// The published start (index 0), then random starts around it. In a set of long trajectories a number x changes by up
/// to 0.2 + 0.1 |x|. In a set of a few variables it changes by up to 1 + 0.5 |x|.
Eigen::VectorXd Start(const ReferenceOptions& options, const ReferenceProblem& problem, int index) {
  Eigen::VectorXd start = problem.start;
  if (index == 0) return start;
  sim::RandomStream stream(options.seed, fmt::format("{} start {}", problem.name, index));
  const double reach = std::isnan(problem.cost) ? 0.2 : 1.0;
  for (double& x : start) x += reach * (1.0 + 0.5 * std::abs(x)) * stream.Uniform(-1.0, 1.0);
  return start;
}

class Contest {
 public:
  Contest(const ReferenceOptions& options, const ReferenceProblem& problem)
      : options_(options), problem_(problem), view_(*problem.problem) {}

  void Ask(const solvers::BackendEntry& entry) {
    ReferenceCell cell{.problem = problem_.name, .backend = entry.name};
    const auto backend = entry.make();
    cell.refusal = backend->Refusal(view_);
    if (cell.refusal.empty()) {
      backend->Prepare(view_);
      for (int i = 0; i < options_.starts; ++i) cell.solves.push_back(Solve(backend.get(), i));
    }
    cells_.push_back(std::move(cell));
  }

  /// After all backends: the optimum may be the best that any of them found.
  std::vector<ReferenceCell> Judge() {
    for (ReferenceCell& cell : cells_) {
      for (ReferenceSolve& solve : cell.solves) {
        solve.verdict = Of(solve.summary);
        solve.best = solve.verdict == Verdict::kRight &&
                     solve.summary.cost <= optimum() + kRight * std::max(1.0, std::abs(optimum()));
      }
    }
    return std::move(cells_);
  }

  double optimum() const { return std::isnan(problem_.cost) ? best_ : problem_.cost; }

 private:
  ReferenceSolve Solve(solvers::SolverBackend* backend, int index) {
    solvers::Stop stop;
    stop.max_iterations = options_.max_iterations;
    stop.wall_limit_s = options_.most_seconds;
    SolverResult result;
    backend->Solve(view_, solvers::WarmStart(Start(options_, problem_, index)), stop, &result);
    const bool claimed = result.status == SolveStatus::kConverged;
    // What a violation saves must not become the optimum of others.
    if (claimed && result.max_violation <= solvers::Evaluator::kFeasible)
      best_ = std::min(best_, result.cost);
    return {.start = index, .summary = result};
  }

  /// At a point that is not feasible, a claim of convergence counts as no optimum.
  Verdict Of(const solvers::SolverSummary& summary) const {
    if (summary.status != SolveStatus::kConverged) return Verdict::kNotClaimed;
    ReferenceProblem judged = problem_;
    judged.cost = optimum();
    const bool known = judged.Off(summary.cost) <= kRight;
    return known && summary.max_violation <= kFeasible ? Verdict::kRight : Verdict::kElsewhere;
  }

  const ReferenceOptions& options_;
  const ReferenceProblem& problem_;
  solvers::View view_;
  double best_ = std::numeric_limits<double>::infinity();
  std::vector<ReferenceCell> cells_;
};

std::vector<double> CpuTimes(const ReferenceCell& cell) {
  std::vector<double> ms;
  for (const ReferenceSolve& solve : cell.solves) ms.push_back(1e3 * solve.summary.cpu_s);
  return ms;
}

struct Total {
  int right = 0, best = 0, elsewhere = 0, unclaimed = 0, refused = 0;
  std::vector<double> cpu_ms;

  int solves() const { return right + elsewhere + unclaimed; }
};

Total TotalOf(const ReferenceResult& result, const std::string& backend) {
  Total total;
  for (const ReferenceCell& cell : result.cells) {
    if (cell.backend != backend) continue;
    total.right += cell.Count(Verdict::kRight);
    total.best += cell.AtTheBest();
    total.elsewhere += cell.Count(Verdict::kElsewhere);
    total.unclaimed += cell.Count(Verdict::kNotClaimed);
    total.refused += cell.refusal.empty() ? 0 : 1;
    for (const double ms : CpuTimes(cell)) total.cpu_ms.push_back(ms);
  }
  return total;
}

/// Of how many problems, by their reasons.
std::map<std::string, int> Refusals(const ReferenceResult& result) {
  std::map<std::string, int> problems;
  for (const ReferenceCell& cell : result.cells) {
    if (!cell.refusal.empty()) ++problems[cell.refusal];
  }
  return problems;
}

std::string Milliseconds(std::optional<double> ms) { return ms ? fmt::format("{:.3g}", *ms) : "-"; }

}  // namespace

const char* ToString(Verdict verdict) {
  switch (verdict) {
    case Verdict::kRight:
      return "right";
    case Verdict::kElsewhere:
      return "elsewhere";
    case Verdict::kNotClaimed:
      return "not_claimed";
  }
  return "unknown";
}

int ReferenceCell::Count(Verdict verdict) const {
  return static_cast<int>(
      std::count_if(solves.begin(), solves.end(),
                    [verdict](const ReferenceSolve& solve) { return solve.verdict == verdict; }));
}

int ReferenceCell::AtTheBest() const {
  return static_cast<int>(std::count_if(solves.begin(), solves.end(),
                                        [](const ReferenceSolve& solve) { return solve.best; }));
}

ReferenceResult RunReferences(const ReferenceOptions& options,
                              const solvers::BackendRegistry& registry,
                              const std::function<void(int done, int all)>& report) {
  ReferenceResult result;
  result.published = options.set != "shooting";
  const std::vector<ReferenceProblem> problems = Problems(options.set);
  for (const ReferenceProblem& problem : problems) {
    result.problems.push_back(problem.name);
    Contest contest(options, problem);
    for (const solvers::BackendEntry& entry : registry) {
      const auto& asked = options.backends;
      const bool wanted =
          asked.empty() || std::find(asked.begin(), asked.end(), entry.name) != asked.end();
      if (wanted && entry.make()->capabilities().compiled) contest.Ask(entry);
    }
    result.optima.push_back(contest.optimum());
    result.others.push_back(problem.others);
    for (ReferenceCell& cell : contest.Judge()) {
      if (result.problems.size() == 1) result.backends.push_back(cell.backend);
      result.cells.push_back(std::move(cell));
    }
    report(static_cast<int>(result.problems.size()), static_cast<int>(problems.size()));
  }
  return result;
}

std::string ReferenceText(const ReferenceOptions& options, const ReferenceResult& result) {
  const char* elsewhere = result.published ? "false claims" : "elsewhere";
  std::string text = fmt::format(
      "Problem set {}: {} problems, {} starts each, seed {}, at most {} iterations. Right: "
      "converged, and within 1e-6 of {}.\n"
      "  {:<15}{:>16}{:>13}{:>14}{:>13}{:>9}{:>11}{:>9}{:>9}\n",
      options.set, result.problems.size(), options.starts, options.seed, options.max_iterations,
      result.published ? "an optimum that is known, which may be a local one"
                       : "the best that any backend found",
      "backend", "right", "at the best", elsewhere, "not claimed", "refused", "median ms", "p95",
      "largest");
  for (const std::string& backend : result.backends) {
    const Total total = TotalOf(result, backend);
    const Quantiles ms = QuantilesOf(total.cpu_ms);
    text += fmt::format("  {:<15}{:>16}{:>13}{:>14}{:>13}{:>9}{:>11}{:>9}{:>9}\n", backend,
                        fmt::format("{} of {}", total.right, total.solves()), total.best,
                        total.elsewhere, total.unclaimed, total.refused, Milliseconds(ms.median),
                        Milliseconds(ms.p95), Milliseconds(ms.max));
  }
  text += fmt::format(
      "  at the best: right, and at the best cost that is known; {}: converged, and not right; not "
      "claimed: ended without saying converged\n",
      elsewhere);
  for (const auto& [reason, problems] : Refusals(result)) {
    text += fmt::format("  refused, {} problems: {}\n", problems, reason);
  }
  text += fmt::format("\nRight, of {} starts; ! {}; - refused\n  {:<22}", options.starts,
                      result.published ? "false claims" : "claims elsewhere", "");
  for (const std::string& backend : result.backends) text += fmt::format("{:>14}", backend);
  text += "\n";
  std::size_t at = 0;
  for (const std::string& problem : result.problems) {
    text += fmt::format("  {:<22}", problem);
    for (std::size_t b = 0; b < result.backends.size(); ++b) {
      const ReferenceCell& cell = result.cells[at++];
      std::string of_cell =
          cell.refusal.empty() ? std::to_string(cell.Count(Verdict::kRight)) : "-";
      const int others = cell.Count(Verdict::kElsewhere);
      if (others > 0) of_cell += fmt::format(" {}!", others);
      text += fmt::format("{:>14}", of_cell);
    }
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json ReferenceJson(const ReferenceOptions& options,
                                     const ReferenceResult& result) {
  Json json{{"problem_set", options.set},    {"starts", options.starts},
            {"seed", options.seed},          {"max_iterations", options.max_iterations},
            {"published", result.published}, {"cells", Json::array()}};
  for (const ReferenceCell& cell : result.cells) {
    const std::optional<double> median = Quantile(CpuTimes(cell), 0.5);
    Json of_cell{{"problem", cell.problem},
                 {"backend", cell.backend},
                 {"right", cell.Count(Verdict::kRight)},
                 {"best", cell.AtTheBest()},
                 {"elsewhere", cell.Count(Verdict::kElsewhere)},
                 {"unclaimed", cell.Count(Verdict::kNotClaimed)},
                 {"median_ms", median ? Json(*median) : Json()}};
    if (!cell.refusal.empty()) of_cell["refusal"] = cell.refusal;
    json["cells"].push_back(std::move(of_cell));
  }
  return json;
}

}  // namespace touchdown::evaluation
