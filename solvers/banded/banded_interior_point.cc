// SPDX-License-Identifier: BSD-3-Clause
// Primal-dual interior point for
//   min f(y)  s.t.  g(y) <= 0,  g a row with one of its bounds:
//   g + s = e,  s v = mu,  grad f + G^T z = 0,  s, v > 0,  v = z.
// Here e = 0. In the elastic mode e > 0 costs a price p each: e w = mu, w = p - z > 0. The slack of
// an equality costs that price, too: v = p + z. Outside of the elastic mode it has neither s nor e.
// A Newton step, with s, z, e, w eliminated, is
//   (H + G^T W G) dy = -grad f - G^T (z + W k),   W = 1 / (s/v + e/w),   k = g + mu/v - mu/w,
//   dz = W (G dy + k).
// H is the Lagrangian's Hessian, including the curvature of the rows. Every row is a window, so
// G^T W G adds no fill-in. The matrix stays a banded arrowhead, and one factor serves Mehrotra's
// predictor and corrector. For an equality without s and e this is a proximal step of the method of
// multipliers. Its W is so large that a step leaves little of the linear row. With it the matrix is
// definite if H is definite along the rows. A merit function guards the step where rows are curved
// or not convex. Where these fast steps stall, the barrier method's careful ones take over.
// Sources: S. Mehrotra, SIAM J. Optim. 2 (1992) 575; J. Nocedal, S. Wright, Numerical Optimization,
// 2nd ed., chapter 19; the elastic form: P. Gill, W. Murray, M. Saunders, SIAM Rev. 47 (2005) 99;
// equalities: M. Friedlander, D. Orban, Math. Prog. Comp. 4 (2012) 71.

#include "solvers/banded/banded_interior_point.h"

#include <algorithm>
#include <cmath>

#include "touchdown/solvers/backend/newton_step.h"

namespace touchdown::solvers {

namespace {

/// Least share of the way to s = 0 or z = 0 that a step may go. It approaches 1 with the gap, so
/// that the last steps converge quadratically.
constexpr double kToBoundary = 0.995;
constexpr double kFirstSlack = 0.1;  // least slack of the first point, share of the largest row
constexpr double kFirstRoom =
    1e-2;  // of its variables to their bounds, share of these and of their distance
constexpr double kFirstMu = 0.1;  // complementarity of the first point, share of the cost
constexpr double kNoCost = 1e-6;  // a cost that is less has not begun
/// A fast step may raise the merit by this share. Good steps over curved rows do so (N. Maratos,
/// 1978), but so do steps that cycle. Late steps may therefore raise it hardly at all.
constexpr double kFastSlack = 1.0;
constexpr double kLateSlack = 1e-4;
constexpr double kCarefulSlack = 1e-12;  // rounding
constexpr int kLateStep = 15;
constexpr double kClearImprovement = 1e-3;  // of the cost, less than a point that is converged
constexpr double kShortestStep = 1e-8;
/// After so many steps in a row that hardly move, the mode gives up.
constexpr int kMostStalls = 3;
constexpr double kStall = 1e-2;
constexpr int kMostFastSteps = 20;  // they converge in 5 to 15 where they do
constexpr int kMostCarefulSteps = 200;
constexpr double kRounding = 1e-8;
constexpr double kLeastTarget = 0.1;  // of the requested gap
constexpr double kLeastShare = 1e-6;  // of the gap there is, that a step aims at
constexpr double kLeastShareCurvedRows = 1e-2;
constexpr double kNearlyMet = 1e-4;
constexpr double kBarrierDecrease = 0.2;
constexpr double kBarrierSolved = 1e-2;  // errors at which its own problem counts as solved
// Where rows are equalities.
constexpr double kEqualityWeight = 1e8;   // of a row of unit slope, times the cost's curvature
constexpr double kLeastCurvature = 1e-3;  // of the cost, share of its slope
constexpr double kLongestStep = 10.0;     // over the point's size
constexpr double kLeastShift = 1e-3;      // that makes a step shorter, share of the curvature
constexpr double kMostShift = 1e3;        // less than what holds the rows
constexpr double kRaisedShift = 10.0;
constexpr double kShiftRoom = 2.0;  // a shift that is just enough leaves a pivot of rounding
constexpr double kLeastCost = 0.1;
constexpr int kLateEqualityStep = 8;  // steps that rows bend go round in circles sooner
// Prices of a unit of violation, times the cost it starts from.
constexpr double kElasticPrice = 100.0;
constexpr double kElasticPriceRaised = 1e5;
constexpr double kContradiction = 0.1;

}  // namespace

void BandedInteriorPoint::Prepare(const View& view) {
  BorderedBandMatrix shape;
  shape.Resize(view.blocks(), view.block_size(), view.problem().half_bandwidth(),
               view.free_interval());
  factor_.Prepare(shape);
  for (auto* vector : {&y_, &trial_, &step_, &right_}) {
    vector->assign(static_cast<std::size_t>(view.num_variables()), 0.0);
  }
  const Problem& problem = view.problem();
  terms_ = problem.num_terms();
  const auto terms = static_cast<std::size_t>(terms_);
  sides_.clear();
  boxes_.clear();
  curvature_ = 0.0;
  may_have_equalities_ = false;
  for (auto* arrays : {&multiplier_, &weight_, &product_}) arrays->assign(terms, {});
  row_weights_.assign(terms, {});
  products_in_.assign(terms, nullptr);
  products_out_.assign(terms, nullptr);
  std::size_t total = 0, all_rows = 0;
  for (int i = 0; i < problem.num_terms(); ++i) {
    if (problem.role(i) != Role::kConstraint) continue;
    const TermShape& term = problem.term(i).shape();
    const auto rows = static_cast<std::size_t>(term.max_windows * term.outputs);
    for (auto* arrays : {&multiplier_, &weight_, &product_}) (*arrays)[i].assign(rows, 0.0);
    row_weights_[i] = {multiplier_[i].data(), weight_[i].data()};
    products_in_[i] = products_out_[i] = product_[i].data();
    all_rows += rows;
    const LossBounds bounds = problem.term(i).bounds();
    const bool equality = bounds.lo == bounds.hi;
    may_have_equalities_ |= equality;
    for (const auto& [sign, bound] : {std::pair{1.0, bounds.hi}, std::pair{-1.0, bounds.lo}}) {
      if (!std::isfinite(bound) || (equality && sign < 0.0)) continue;
      sides_.push_back({i, term.outputs, sign, bound, equality});
      total += rows;
    }
  }
  for (int sign = -1; sign <= 1 && view.bounded(); ++sign) AddBox(sign, view);
  for (const Box& box : boxes_) total += box.variable.size();
  FindOpposites(view);
  if (may_have_equalities_) {
    rows_.Prepare(view);
    ConstraintRows::Size(view, &give_by_term_);
    jacobian_.reserve(static_cast<std::size_t>(rows_.most_nonzeros()));
    give_.reserve(all_rows);
    equality_give_.assign(total, 0.0);
  }
  for (auto* array :
       {&now_.s, &now_.z, &now_.e, &now_.w, &now_.v, &next_.s, &next_.z, &next_.e, &next_.w,
        &next_.v, &g_, &k_, &ds_, &dz_, &de_, &correction_s_, &correction_e_}) {
    array->assign(total, 0.0);
  }
}

/// Lower bounds, values that are fixed, or upper bounds.
void BandedInteriorPoint::AddBox(int sign, const View& view) {
  Box box;
  for (int i = 0; i < view.blocks() * view.block_size(); ++i) {
    const double lower = view.lower(i), upper = view.upper(i);
    const double bound = sign < 0 ? lower : upper;
    if (!std::isfinite(bound) || (lower == upper) != (sign == 0)) continue;
    box.variable.push_back(i);
  }
  box.bound.resize(box.variable.size());
  if (box.variable.empty()) return;
  const int term = terms_ + static_cast<int>(boxes_.size());
  sides_.push_back({term, 1, sign < 0 ? -1.0 : 1.0, 0.0, sign == 0});
  may_have_equalities_ |= sign == 0;
  for (auto* arrays : {&multiplier_, &weight_, &product_}) {
    arrays->emplace_back(box.variable.size(), 0.0);
  }
  boxes_.push_back(std::move(box));
}

const BandedInteriorPoint::Box* BandedInteriorPoint::BoxOf(const Side& side) const {
  return side.term < terms_ ? nullptr : &boxes_[side.term - terms_];
}

/// Reads the values of the bounds, which may differ in each solve.
void BandedInteriorPoint::ReadBounds(const View& view) {
  for (const Side& side : sides_) {
    if (side.term < terms_) continue;
    Box& box = boxes_[side.term - terms_];
    for (std::size_t j = 0; j < box.variable.size(); ++j) {
      const int i = box.variable[j];
      box.bound[j] = side.sign > 0.0 ? view.upper(i) : view.lower(i);
    }
  }
}

void BandedInteriorPoint::BoundMultipliers(std::vector<double>* multipliers) const {
  multipliers->assign(boxes_.empty() ? 0 : y_.size(), 0.0);
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    const std::vector<double>& of_box = multiplier_[terms_ + b];
    for (std::size_t j = 0; j < of_box.size(); ++j) {
      (*multipliers)[boxes_[b].variable[j]] += of_box[j];
    }
  }
}

SolveStatus BandedInteriorPoint::Run(const View& view, const double* start,
                                     const std::vector<std::vector<double>>& multipliers,
                                     const Tolerances& tolerances, Evaluator* evaluator) {
  const SolveStatus status = Attempts(view, start, multipliers, tolerances, evaluator);
  StoreMultipliers(now_);
  return status;
}

SolveStatus BandedInteriorPoint::Attempts(const View& view, const double* start,
                                          const std::vector<std::vector<double>>& multipliers,
                                          const Tolerances& tolerances, Evaluator* evaluator) {
  ReadBounds(view);
  std::copy(start, start + y_.size(), y_.begin());
  invariant_ = tolerances.invariant;
  SolveStatus status = Attempt(view, {}, multipliers, tolerances, evaluator);
  // Rows that cannot be met, or a problem that is too nonlinear: look for the least costly
  // violation instead. Fast steps come first, then careful ones, each at a price and at a much
  // higher one. They continue from where the last ones stalled: the best point may be a feasible
  // start far away.
  const std::vector<std::vector<double>> none;
  const auto once_more = [&](const Mode& mode, const auto& known) {
    if (!mode.elastic) {
      std::copy(evaluator->best().data(), evaluator->best().data() + y_.size(), y_.begin());
    }
    status = Attempt(view, mode, known, tolerances, evaluator);
  };
  const auto failed = [&status] { return status == SolveStatus::kNumericalFailure; };
  for (const bool careful : {false, true}) {
    for (const double price : {kElasticPrice, kElasticPriceRaised}) {
      if (failed()) once_more({true, careful, price}, none);
    }
  }
  // The elastic mode has found that the rows can be met. It pinches equalities from both sides,
  // until only rounding is left of their metric.
  const bool pinched = mode_.elastic && has_equalities_ && status == SolveStatus::kConverged;
  const bool known_feasible = evaluator->best_violation() <= Evaluator::kFeasible;
  if (known_feasible && (failed() || pinched || status == SolveStatus::kInfeasible)) {
    StoreMultipliers(now_);
    once_more({}, pinched ? multiplier_ : none);
    if (pinched && failed()) status = SolveStatus::kUnconfirmed;
  }
  // Steps uphill may have left a better valley: careful ones descend in it.
  if (status == SolveStatus::kConverged && left_better_) {
    once_more({.careful = true}, none);
    if (failed() || left_better_) status = SolveStatus::kUnconfirmed;
  }
  return status;
}

void BandedInteriorPoint::StoreMultipliers(const Rows& rows) {
  for (auto& array : multiplier_) std::fill(array.begin(), array.end(), 0.0);
  for (const Side& side : sides_) {
    for (int j = 0; j < side.rows; ++j) {
      const double multiplier = side.sign * rows.z[side.first + j];
      const bool others = side.merged && rows.z[side.first + j] < 0.0;
      multiplier_[others ? sides_[side.opposite].term : side.term][j] += multiplier;
    }
  }
}

SolveStatus BandedInteriorPoint::Attempt(const View& view, const Mode& mode,
                                         const std::vector<std::vector<double>>& multipliers,
                                         const Tolerances& tolerances, Evaluator* evaluator) {
  mode_ = mode;
  MoveInside(view);
  if (!evaluator->Evaluate(y_.data(), {.gradient = true})) return SolveStatus::kEvaluationFailed;
  price_ = mode.price * std::max(std::abs(evaluator->last().full.value), 1.0);
  MergeOpposites(view, evaluator->last());
  PlaceRows(evaluator->last());
  if (has_equalities_ && !WeighEqualities(view, evaluator)) return SolveStatus::kEvaluationFailed;
  StartRows(evaluator->last(), multipliers);
  if (!EvaluateAt(y_.data(), now_, evaluator)) return SolveStatus::kEvaluationFailed;
  double barrier = Complementarity({0.0, 0.0});
  double steepest = 0.0;
  int stalls = 0;
  const int most_steps = mode.careful ? kMostCarefulSteps : kMostFastSteps;
  for (int step = 0; step < most_steps && !evaluator->must_stop(); ++step) {
    ReadRows(evaluator->last());
    double shift = 0.0;
    if (!Factor(evaluator, &shift)) break;
    const Errors errors = MeasureErrors(view, evaluator);
    steepest = std::max(steepest, Largest(evaluator->last().gradient));
    // A metric with a shift is blind.
    const bool stationary = shift == 0.0 || Largest(right_) <= kRounding * steepest;
    if (errors.gap + errors.worth + errors.dual <= tolerances.gap && stationary &&
        (errors.row <= tolerances.violation ||
         (mode.elastic && LargestMultiplier(0.0) > 0.5 * price_))) {
      // An earlier point may cost less by what it violates within the tolerance. One that costs
      // much less is of another valley, which steps uphill have left.
      const double last = evaluator->last().full.value;
      const bool known_feasible = evaluator->best_violation() <= Evaluator::kFeasible;
      const bool much_better = evaluator->best_cost() < last - kClearImprovement * std::abs(last) &&
                               evaluator->best_violation() <= tolerances.violation;
      left_better_ = known_feasible && (errors.row > Evaluator::kFeasible || much_better);
      if (!left_better_) evaluator->PreferLast();
      if (errors.row > Evaluator::kFeasible) {
        if (RowsContradict(evaluator->last().gradient)) return SolveStatus::kInfeasible;
        break;  // the price is too low
      }
      if (has_equalities_) CorrectEqualities(view, evaluator);
      return SolveStatus::kConverged;
    }
    const double least =
        kLeastTarget * tolerances.gap / std::max(errors.gap, 1e-300) * Complementarity({0.0, 0.0});
    const auto direction = [&] {
      return mode.careful ? CarefulDirection(view, errors, least, &barrier, evaluator)
                          : FastDirection(view, errors, least, evaluator);
    };
    double target = direction();
    while (has_equalities_ && StepIsTooLong() && shift < kMostShift * curvature_) {
      shift = std::max(kRaisedShift * shift, kLeastShift * curvature_);
      if (!FactorDefinite(evaluator->last().hessian, &factor_, curvature_, &shift)) break;
      target = direction();
    }
    const int late = has_equalities_ ? kLateEqualityStep : kLateStep;
    const double slack = mode.careful ? kCarefulSlack : step < late ? kFastSlack : kLateSlack;
    const StepLengths length = LineSearch(target, LongestStep(errors.gap), slack, evaluator);
    if (evaluator->must_stop()) break;
    if (length.primal < kShortestStep) {
      // Tolerances below rounding end here.
      if (errors.gap > kRounding || errors.dual > kRounding || errors.row > kRounding) break;
      return SolveStatus::kConverged;
    }
    y_.swap(trial_);
    std::swap(now_, next_);
    evaluator->FinishIteration(length.primal * std::sqrt(Dot(step_, step_)), errors.dual);
    evaluator->CheckStop();
    // A far step goes as far as one step may.
    const double allowed =
        std::min(1.0, kLongestStep * PointSize() / std::max(Largest(step_), 1e-300));
    stalls = length.primal < kStall * allowed ? stalls + 1 : 0;
    if (stalls >= kMostStalls) break;
  }
  return evaluator->must_stop() ? evaluator->stop_status() : SolveStatus::kNumericalFailure;
}

/// Moves variables off their bounds, so that their slacks start at their true values and stay true.
void BandedInteriorPoint::MoveInside(const View& view) {
  for (int i = 0; i < view.blocks() * view.block_size() && view.bounded(); ++i) {
    const double lower = view.lower(i), upper = view.upper(i), width = upper - lower;
    const auto room = [width](double bound) {
      return std::isfinite(bound) ? kFirstRoom * std::min(std::max(1.0, std::abs(bound)), width)
                                  : 0.0;
    };
    y_[i] = std::clamp(y_[i], lower + room(lower), upper - room(upper));
  }
}

/// Factors the last point's matrix. A shift is at least some times the one it needs.
bool BandedInteriorPoint::Factor(Evaluator* evaluator, double* shift) {
  const BorderedBandMatrix& H = evaluator->last().hessian;
  if (!FactorDefinite(H, &factor_, curvature_, shift)) return false;
  if (*shift == 0.0) return true;
  *shift *= kShiftRoom;
  return FactorDefinite(H, &factor_, curvature_, shift);
}

/// The metric of a step does not see what is left across an equality. Its multiplier takes one more
/// step.
void BandedInteriorPoint::CorrectEqualities(const View& view, Evaluator* evaluator) {
  SetCorrection(false);
  Direction(view, Complementarity({0.0, 0.0}), evaluator);
  for (const Side& side : sides_) {
    for (int i = side.first; i < side.first + side.rows && !HasSlack(side); ++i) {
      now_.z[i] += dz_[i];
    }
  }
}

/// Mehrotra's predictor and corrector. Returns the complementarity aimed at, which is `least` or
/// more: far below what is asked for there is only rounding.
double BandedInteriorPoint::FastDirection(const View& view, const Errors& errors, double least,
                                          Evaluator* evaluator) {
  const double mu = Complementarity({0.0, 0.0});
  SetCorrection(false);
  Direction(view, 0.0, evaluator);
  if (pairs_ == 0) return 0.0;
  const double ratio = Complementarity(LongestStep(errors.gap)) / mu;
  // Rows that are far from met are curved: the gap that the predictor expects is unreliable.
  const bool bend = has_equalities_ && !mode_.elastic && errors.primal > kNearlyMet;
  const double lowest = bend ? kLeastShareCurvedRows : kLeastShare;
  const double target = std::max(mu * std::clamp(ratio * ratio * ratio, lowest, 1.0), least);
  SetCorrection(true);
  Direction(view, target, evaluator);
  return target;
}

/// The barrier method of Fiacco and McCormick: the target falls only where its own problem is
/// solved.
double BandedInteriorPoint::CarefulDirection(const View& view, const Errors& errors, double least,
                                             double* barrier, Evaluator* evaluator) {
  const double mu = Complementarity({0.0, 0.0});
  if (mu <= 2.0 * *barrier && errors.dual <= kBarrierSolved && errors.primal <= kBarrierSolved) {
    *barrier = std::max(kBarrierDecrease * *barrier, least);
  }
  SetCorrection(false);
  Direction(view, *barrier, evaluator);
  return *barrier;
}

/// Halves the primal step until the merit function accepts it. trial_, next_ and the evaluator's
/// last point are then that point.
BandedInteriorPoint::StepLengths BandedInteriorPoint::LineSearch(double target, StepLengths length,
                                                                 double slack,
                                                                 Evaluator* evaluator) {
  const double penalty = 2.0 * std::max(LargestMultiplier(1.0), 1e-12);
  const double merit = Merit(evaluator->last().full.value, target, penalty, now_);
  const double highest = merit + slack * std::abs(merit);
  for (; length.primal >= kShortestStep; length.primal *= 0.5) {
    Move(length);
    const bool ok = EvaluateAt(trial_.data(), next_, evaluator);
    if (evaluator->must_stop()) break;
    if (!ok) continue;
    ReadRows(evaluator->last());
    if (Merit(evaluator->last().full.value, target, penalty, next_) <= highest) break;
  }
  return length;
}

BandedInteriorPoint::Errors BandedInteriorPoint::MeasureErrors(const View& view,
                                                               Evaluator* evaluator) {
  Errors errors;
  const ViewEvaluation& at = evaluator->last();
  const double cost = invariant_ ? CostSize(at, evaluator->first_cost())
                                 : std::max(std::abs(at.full.value), kSmallestCost);
  errors.gap = Complementarity({0.0, 0.0}) * pairs_ / cost;
  for (const Side& side : sides_) {
    // Rows that were the same at the start have to be so in the end.
    if (side.merged) errors.row = std::max(errors.row, at.full.max_violation);
    for (int i = side.first; i < side.first + side.rows; ++i) {
      errors.row = std::max(errors.row, side.equality ? std::abs(g_[i]) : g_[i]);
      const double off = g_[i] + now_.s[i] - (Elastic(side) ? now_.e[i] : 0.0);
      errors.primal = std::max(errors.primal, std::abs(off));
      errors.worth += std::abs(now_.z[i] * off) / cost;
    }
  }
  DualResidual(view, evaluator);
  errors.dual = NewtonStep(view, y_.data(), right_.data(), factor_, step_.data()) / cost;
  return errors;
}

double BandedInteriorPoint::PointSize() const { return 1.0 + Largest(y_); }

/// The cost's size, whatever constant the cost contains: the gain so far, or the slope times the
/// point's size. At most the cost itself, which may be less than the gain.
double BandedInteriorPoint::CostSize(const ViewEvaluation& at, double first) const {
  const double value = at.full.value;
  const double slope = Largest(at.gradient);
  const double gained = std::max(std::abs(first - value), slope * PointSize());
  return std::max(std::min(gained, std::max(std::abs(value), kLeastCost)), kSmallestCost);
}

/// Whether any step as long as the point's size gains little on the rows, compared with their
/// violation.
bool BandedInteriorPoint::RowsContradict(const std::vector<double>& gradient) const {
  double pull = 0.0, off = 0.0;
  for (std::size_t i = 0; i < right_.size(); ++i) {
    pull = std::max(pull, std::abs(right_[i] - gradient[i]));  // G^T z
  }
  for (const Side& side : sides_) {
    for (int i = side.first; i < side.first + side.rows && Elastic(side); ++i) {
      off += std::abs(now_.z[i] * (side.equality ? g_[i] : std::max(g_[i], 0.0)));
    }
  }
  return pull * PointSize() <= kContradiction * off;
}

/// Over the rows, a share of the latest direction further: multipliers of equalities may begin at
/// 0.
double BandedInteriorPoint::LargestMultiplier(double share) const {
  double largest = 0.0;
  for (const Side& side : sides_) {
    if (BoxOf(side)) continue;
    for (int i = side.first; i < side.first + side.rows; ++i) {
      largest = std::max(largest, std::abs(now_.z[i]));
      if (side.equality) largest = std::max(largest, std::abs(now_.z[i] + share * dz_[i]));
    }
  }
  return largest;
}

double BandedInteriorPoint::Give(const Side& side, const Rows& rows, int i) const {
  if (!HasSlack(side)) return equality_give_[i];
  return rows.s[i] / rows.v[i] + (Elastic(side) ? rows.e[i] / rows.w[i] : 0.0);
}

/// How far equalities give: set by their slopes here and by the cost's curvature in the most curved
/// of their variables.
bool BandedInteriorPoint::WeighEqualities(const View& view, Evaluator* evaluator) {
  if (!evaluator->EvaluateLagrangian(y_.data(), {})) return false;
  const ViewEvaluation& at = evaluator->last();
  curvature_ = std::max(
      {LargestDiagonal(at.hessian), kLeastCurvature * Largest(at.gradient), kSmallestCost});
  rows_.Set(view, at);
  jacobian_.assign(static_cast<std::size_t>(rows_.nonzeros()), 0.0);
  give_.assign(static_cast<std::size_t>(rows_.size()), 0.0);
  rows_.Jacobian(at, jacobian_.data());
  const auto curvature = [&](int variable) {
    return std::abs(evaluator->mutable_last()->hessian.Diagonal(variable));
  };
  const auto give = [&](double norm2, double most_curved) {
    return norm2 / (kEqualityWeight * (most_curved > 0.0 ? most_curved : curvature_));
  };
  double most = 0.0;
  for (int row = 0; row < rows_.size(); ++row) {
    double norm2 = 0.0, most_curved = 0.0;
    for (int k = rows_.start(row); k < rows_.start(row + 1); ++k) {
      norm2 += jacobian_[k] * jacobian_[k];
      most_curved = std::max(most_curved, curvature(rows_.column(k)));
    }
    give_[row] = give(norm2, most_curved);
    most = std::max(most, give_[row]);
  }
  rows_.Spread(give_.data(), &give_by_term_);
  for (const Side& side : sides_) {
    const Box* box = BoxOf(side);
    for (int j = 0; side.equality && j < side.rows; ++j) {
      const double own = box ? give(1.0, curvature(box->variable[j])) : give_by_term_[side.term][j];
      // A row without any slope here: as another.
      equality_give_[side.first + j] = own > 0.0 ? own : most > 0.0 ? most : give(1.0, 0.0);
    }
  }
  return true;
}

/// By their shapes and bounds.
void BandedInteriorPoint::FindOpposites(const View& view) {
  const auto shape = [&](int side) -> const TermShape& {
    return view.problem().term(sides_[side].term).shape();
  };
  for (int a = 0; a < static_cast<int>(sides_.size()); ++a) {
    for (int b = 0; b < a && sides_[a].opposite < 0; ++b) {
      if (BoxOf(sides_[a]) || BoxOf(sides_[b]) || sides_[b].opposite >= 0) continue;
      const bool opposite = sides_[a].term != sides_[b].term && sides_[a].sign != sides_[b].sign &&
                            !sides_[a].equality && !sides_[b].equality &&
                            sides_[a].bound == sides_[b].bound;
      if (!opposite || shape(a).window != shape(b).window || shape(a).outputs != shape(b).outputs ||
          shape(a).max_windows != shape(b).max_windows) {
        continue;
      }
      sides_[a].opposite = b;
      sides_[b].opposite = a;
      may_have_equalities_ = true;
    }
  }
}

/// Whether two terms have the same rows and slopes to the last bit: a row written twice.
bool BandedInteriorPoint::AreTheSameRows(const View& view, const ViewEvaluation& at, int term,
                                         int other) const {
  const TermBlock &a = at.full.terms[term], &b = at.full.terms[other];
  const TermShape& shape = view.problem().term(term).shape();
  const auto rows = static_cast<std::ptrdiff_t>(a.windows) * shape.outputs;
  const auto same = [](const auto& p, const auto& q, std::ptrdiff_t count) {
    return std::equal(p.begin(), p.begin() + count, q.begin());
  };
  return a.windows == b.windows && same(a.first_block, b.first_block, a.windows) &&
         same(a.u, b.u, rows) && same(a.du_dh, b.du_dh, rows) &&
         same(a.du, b.du, rows * shape.window * shape.block_size);
}

void BandedInteriorPoint::MergeOpposites(const View& view, const ViewEvaluation& at) {
  has_equalities_ = false;
  for (int i = 0; i < static_cast<int>(sides_.size()); ++i) {
    Side& side = sides_[i];
    if (side.opposite >= 0) {
      side.merged = AreTheSameRows(view, at, side.term, sides_[side.opposite].term);
      side.equality = side.merged && i < side.opposite;
    }
    has_equalities_ |= side.equality;
  }
}

void BandedInteriorPoint::PlaceRows(const ViewEvaluation& at) {
  active_ = pairs_ = 0;
  for (Side& side : sides_) {
    side.first = active_;
    const Box* box = BoxOf(side);
    side.rows = side.merged && !side.equality ? 0
                : box                         ? static_cast<int>(box->variable.size())
                                              : at.full.terms[side.term].windows * side.outputs;
    active_ += side.rows;
    pairs_ += side.rows * ((HasSlack(side) ? 1 : 0) + (Elastic(side) ? 1 : 0));
  }
}

void BandedInteriorPoint::StartRows(const ViewEvaluation& at,
                                    const std::vector<std::vector<double>>& multipliers) {
  ReadRows(at);
  double size = 1e-6;
  for (const Side& side : sides_) {
    for (int i = side.first; i < side.first + side.rows && !BoxOf(side); ++i) {
      size = std::max(size, std::abs(g_[i]));
    }
  }
  for (auto* array : {&ds_, &dz_, &de_}) std::fill(array->begin(), array->end(), 0.0);
  // A cost of zero says nothing of its size.
  const double value = std::abs(at.full.value);
  double cost = value > kNoCost ? value : std::max(CostSize(at, at.full.value), kNoCost);
  if (has_equalities_) cost = std::max(cost, curvature_ * PointSize() * PointSize());
  const double mu = kFirstMu * cost / std::max(active_, 1);
  for (const Side& side : sides_) {
    const auto tells = [&](int term) {
      return term < terms_ && term < static_cast<int>(multipliers.size()) &&
             static_cast<int>(multipliers[term].size()) >= side.rows;
    };
    const bool known = tells(side.term) && (!side.merged || tells(sides_[side.opposite].term));
    for (int j = 0; j < side.rows; ++j) {
      const int i = side.first + j;
      if (side.equality) {
        now_.z[i] = known && !mode_.elastic ? side.sign * multipliers[side.term][j] : 0.0;
        if (known && !mode_.elastic && side.merged) {
          now_.z[i] += side.sign * multipliers[sides_[side.opposite].term][j];
        }
        now_.s[i] = now_.e[i] = 0.0;
        if (!Elastic(side)) continue;
        now_.v[i] = now_.w[i] = price_;
        now_.s[i] = std::max(-g_[i], 0.0) + mu / price_;
        now_.e[i] = std::max(g_[i], 0.0) + mu / price_;
        continue;
      }
      now_.s[i] = BoxOf(side) ? -g_[i] : std::max(-g_[i], kFirstSlack * size);
      now_.e[i] = 0.0;
      now_.z[i] = mu / now_.s[i];
      if (known) now_.z[i] = std::max(now_.z[i], side.sign * multipliers[side.term][j]);
      if (Elastic(side)) {
        now_.z[i] = std::min(now_.z[i], 0.5 * price_);
        now_.w[i] = price_ - now_.z[i];
        now_.e[i] = std::max(g_[i] + now_.s[i], mu / now_.w[i]);
      }
      now_.v[i] = now_.z[i];
    }
  }
}

void BandedInteriorPoint::ReadRows(const ViewEvaluation& at) {
  for (const Side& side : sides_) {
    if (const Box* box = BoxOf(side)) {
      for (int j = 0; j < side.rows; ++j) {
        g_[side.first + j] = side.sign * (at.x[box->variable[j]] - box->bound[j]);
      }
      continue;
    }
    const double* u = at.full.terms[side.term].u.data();
    for (int j = 0; j < side.rows; ++j) g_[side.first + j] = side.sign * (u[j] - side.bound);
  }
}

bool BandedInteriorPoint::EvaluateAt(const double* y, const Rows& rows, Evaluator* evaluator) {
  StoreMultipliers(rows);
  for (auto& array : weight_) std::fill(array.begin(), array.end(), 0.0);
  for (const Side& side : sides_) {
    for (int j = 0; j < side.rows; ++j) {
      weight_[side.term][j] += 1.0 / Give(side, rows, side.first + j);
    }
  }
  if (!evaluator->EvaluateLagrangian(y, {.rows = row_weights_.data()})) return false;
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    const std::vector<double>& weight = weight_[terms_ + b];
    for (std::size_t j = 0; j < weight.size(); ++j) {
      evaluator->mutable_last()->hessian.Diagonal(boxes_[b].variable[j]) += weight[j];
    }
  }
  return true;
}

/// right_ = grad f + G^T product_.
void BandedInteriorPoint::AddRowsTransposed(const View& view, Evaluator* evaluator) {
  view.MultiplyRowsTransposed(products_in_.data(), evaluator->mutable_last(), right_.data());
  const std::vector<double>& gradient = evaluator->last().gradient;
  for (std::size_t i = 0; i < right_.size(); ++i) right_[i] += gradient[i];
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    const std::vector<double>& product = product_[terms_ + b];
    for (std::size_t j = 0; j < product.size(); ++j) right_[boxes_[b].variable[j]] += product[j];
  }
}

/// product_ = G step_.
void BandedInteriorPoint::MultiplyRows(const View& view, Evaluator* evaluator) {
  view.MultiplyRows(step_.data(), evaluator->mutable_last(), products_out_.data());
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    std::vector<double>& product = product_[terms_ + b];
    for (std::size_t j = 0; j < product.size(); ++j) product[j] = step_[boxes_[b].variable[j]];
  }
}

/// right_ = grad f + G^T z.
void BandedInteriorPoint::DualResidual(const View& view, Evaluator* evaluator) {
  for (auto& array : product_) std::fill(array.begin(), array.end(), 0.0);
  for (const Side& side : sides_) {
    for (int j = 0; j < side.rows; ++j) {
      product_[side.term][j] += side.sign * now_.z[side.first + j];
    }
  }
  AddRowsTransposed(view, evaluator);
}

void BandedInteriorPoint::Direction(const View& view, double mu, Evaluator* evaluator) {
  for (auto& array : product_) std::fill(array.begin(), array.end(), 0.0);
  for (const Side& side : sides_) {
    for (int j = 0; j < side.rows; ++j) {
      const int i = side.first + j;
      k_[i] = g_[i];
      if (HasSlack(side)) k_[i] += (mu - correction_s_[i]) / now_.v[i];
      if (Elastic(side)) k_[i] -= (mu - correction_e_[i]) / now_.w[i];
      product_[side.term][j] += side.sign * (now_.z[i] + k_[i] / Give(side, now_, i));
    }
  }
  AddRowsTransposed(view, evaluator);
  NewtonStep(view, y_.data(), right_.data(), factor_, step_.data());
  MultiplyRows(view, evaluator);
  for (const Side& side : sides_) {
    for (int j = 0; j < side.rows; ++j) {
      const int i = side.first + j;
      dz_[i] = (side.sign * product_[side.term][j] + k_[i]) / Give(side, now_, i);
      if (!HasSlack(side)) continue;
      const double s = now_.s[i];
      ds_[i] = (mu - correction_s_[i] - s * dz_[i]) / now_.v[i] - s;
      if (!Elastic(side)) continue;
      const double e = now_.e[i], w = now_.w[i];
      de_[i] = (mu - correction_e_[i] + e * dz_[i]) / w - e;
    }
  }
}

/// The second-order terms that the predictor's full step would leave in s z and e w, or none.
void BandedInteriorPoint::SetCorrection(bool predicted) {
  for (int i = 0; i < active_; ++i) {
    correction_s_[i] = predicted ? ds_[i] * dz_[i] : 0.0;
    correction_e_[i] = predicted && mode_.elastic ? -de_[i] * dz_[i] : 0.0;
  }
}

/// Without curvature along the rows, nothing limits the length of a step.
bool BandedInteriorPoint::StepIsTooLong() const {
  return Largest(step_) > kLongestStep * PointSize();
}

BandedInteriorPoint::StepLengths BandedInteriorPoint::LongestStep(double gap) const {
  const double longest = kLongestStep * PointSize();
  double primal = std::min(1.0, longest / std::max(Largest(step_), longest)), dual = 1.0;
  const double share = std::max(kToBoundary, 1.0 - gap);
  const auto limit = [share](double from, double step, double* length) {
    if (step < 0.0) *length = std::min(*length, -share * from / step);
  };
  for (const Side& side : sides_) {
    if (!HasSlack(side)) continue;
    for (int i = side.first; i < side.first + side.rows; ++i) {
      limit(now_.s[i], ds_[i], &primal);
      limit(now_.v[i], dz_[i], &dual);
      if (!Elastic(side)) continue;
      limit(now_.e[i], de_[i], &primal);
      limit(now_.w[i], -dz_[i], &dual);
    }
  }
  return {primal, dual};
}

/// Mean of s z (and e w) after a step of these lengths.
double BandedInteriorPoint::Complementarity(const StepLengths& length) const {
  double sum = 0.0;
  for (const Side& side : sides_) {
    if (!HasSlack(side)) continue;
    for (int i = side.first; i < side.first + side.rows; ++i) {
      const double v = now_.v[i] + length.dual * dz_[i];
      sum += (now_.s[i] + length.primal * ds_[i]) * v;
      if (Elastic(side))
        sum += (now_.e[i] + length.primal * de_[i]) * (now_.w[i] - length.dual * dz_[i]);
    }
  }
  return sum / std::max(pairs_, 1);
}

void BandedInteriorPoint::Move(const StepLengths& length) {
  for (std::size_t i = 0; i < y_.size(); ++i) trial_[i] = y_[i] + length.primal * step_[i];
  for (const Side& side : sides_) {
    // The multiplier of an equality belongs to what is left of its row.
    const double share = HasSlack(side) ? length.dual : length.primal;
    for (int i = side.first; i < side.first + side.rows; ++i) {
      next_.z[i] = now_.z[i] + share * dz_[i];
    }
  }
  for (int i = 0; i < active_; ++i) {
    next_.s[i] = now_.s[i] + length.primal * ds_[i];
    next_.v[i] = now_.v[i] + length.dual * dz_[i];
    if (!mode_.elastic) continue;
    next_.e[i] = now_.e[i] + length.primal * de_[i];
    next_.w[i] = now_.w[i] - length.dual * dz_[i];  // price - z without its cancellation
  }
}

/// f + p sum e - mu sum (log s + log e) + penalty sum |g + s - e|, with the rows just read. An
/// equality's s costs p, too.
double BandedInteriorPoint::Merit(double cost, double mu, double penalty, const Rows& rows) const {
  double merit = cost;
  for (const Side& side : sides_) {
    for (int i = side.first; i < side.first + side.rows; ++i) {
      if (!HasSlack(side)) {
        merit += penalty * std::abs(g_[i]);
        continue;
      }
      const double e = Elastic(side) ? rows.e[i] : 0.0;
      merit += penalty * std::abs(g_[i] + rows.s[i] - e) - mu * std::log(rows.s[i]);
      if (side.equality) merit += price_ * rows.s[i];
      if (Elastic(side)) merit += price_ * e - mu * std::log(e);
    }
  }
  return merit;
}

}  // namespace touchdown::solvers
