// SPDX-License-Identifier: BSD-3-Clause

#include "touchdown/solvers/problem/view_structure.h"

#include <cmath>
#include <cstddef>

namespace touchdown::solvers {
namespace {

template <class Visit>
void ForEachNumber(const View& view, Visit&& visit) {
  const Problem& problem = view.problem();
  visit(problem.shape().blocks);
  visit(problem.shape().block_size);
  visit(problem.shape().free_interval);
  visit(view.blocks());
  for (const int block : view.lift().block) visit(block);
  for (const double coefficient : view.lift().coefficient) visit(coefficient);
  for (int i = 0; view.bounded() && i < view.num_variables(); ++i) {
    // Their values may differ in each solve.
    visit(std::isfinite(view.lower(i)));
    visit(std::isfinite(view.upper(i)));
    visit(view.lower(i) == view.upper(i));
  }
  visit(problem.num_terms());
  for (int i = 0; i < problem.num_terms(); ++i) {
    const TermShape& shape = problem.term(i).shape();
    visit(shape.window);
    visit(shape.outputs);
    visit(shape.max_windows);
    visit(shape.has_residual);
    visit(problem.role(i) == Role::kConstraint);
    visit(problem.term(i).bounds().lo);
    visit(problem.term(i).bounds().hi);
  }
}

}  // namespace

ViewStructure::ViewStructure(const View& view) {
  ForEachNumber(view, [this](double number) { numbers_.push_back(number); });
}

bool ViewStructure::IsOf(const View& view) const {
  std::size_t at = 0;
  bool same = true;
  ForEachNumber(view, [&](double number) {
    same = same && at < numbers_.size() && numbers_[at] == number;
    ++at;
  });
  return same && at == numbers_.size();
}

}  // namespace touchdown::solvers
