// SPDX-License-Identifier: BSD-3-Clause
// Problems, backends and solves.
#include <limits>
#include <memory>
#include <optional>

#include "evaluation/binding/bind.h"
#include "evaluation/binding/call.h"
#include "evaluation/binding/python_term.h"
#include "evaluation/binding/solvable.h"
#include "touchdown/solvers/backend/derivative_check.h"
#include "touchdown/solvers/backend_registry.h"
#include "touchdown/solvers/problem/view.h"

namespace touchdown::binding {

using namespace pybind11::literals;
using solvers::SolverResult;
using Vector = Eigen::Ref<const Eigen::VectorXd>;

namespace {

/// A problem of one's own, in its own variables.
class OwnProblem : public Solvable {
 public:
  explicit OwnProblem(const solvers::ProblemShape& shape)
      : Solvable("Problem"), problem_(shape), view_(problem_) {}

  const solvers::View& view() const override { return view_; }
  solvers::Problem& problem() { return problem_; }

 private:
  solvers::Problem problem_;
  solvers::View view_;
};

std::unique_ptr<OwnProblem> MakeProblem(int blocks, int block_size, bool free_interval,
                                        double interval, double interval_min, double interval_max,
                                        double t0) {
  auto made = std::make_unique<OwnProblem>(
      solvers::ProblemShape{blocks, block_size, free_interval, interval_min, interval_max});
  if (!(interval > 0.0) || !std::isfinite(interval)) {
    throw py::value_error("interval is " + std::to_string(interval) + ", it must be > 0");
  }
  if (!std::isfinite(t0)) throw py::value_error("t0 is not finite");
  made->problem().set_interval(interval);
  made->problem().set_t0(t0);
  return made;
}

void Add(OwnProblem& self, const py::object& term, solvers::Role role) {
  const InUse::Claim claim(self.use);
  const solvers::ProblemShape& shape = self.problem().shape();
  RequireTerm(term);
  const std::string name = py::str(term.attr("name"));
  for (int i = 0; i < self.problem().num_terms(); ++i) {
    if (self.problem().term(i).info().name != name) continue;
    throw py::value_error("there is a term " + name + " already: give this one another `name`");
  }
  self.problem().AddTerm(MakePythonTerm(term, shape.blocks, shape.block_size), role);
}

/// What a problem is at a point.
py::dict EvaluateAt(Solvable& self, const Vector& y, bool gradient, bool hessian) {
  const InUse::Claim claim(self.use);
  const solvers::View& view = self.view();
  RequireSize(view, y, "y");
  solvers::ViewEvaluation at;
  view.Resize(&at);
  WithoutLock([&] {
    view.Evaluate(y.data(), {.gradient = gradient || hessian, .hessian = hessian}, {}, &at);
  });
  py::dict told;
  told["ok"] = at.full.ok;
  std::string failure = at.full.failure;
  if (!at.full.ok && failure.empty()) {
    const int failed = at.full.failed_term;
    failure = failed < 0 ? "there is no boundary yet, or the sum of the terms is not finite"
                         : "term " + view.problem().term(failed).info().name + " is not finite";
  }
  told["failure"] = failure;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (!at.full.ok) std::fill(at.gradient.begin(), at.gradient.end(), nan);
  told["cost"] = at.full.value;
  told["max_violation"] = at.full.max_violation;
  py::dict costs;
  for (int i = 0; i < view.problem().num_terms(); ++i) {
    costs[py::str(view.problem().term(i).info().name)] = at.full.cost_by_term[i];
  }
  told["cost_by_term"] = costs;
  if (gradient || hessian) told["gradient"] = Array(at.gradient);
  if (hessian) {
    const int n = at.hessian.size();
    Eigen::MatrixXd dense(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) dense(i, j) = at.hessian.At(i, j);
    }
    told["hessian"] = dense;
  }
  return told;
}

solvers::DerivativeErrors Check(Solvable& self, const Vector& y, double step) {
  const InUse::Claim claim(self.use);
  RequireSize(self.view(), y, "y");
  if (!(step > 0.0) || !std::isfinite(step)) throw py::value_error("step must be > 0");
  return WithoutLock(
      [&] { return solvers::CheckDerivatives(self.view(), y, solvers::Lagrangian{}, step); });
}

/// The stop rule by its parts.
solvers::Stop StopOf(const py::kwargs& given) {
  solvers::Stop stop;
  for (const auto& [key, value] : given) {
    const auto name = key.cast<std::string>();
    const auto set = [&, &value = value](auto* to) {
      try {
        *to = value.cast<std::remove_pointer_t<decltype(to)>>();
      } catch (const py::cast_error&) {
        throw py::type_error(name + " is " + std::string(py::repr(value)));
      }
    };
    if (name == "max_iterations") {
      set(&stop.max_iterations);
    } else if (name == "max_evaluations") {
      set(&stop.max_evaluations);
    } else if (name == "wall_limit_s") {
      set(&stop.wall_limit_s);
    } else if (name == "gap") {
      set(&stop.gap);
    } else if (name == "confirm") {
      set(&stop.confirm);
    } else if (name == "trace") {
      set(&stop.trace);
    } else if (name == "shares") {
      set(&stop.shares);
    } else {
      throw py::type_error("solve has no argument " + name +
                           "; it has problem, start, multipliers, callback, max_iterations, "
                           "max_evaluations, wall_limit_s, gap, confirm, trace, shares");
    }
  }
  if (!(stop.gap >= 0.0 && stop.gap < 1.0)) {
    throw py::value_error("gap is " + std::to_string(stop.gap) + ", it must be in [0, 1)");
  }
  if (std::isnan(stop.wall_limit_s)) throw py::value_error("wall_limit_s is not a number");
  if (stop.max_iterations < 0 || stop.max_evaluations < 0) {
    throw py::value_error("max_iterations and max_evaluations must be at least 0");
  }
  return stop;
}

/// A backend with its options, prepared for the structure that it solved last.
class Solver {
 public:
  Solver(const std::string& backend, const py::dict& options)
      : use("Solver"), backend_(solvers::MakeBackend(solvers::StandardBackends(), backend)) {
    for (const auto& [name, value] : options) {
      const std::string word = py::str(name);
      if (!py::isinstance<py::float_>(value) && !py::isinstance<py::int_>(value)) {
        throw py::type_error("option " + word + " is " + std::string(py::repr(value)) +
                             ", it must be a number");
      }
      Set(word, value.cast<double>());
    }
  }
  ~Solver() {
    const CallGuard under_way;
    const py::gil_scoped_release release;  // a backend may wait for another one's solve
    backend_.reset();
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  void Set(const std::string& option, double value) { backend_->options().Set(option, value); }
  const std::string& name() const { return backend_->name(); }
  const solvers::SolverOptions& options() const { return backend_->options(); }
  std::string Refusal(Solvable& problem) {
    const InUse::Share mine(use), its(problem.use);
    return backend_->Refusal(problem.view());
  }

  std::unique_ptr<SolverResult> Solve(Solvable& problem, const Vector& start,
                                      std::vector<std::vector<double>> multipliers,
                                      const py::object& callback, const py::kwargs& kwargs) {
    const InUse::Claim mine(use), its(problem.use);
    const solvers::View& view = problem.view();
    RequireSize(view, start, "start");
    solvers::Stop stop = StopOf(kwargs);
    const std::optional<Kept> asks =
        callback.is_none() ? std::nullopt : std::make_optional<Kept>(callback);
    stop.callback = [&](const solvers::StopQuery& query) {
      if (Call::Now()->MustEnd()) return true;
      if (!asks) return false;
      try {
        return WithLock([&] {
          const auto y =
              py::array_t<double>(static_cast<py::ssize_t>(query.y.size()), query.y.data());
          const py::object ends =
              asks->get()(y, query.cost, query.max_violation, query.evaluations);
          return static_cast<bool>(py::bool_(ends));
        });
      } catch (const PythonRaised&) {
        return true;
      }
    };
    auto result = std::make_unique<SolverResult>();
    const solvers::WarmStart warm(start, std::move(multipliers));
    WithoutLock([&] {
      if (!prepared_.IsOf(view)) {
        prepared_ = {};
        backend_->Prepare(view);
        prepared_ = solvers::ViewStructure(view);
      }
      backend_->Solve(view, warm, stop, result.get());
    });
    return result;
  }

  InUse use;

 private:
  std::unique_ptr<solvers::SolverBackend> backend_;
  solvers::ViewStructure prepared_;
};

py::list Trace(const SolverResult& result) {
  py::list rows;
  for (const solvers::IterationRecord& at : result.trace) {
    rows.append(py::dict("iteration"_a = at.iteration, "cost"_a = at.cost,
                         "max_violation"_a = at.max_violation, "step_norm"_a = at.step_norm,
                         "gradient_max_norm"_a = at.gradient_max_norm, "time_s"_a = at.time_s));
  }
  return rows;
}

py::dict CostByTerm(const SolverResult& result) {
  py::dict costs;
  for (const solvers::TermCost& term : result.cost_by_term) costs[py::str(term.name)] = term.cost;
  return costs;
}

py::list Backends() {
  py::list all;
  for (const solvers::BackendEntry& entry : solvers::StandardBackends()) {
    const auto backend = entry.make();
    const solvers::Capabilities can = backend->capabilities();
    py::dict options;
    for (const solvers::OptionSpec& option : backend->options().specs()) {
      options[py::str(option.name)] =
          py::dict("value"_a = option.value, "lo"_a = option.lo, "hi"_a = option.hi,
                   "integer"_a = option.integer, "help"_a = option.help);
    }
    all.append(py::dict(
        "name"_a = entry.name, "description"_a = entry.description, "compiled"_a = can.compiled,
        "hard_rows"_a = can.hard_rows, "equality_rows"_a = can.equality_rows,
        "variable_bounds"_a = can.variable_bounds, "free_interval"_a = can.free_interval,
        "needs_residuals"_a = can.needs_residuals, "options"_a = options));
  }
  return all;
}

void BindResult(py::module_& m) {
  py::class_<solvers::Optimality>(m, "Optimality", Doc("Optimality"))
      .def_readonly("evaluated", &solvers::Optimality::evaluated, Doc("Optimality::evaluated"))
      .def_readonly("violation", &solvers::Optimality::violation, Doc("Optimality::violation"))
      .def_readonly("step", &solvers::Optimality::step, Doc("Optimality::step"))
      .def_readonly("gain", &solvers::Optimality::gain, Doc("Optimality::gain"))
      .def_readonly("left", &solvers::Optimality::left, Doc("Optimality::left"))
      .def_readonly("gap", &solvers::Optimality::gap, Doc("Optimality::gap"))
      .def_readonly("saddle", &solvers::Optimality::saddle, Doc("Optimality::saddle"))
      .def_property_readonly("feasible", &solvers::Optimality::feasible, "The rows are kept.")
      .def_property_readonly("stationary", &solvers::Optimality::stationary,
                             "No step is worth taking.");
  py::class_<SolverResult>(m, "SolverResult", Doc("SolverSummary"))
      .def_readonly("status", &SolverResult::status, Doc("SolveStatus"))
      .def_property_readonly(
          "x", [](const SolverResult& r) { return Eigen::VectorXd(r.x); }, Doc("SolverResult::x"))
      .def_readonly("cost", &SolverResult::cost, "Of the point.")
      .def_property_readonly("cost_by_term", &CostByTerm, Doc("TermCost"))
      .def_readonly("max_violation", &SolverResult::max_violation,
                    Doc("SolverSummary::max_violation"))
      .def_readonly("iterations", &SolverResult::iterations, "As reported by the backend.")
      .def_readonly("evaluations", &SolverResult::evaluations, Doc("SolverSummary::evaluations"))
      .def_readonly("wall_s", &SolverResult::wall_s, "Wall time of the solve [s].")
      .def_readonly("cpu_s", &SolverResult::cpu_s, Doc("SolverSummary::cpu_s"))
      .def_readonly("message", &SolverResult::message, Doc("SolverResult::message"))
      .def_readonly("multipliers", &SolverResult::multipliers, Doc("SolverResult::multipliers"))
      .def_readonly("bound_multipliers", &SolverResult::bound_multipliers,
                    Doc("SolverResult::bound_multipliers"))
      .def_readonly("optimality", &SolverResult::optimality, Doc("SolverSummary::optimality"))
      .def_property_readonly("usable", &SolverResult::usable, Doc("SolverSummary::usable"))
      .def_property_readonly("trace", &Trace, Doc("SolverResult::trace"))
      .def_property_readonly(
          "shares",
          [](const SolverResult& r) {
            return py::dict("evaluation_s"_a = r.shares.evaluation_s,
                            "whitening_s"_a = r.shares.whitening_s,
                            "native_s"_a = r.shares.native_s, "adapter_s"_a = r.shares.adapter_s);
          },
          Doc("SolveShares"))
      .def("__repr__", [](const SolverResult& r) {
        return "SolverResult(status=" + std::string(py::repr(py::cast(r.status))) +
               ", cost=" + std::string(py::repr(py::float_(r.cost))) +
               ", max_violation=" + std::string(py::repr(py::float_(r.max_violation))) +
               ", iterations=" + std::to_string(r.iterations) + ")";
      });
  py::class_<solvers::DerivativeErrors>(m, "DerivativeErrors", Doc("DerivativeErrors"))
      .def_readonly("evaluated", &solvers::DerivativeErrors::evaluated,
                    Doc("DerivativeErrors::evaluated"))
      .def_readonly("gradient", &solvers::DerivativeErrors::gradient,
                    Doc("DerivativeErrors::gradient"))
      .def_readonly("hessian", &solvers::DerivativeErrors::hessian,
                    Doc("DerivativeErrors::hessian"))
      .def_readonly("residual_jacobian", &solvers::DerivativeErrors::residual_jacobian,
                    Doc("DerivativeErrors::residual_jacobian"))
      .def_readonly("row_jacobian", &solvers::DerivativeErrors::row_jacobian,
                    Doc("DerivativeErrors::row_jacobian"))
      .def_property_readonly("worst", &solvers::DerivativeErrors::worst,
                             Doc("DerivativeErrors::worst"));
}

}  // namespace

void RequireSize(const solvers::View& view, const Vector& y, const char* name) {
  if (y.size() == view.num_variables()) return;
  throw py::value_error(std::string(name) + " has " + std::to_string(y.size()) +
                        " numbers, the problem has " + std::to_string(view.num_variables()) +
                        " variables");
}

void BindLosses(py::module_& m) {
  const auto value = [](const auto& loss, double u) {
    const solvers::LossValue at = loss.Value(u);
    return py::make_tuple(at.rho, at.drho, at.d2rho);
  };
  const char* told = "(rho, drho, d2rho) at u.";
  py::class_<solvers::SquareLoss>(m, "SquareLoss", Doc("SquareLoss"))
      .def(py::init<double>(), "weight"_a)
      .def(
          "value", [=](const solvers::SquareLoss& l, double u) { return value(l, u); }, "u"_a,
          told);
  py::class_<solvers::HingeLoss>(m, "HingeLoss", Doc("HingeLoss"))
      .def(py::init<double, double>(), "weight"_a, "width"_a)
      .def(
          "value", [=](const solvers::HingeLoss& l, double u) { return value(l, u); }, "u"_a, told);
  py::class_<solvers::RangeLoss>(m, "RangeLoss", Doc("RangeLoss"))
      .def(py::init([](double lo, double hi, double weight, double width) {
             return solvers::RangeLoss({lo, hi}, weight, width);
           }),
           "lo"_a, "hi"_a, "weight"_a = 1.0, "width"_a = 1.0)
      .def(
          "value", [=](const solvers::RangeLoss& l, double u) { return value(l, u); }, "u"_a, told);
  py::class_<solvers::LinearLoss>(m, "LinearLoss", Doc("LinearLoss"))
      .def(py::init<double>(), "weight"_a)
      .def(
          "value", [=](const solvers::LinearLoss& l, double u) { return value(l, u); }, "u"_a,
          told);
}

void BindSolve(py::module_& m) {
  BindResult(m);
  py::class_<Solvable>(m, "Solvable", "What can be solved: a Problem, or a LandingProblem.")
      .def_property_readonly(
          "num_variables", [](const Solvable& p) { return p.view().num_variables(); },
          "How many numbers a point has.")
      .def_property_readonly(
          "terms",
          [](Solvable& p) {
            const InUse::Share share(p.use);
            py::list names;
            for (int i = 0; i < p.view().problem().num_terms(); ++i) {
              names.append(p.view().problem().term(i).info().name);
            }
            return names;
          },
          "Names of its terms, in the order in which they were added.")
      .def("evaluate", &EvaluateAt, "y"_a, "gradient"_a = true, "hessian"_a = false,
           "The problem at y, a dictionary: `ok`, `failure`, `cost`, `max_violation`, "
           "`cost_by_term` and what is "
           "asked for: `gradient` of shape (n,), `hessian` of shape (n, n).")
      .def("check_derivatives", &Check, "y"_a, "step"_a = 1e-6, Doc("CheckDerivatives"));
  py::class_<OwnProblem, Solvable>(m, "Problem", Doc("Problem"))
      .def(py::init(&MakeProblem), "blocks"_a, "block_size"_a = 1, "free_interval"_a = false,
           "interval"_a = 1.0, "interval_min"_a = 1e-3, "interval_max"_a = 1e3, "t0"_a = 0.0,
           Doc("ProblemShape"))
      .def("add", &Add, "term"_a, "role"_a = solvers::Role::kCost,
           "Adds a touchdown.Term, as a \"cost\" or as \"rows\". Raises ValueError or TypeError "
           "naming what of it "
           "does not fit.")
      .def(
          "set_bounds",
          [](OwnProblem& self, std::vector<double> lower, std::vector<double> upper) {
            const InUse::Claim claim(self.use);
            self.problem().SetBounds(std::move(lower), std::move(upper));
          },
          "lower"_a, "upper"_a, Doc("Problem::SetBounds"))
      .def_property_readonly(
          "convex",
          [](OwnProblem& p) {
            const InUse::Share share(p.use);
            return p.problem().convex();
          },
          Doc("Problem::convex"));
  py::class_<Solver>(
      m, "Solver",
      "A backend with its options. It keeps its memory from solve to solve of one structure.")
      .def(py::init<const std::string&, const py::dict&>(), "backend"_a = "banded",
           "options"_a = py::dict())
      .def_property_readonly("name", &Solver::name, "Of the backend.")
      .def(
          "set_option",
          [](Solver& self, const std::string& name, double value) {
            const InUse::Claim claim(self.use);
            self.Set(name, value);
          },
          "name"_a, "value"_a, Doc("SolverOptions::Set"))
      .def(
          "option",
          [](Solver& self, const std::string& name) {
            const InUse::Share share(self.use);
            return self.options().Get(name);
          },
          "name"_a, Doc("SolverOptions::Get"))
      .def("refusal", &Solver::Refusal, "problem"_a, Doc("SolverBackend::Refusal"))
      .def("solve", &Solver::Solve, "problem"_a, "start"_a,
           "multipliers"_a = std::vector<std::vector<double>>(), "callback"_a = py::none(),
           "Solves the problem from `start`, of shape (n,). Also takes the parts of the stop rule "
           "by name: "
           "max_iterations=100, max_evaluations, wall_limit_s, gap=0.0, confirm=True, trace=False, "
           "shares=False. "
           "`callback(y, cost, max_violation, evaluations)` is asked at every evaluation, and ends "
           "the solve by a true "
           "answer. What a term or the callback raises is raised here.");
  m.def("backends", &Backends,
        "All backends, a list of dictionaries: name, description, what they can take, their "
        "options.");
}

}  // namespace touchdown::binding
