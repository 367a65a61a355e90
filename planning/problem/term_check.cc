// SPDX-License-Identifier: BSD-3-Clause
// Derivatives of one term in random landings. The points of a hinge's edge are found by Newton steps
// along the gradient of one u, drawn at random.

#include "touchdown/planning/problem/term_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Eigenvalues>

#include "planning/problem/random_context.h"

namespace touchdown::planning {

namespace {

using Eigen::VectorXd;
using solvers::View;
using solvers::ViewEvaluation;

constexpr double kStep = 1e-6;      // of differences
constexpr double kEdgeStep = 1e-7;  // and on the edge of a hinge, whose u may be steep
constexpr double kNoise = 0.3;      // of the points about the boundary lift [m]
constexpr double kBeyond = 0.03;    // u of CheckedPoint::kActive
constexpr double kReached = 1e-12;  // of a wanted u
constexpr int kNewtonSteps = 40;
constexpr int kDraws = 6;  // of a u that can be brought to 0
constexpr int kMaxObstacles = 2;

/// One term in one random landing, on one view.
class Bench {
 public:
  Bench(const TermEntry& entry, const TermCheckRow& kind, int control_points,
        std::mt19937_64& random)
      : random_(random),
        context_(control_points - 3, control_points, kMaxObstacles, random),
        free_end_acceleration_(std::bernoulli_distribution()(random)),
        lift_(std::make_shared<BoundaryLift>(control_points - 3, free_end_acceleration_)),
        problem_(Shape(control_points, kind.arrival)) {
    const LandingContext& context = context_.get();
    lift_->Set(context.start, context.t0, *context.pad, context.target);
    problem_.set_t0(context.t0);
    problem_.set_interval(context.interval);
    Add(entry, kind.hard, control_points);
    // The metric of a term alone may be singular, and then the whitening is poor.
    if (kind.view == CheckedView::kWhitened) {
      const TermRegistry terms = StandardTerms();
      Add(FindTerm(terms, "smoothness"), false, control_points);
    }
    solvers::AffineLift structure = solvers::AffineLift::Identity(control_points);
    if (kind.view != CheckedView::kFull) {
      structure = lift_->Structure();
      structure.offset = lift_;
    }
    view_ = std::make_unique<View>(problem_, std::move(structure));
    view_->Resize(&at_);
    if (kind.view == CheckedView::kWhitened) whitening_.Prepare(*view_);
    whitened_ = kind.view == CheckedView::kWhitened;
  }

  VectorXd RandomPoint() {
    VectorXd y = VectorXd::Zero(view_->num_variables());
    if (!view_->lift().offset) lift_->At(context_.get().interval, y.data(), nullptr, nullptr);
    std::uniform_real_distribution<double> noise(-kNoise, kNoise);
    for (double& number : y) number += noise(random_);
    if (view_->free_interval()) y[y.size() - 1] = context_.get().interval;
    return y;
  }

  /// Moves y until one u, drawn at random, is `wanted`; false if none can be.
  bool MoveTo(double wanted, VectorXd* y) {
    for (int draw = 0; draw < kDraws; ++draw) {
      if (!view_->Evaluate(y->data(), {.gradient = true}, {}, &at_)) return false;
      const int rows = at_.full.terms[0].windows * view_->problem().term(0).shape().outputs;
      if (rows == 0) return false;
      const int row = std::uniform_int_distribution<int>(0, rows - 1)(random_);
      VectorXd moved = *y;
      if (!MoveRow(row, wanted, &moved)) continue;
      *y = moved;
      return true;
    }
    return false;
  }

  solvers::DerivativeErrors Check(const VectorXd& y, double step) {
    if (!view_->Evaluate(y.data(), {}, {}, &at_)) return {};
    windows_ = at_.full.terms[0].windows;
    if (whitened_ && !whitening_.Set(*view_, y.data(), &at_)) return {};
    const solvers::TermShape& shape = view_->problem().term(0).shape();
    std::vector<double> multipliers(static_cast<std::size_t>(shape.max_windows * shape.outputs));
    std::uniform_real_distribution<double> draw(-1.0, 1.0);
    for (double& multiplier : multipliers) multiplier = draw(random_);
    std::vector<solvers::RowWeights> rows(static_cast<std::size_t>(problem_.num_terms()));
    rows[0].multiplier = multipliers.data();
    return solvers::CheckDerivatives(*view_, y, {.rows = rows.data()}, step,
                                     whitened_ ? &whitening_ : nullptr);
  }

  /// Windows of the last check.
  int windows() const { return windows_; }

  /// The lowest eigenvalue of the Hessian over the largest in size, at most 0; -infinity where it
  /// is not finite.
  double LeastCurvature(const VectorXd& y) {
    constexpr solvers::Want kHessian{.gradient = true, .hessian = true};
    if (!view_->Evaluate(y.data(), kHessian, {}, &at_)) return -HUGE_VAL;
    const int n = view_->num_variables();
    Eigen::MatrixXd hessian(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) hessian(i, j) = at_.hessian.At(i, j);
    }
    if (!hessian.allFinite()) return -HUGE_VAL;
    const double size = hessian.cwiseAbs().maxCoeff();
    if (size < std::numeric_limits<double>::min()) return 0.0;
    const VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian / size, Eigen::EigenvaluesOnly)
            .eigenvalues();
    return std::min(0.0, eigenvalues.minCoeff() / eigenvalues.cwiseAbs().maxCoeff());
  }

  const solvers::Term& term() const { return problem_.term(0); }

 private:
  static solvers::ProblemShape Shape(int control_points, ArrivalMode arrival) {
    solvers::ProblemShape shape;
    shape.blocks = control_points;
    shape.free_interval = arrival == ArrivalMode::kFree;
    return shape;
  }

  void Add(const TermEntry& entry, bool hard, int control_points) {
    TermSetup setup = DefaultSetup(entry, control_points);
    setup.weight = 1.0;
    setup.hard = hard;
    setup.free_end_acceleration = free_end_acceleration_;
    setup.max_pairs = control_points;
    setup.max_obstacles = kMaxObstacles;
    const std::shared_ptr<solvers::Term> term = entry.make(setup);
    if (auto* user = dynamic_cast<ContextUser*>(term.get())) user->Update(context_.get());
    problem_.AddTerm(term, hard ? solvers::Role::kConstraint : solvers::Role::kCost);
  }

  bool MoveRow(int row, double wanted, VectorXd* y) {
    const solvers::TermShape& shape = view_->problem().term(0).shape();
    const int d = view_->block_size();
    for (int step = 0; step < kNewtonSteps; ++step) {
      if (!view_->Evaluate(y->data(), {.gradient = true}, {}, &at_)) return false;
      const solvers::TermBlock& block = at_.full.terms[0];
      const double miss = block.u[row] - wanted;
      if (std::abs(miss) <= kReached) return true;
      const int first = block.first_block[block.window_of(row)];
      VectorXd gradient = VectorXd::Zero(y->size());
      std::vector<int> reduced(static_cast<std::size_t>(shape.window));
      const int count = view_->WindowBlocks(first, shape.window, reduced.data());
      VectorXd by_block(count * d);
      view_->WindowJacobian(block.slopes(row), first, shape.window, 1.0, by_block.data());
      for (int b = 0; b < count; ++b) {
        gradient.segment(reduced[b] * d, d) = by_block.segment(b * d, d);
      }
      if (gradient.norm() < 1e-6) return false;  // the boundary fixes it
      *y -= miss / gradient.squaredNorm() * gradient;
    }
    return false;
  }

  std::mt19937_64& random_;
  RandomContext context_;
  bool free_end_acceleration_;
  std::shared_ptr<BoundaryLift> lift_;
  solvers::Problem problem_;
  std::unique_ptr<View> view_;
  solvers::Whitening whitening_;
  bool whitened_ = false;
  int windows_ = 0;
  ViewEvaluation at_;
};

/// The larger of two errors; NaN is the worst.
double Worse(double a, double b) { return std::isnan(b) ? HUGE_VAL : std::max(a, b); }

void KeepWorst(const solvers::DerivativeErrors& errors, TermCheckRow* row) {
  solvers::DerivativeErrors& worst = row->errors;
  worst.evaluated = errors.evaluated && (row->points == 0 || worst.evaluated);
  worst.gradient = Worse(worst.gradient, errors.gradient);
  worst.hessian = Worse(worst.hessian, errors.hessian);
  worst.residual_jacobian = Worse(worst.residual_jacobian, errors.residual_jacobian);
  worst.row_jacobian = Worse(worst.row_jacobian, errors.row_jacobian);
  ++row->points;
}

TermCheckRow CheckKind(const TermEntry& entry, TermCheckRow row, const TermCheckOptions& options) {
  std::mt19937_64 random(options.seed);
  for (int trial = 0; trial < options.trials; ++trial) {
    Bench bench(entry, row, options.control_points, random);
    const solvers::LossBounds bounds = bench.term().bounds();
    row.has_edge = std::isinf(bounds.lo) != std::isinf(bounds.hi);
    // In the problem's own variables: with a lift, what remains of a term may be rounding alone.
    row.claims_convex = bench.term().info().convex && !row.hard &&
                        row.arrival == ArrivalMode::kFixed && row.view == CheckedView::kFull;
    VectorXd y = bench.RandomPoint();
    const bool random_point = row.point == CheckedPoint::kRandom;
    const double wanted = row.point == CheckedPoint::kZero ? 0.0 : kBeyond;
    if (!random_point && !bench.MoveTo(wanted, &y)) continue;
    const double step = row.point == CheckedPoint::kZero ? kEdgeStep : kStep;
    KeepWorst(bench.Check(y, step), &row);
    row.windows += bench.windows();
    if (row.claims_convex) {
      row.least_curvature = std::min(row.least_curvature, bench.LeastCurvature(y));
    }
  }
  return row;
}

}  // namespace

std::vector<TermCheckRow> CheckTerm(const TermEntry& entry, const TermCheckOptions& options) {
  if (options.control_points < 9 || options.trials < 1) {
    throw std::invalid_argument("CheckTerm: " + std::to_string(options.control_points) +
                                " control points and " + std::to_string(options.trials) +
                                " trials, it must be at least 9 and 1");
  }
  std::vector<TermCheckRow> rows;
  for (const CheckedView view :
       {CheckedView::kFull, CheckedView::kReduced, CheckedView::kWhitened}) {
    for (const ArrivalMode arrival : {ArrivalMode::kFixed, ArrivalMode::kFree}) {
      for (const bool hard : {false, true}) {
        if (hard && !entry.can_be_hard) continue;
        for (const CheckedPoint point :
             {CheckedPoint::kRandom, CheckedPoint::kZero, CheckedPoint::kActive}) {
          rows.push_back(CheckKind(entry, {view, arrival, hard, point}, options));
        }
      }
    }
  }
  return rows;
}

std::string Complaint(const std::vector<TermCheckRow>& rows) {
  int windows = 0, edges = 0;
  bool has_edge = false;
  for (const TermCheckRow& row : rows) {
    windows += row.windows;
    has_edge = has_edge || row.has_edge;
    if (row.point == CheckedPoint::kZero) edges += row.points;
    if (row.points > 0 && !row.errors.evaluated) {
      return "the term could not be evaluated in a random landing: a value is not finite, a window "
             "lies outside of the spline, or it threw";
    }
    if (row.points > 0 && std::isinf(row.errors.worst())) {
      return "a value or a derivative is not finite in a random landing";
    }
    if (row.points > 0 && !(row.errors.worst() <= kTermCheckTolerance)) {
      return "derivatives disagree with central differences";
    }
    if (row.claims_convex && !(row.least_curvature >= -kTermCheckConvexity)) {
      return "the term says that it is convex, and its Hessian at a fixed interval has a negative "
             "eigenvalue";
    }
  }
  if (windows == 0) return "nothing was compared: the term had no window in any random landing";
  if (has_edge && edges == 0) {
    return "the edge of the hinge was not compared: no u could be brought to 0 in any random "
           "landing";
  }
  return {};
}

bool Passed(const std::vector<TermCheckRow>& rows) { return Complaint(rows).empty(); }

}  // namespace touchdown::planning
