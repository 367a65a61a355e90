// SPDX-License-Identifier: BSD-3-Clause
// A problem through x = E y + l(h). With g, H the full gradient and Hessian and ' = d/dh:
//   g_y = E^T g,             g_h = dJ/dh + l' . g
//   H_yy = E^T H E,          H_yh = E^T (H l' + H_xh)
//   H_hh = d2J/dh2 + 2 l' . H_xh + l'^T H l' + l'' . g,
// in the last line with g of the Lagrangian, as H is.

#include "touchdown/solvers/view.h"

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
  if (last + 1 != lift_.reduced_blocks) {
    throw std::invalid_argument("View: the lift uses " + std::to_string(last + 1) + " of " +
                                std::to_string(lift_.reduced_blocks) + " reduced blocks");
  }
}

void View::Resize(ViewEvaluation* evaluation) const {
  problem_->Resize(&evaluation->full);
  const auto n = static_cast<std::size_t>(problem_->shape().blocks * block_size());
  evaluation->x.assign(n, 0.0);
  evaluation->dl.assign(n, 0.0);
  evaluation->d2l.assign(n, 0.0);
  evaluation->gradient.assign(static_cast<std::size_t>(num_variables()), 0.0);
  evaluation->hessian.Resize(blocks(), block_size(), problem_->half_bandwidth(), free_interval());
}

namespace {

void AddReducedBlocks(const double* y, const AffineLift& lift, int d, double* x) {
  for (std::size_t i = 0; i < lift.block.size(); ++i) {
    if (lift.block[i] < 0) continue;
    for (int c = 0; c < d; ++c) {
      x[static_cast<int>(i) * d + c] += lift.coefficient[i] * y[lift.block[i] * d + c];
    }
  }
}

}  // namespace

bool View::Evaluate(const double* y, Want want, const Lagrangian& lagrangian,
                    ViewEvaluation* e) const noexcept {
  e->h = free_interval() ? y[num_variables() - 1] : problem_->interval();
  if (lift_.offset) {
    lift_.offset->At(e->h, e->x.data(), free_interval() ? e->dl.data() : nullptr,
                     free_interval() && want.hessian ? e->d2l.data() : nullptr);
  } else {
    std::fill(e->x.begin(), e->x.end(), 0.0);
  }
  AddReducedBlocks(y, lift_, block_size(), e->x.data());
  if (!problem_->Evaluate(e->x.data(), e->h, want, lagrangian, &e->full)) return false;
  if (want.gradient) ReduceGradient(e);
  if (want.hessian) ReduceHessian(e);
  return true;
}

void View::ReduceGradient(ViewEvaluation* e) const {
  const int d = block_size();
  const std::vector<double>& g = e->full.gradient;
  std::fill(e->gradient.begin(), e->gradient.end(), 0.0);
  for (std::size_t i = 0; i < lift_.block.size(); ++i) {
    if (lift_.block[i] < 0) continue;
    for (int c = 0; c < d; ++c) {
      e->gradient[lift_.block[i] * d + c] += lift_.coefficient[i] * g[static_cast<int>(i) * d + c];
    }
  }
  if (!free_interval()) return;
  double sum = g.back();
  for (std::size_t i = 0; i < e->dl.size(); ++i) sum += e->dl[i] * g[i];
  e->gradient.back() = sum;
}

void View::ReduceHessian(ViewEvaluation* e) const {
  const int d = block_size();
  const int n = problem_->shape().blocks;
  const int half = problem_->half_bandwidth();
  const BorderedBandMatrix& H = e->full.hessian;
  e->hessian.SetZero();
  double corner = free_interval() ? H.corner() : 0.0;
  for (int i = 0; i < n; ++i) {
    const int bi = lift_.block[i];
    const double ci = lift_.coefficient[i];
    for (int k = 0; k <= half && i + k < n; ++k) {
      const int j = i + k;
      const int bj = lift_.block[j];
      const double cj = lift_.coefficient[j];
      const double* in = H.block(i, k);
      if (bi >= 0 && bj >= 0) {
        double* out = e->hessian.block(bi, bj - bi);
        // Two full blocks on one reduced block: both triangles of the pair fall on its diagonal.
        const bool folded = bi == bj && k > 0;
        for (int r = 0; r < d; ++r) {
          for (int s = 0; s < d; ++s) {
            out[r * d + s] += ci * cj * (in[r * d + s] + (folded ? in[s * d + r] : 0.0));
          }
        }
      }
      if (!free_interval()) continue;
      for (int r = 0; r < d; ++r) {
        for (int s = 0; s < d; ++s) {
          const double h_rs = in[r * d + s];
          const double li = e->dl[i * d + r];
          const double lj = e->dl[j * d + s];
          if (bi >= 0) e->hessian.border()[bi * d + r] += ci * h_rs * lj;
          if (k > 0 && bj >= 0) e->hessian.border()[bj * d + s] += cj * h_rs * li;
          corner += (k > 0 ? 2.0 : 1.0) * li * h_rs * lj;
        }
      }
    }
    if (!free_interval()) continue;
    for (int r = 0; r < d; ++r) {
      const double cross = H.border()[i * d + r];
      if (bi >= 0) e->hessian.border()[bi * d + r] += ci * cross;
      corner += 2.0 * e->dl[i * d + r] * cross +
                e->d2l[i * d + r] * e->full.lagrangian_gradient[i * d + r];
    }
  }
  e->hessian.corner() = corner;
}

void View::Lift(const double* y, std::vector<double>* x, double* h) const {
  *h = free_interval() ? y[num_variables() - 1] : problem_->interval();
  x->assign(static_cast<std::size_t>(problem_->shape().blocks * block_size()), 0.0);
  if (lift_.offset) lift_.offset->At(*h, x->data(), nullptr, nullptr);
  AddReducedBlocks(y, lift_, block_size(), x->data());
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

void View::WindowJacobian(const double* du, int first_block, int window, int reduced,
                          double* out) const {
  const int d = block_size();
  std::fill(out, out + d, 0.0);
  for (int i = 0; i < window; ++i) {
    if (lift_.block[first_block + i] != reduced) continue;
    for (int c = 0; c < d; ++c) out[c] += lift_.coefficient[first_block + i] * du[i * d + c];
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
