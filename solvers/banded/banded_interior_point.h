// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "touchdown/solvers/backend/constraint_rows.h"
#include "touchdown/solvers/backend/evaluator.h"
#include "touchdown/solvers/linear/bordered_cholesky.h"

namespace touchdown::solvers {

/// A primal-dual interior point on a problem with rows lo <= u <= hi, equalities among them.
/// Variables may have bounds; all of its points are inside them.
class BandedInteriorPoint {
 public:
  struct Tolerances {
    double gap = 1e-8;        ///< complementarity and dual error, relative to the cost
    double violation = 1e-8;  ///< of a row
    bool invariant =
        false;  ///< the cost counts as large as what was gained and its slope say, not its value
  };

  void Prepare(const View& view);
  /// `multipliers` ([term][row], positive at an upper bound, negative at a lower one, either at an
  /// equality) may hold an earlier solve's. Does not allocate.
  SolveStatus Run(const View& view, const double* start,
                  const std::vector<std::vector<double>>& multipliers, const Tolerances& tolerances,
                  Evaluator* evaluator);
  /// The multiplier of every row at the last point, [term] -> [row]; empty for costs.
  const std::vector<double>& multipliers(int term) const { return multiplier_[term]; }
  /// Of the bounds of every variable, the interval left out.
  void BoundMultipliers(std::vector<double>* multipliers) const;

 private:
  /// Variables with a lower bound, with an upper one, or with one value: y - bound are the rows of
  /// one more term.
  struct Box {
    std::vector<int> variable;
    std::vector<double> bound;
  };
  /// One bound of all rows of a term: g = sign (u - bound) <= 0, or = 0.
  struct Side {
    int term = 0;  ///< beyond the problem's: a box
    int outputs = 0;
    double sign = 1.0;
    double bound = 0.0;
    bool equality = false;
    /// A side that may have the same rows from the other side of the bound. Together they are
    /// equalities without slacks.
    int opposite = -1;
    bool merged =
        false;  ///< in this solve it is so: one of the two is the equality, the other has no rows
    int first = 0;  ///< place in the flat arrays
    int rows = 0;   ///< active in this solve
  };
  /// Of g + s = e: slack, multiplier, elastic part, and the multipliers v of the slack and w of the
  /// elastic part. All but z are > 0; v is z, of an equality price + z.
  struct Rows {
    std::vector<double> s, z, e, w, v;
  };
  struct StepLengths {
    double primal = 1.0;
    double dual = 1.0;
  };

  struct Mode {
    bool elastic = false;
    bool careful = false;
    double price = 0.0;  ///< of a unit of violation, times the cost it starts from
  };
  struct Errors {
    double gap = 0.0;     ///< sum of s z and e w, share of the cost
    double worth = 0.0;   ///< what the rows are off by, times their multipliers, share of the cost
    double dual = 0.0;    ///< what a step to grad f + G^T z = 0 would gain, share of the cost
    double primal = 0.0;  ///< of g + s = e
    double row = 0.0;     ///< largest g
  };

  SolveStatus Attempts(const View& view, const double* start,
                       const std::vector<std::vector<double>>& multipliers,
                       const Tolerances& tolerances, Evaluator* evaluator);
  SolveStatus Attempt(const View& view, const Mode& mode,
                      const std::vector<std::vector<double>>& multipliers,
                      const Tolerances& tolerances, Evaluator* evaluator);
  bool Factor(Evaluator* evaluator, double* shift);
  void CorrectEqualities(const View& view, Evaluator* evaluator);
  void StoreMultipliers(const Rows& rows);
  double FastDirection(const View& view, const Errors& errors, double least, Evaluator* evaluator);
  double CarefulDirection(const View& view, const Errors& errors, double least, double* barrier,
                          Evaluator* evaluator);
  StepLengths LineSearch(double target, StepLengths length, double slack, Evaluator* evaluator);
  bool StepIsTooLong() const;
  bool RowsContradict(const std::vector<double>& gradient) const;
  double LargestMultiplier(double share) const;
  double PointSize() const;
  double CostSize(const ViewEvaluation& at, double first) const;
  const Box* BoxOf(const Side& side) const;
  /// Bounds of variables never give.
  bool Elastic(const Side& side) const { return mode_.elastic && !BoxOf(side); }
  bool HasSlack(const Side& side) const { return !side.equality || Elastic(side); }
  void AddBox(int sign, const View& view);
  void ReadBounds(const View& view);
  void MoveInside(const View& view);
  void AddRowsTransposed(const View& view, Evaluator* evaluator);
  void MultiplyRows(const View& view, Evaluator* evaluator);
  /// By how much a row gives for a unit of its multiplier.
  double Give(const Side& side, const Rows& rows, int i) const;
  bool WeighEqualities(const View& view, Evaluator* evaluator);
  Errors MeasureErrors(const View& view, Evaluator* evaluator);
  void FindOpposites(const View& view);
  bool AreTheSameRows(const View& view, const ViewEvaluation& at, int term, int other) const;
  void MergeOpposites(const View& view, const ViewEvaluation& at);
  void PlaceRows(const ViewEvaluation& at);
  void StartRows(const ViewEvaluation& at, const std::vector<std::vector<double>>& multipliers);
  void ReadRows(const ViewEvaluation& at);
  /// Evaluates at y with the Hessian H + G^T W G of these rows.
  bool EvaluateAt(const double* y, const Rows& rows, Evaluator* evaluator);
  void DualResidual(const View& view, Evaluator* evaluator);
  /// The step to complementarity `mu`, with the second-order terms `correction` counted in.
  void Direction(const View& view, double mu, Evaluator* evaluator);
  void SetCorrection(bool predicted);
  /// `gap`: relative to the cost.
  StepLengths LongestStep(double gap) const;
  double Complementarity(const StepLengths& length) const;
  void Move(const StepLengths& length);
  double Merit(double cost, double mu, double penalty, const Rows& rows) const;

  Mode mode_;
  bool left_better_ = false;  // a point that costs much less than where an attempt has converged
  double price_ = 0.0;        // of a unit of e
  int active_ = 0;            // rows in all sides
  int pairs_ = 0;             // products that are to become the target: s v and e w
  bool invariant_ = false;
  bool may_have_equalities_ = false;
  bool has_equalities_ = false;  // in this solve
  double curvature_ = 0.0;       // of the cost, where equalities are weighed by it
  ConstraintRows rows_;
  std::vector<double> jacobian_, give_;
  std::vector<std::vector<double>> give_by_term_;
  std::vector<double> equality_give_;
  std::vector<Side> sides_;
  std::vector<Box> boxes_;
  int terms_ = 0;  // of the problem; boxes follow them
  Rows now_, next_;
  std::vector<double> g_, k_, ds_, dz_, de_, correction_s_, correction_e_;
  std::vector<std::vector<double>> multiplier_, weight_,
      product_;  // [term][row], boxes among the terms
  std::vector<RowWeights> row_weights_;
  std::vector<const double*> products_in_;
  std::vector<double*> products_out_;
  std::vector<double> y_, trial_, step_, right_;
  BorderedCholesky factor_;
};

}  // namespace touchdown::solvers
