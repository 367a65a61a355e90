// SPDX-License-Identifier: BSD-3-Clause
// Flat constraint rows in compressed-row form. A row has the columns of the reduced blocks that its
// window reaches, then the interval where it is free. Nonzeros that happen to vanish stay in the
// structure. So it depends on the windows alone.

#include "touchdown/solvers/backend/constraint_rows.h"

#include <algorithm>
#include <cmath>

namespace touchdown::solvers {

void ConstraintRows::Prepare(const View& view, bool bounds) {
  const Problem& problem = view.problem();
  with_bounds_ = bounds;
  const auto variables = static_cast<std::size_t>(bounds ? view.num_variables() : 0);
  std::size_t windows = 0, rows = variables, nonzeros = variables;
  for (int i = 0; i < problem.num_terms(); ++i) {
    if (problem.role(i) != Role::kConstraint) continue;
    const TermShape& shape = problem.term(i).shape();
    const auto most = static_cast<std::size_t>(shape.max_windows);
    windows += most;
    rows += most * static_cast<std::size_t>(shape.outputs);
    nonzeros +=
        most * static_cast<std::size_t>(shape.outputs * (shape.window * shape.block_size + 1));
  }
  windows_.reserve(windows);
  lo_.reserve(rows);
  hi_.reserve(rows);
  start_.reserve(rows + 1);
  column_.reserve(nonzeros);
}

void ConstraintRows::Set(const View& view, const ViewEvaluation& evaluation) {
  view_ = &view;
  windows_.clear();
  lo_.clear();
  hi_.clear();
  column_.clear();
  start_.assign(1, 0);
  constant_violation_ = 0.0;
  const int d = view.block_size();
  for (int i = 0; i < view.problem().num_terms(); ++i) {
    if (view.problem().role(i) != Role::kConstraint) continue;
    const TermBlock& block = evaluation.full.terms[i];
    const TermShape& shape = view.problem().term(i).shape();
    const LossBounds bounds = view.problem().term(i).bounds();
    for (int k = 0; k < block.windows; ++k) {
      Window window{i, k, block.first_block[k], 0, {}};
      window.reduced_count = view.WindowBlocks(window.first_block, shape.window, window.reduced);
      if (IsConstant(view, window)) {
        for (int j = k * shape.outputs; j < (k + 1) * shape.outputs; ++j) {
          constant_violation_ =
              std::max({constant_violation_, bounds.lo - block.u[j], block.u[j] - bounds.hi});
        }
        continue;
      }
      windows_.push_back(window);
      for (int c = 0; c < shape.outputs; ++c) {
        lo_.push_back(bounds.lo);
        hi_.push_back(bounds.hi);
        for (int b = 0; b < window.reduced_count; ++b) {
          for (int s = 0; s < d; ++s) column_.push_back(window.reduced[b] * d + s);
        }
        if (view.free_interval()) column_.push_back(view.num_variables() - 1);
        start_.push_back(nonzeros());
      }
    }
  }
  first_bound_ = size();
  for (int i = 0; with_bounds_ && i < view.num_variables(); ++i) {
    if (!std::isfinite(view.lower(i)) && !std::isfinite(view.upper(i))) continue;
    lo_.push_back(view.lower(i));
    hi_.push_back(view.upper(i));
    column_.push_back(i);
    start_.push_back(nonzeros());
  }
}

/// No variable that it reaches is free.
bool ConstraintRows::IsConstant(const View& view, const Window& window) {
  if (view.free_interval() && !view.fixed(view.num_variables() - 1)) return false;
  for (int b = 0; b < window.reduced_count; ++b) {
    for (int s = 0; s < view.block_size(); ++s) {
      if (!view.fixed(window.reduced[b] * view.block_size() + s)) return false;
    }
  }
  return true;
}

void ConstraintRows::Values(const ViewEvaluation& evaluation, double* u) const {
  for (const Window& window : windows_) {
    const int outputs = view_->problem().term(window.term).shape().outputs;
    u = std::copy_n(&evaluation.full.terms[window.term].u[window.index * outputs], outputs, u);
  }
  const int blocks = view_->blocks() * view_->block_size();
  for (int r = first_bound_; r < size(); ++r) {
    const int variable = column_[start_[r]];
    *u++ =
        variable < blocks ? evaluation.x[variable] : evaluation.h;  // bounds of blocks: an identity
  }
}

void ConstraintRows::Jacobian(const ViewEvaluation& evaluation, double* values) const {
  const int d = view_->block_size();
  for (const Window& w : windows_) {
    const TermShape& shape = view_->problem().term(w.term).shape();
    const TermBlock& block = evaluation.full.terms[w.term];
    for (int c = 0; c < shape.outputs; ++c) {
      const int j = shape.row(w.index, c);
      const double* du = block.slopes(j);
      view_->WindowJacobian(du, w.first_block, shape.window, 1.0, values);
      values += w.reduced_count * d;
      if (!view_->free_interval()) continue;
      *values++ =
          view_->IntervalDerivative(du, block.du_dh[j], w.first_block, shape.window, evaluation);
    }
  }
  std::fill_n(values, size() - first_bound_, 1.0);
}

void ConstraintRows::Spread(const double* flat, std::vector<std::vector<double>>* by_term) const {
  for (std::vector<double>& rows : *by_term) std::fill(rows.begin(), rows.end(), 0.0);
  for (const Window& window : windows_) {
    const int outputs = view_->problem().term(window.term).shape().outputs;
    std::copy_n(flat, outputs, &(*by_term)[window.term][window.index * outputs]);
    flat += outputs;
  }
}

bool ConstraintRows::Gather(const std::vector<std::vector<double>>& by_term, double* flat) const {
  if (static_cast<int>(by_term.size()) != view_->problem().num_terms()) return false;
  for (const Window& window : windows_) {
    const auto outputs =
        static_cast<std::size_t>(view_->problem().term(window.term).shape().outputs);
    const std::size_t first = static_cast<std::size_t>(window.index) * outputs;
    const std::vector<double>& rows = by_term[window.term];
    if (rows.size() < first + outputs) return false;
    flat = std::copy_n(&rows[first], outputs, flat);
  }
  return true;
}

namespace {

std::size_t RowsOf(const Problem& problem, int term) {
  const TermShape& shape = problem.term(term).shape();
  const int rows = problem.role(term) == Role::kConstraint ? shape.max_windows * shape.outputs : 0;
  return static_cast<std::size_t>(rows);
}

}  // namespace

void ConstraintRows::Size(const View& view, std::vector<std::vector<double>>* by_term) {
  const Problem& problem = view.problem();
  by_term->resize(static_cast<std::size_t>(problem.num_terms()));
  for (int i = 0; i < problem.num_terms(); ++i) (*by_term)[i].assign(RowsOf(problem, i), 0.0);
}

bool ConstraintRows::Fit(const View& view, const std::vector<std::vector<double>>& by_term) {
  const Problem& problem = view.problem();
  if (static_cast<int>(by_term.size()) != problem.num_terms()) return false;
  for (int i = 0; i < problem.num_terms(); ++i) {
    if (by_term[i].size() != RowsOf(problem, i)) return false;
  }
  return true;
}

}  // namespace touchdown::solvers
