// SPDX-License-Identifier: BSD-3-Clause
// The backends `ipopt` and `ipopt-lm` (A. Waechter, L. Biegler, Math. Program. 106 (2006) 25).
// Written for Ipopt 3.11 and later. With the exact Hessian a few iterations reach rounding, and
// each costs a call of MUMPS. With a limited-memory Hessian the landing problem converges only if
// it is whitened. So `ipopt-lm` is always whitened, which makes its rows' Jacobian dense. The
// monotone barrier is faster than the adaptive one on these problems.
//
// Statuses. "Solved", also to the acceptable level, is convergence. Local infeasibility is
// kInfeasible, and a number that is not finite is kEvaluationFailed. If Ipopt can no longer move,
// the point has converged only if its last infeasibilities were small.

#include "solvers/ipopt/ipopt_solver.h"

#include <IpIpoptApplication.hpp>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "solvers/ipopt/ipopt_nlp.h"

namespace touchdown::solvers {

namespace {

/// Largest dual infeasibility, share of the cost, at which a point that Ipopt cannot improve counts
/// as converged.
constexpr double kStationary = 1e-6;

/// Held while any code of Ipopt runs, in whichever instance. A term may solve with another instance
/// meanwhile: it is called between Ipopt's steps.
std::recursive_mutex& IpoptMutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

SolverOptions OptionsOf(bool exact_hessian) {
  std::vector<OptionSpec> specs = {
      {"tolerance", 1e-8, 1e-15, 1e-1, false, "scaled optimality error that ends a solve"},
      {"violation_tolerance", 1e-8, 1e-14, Evaluator::kFeasible, false,
       "violation of a hard row at which a solve may end"},
      {"mu_init", 1e-3, 1e-12, 1e3, false, "first barrier parameter"},
      {"warm_mu_init", 1e-6, 1e-12, 1e3, false, "the same where multipliers are given"},
      {"scaling", 1.0, 0.0, 1.0, true, "1: scale objective and rows by their first gradients"},
  };
  if (!exact_hessian) {
    specs.push_back({"vector_storage", 10.0, 1.0, 1000.0, true, "gradients remembered"});
  }
  return SolverOptions(specs);
}

class IpoptSolver : public SolverBackend {
 public:
  IpoptSolver(const std::string& name, bool exact_hessian)
      : SolverBackend(name, OptionsOf(exact_hessian)), exact_hessian_(exact_hessian) {}
  ~IpoptSolver() override {
    if (!Ipopt::IsValid(application_)) return;  // nothing of Ipopt's was made
    const std::lock_guard<std::recursive_mutex> lock(IpoptMutex());
    nlp_ = nullptr;
    application_ = nullptr;
  }
  IpoptSolver(const IpoptSolver&) = delete;
  IpoptSolver& operator=(const IpoptSolver&) = delete;

  Capabilities capabilities() const override {
    return {.hard_rows = true, .equality_rows = true, .variable_bounds = true};
  }

 private:
  void DoPrepare(const View& view) override {
    const std::lock_guard<std::recursive_mutex> lock(IpoptMutex());
    nlp_ = new IpoptNlp(exact_hessian_);
    nlp_->Prepare(view);
    if (Ipopt::IsValid(application_)) return;
    application_ = new Ipopt::IpoptApplication(false);
    application_->RethrowNonIpoptException(true);
    const auto options = application_->Options();
    options->SetStringValue("sb", "yes");
    options->SetIntegerValue("print_level", 0);
    options->SetStringValue("linear_solver", "mumps");
    options->SetStringValue("mu_strategy", "monotone");
    options->SetStringValue("hessian_approximation", exact_hessian_ ? "exact" : "limited-memory");
    // Where multipliers are given, they and the point beside them are to be kept as they are.
    for (const char* name :
         {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_slack_bound_push",
          "warm_start_slack_bound_frac", "warm_start_mult_bound_push"}) {
      options->SetNumericValue(name, 1e-9);
    }
    application_->Initialize("");  // no options file
  }

  void DoSolve(const View& view, const WarmStart& warm, const Stop& stop, Evaluator* evaluator,
               SolverResult* result) override {
    if (!nlp_->Begin(view, warm, evaluator)) {
      result->status = SolveStatus::kEvaluationFailed;
      return;
    }
    const std::lock_guard<std::recursive_mutex> lock(IpoptMutex());
    if (evaluator->CheckStop()) {
      result->status = evaluator->stop_status();
      return;
    }
    Configure(stop);
    Ipopt::ApplicationReturnStatus code = Ipopt::User_Requested_Stop;
    try {
      const ShareScope scope(evaluator, Share::kNative);
      code = application_->OptimizeTNLP(Ipopt::GetRawPtr(nlp_));
    } catch (const IpoptNlp::Ended&) {
    }
    result->native_status = code;
    result->message = Words(code);
    result->status = Status(code, *evaluator);
    if (!nlp_->report().has_multipliers) return;
    result->multipliers = nlp_->multipliers();
    result->bound_multipliers = nlp_->bound_multipliers();
  }

  void Configure(const Stop& stop) {
    const auto ipopt = application_->Options();
    const double tolerance = options().Get("tolerance");
    ipopt->SetNumericValue("tol", tolerance);
    ipopt->SetNumericValue("acceptable_tol", 10.0 * tolerance);
    ipopt->SetNumericValue("constr_viol_tol", options().Get("violation_tolerance"));
    ipopt->SetNumericValue("acceptable_constr_viol_tol", options().Get("violation_tolerance"));
    ipopt->SetStringValue("nlp_scaling_method",
                          options().Get("scaling") != 0.0 ? "gradient-based" : "none");
    const bool warm = nlp_->has_warm_multipliers();
    ipopt->SetStringValue("warm_start_init_point", warm ? "yes" : "no");
    ipopt->SetNumericValue("mu_init", options().Get(warm ? "warm_mu_init" : "mu_init"));
    ipopt->SetIntegerValue("max_iter", stop.max_iterations);
    if (!exact_hessian_) {
      ipopt->SetIntegerValue("limited_memory_max_history",
                             static_cast<int>(options().Get("vector_storage")));
    }
  }

  SolveStatus Status(Ipopt::ApplicationReturnStatus code, const Evaluator& evaluator) const {
    if (evaluator.must_stop()) return evaluator.stop_status();
    if (nlp_->rows().constant_violation() > Evaluator::kFeasible) return SolveStatus::kInfeasible;
    switch (code) {
      case Ipopt::Solve_Succeeded:
      case Ipopt::Solved_To_Acceptable_Level:
      case Ipopt::Feasible_Point_Found:
        return SolveStatus::kConverged;
      case Ipopt::Infeasible_Problem_Detected:
        return SolveStatus::kInfeasible;
      case Ipopt::Maximum_Iterations_Exceeded:
        return SolveStatus::kIterationLimit;
      case Ipopt::Invalid_Number_Detected:
        return SolveStatus::kEvaluationFailed;
      case Ipopt::Diverging_Iterates:
        return SolveStatus::kUnbounded;
      default:
        break;
    }
    const IpoptNlp::Report& last = nlp_->report();
    if (!last.told) return SolveStatus::kNumericalFailure;
    const double scale = std::max(1.0, std::abs(evaluator.best_cost()));
    const bool stationary = last.primal_infeasibility <= Evaluator::kFeasible &&
                            last.dual_infeasibility <= kStationary * scale;
    return stationary ? SolveStatus::kConverged : SolveStatus::kNumericalFailure;
  }

  static const char* Words(Ipopt::ApplicationReturnStatus code) {
    switch (code) {
      case Ipopt::Solve_Succeeded:
        return "solve succeeded";
      case Ipopt::Solved_To_Acceptable_Level:
        return "solved to acceptable level";
      case Ipopt::Infeasible_Problem_Detected:
        return "converged to a point of local infeasibility";
      case Ipopt::Search_Direction_Becomes_Too_Small:
        return "search direction becomes too small";
      case Ipopt::Diverging_Iterates:
        return "diverging iterates";
      case Ipopt::User_Requested_Stop:
        return "stopped";
      case Ipopt::Feasible_Point_Found:
        return "feasible point found";
      case Ipopt::Maximum_Iterations_Exceeded:
        return "maximum number of iterations exceeded";
      case Ipopt::Restoration_Failed:
        return "restoration failed";
      case Ipopt::Error_In_Step_Computation:
        return "error in step computation";
      case Ipopt::Not_Enough_Degrees_Of_Freedom:
        return "more equality rows than variables";
      case Ipopt::Invalid_Number_Detected:
        return "a function value is not finite";
      default:
        return "internal failure";
    }
  }

  bool exact_hessian_;
  Ipopt::SmartPtr<IpoptNlp> nlp_;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application_;
};

}  // namespace

std::unique_ptr<SolverBackend> MakeIpopt() { return std::make_unique<IpoptSolver>("ipopt", true); }
std::unique_ptr<SolverBackend> MakeIpoptLm() {
  return std::make_unique<IpoptSolver>("ipopt-lm", false);
}

}  // namespace touchdown::solvers
