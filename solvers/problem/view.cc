// SPDX-License-Identifier: BSD-3-Clause
// A problem through x = E y + l(h). With g, H the full gradient and Hessian and ' = d/dh:
//   g_y = E^T g,             g_h = dJ/dh + l' . g
//   H_yy = E^T H E,          H_yh = E^T (H l' + H_xh)
//   H_hh = d2J/dh2 + 2 l' . H_xh + l'^T H l' + l'' . g.
// The g in the last line is that of the Lagrangian, as H is. Rows go through the same lift.

#include "touchdown/solvers/problem/view.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace touchdown::solvers {

AffineLift AffineLift::Identity(int blocks) {
  AffineLift lift;
  lift.reduced_blocks = blocks;
  lift.coefficient.assign(static_cast<std::size_t>(blocks), 1.0);
  for (int i = 0; i < blocks; ++i) lift.block.push_back(i);
  return lift;
}

View::View(const Problem& problem, AffineLift lift) : problem_(&problem), lift_(std::move(lift)) {
  const auto blocks = static_cast<std::size_t>(problem.shape().blocks);
  if (lift_.block.size() != blocks || lift_.coefficient.size() != blocks) {
    throw std::invalid_argument("View: the lift has " + std::to_string(lift_.block.size()) +
                                " blocks, the problem has " + std::to_string(blocks));
  }
  int last = -1;
  for (std::size_t i = 0; i < blocks; ++i) {
    const int b = lift_.block[i];
    if (b < 0) continue;
    if (lift_.coefficient[i] == 0.0) {
      throw std::invalid_argument("View: block " + std::to_string(i) +
                                  " depends on a reduced block with coefficient 0");
    }
    if (b >= lift_.reduced_blocks || b < last || b > last + 1) {
      throw std::invalid_argument("View: reduced block " + std::to_string(b) +
                                  " is out of order; reduced blocks must follow the blocks");
    }
    last = b;
  }
  run_.assign(blocks, 0);
  for (std::size_t i = blocks; i-- > 0;) {
    if (lift_.block[i] < 0 || lift_.coefficient[i] != 1.0) continue;
    const bool goes_on = i + 1 < blocks && lift_.block[i + 1] == lift_.block[i] + 1;
    run_[i] = 1 + (goes_on ? run_[i + 1] : 0);
  }
  if (last + 1 != lift_.reduced_blocks) {
    throw std::invalid_argument("View: the lift uses " + std::to_string(last + 1) + " of " +
                                std::to_string(lift_.reduced_blocks) + " reduced blocks");
  }
}

bool View::identity() const {
  return !lift_.offset && lift_.reduced_blocks == problem_->shape().blocks &&
         std::all_of(lift_.coefficient.begin(), lift_.coefficient.end(),
                     [](double c) { return c == 1.0; });
}

bool View::constrained() const {
  for (int i = 0; i < problem_->num_terms(); ++i) {
    if (problem_->role(i) == Role::kConstraint) return true;
  }
  return bounded();
}

double View::lower(int i) const {
  const bool interval = free_interval() && i == num_variables() - 1;
  return interval ? problem_->shape().interval_min : problem_->lower(i);
}

double View::upper(int i) const {
  const bool interval = free_interval() && i == num_variables() - 1;
  return interval ? problem_->shape().interval_max : problem_->upper(i);
}

int View::num_free_variables() const {
  int free = 0;
  for (int i = 0; i < num_variables(); ++i) free += fixed(i) ? 0 : 1;
  return free;
}

void View::MoveIntoBounds(double* y) const {
  const int n = num_variables();
  const int first = bounded() ? 0 : n - (free_interval() ? 1 : 0);
  for (int i = first; i < n; ++i) y[i] = std::clamp(y[i], lower(i), upper(i));
}

void ViewEvaluation::HoldParameters() {
  full.HoldParameters();
  hold_ = true;
  offset_known_ = false;
}

void View::Resize(ViewEvaluation* evaluation) const {
  problem_->Resize(&evaluation->full);
  const auto n = static_cast<std::size_t>(problem_->shape().blocks * block_size());
  for (auto* array : {&evaluation->x, &evaluation->dl, &evaluation->d2l, &evaluation->offset_}) {
    array->assign(n, 0.0);
  }
  evaluation->scratch_.assign(2 * (n + 1), 0.0);
  evaluation->gradient.assign(static_cast<std::size_t>(num_variables()), 0.0);
  evaluation->hessian.Resize(blocks(), block_size(), problem_->half_bandwidth(), free_interval());
  evaluation->hold_ = evaluation->offset_known_ = false;
}

void View::AddReducedBlocks(const double* y, double* x) const {
  const int d = block_size();
  for (std::size_t i = 0; i < lift_.block.size(); ++i) {
    if (lift_.block[i] < 0) continue;
    for (int c = 0; c < d; ++c) {
      x[static_cast<int>(i) * d + c] += lift_.coefficient[i] * y[lift_.block[i] * d + c];
    }
  }
}

void View::ComputeOffset(Want want, ViewEvaluation* e) const {
  if (!lift_.offset) {
    std::fill(e->x.begin(), e->x.end(), 0.0);
  } else if (free_interval()) {
    const bool hessian = want.hessian;
    lift_.offset->At(e->h, e->x.data(), e->dl.data(), hessian ? e->d2l.data() : nullptr);
  } else {
    if (!e->offset_known_) lift_.offset->At(e->h, e->offset_.data(), nullptr, nullptr);
    e->offset_known_ = e->hold_;
    e->x = e->offset_;
  }
}

bool View::Fits(const ViewEvaluation& e) const {
  const auto n = static_cast<std::size_t>(problem_->shape().blocks * block_size());
  return e.x.size() == n && e.dl.size() == n && e.hessian.blocks() == blocks() &&
         e.hessian.half_bandwidth() == problem_->half_bandwidth() &&
         e.gradient.size() == static_cast<std::size_t>(num_variables());
}

bool View::Evaluate(const double* y, Want want, const Lagrangian& lagrangian,
                    ViewEvaluation* e) const noexcept {
  if (!Fits(*e)) {
    e->full.ok = false;
    e->full.failure = "the evaluation was not resized for this view as it is now";
    return false;
  }
  e->h = free_interval() ? y[num_variables() - 1] : problem_->interval();
  ComputeOffset(want, e);
  AddReducedBlocks(y, e->x.data());
  if (!problem_->Evaluate(e->x.data(), e->h, want, lagrangian, &e->full)) return false;
  if (want.gradient || want.hessian) ReduceVector(e->full.gradient.data(), *e, e->gradient.data());
  if (want.hessian) ReduceHessian(lagrangian, e);
  return true;
}

void View::ReduceVector(const double* full, const ViewEvaluation& e, double* out) const {
  const int d = block_size();
  std::fill(out, out + num_variables(), 0.0);
  for (std::size_t i = 0; i < lift_.block.size(); ++i) {
    if (lift_.block[i] < 0) continue;
    for (int c = 0; c < d; ++c) {
      out[lift_.block[i] * d + c] += lift_.coefficient[i] * full[static_cast<int>(i) * d + c];
    }
  }
  if (!free_interval()) return;
  double sum = full[e.dl.size()];
  for (std::size_t i = 0; i < e.dl.size(); ++i) sum += e.dl[i] * full[i];
  out[num_variables() - 1] = sum;
}

void View::ReduceHessian(const Lagrangian& lagrangian, ViewEvaluation* e) const {
  const int d = block_size();
  const int n = problem_->shape().blocks;
  const int half = problem_->half_bandwidth();
  const BorderedBandMatrix& H = e->full.hessian;
  e->hessian.SetZero();
  for (int i = 0; i < n; ++i) {
    const int bi = lift_.block[i];
    if (bi < 0) continue;
    const int last = std::min(half, n - 1 - i);
    if (run_[i] > last) {  // this block row as it is
      const double* in = H.block(i, 0);
      double* out = e->hessian.block(bi, 0);
      for (int j = 0; j < (last + 1) * d * d; ++j) out[j] += in[j];
      continue;
    }
    for (int k = 0; k <= last; ++k) {
      const int bj = lift_.block[i + k];
      if (bj < 0) continue;
      const double scale = lift_.coefficient[i] * lift_.coefficient[i + k];
      const double* in = H.block(i, k);
      double* out = e->hessian.block(bi, bj - bi);
      // Two full blocks on one reduced block: both triangles of the pair fall on its diagonal.
      const bool folded = bi == bj && k > 0;
      for (int r = 0; r < d; ++r) {
        for (int s = 0; s < d; ++s) {
          out[r * d + s] += scale * (in[r * d + s] + (folded ? in[s * d + r] : 0.0));
        }
      }
    }
  }
  if (!free_interval()) return;

  // v = H (l', 1): its blocks are H l' + H_xh, its last element l' . H_xh + d2J/dh2.
  const std::size_t full = e->dl.size() + 1;
  double* direction = e->scratch_.data();
  double* v = e->scratch_.data() + full;
  std::copy(e->dl.begin(), e->dl.end(), direction);
  direction[full - 1] = 1.0;
  H.Multiply(direction, v);
  double corner = v[full - 1];
  for (std::size_t i = 0; i + 1 < full; ++i) {
    const double slope =
        lagrangian.objective_factor * e->full.gradient[i] + e->full.row_gradient[i];
    corner += e->dl[i] * v[i] + (lagrangian.nominal_curvature ? 0.0 : e->d2l[i] * slope);
  }
  for (int i = 0; i < n; ++i) {
    if (lift_.block[i] < 0) continue;
    for (int r = 0; r < d; ++r) {
      e->hessian.border()[lift_.block[i] * d + r] += lift_.coefficient[i] * v[i * d + r];
    }
  }
  e->hessian.corner() = corner;
}

void View::MultiplyRowsTransposed(const double* const* weights, ViewEvaluation* e,
                                  double* out) const {
  const int d = block_size();
  const auto full = e->x.size();
  double* sum = e->scratch_.data();
  std::fill(sum, sum + full + 1, 0.0);
  for (int i = 0; i < problem_->num_terms(); ++i) {
    if (problem_->role(i) != Role::kConstraint) continue;
    const TermBlock& block = e->full.terms[i];
    const TermShape& shape = problem_->term(i).shape();
    const int v = shape.variables();
    for (int k = 0; k < block.windows; ++k) {
      double* window = sum + block.first_block[k] * d;
      for (int j = shape.row(k, 0); j < shape.row(k + 1, 0); ++j) {
        const double weight = weights[i][j];
        const double* du = block.slopes(j);
        for (int c = 0; c < v; ++c) window[c] += weight * du[c];
        sum[full] += weight * block.du_dh[j];
      }
    }
  }
  ReduceVector(sum, *e, out);
}

void View::MultiplyRows(const double* dy, ViewEvaluation* e, double* const* out) const {
  const int d = block_size();
  const auto full = e->x.size();
  double* dx = e->scratch_.data();
  const double dh = free_interval() ? dy[num_variables() - 1] : 0.0;
  for (std::size_t i = 0; i < full; ++i) dx[i] = free_interval() ? dh * e->dl[i] : 0.0;
  AddReducedBlocks(dy, dx);
  for (int i = 0; i < problem_->num_terms(); ++i) {
    if (problem_->role(i) != Role::kConstraint) continue;
    const TermBlock& block = e->full.terms[i];
    const TermShape& shape = problem_->term(i).shape();
    const int v = shape.variables();
    for (int k = 0; k < block.windows; ++k) {
      const double* window = dx + block.first_block[k] * d;
      for (int j = shape.row(k, 0); j < shape.row(k + 1, 0); ++j) {
        const double* du = block.slopes(j);
        double product = block.du_dh[j] * dh;
        for (int c = 0; c < v; ++c) product += du[c] * window[c];
        out[i][j] = product;
      }
    }
  }
}

void View::Lift(const double* y, std::vector<double>* x, double* h) const {
  *h = free_interval() ? y[num_variables() - 1] : problem_->interval();
  x->assign(static_cast<std::size_t>(problem_->shape().blocks * block_size()), 0.0);
  if (lift_.offset) lift_.offset->At(*h, x->data(), nullptr, nullptr);
  AddReducedBlocks(y, x->data());
}

Eigen::VectorXd View::Restrict(const double* x, double h) const {
  const int d = block_size();
  std::vector<double> l(static_cast<std::size_t>(problem_->shape().blocks * d), 0.0);
  if (lift_.offset) lift_.offset->At(h, l.data(), nullptr, nullptr);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(num_variables());
  int next = 0;
  for (int i = 0; i < problem_->shape().blocks; ++i) {
    if (lift_.block[i] != next) continue;
    for (int c = 0; c < d; ++c) {
      y[next * d + c] = (x[i * d + c] - l[i * d + c]) / lift_.coefficient[i];
    }
    ++next;
  }
  if (free_interval()) y[num_variables() - 1] = h;
  return y;
}

int View::WindowBlocks(int first_block, int window, int* reduced) const {
  int count = 0;
  for (int i = first_block; i < first_block + window; ++i) {
    const int b = lift_.block[i];
    if (b >= 0 && (count == 0 || reduced[count - 1] != b)) reduced[count++] = b;
  }
  return count;
}

namespace {

// D: the block's size, or Eigen::Dynamic.
template <int D>
void FoldWindow(const AffineLift& lift, const double* du, int d, int first_block, int window,
                double scale, double* out) {
  using Block = Eigen::Matrix<double, D, 1>;
  int last = -1;
  for (int i = first_block; i < first_block + window; ++i, du += d) {
    const int b = lift.block[i];
    if (b < 0) continue;
    const double factor = scale * lift.coefficient[i];
    const Eigen::Map<const Block> from(du, d);
    if (b == last) {
      Eigen::Map<Block>(out - d, d) += factor * from;
    } else {
      Eigen::Map<Block>(out, d) = factor * from;
      out += d;
      last = b;
    }
  }
}

}  // namespace

void View::WindowJacobian(const double* du, int first_block, int window, double scale,
                          double* out) const {
  const int d = block_size();
  if (d == 3) {
    FoldWindow<3>(lift_, du, d, first_block, window, scale, out);
  } else {
    FoldWindow<Eigen::Dynamic>(lift_, du, d, first_block, window, scale, out);
  }
}

double View::IntervalDerivative(const double* du, double du_dh, int first_block, int window,
                                const ViewEvaluation& evaluation) const {
  const int d = block_size();
  double sum = du_dh;
  for (int i = 0; i < window * d; ++i) sum += du[i] * evaluation.dl[first_block * d + i];
  return sum;
}

}  // namespace touchdown::solvers
