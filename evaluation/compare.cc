// SPDX-License-Identifier: BSD-3-Clause
// The measurement. The reference cost of a problem is the best feasible one over tight solves of
// all backends, `banded` and `ipopt` always among them where they can solve it, even when they are
// out of the timed solves. A timed solve runs
// with tolerances that never end it and is ended from outside by one test for all, at its evaluations:
// cost within the gap of the reference, rows within Evaluator::kFeasible. No backend's own idea of
// convergence decides. The point it returns is evaluated anew; what it says of itself counts for
// nothing.
#include "touchdown/evaluation/compare.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/scenario_value.h"
#include "touchdown/sim/random_stream.h"
#include "touchdown/solvers/evaluator.h"
#include "touchdown/solvers/thread_clock.h"

namespace touchdown::evaluation {
namespace {

using solvers::SolverBackend;
using solvers::Stop;

constexpr double kSolveLimit = 5.0;  // wall time of any one solve [s]
constexpr int kIterations = 3000;    // of any one solve
// What tolerances are set to where a backend's own test is to mean something, and where it shall
// not end a solve before the test from outside does.
constexpr double kTight = 1e-10;
constexpr double kTightViolation = 1e-9;
constexpr double kNever = 1e-15;
constexpr double kNeverViolation = 1e-12;
const std::vector<std::string> kReferees = {"banded", "ipopt"};

/// One backend at work on the problems of one size.
struct Contestant {
  std::string name;
  bool compared = false;                    ///< else it only helps to find the reference
  std::unique_ptr<SolverBackend> tight;     ///< for SolvePhase::kTight
  std::unique_ptr<SolverBackend> unending;  ///< for those that are ended from outside
  std::unique_ptr<SolverBackend> usual;     ///< for SolvePhase::kDeadline, default tolerances
  double seconds = 0.0;                     ///< used so far, but for the tight solves
  bool out = false;                         ///< of all but FindReference, if it is a referee
};

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool IsReferee(const std::string& name) { return Contains(kReferees, name); }

void SetTolerances(double tolerance, double violation, solvers::SolverOptions* options) {
  for (const solvers::OptionSpec& spec : std::vector(options->specs())) {
    if (spec.name.find("tolerance") == std::string::npos) continue;
    const double wanted = spec.name.find("violation") == std::string::npos ? tolerance : violation;
    options->Set(spec.name, std::clamp(wanted, spec.lo, std::max(spec.lo, spec.value)));
  }
}

/// A point as seen from outside.
struct Merit {
  bool ok = false;
  double cost = 0.0;
  double violation = 0.0;
  double end_position = 0.0;
  double end_velocity = 0.0;

  bool feasible() const { return ok && violation <= solvers::Evaluator::kFeasible; }
};

/// All backends on all problems of one size.
class Bench {
 public:
  /// `slow`: backends that used up their time at a smaller size.
  Bench(const CompareOptions& options, int points, const solvers::BackendRegistry& registry,
        const std::set<std::string>& slow, CompareResult* result)
      : options_(options),
        points_(points),
        problem_(points - 3, options.cases.problem),
        maker_(options.cases, points),
        result_(result) {
    problem_.view().Resize(&outside_);
    for (const solvers::BackendEntry& entry : registry) {
      if (!slow.contains(entry.name)) {
        Enter(entry, false);
      } else if (IsReferee(entry.name)) {
        Enter(entry, true);
      }
    }
  }

  void Run(int index);

  const std::vector<Contestant>& contestants() const { return contestants_; }

 private:
  void Enter(const solvers::BackendEntry& entry, bool out);
  void WarmUp(const LandingCase& made);
  Merit Judge(const Eigen::VectorXd& y);
  SolveRow Solve(Contestant* who, SolvePhase phase, const Stop& stop, int index);
  void FindReference(ProblemRow* row);
  void SolveToGap(Contestant* who, const ProblemRow& row, int repeat, bool shares);
  void SolveUnderDeadline(Contestant* who, const ProblemRow& row, int repeat);
  void Rate(const ProblemRow& row, SolveRow* solve) const;
  /// All backends in a random order, a function of seed, size and arguments: nobody always follows
  /// the same one.
  std::vector<Contestant*> Shuffled(int index, SolvePhase phase, int repeat);

  const CompareOptions& options_;
  int points_;
  planning::LandingProblem problem_;
  CaseMaker maker_;
  CompareResult* result_;
  solvers::ViewEvaluation outside_;
  std::vector<Contestant> contestants_;
  const LandingCase* case_ = nullptr;
  Eigen::VectorXd start_;
  bool warmed_up_ = false;
  solvers::SolverResult solver_;
};

void Bench::Enter(const solvers::BackendEntry& entry, bool out) {
  Contestant who;
  who.name = entry.name;
  who.out = out;
  who.compared = options_.backends.empty() || Contains(options_.backends, entry.name);
  if (!who.compared && !IsReferee(entry.name)) return;
  who.tight = entry.make();
  who.unending = entry.make();
  who.usual = entry.make();
  const std::string refusal = who.tight->Refusal(problem_.view());
  if (!refusal.empty()) {
    if (who.compared) result_->refusals.push_back({points_, who.name, refusal + "."});
    return;
  }
  SetTolerances(kTight, kTightViolation, &who.tight->options());
  SetTolerances(kNever, kNeverViolation, &who.unending->options());
  for (const auto& backend : {&who.tight, &who.unending, &who.usual}) {
    (*backend)->Prepare(problem_.view());
  }
  contestants_.push_back(std::move(who));
}

// First solves pay for pages, caches and lazy set-up; nobody is timed on them.
void Bench::WarmUp(const LandingCase& made) {
  made.Apply(&problem_);
  const Eigen::VectorXd start = made.StartPoint(problem_);
  Stop stop;
  stop.max_iterations = 50;
  stop.wall_limit_s = 1.0;
  for (Contestant& who : contestants_) {
    for (const auto& backend : {&who.tight, &who.unending, &who.usual}) {
      (*backend)->Solve(problem_.view(), start, stop, &solver_);
    }
  }
}

std::vector<Contestant*> Bench::Shuffled(int index, SolvePhase phase, int repeat) {
  sim::RandomStream stream(options_.cases.seed, fmt::format("compare order {} {} {} {}", points_,
                                                            index, ToString(phase), repeat));
  std::vector<Contestant*> order;
  for (Contestant& who : contestants_) order.push_back(&who);
  for (std::size_t left = order.size(); left > 1; --left) {
    const auto drawn = static_cast<std::size_t>(stream.Uniform(0.0, static_cast<double>(left)));
    std::swap(order[left - 1], order[std::min(drawn, left - 1)]);
  }
  return order;
}

Merit Bench::Judge(const Eigen::VectorXd& y) {
  Merit merit;
  merit.ok = problem_.view().Evaluate(y.data(), {}, {}, &outside_);
  merit.cost = outside_.full.value;
  merit.violation = outside_.full.max_violation;
  const planning::UniformBspline curve = problem_.Curve(y);
  const planning::FlatState at = curve.Evaluate(curve.t_end());
  const planning::SplineState wanted =
      planning::EndStateAt(*case_->pad, case_->target, curve.t_end()).state;
  merit.end_position = (at.p_WB - wanted.p).norm();
  merit.end_velocity = (at.v_WB - wanted.v).norm();
  return merit;
}

SolveRow Bench::Solve(Contestant* who, SolvePhase phase, const Stop& stop, int index) {
  SolverBackend& backend = phase == SolvePhase::kDeadline ? *who->usual
                           : phase == SolvePhase::kTight  ? *who->tight
                                                          : *who->unending;
  const double cpu = solvers::ThreadCpuSeconds();
  const auto wall = std::chrono::steady_clock::now();
  backend.Solve(problem_.view(), start_, stop, &solver_);
  SolveRow row;
  row.cpu_ms = 1e3 * (solvers::ThreadCpuSeconds() - cpu);
  row.wall_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - wall).count();
  if (phase != SolvePhase::kTight) who->seconds += 1e-3 * row.wall_ms;
  row.points = points_;
  row.problem = index;
  row.backend = who->name;
  row.phase = phase;
  row.status = solver_.status;
  row.iterations = solver_.iterations;
  row.evaluations = solver_.evaluations;
  row.shares = solver_.shares;
  const Merit merit = Judge(solver_.x);
  row.reached = merit.feasible();
  row.cost = merit.ok ? merit.cost : std::numeric_limits<double>::quiet_NaN();
  row.max_violation = merit.violation;
  row.end_position_m = merit.end_position;
  row.end_velocity_mps = merit.end_velocity;
  return row;
}

void Bench::Rate(const ProblemRow& row, SolveRow* solve) const {
  solve->gap = (solve->cost - row.reference_cost) / std::abs(row.reference_cost);
  solve->reached = solve->reached && solve->gap <= options_.gap;
}

void Bench::FindReference(ProblemRow* row) {
  row->reference_cost = std::numeric_limits<double>::quiet_NaN();
  Stop stop;
  stop.max_iterations = kIterations;
  stop.wall_limit_s = kSolveLimit;
  std::vector<SolveRow> solves;
  for (Contestant* who : Shuffled(row->made.index, SolvePhase::kTight, 0)) {
    if (who->out && !IsReferee(who->name)) continue;
    ++row->reference_solves;
    SolveRow solve = Solve(who, SolvePhase::kTight, stop, row->made.index);
    if (solve.reached && !(solve.cost >= row->reference_cost)) {
      row->reference_cost = solve.cost;
      row->reference_backend = solve.backend;
    }
    if (who->compared && !who->out) solves.push_back(std::move(solve));
  }
  for (SolveRow& solve : solves) {
    Rate(*row, &solve);
    result_->solves.push_back(std::move(solve));
  }
}

void Bench::SolveToGap(Contestant* who, const ProblemRow& row, int repeat, bool shares) {
  const double enough = row.reference_cost + options_.gap * std::abs(row.reference_cost);
  Stop stop;
  stop.max_iterations = kIterations;
  stop.wall_limit_s = kSolveLimit;
  stop.shares = shares;
  stop.callback = [enough](const solvers::StopQuery& query) {
    return query.cost <= enough && query.max_violation <= solvers::Evaluator::kFeasible;
  };
  SolveRow solve =
      Solve(who, shares ? SolvePhase::kShares : SolvePhase::kGap, stop, row.made.index);
  solve.repeat = repeat;
  Rate(row, &solve);
  result_->solves.push_back(std::move(solve));
}

void Bench::SolveUnderDeadline(Contestant* who, const ProblemRow& row, int repeat) {
  double best = std::numeric_limits<double>::infinity();
  Stop stop;
  stop.max_iterations = kIterations;
  stop.wall_limit_s = 1e-3 * *options_.deadline_ms;
  stop.callback = [&best](const solvers::StopQuery& query) {
    if (query.max_violation <= solvers::Evaluator::kFeasible) best = std::min(best, query.cost);
    return false;
  };
  SolveRow solve = Solve(who, SolvePhase::kDeadline, stop, row.made.index);
  solve.repeat = repeat;
  // Before the first feasible point there is nothing to return.
  const bool feasible = solve.max_violation <= solvers::Evaluator::kFeasible;
  solve.best_returned =
      !std::isfinite(best) || (feasible && solve.cost <= best + 1e-9 * std::abs(best));
  Rate(row, &solve);
  result_->solves.push_back(std::move(solve));
}

void Bench::Run(int index) {
  ProblemRow row;
  row.points = points_;
  row.made = maker_.Make(index);
  case_ = &row.made;
  if (!warmed_up_) WarmUp(row.made);
  warmed_up_ = true;
  row.made.Apply(&problem_);
  start_ = row.made.StartPoint(problem_);
  FindReference(&row);
  if (std::isfinite(row.reference_cost)) {
    for (int repeat = 0; repeat < options_.repeats; ++repeat) {
      for (Contestant* who : Shuffled(index, SolvePhase::kGap, repeat)) {
        if (!who->compared || who->out) continue;
        SolveToGap(who, row, repeat, false);
        if (options_.deadline_ms) SolveUnderDeadline(who, row, repeat);
      }
    }
    for (Contestant* who : Shuffled(index, SolvePhase::kShares, 0)) {
      if (who->compared && !who->out) SolveToGap(who, row, 0, true);
    }
  }
  result_->problems.push_back(std::move(row));
  for (Contestant& who : contestants_) {
    if (who.out || who.seconds < options_.backend_seconds) continue;
    who.out = true;
    if (!who.compared || index + 1 == options_.problems) continue;
    result_->refusals.push_back(
        {points_, who.name,
         fmt::format("backend {} was stopped after {} of {} problems: it had used {:.4g} s "
                     "(--backend-seconds).",
                     who.name, index + 1, options_.problems, who.seconds)});
  }
}

void CheckNames(const std::vector<std::string>& names, const solvers::BackendRegistry& registry) {
  std::vector<std::string> known;
  for (const solvers::BackendEntry& entry : registry) known.push_back(entry.name);
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (std::find(names.begin(), name, *name) != name) {
      throw BadInput(fmt::format("--backends {}: named twice.", *name));
    }
    if (!Contains(known, *name)) {
      throw BadInput(
          fmt::format("--backends {}: unknown; the backends are {}.", *name, Enumerate(known)));
    }
  }
}

}  // namespace

const char* ToString(SolvePhase phase) {
  switch (phase) {
    case SolvePhase::kTight:
      return "tight";
    case SolvePhase::kGap:
      return "gap";
    case SolvePhase::kShares:
      return "shares";
    case SolvePhase::kDeadline:
      return "deadline";
  }
  return "unknown";
}

CompareResult RunCompare(const CompareOptions& options, const solvers::BackendRegistry& registry,
                         const std::function<void(int done, int all)>& report) {
  CheckNames(options.backends, registry);
  CompareResult result;
  const int all = options.problems * static_cast<int>(options.points.size());
  int done = 0;
  std::set<std::string> slow;
  for (const int points : options.points) {
    Bench bench(options, points, registry, slow, &result);
    for (const std::string& name : slow) {
      if (!Contains(result.backends, name)) continue;
      result.refusals.push_back(
          {points, name,
           fmt::format("backend {} sits out: it used up its time at a smaller size "
                       "(--backend-seconds).",
                       name)});
    }
    if (points == options.points.front()) {
      for (const Contestant& who : bench.contestants()) {
        if (who.compared) result.backends.push_back(who.name);
      }
    }
    if (result.backends.empty()) {
      throw BadInput(fmt::format(
          "No backend can solve this formulation: {}",
          result.refusals.empty() ? "none is registered." : result.refusals.front().reason));
    }
    for (int index = 0; index < options.problems; ++index) {
      bench.Run(index);
      report(++done, all);
    }
    for (const Contestant& who : bench.contestants()) {
      if (who.out) slow.insert(who.name);
    }
  }
  return result;
}

}  // namespace touchdown::evaluation
