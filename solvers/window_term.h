// SPDX-License-Identifier: BSD-3-Clause
// From an inner map to a whole term. A user writes
//
//   struct MyMap {
//     static constexpr int kBlockSize = 3, kWindow = 4, kOutputs = 1;
//     static constexpr bool kUsesInterval = true;
//     static constexpr bool kLinearInBlocks = false;  // u affine in q: no curvature at fixed h
//     int windows() const;                    // active now
//     int first_block(int k) const;           // where window k starts
//     template <class T>
//     void operator()(int k, const T* q, const T& h, const T& t, T* u) const;
//   };
//
// and gets value, gradient, exact Hessian, residuals and constraint rows by forward automatic
// differentiation. A map that also has
//
//     void Jacobian(int k, const double* q, double h, double t,
//                   double* u, double* du, double* du_dh) const;
//
// is differentiated by hand instead (du_dh with t_k's share); second derivatives stay automatic.
// Instantiate WindowTerm in one .cc only.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "touchdown/solvers/dual.h"
#include "touchdown/solvers/term.h"

namespace touchdown::solvers {

template <class Inner>
concept HasJacobian = requires(const Inner& inner, const double* q, double* out) {
  inner.Jacobian(0, q, 1.0, 0.0, out, out, out);
};

template <class Inner, class Loss>
class WindowTerm : public Term {
 public:
  static constexpr int kV = Inner::kWindow * Inner::kBlockSize;
  static constexpr int kM = Inner::kOutputs;

  WindowTerm(TermInfo info, Inner inner, Loss loss, int max_windows)
      : info_(std::move(info)), inner_(std::move(inner)), loss_(loss) {
    if (max_windows < 0) {
      throw std::invalid_argument("term " + info_.name + ": max_windows is " +
                                  std::to_string(max_windows) + ", it must be >= 0");
    }
    shape_ = {Inner::kBlockSize, Inner::kWindow, kM, max_windows, Inner::kUsesInterval};
  }

  const TermInfo& info() const override { return info_; }
  const TermShape& shape() const override { return shape_; }
  LossBounds bounds() const override { return loss_.bounds(); }

  /// The inner map, to change its parameters between solves.
  Inner& inner() { return inner_; }
  const Inner& inner() const { return inner_; }
  void set_loss(const Loss& loss) { loss_ = loss; }

  void Evaluate(const TermInput& input, Want want, const double* multipliers,
                TermBlock* block) const override {
    const int windows = inner_.windows();
    if (windows > shape_.max_windows) {
      throw std::length_error("term " + info_.name + ": more windows than it was sized for");
    }
    block->windows = windows;
    for (int k = 0; k < windows; ++k) {
      const int first = inner_.first_block(k);
      block->first_block[k] = first;
      const double* q = input.x + first * Inner::kBlockSize;
      const double t = input.t0 + first * input.h;
      EvaluateMap(k, q, input.h, t, first, want.gradient || want.hessian, block);
      EvaluateLoss(k, block);
      if (want.hessian) {
        const double* m = multipliers ? multipliers + k * kM : &block->drho[k * kM];
        EvaluateCurvature(k, q, input, t, first, m, block);
      }
    }
  }

 private:
  void EvaluateMap(int k, const double* q, double h, double t, int first, bool derivatives,
                   TermBlock* block) const {
    double* u = &block->u[k * kM];
    if (!derivatives) {
      inner_(k, q, h, t, u);
      return;
    }
    double* du = &block->du[k * kM * kV];
    double* du_dh = &block->du_dh[k * kM];
    if constexpr (HasJacobian<Inner>) {
      inner_.Jacobian(k, q, h, t, u, du, du_dh);
    } else {
      using D = Dual<double, kV + 1>;
      std::array<D, kV> q_dual;
      for (int i = 0; i < kV; ++i) q_dual[i] = D(q[i], i);
      const D h_dual(h, kV);
      D t_dual(t);
      t_dual.d[kV] = first;  // t_k = t0 + k h moves with the interval
      std::array<D, kM> u_dual;
      inner_(k, q_dual.data(), h_dual, t_dual, u_dual.data());
      for (int c = 0; c < kM; ++c) {
        u[c] = u_dual[c].v;
        for (int i = 0; i < kV; ++i) du[c * kV + i] = u_dual[c].d[i];
        du_dh[c] = u_dual[c].d[kV];
      }
    }
  }

  void EvaluateLoss(int k, TermBlock* block) const {
    for (int i = k * kM; i < (k + 1) * kM; ++i) {
      const LossValue value = loss_.Value(block->u[i]);
      block->rho[i] = value.rho;
      block->drho[i] = value.drho;
      block->d2rho[i] = value.d2rho;
      const LossResidual residual = loss_.Residual(block->u[i]);
      block->r[i] = residual.r;
      block->dr[i] = residual.dr;
    }
  }

  void EvaluateCurvature(int k, const double* q, const TermInput& input, double t, int first,
                         const double* multipliers, TermBlock* block) const {
    constexpr int n = kV + 1;
    double* out = &block->curvature[k * n * n];
    for (int i = 0; i < n * n; ++i) out[i] = 0.0;
    const bool bends_with_interval = Inner::kUsesInterval && input.free_interval;
    bool any = false;
    for (int c = 0; c < kM; ++c) any = any || multipliers[c] != 0.0;
    // Affine maps and inactive hinges bend nothing.
    if ((Inner::kLinearInBlocks && !bends_with_interval) || !any) return;
    if constexpr (!Inner::kLinearInBlocks || Inner::kUsesInterval) {
      using Inside = Dual<double, n>;
      using Outside = Dual<Inside, n>;
      std::array<Outside, kV> q_dual;
      for (int i = 0; i < kV; ++i) q_dual[i] = Outside(Inside(q[i], i), i);
      const Outside h_dual(Inside(input.h, kV), kV);
      Inside t_inside(t);
      t_inside.d[kV] = first;
      Outside t_dual;
      t_dual.v = t_inside;
      t_dual.d[kV] = Inside(static_cast<double>(first));
      std::array<Outside, kM> u;
      inner_(k, q_dual.data(), h_dual, t_dual, u.data());
      for (int c = 0; c < kM; ++c) {
        if (multipliers[c] == 0.0) continue;
        for (int i = 0; i < n; ++i) {
          for (int j = 0; j < n; ++j) out[i * n + j] += multipliers[c] * u[c].d[i].d[j];
        }
      }
    }
  }

  TermInfo info_;
  TermShape shape_;
  Inner inner_;
  Loss loss_;
};

}  // namespace touchdown::solvers
