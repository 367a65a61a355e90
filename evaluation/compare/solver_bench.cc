// SPDX-License-Identifier: BSD-3-Clause
// The measurement. The reference cost of a problem is the best feasible one over tight solves of all backends. `banded`
// and `ipopt` are always among them where they can solve it, even when they are not timed. A timed solve runs with
// tolerances that never end it. One test for all, outside of the backend, ends it at one of its evaluations: cost
// within the gap of the reference, rows within Evaluator::kFeasible. So no backend's own convergence test decides. The
// returned point is evaluated anew; the backend's own report is not used.
#include "evaluation/compare/solver_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/suggestion.h"
#include "evaluation/scenario/scenario_value.h"
#include "sim/base/random_stream.h"
#include "touchdown/solvers/backend/evaluator.h"
#include "touchdown/solvers/backend/thread_clock.h"

namespace touchdown::evaluation {
namespace {

using solvers::SolverBackend;
using solvers::Stop;

constexpr double kSolveLimit = 5.0;  // wall time of any one solve [s]
constexpr int kIterations = 3000;    // of any one solve
// Tolerances below rounding never end some solves. A solve that gains nothing in so many evaluations is ended.
constexpr int kIdleEvaluations = 200;
constexpr double kGain = 1e-13;  // of the cost
// Tight tolerances are for solves in which the backend's own test decides. With the others the
// backend does not end a solve before the test from outside does.
constexpr double kTight = 1e-10;
constexpr double kTightViolation = 1e-9;
constexpr double kNever = 1e-15;
constexpr double kNeverViolation = 1e-12;
const std::vector<std::string> kReferenceBackends = {"banded", "ipopt"};

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool IsReference(const std::string& name) { return Contains(kReferenceBackends, name); }

void SetTolerances(double tolerance, double violation, solvers::SolverOptions* options) {
  for (const solvers::OptionSpec& spec : std::vector(options->specs())) {
    if (spec.name.find("tolerance") == std::string::npos) continue;
    const double wanted = spec.name.find("violation") == std::string::npos ? tolerance : violation;
    options->Set(spec.name, std::clamp(wanted, spec.lo, std::max(spec.lo, spec.value)));
  }
}

Stop Limited() {
  Stop stop;
  stop.max_iterations = kIterations;
  stop.wall_limit_s = kSolveLimit;
  return stop;
}

std::ptrdiff_t PlaceOf(const solvers::BackendRegistry& registry, const std::string& name) {
  const auto named = [&](const solvers::BackendEntry& entry) { return entry.name == name; };
  return std::find_if(registry.begin(), registry.end(), named) - registry.begin();
}

Stop UntilIdle() {
  Stop stop = Limited();
  stop.callback = [best = std::numeric_limits<double>::infinity(),
                   idle = 0](const solvers::StopQuery& query) mutable {
    const bool feasible = query.max_violation <= solvers::Evaluator::kFeasible;
    if (!std::isfinite(best) && !feasible) return false;
    if (feasible && !(query.cost >= best - kGain * std::abs(best))) {
      best = query.cost;
      idle = 0;
    }
    return ++idle > kIdleEvaluations;
  };
  return stop;
}

void CheckNames(const std::vector<std::string>& names, const solvers::BackendRegistry& registry) {
  std::vector<std::string> known;
  for (const solvers::BackendEntry& entry : registry) known.push_back(entry.name);
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (std::find(names.begin(), name, *name) != name) {
      throw BadInput(fmt::format("--backends {}: named twice.", *name));
    }
    if (!Contains(known, *name)) {
      throw BadInput(fmt::format("--backends {}: unknown{}.", *name,
                                 Instead(*name, known, "the backends are")));
    }
  }
}

}  // namespace

/// One backend at work on the problems of one structure.
struct SolverBench::BenchBackend {
  std::string name;
  std::unique_ptr<SolverBackend> tight;     ///< for SolvePhase::kTight
  std::unique_ptr<SolverBackend> unending;  ///< for those that are ended from outside
  std::unique_ptr<SolverBackend> usual;     ///< for SolvePhase::kDeadline, default tolerances
};

/// All backends that can solve the problems of one structure.
struct SolverBench::Field {
  solvers::ViewStructure structure;
  std::vector<BenchBackend> backends;
  solvers::ViewEvaluation outside;
};

/// A point as seen from outside.
struct SolverBench::Merit {
  bool ok = false;
  double cost = 0.0;
  double violation = 0.0;

  bool feasible() const { return ok && violation <= solvers::Evaluator::kFeasible; }
};

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

SolverBench::SolverBench(const BenchOptions& options, const solvers::BackendRegistry& registry,
                         const planning::TermRegistry& terms)
    : options_(options), registry_(registry) {
  CheckNames(options_.backends, registry_);
  for (const planning::TermEntry& entry : terms) {
    if (entry.is_clearance) clearance_terms_.insert(entry.info.name);
  }
}

SolverBench::~SolverBench() = default;

bool SolverBench::Compares(const std::string& name) const {
  return options_.backends.empty() || Contains(options_.backends, name);
}

void SolverBench::Enter(const solvers::BackendEntry& entry, const solvers::View& view,
                        Field* field) {
  const bool compared = Compares(entry.name);
  if (!compared && !IsReference(entry.name)) return;
  BenchBackend backend;
  backend.name = entry.name;
  backend.tight = entry.make();
  backend.unending = entry.make();
  backend.usual = entry.make();
  const std::string refusal = backend.tight->Refusal(view);
  const auto told = [&](const Refusal& of) { return of.backend == entry.name; };
  auto& refusals = result_.refusals;
  if (!refusal.empty()) {
    if (compared && std::none_of(refusals.begin(), refusals.end(), told)) {
      refusals.push_back({entry.name, refusal + "."});
    }
    return;
  }
  SetTolerances(kTight, kTightViolation, &backend.tight->options());
  SetTolerances(kNever, kNeverViolation, &backend.unending->options());
  for (const auto& solver : {&backend.tight, &backend.unending, &backend.usual})
    (*solver)->Prepare(view);
  if (compared && !Contains(result_.backends, entry.name)) {
    result_.backends.push_back(entry.name);
    std::sort(result_.backends.begin(), result_.backends.end(), [&](const auto& a, const auto& b) {
      return PlaceOf(registry_, a) < PlaceOf(registry_, b);
    });
  }
  field->backends.push_back(std::move(backend));
}

// First solves pay for pages, caches and lazy set-up; they are not timed.
SolverBench::Field& SolverBench::FieldFor(const solvers::SolveRequest& asked) {
  for (Field& field : fields_) {
    if (field.structure.IsOf(asked.view)) return field;
  }
  Field& field = fields_.emplace_back();
  field.structure = solvers::ViewStructure(asked.view);
  asked.view.Resize(&field.outside);
  for (const solvers::BackendEntry& entry : registry_) Enter(entry, asked.view, &field);
  Stop stop;
  stop.max_iterations = 50;
  stop.wall_limit_s = 1.0;
  for (BenchBackend& backend : field.backends) {
    for (const auto& solver : {&backend.tight, &backend.unending, &backend.usual}) {
      (*solver)->Solve(asked.view, asked.start, stop, &solver_);
    }
  }
  return field;
}

// A function of seed, problem and arguments. No backend always follows the same other.
std::vector<SolverBench::BenchBackend*> SolverBench::Shuffled(SolvePhase phase, int repeat) {
  sim::RandomStream stream(options_.seed,
                           fmt::format("compare order {} {} {}", index(), ToString(phase), repeat));
  std::vector<BenchBackend*> order;
  for (BenchBackend& backend : field_->backends) order.push_back(&backend);
  for (std::size_t left = order.size(); left > 1; --left) {
    const auto drawn = static_cast<std::size_t>(stream.Uniform(0.0, static_cast<double>(left)));
    std::swap(order[left - 1], order[std::min(drawn, left - 1)]);
  }
  return order;
}

SolverBench::Merit SolverBench::Judge(const Eigen::VectorXd& y) {
  Merit merit;
  merit.ok = asked_->view.Evaluate(y.data(), {}, {}, &field_->outside);
  merit.cost = field_->outside.full.value;
  merit.violation =
      merit.ok ? field_->outside.full.max_violation : std::numeric_limits<double>::quiet_NaN();
  return merit;
}

SolveRow SolverBench::Solve(BenchBackend* backend, SolvePhase phase, const Stop& stop) {
  SolverBackend& solver = phase == SolvePhase::kDeadline ? *backend->usual
                          : phase == SolvePhase::kTight  ? *backend->tight
                                                         : *backend->unending;
  const double cpu = solvers::ThreadCpuSeconds();
  const auto wall = std::chrono::steady_clock::now();
  solver.Solve(asked_->view, asked_->start, stop, &solver_);
  SolveRow row;
  row.cpu_ms = 1e3 * (solvers::ThreadCpuSeconds() - cpu);
  row.wall_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - wall).count();
  if (phase != SolvePhase::kTight) seconds_[backend->name] += 1e-3 * row.wall_ms;
  row.problem = index();
  row.backend = backend->name;
  row.phase = phase;
  row.status = solver_.status;
  row.iterations = solver_.iterations;
  row.evaluations = solver_.evaluations;
  row.shares = solver_.shares;
  const Merit merit = Judge(solver_.x);
  row.reached = merit.feasible();
  row.cost = merit.ok ? merit.cost : std::numeric_limits<double>::quiet_NaN();
  row.max_violation = merit.violation;
  return row;
}

void SolverBench::Rate(const ProblemRow& row, SolveRow* solve) const {
  solve->gap = (solve->cost - row.reference_cost) / std::abs(row.reference_cost);
  solve->reached = solve->reached && solve->gap <= options_.gap;
}

void SolverBench::FindReference(ProblemRow* row) {
  row->reference_cost = std::numeric_limits<double>::quiet_NaN();
  std::vector<SolveRow> solves;
  for (BenchBackend* backend : Shuffled(SolvePhase::kTight, 0)) {
    if (out_.contains(backend->name) && !IsReference(backend->name)) continue;
    ++row->reference_solves;
    SolveRow solve = Solve(backend, SolvePhase::kTight, UntilIdle());
    if (solve.reached && !(solve.cost >= row->reference_cost)) {
      row->reference_cost = solve.cost;
      row->reference_backend = solve.backend;
    }
    if (Compares(backend->name) && !out_.contains(backend->name))
      solves.push_back(std::move(solve));
  }
  for (SolveRow& solve : solves) {
    Rate(*row, &solve);
    result_.solves.push_back(std::move(solve));
  }
}

void SolverBench::SolveToGap(BenchBackend* backend, const ProblemRow& row, int repeat,
                             bool shares) {
  const double enough = row.reference_cost + options_.gap * std::abs(row.reference_cost);
  Stop stop = Limited();
  stop.shares = shares;
  stop.callback = [enough](const solvers::StopQuery& query) {
    return query.cost <= enough && query.max_violation <= solvers::Evaluator::kFeasible;
  };
  SolveRow solve = Solve(backend, shares ? SolvePhase::kShares : SolvePhase::kGap, stop);
  solve.repeat = repeat;
  Rate(row, &solve);
  result_.solves.push_back(std::move(solve));
}

void SolverBench::SolveUnderDeadline(BenchBackend* backend, const ProblemRow& row, int repeat) {
  double best = std::numeric_limits<double>::infinity();
  Stop stop = Limited();
  stop.wall_limit_s = 1e-3 * *options_.deadline_ms;
  stop.callback = [&best](const solvers::StopQuery& query) {
    if (query.max_violation <= solvers::Evaluator::kFeasible) best = std::min(best, query.cost);
    return false;
  };
  SolveRow solve = Solve(backend, SolvePhase::kDeadline, stop);
  solve.repeat = repeat;
  // Before the first feasible point there is nothing to return.
  const bool feasible = solve.max_violation <= solvers::Evaluator::kFeasible;
  solve.best_returned =
      !std::isfinite(best) || (feasible && solve.cost <= best + 1e-9 * std::abs(best));
  Rate(row, &solve);
  result_.solves.push_back(std::move(solve));
}

ProblemRow SolverBench::Facts(const solvers::View& view) {
  const solvers::Problem& problem = view.problem();
  ProblemRow row;
  row.points = problem.shape().blocks;
  row.free_arrival = view.free_interval();
  row.explicit_endpoint = view.identity();
  for (int i = 0; i < problem.num_terms(); ++i) {
    const solvers::LossBounds bounds = problem.term(i).bounds();
    const bool rows = problem.role(i) == solvers::Role::kConstraint;
    row.hard_limits = row.hard_limits || (rows && bounds.lo != bounds.hi);
    if (clearance_terms_.contains(problem.term(i).info().name)) {
      row.pairs += field_->outside.full.terms[static_cast<std::size_t>(i)].windows;
    }
  }
  row.duration_s = field_->outside.h * (row.points - 3);
  return row;
}

// Backends that have used their time are skipped from here on.
void SolverBench::EndTurns() {
  for (const BenchBackend& backend : field_->backends) {
    if (out_.contains(backend.name) || seconds_[backend.name] < options_.backend_seconds) continue;
    out_.insert(backend.name);
    if (!Compares(backend.name)) continue;
    result_.refusals.push_back(
        {backend.name,
         fmt::format("backend {} is skipped after {} problems: its time of {:.4g} s is used up.",
                     backend.name, index(), seconds_[backend.name])});
  }
}

void SolverBench::Run(const solvers::SolveRequest& asked, int flight, int solve) {
  asked_ = &asked;
  field_ = &FieldFor(asked);
  const bool compares =
      std::any_of(field_->backends.begin(), field_->backends.end(),
                  [&](const BenchBackend& backend) { return Compares(backend.name); });
  if (!compares) {
    ++result_.refused;  // the refusals say why
    return;
  }
  const Merit start = Judge(asked.start.y);
  ProblemRow row = Facts(asked.view);  // as that look has placed the terms
  row.flight = flight;
  row.solve = solve;
  FindReference(&row);
  row.start_gap = start.feasible()
                      ? (start.cost - row.reference_cost) / std::abs(row.reference_cost)
                      : std::numeric_limits<double>::quiet_NaN();
  row.standing = row.start_gap <= options_.gap;
  if (std::isfinite(row.reference_cost) && !row.standing) {
    for (int repeat = 0; repeat < options_.repeats; ++repeat) {
      for (BenchBackend* backend : Shuffled(SolvePhase::kGap, repeat)) {
        if (!Compares(backend->name) || out_.contains(backend->name)) continue;
        SolveToGap(backend, row, repeat, false);
        if (options_.deadline_ms) SolveUnderDeadline(backend, row, repeat);
      }
    }
    for (BenchBackend* backend : Shuffled(SolvePhase::kShares, 0)) {
      if (options_.shares && Compares(backend->name) && !out_.contains(backend->name)) {
        SolveToGap(backend, row, 0, true);
      }
    }
  }
  result_.problems.push_back(std::move(row));
  EndTurns();
  asked_ = nullptr;
}

}  // namespace touchdown::evaluation
