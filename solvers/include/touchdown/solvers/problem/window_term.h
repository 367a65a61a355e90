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
// is differentiated by hand instead (du_dh with t_k's share), and with
//
//     void Curvature(int k, const double* q, double h, double t, bool free_interval,
//                    const double* m, double* d2) const;
//
// for second derivatives. It adds sum_c m_c d2u_c to d2, a row-major (v + 1) x (v + 1) matrix with
// h last. The blocks on and above the diagonal are read, those on it whole, and h's column if it is
// free. Without it a SecondDual does the same, a few times slower, for w d < 64. If output c of a
// map depends on coordinate c % d of the blocks alone, the map sets kSeparable = true. Its Hessian
// is then summed coordinate by coordinate. Instantiate WindowTerm in one .cc only.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "touchdown/solvers/problem/dual.h"
#include "touchdown/solvers/problem/term.h"

namespace touchdown::solvers {

template <class Inner>
concept HasJacobian = requires(const Inner& inner, const double* q, double* out) {
  inner.Jacobian(0, q, 1.0, 0.0, out, out, out);
};

template <class Inner>
concept HasCurvature = requires(const Inner& inner, const double* q, double* out) {
  inner.Curvature(0, q, 1.0, 0.0, true, q, out);
};

template <class Inner>
concept IsSeparable = requires {
  requires Inner::kSeparable;
};

template <class Loss>
concept HasResidual = requires(const Loss& loss) {
  loss.Residual(0.0);
};

template <class Inner, class Loss>
class WindowTerm : public Term {
 public:
  static constexpr int kD = Inner::kBlockSize;
  static constexpr int kW = Inner::kWindow;
  static constexpr int kV = kW * kD;
  static constexpr int kM = Inner::kOutputs;

  WindowTerm(TermInfo info, Inner inner, Loss loss, int max_windows)
      : info_(std::move(info)), inner_(std::move(inner)), loss_(loss) {
    if (max_windows < 0) {
      throw std::invalid_argument("term " + info_.name + ": max_windows is " +
                                  std::to_string(max_windows) + ", it must be >= 0");
    }
    shape_ = {kD,
              kW,
              kM,
              max_windows,
              Inner::kUsesInterval,
              Inner::kLinearInBlocks && Loss::kQuadratic,
              HasResidual<Loss>};
  }

  const TermInfo& info() const override { return info_; }
  const TermShape& shape() const override { return shape_; }
  LossBounds bounds() const override { return loss_.bounds(); }
  double nominal_row_weight() const override { return loss_.NominalCurvature(0.0); }

  /// The inner map, to change its parameters between solves.
  Inner& inner() { return inner_; }
  const Inner& inner() const { return inner_; }
  void set_loss(const Loss& loss) { loss_ = loss; }

  void Place(TermBlock* block) const override {
    const int windows = inner_.windows();
    if (windows > shape_.max_windows) {
      throw std::length_error("term " + info_.name + ": more windows than it was sized for");
    }
    block->windows = windows;
    for (int k = 0; k < windows; ++k) block->first_block[k] = inner_.first_block(k);
  }

  void Evaluate(const TermInput& input, const TermRequest& request, TermBlock* block,
                const TermSums& sums) const override {
    const bool bends = !Inner::kLinearInBlocks || (Inner::kUsesInterval && input.free_interval);
    for (int k = 0; k < block->windows; ++k) {
      const int first = block->first_block[k];
      const Window w{
          k, first, input.x + first * kD, input.h, input.t0 + first * input.h, input.free_interval};
      EvaluateMap(w, request, block);
      if (request.role == Role::kCost) EvaluateLoss(k, request, block);
      if (request.want.gradient) AddGradient(w, request, *block, sums);
      if (request.want.hessian && !request.hessian_known) {
        AddHessian(w, request, bends, *block, sums.hessian);
      }
    }
  }

 private:
  struct Window {
    int k;
    int first;
    const double* q;
    double h;
    double t;
    bool free_interval;
  };

  void EvaluateMap(const Window& w, const TermRequest& request, TermBlock* block) const {
    double* u = &block->u[w.k * kM];
    const bool derivatives = request.want.gradient || request.want.residual;
    if (!derivatives || request.jacobian_known) {
      inner_(w.k, w.q, w.h, w.t, u);
      return;
    }
    double* du = &block->du[w.k * kM * kV];
    double* du_dh = &block->du_dh[w.k * kM];
    if constexpr (HasJacobian<Inner>) {
      inner_.Jacobian(w.k, w.q, w.h, w.t, u, du, du_dh);
    } else {
      using D = Dual<kV + 1>;
      std::array<D, kV> q_dual;
      for (int i = 0; i < kV; ++i) q_dual[i] = D(w.q[i], i);
      const D h_dual(w.h, kV);
      // t_k = t0 + k h moves with the interval.
      const D t_dual = w.t + w.first * (h_dual - w.h);
      std::array<D, kM> u_dual;
      inner_(w.k, q_dual.data(), h_dual, t_dual, u_dual.data());
      for (int c = 0; c < kM; ++c) {
        u[c] = u_dual[c].v;
        for (int i = 0; i < kV; ++i) du[c * kV + i] = u_dual[c].d[i];
        du_dh[c] = u_dual[c].d[kV];
      }
    }
  }

  void EvaluateLoss(int k, const TermRequest& request, TermBlock* block) const {
    for (int i = k * kM; i < (k + 1) * kM; ++i) {
      const LossValue value = loss_.Value(block->u[i]);
      block->rho[i] = value.rho;
      block->drho[i] = value.drho;
      block->d2rho[i] =
          request.nominal_curvature ? loss_.NominalCurvature(block->u[i]) : value.d2rho;
      if constexpr (HasResidual<Loss>) {
        if (!request.want.residual) continue;
        const LossResidual residual = loss_.Residual(block->u[i]);
        block->r[i] = residual.r;
        block->dr[i] = residual.dr;
      }
    }
  }

  void AddGradient(const Window& w, const TermRequest& request, const TermBlock& block,
                   const TermSums& sums) const {
    const bool cost = request.role == Role::kCost;
    const double* weights = cost ? &block.drho[w.k * kM] : nullptr;
    if (!cost && request.rows.multiplier) weights = request.rows.multiplier + w.k * kM;
    if (!weights) return;
    double* out = cost ? sums.gradient : sums.row_gradient;
    double* h_out = out + sums.interval_index;
    std::array<double, kV> sum{};
    double h_sum = 0.0;
    for (int c = 0; c < kM; ++c) {
      if (weights[c] == 0.0) continue;
      const double* du = &block.du[(w.k * kM + c) * kV];
      for (int i = 0; i < kV; ++i) sum[i] += weights[c] * du[i];
      h_sum += weights[c] * block.du_dh[w.k * kM + c];
    }
    for (int i = 0; i < kV; ++i) out[w.first * kD + i] += sum[i];
    if (w.free_interval) *h_out += h_sum;
  }

  /// Adds sum_c (weight_c du_c du_c^T + slope_c d2u_c) of one window.
  void AddHessian(const Window& w, const TermRequest& request, bool bends, const TermBlock& block,
                  BorderedBandMatrix* hessian) const {
    constexpr int n = kV + 1;
    std::array<double, kM> weight{}, slope{};
    bool any_weight = false, any_slope = false;
    for (int c = 0; c < kM; ++c) {
      const int i = w.k * kM + c;
      if (request.role == Role::kCost) {
        weight[c] = request.objective_factor * block.d2rho[i];
        slope[c] = request.objective_factor * block.drho[i];
      } else {
        if (request.rows.weight) weight[c] = request.rows.weight[i];
        if (request.rows.multiplier) slope[c] = request.rows.multiplier[i];
      }
      any_weight = any_weight || weight[c] != 0.0;
      any_slope = any_slope || slope[c] != 0.0;
    }
    any_slope = any_slope && bends && !request.nominal_curvature;
    if (!any_weight && !any_slope) return;

    if constexpr (IsSeparable<Inner>) {
      AddSeparable(w, weight.data(), block, hessian);
      if (!any_slope) return;
    }
    std::array<double, n * n> sum{};
    if constexpr (!IsSeparable<Inner>) AddOuterProducts(w, weight.data(), block, sum.data());
    if (any_slope) AddCurvature(w, slope.data(), sum.data());
    if (!IsSeparable<Inner> || !Inner::kLinearInBlocks) ScatterBlocks(w, sum.data(), hessian);
    if (w.free_interval) ScatterBorder(w, sum.data(), hessian);
  }

  void AddOuterProducts(const Window& w, const double* weight, const TermBlock& block,
                        double* sum) const {
    constexpr int n = kV + 1;
    for (int c = 0; c < kM; ++c) {
      if (weight[c] == 0.0) continue;
      const double* du = &block.du[(w.k * kM + c) * kV];
      for (int i = 0; i < kV; ++i) {
        const double left = weight[c] * du[i];
        if (left == 0.0) continue;  // rows of many variables depend on few of them
        // From the row's own block on: the block diagonal is stored whole.
        for (int j = i / kD * kD; j < kV; ++j) sum[i * n + j] += left * du[j];
      }
      if (w.free_interval) {
        const double left = weight[c] * block.du_dh[w.k * kM + c];
        for (int i = 0; i < kV; ++i) sum[i * n + kV] += left * du[i];
        sum[n * n - 1] += left * block.du_dh[w.k * kM + c];
      }
    }
  }

  void AddSeparable(const Window& w, const double* weight, const TermBlock& block,
                    BorderedBandMatrix* hessian) const {
    for (int x = 0; x < kD; ++x) {
      std::array<double, kW * kW> sum{};
      std::array<double, kW> border{};
      for (int c = x; c < kM; c += kD) {
        const double* du = &block.du[(w.k * kM + c) * kV + x];
        const double du_dh = block.du_dh[w.k * kM + c];
        for (int a = 0; a < kW; ++a) {
          const double left = weight[c] * du[a * kD];
          for (int b = a; b < kW; ++b) sum[a * kW + b] += left * du[b * kD];
          border[a] += left * du_dh;
        }
        if (w.free_interval) hessian->corner() += weight[c] * du_dh * du_dh;
      }
      for (int a = 0; a < kW; ++a) {
        for (int b = a; b < kW; ++b) {
          hessian->block(w.first + a, b - a)[x * kD + x] += sum[a * kW + b];
        }
        if (w.free_interval) hessian->border()[(w.first + a) * kD + x] += border[a];
      }
    }
  }

  void AddCurvature(const Window& w, const double* slope, double* sum) const {
    constexpr int n = kV + 1;
    if constexpr (HasCurvature<Inner>) {
      inner_.Curvature(w.k, w.q, w.h, w.t, w.free_interval, slope, sum);
    } else if constexpr (!Inner::kLinearInBlocks || Inner::kUsesInterval) {
      using D = SecondDual<n>;
      std::array<D, kV> q;
      for (int i = 0; i < kV; ++i) q[i] = D(w.q[i], i);
      const D h(w.h, kV);
      std::array<D, kM> u;
      inner_(w.k, q.data(), h, w.t + w.first * (h - w.h), u.data());
      for (int c = 0; c < kM; ++c) {
        if (slope[c] == 0.0) continue;
        u[c].ForEachCurvature([&](int i, int j, double curvature) {
          sum[i * n + j] += slope[c] * curvature;
          if (i != j) sum[j * n + i] += slope[c] * curvature;
        });
      }
    }
  }

  void ScatterBlocks(const Window& w, const double* sum, BorderedBandMatrix* hessian) const {
    constexpr int n = kV + 1;
    for (int a = 0; a < kW; ++a) {
      for (int b = a; b < kW; ++b) {
        double* out = hessian->block(w.first + a, b - a);
        for (int i = 0; i < kD; ++i) {
          for (int j = 0; j < kD; ++j) out[i * kD + j] += sum[(a * kD + i) * n + b * kD + j];
        }
      }
    }
  }

  void ScatterBorder(const Window& w, const double* sum, BorderedBandMatrix* hessian) const {
    constexpr int n = kV + 1;
    for (int i = 0; i < kV; ++i) hessian->border()[w.first * kD + i] += sum[i * n + kV];
    hessian->corner() += sum[n * n - 1];
  }

  TermInfo info_;
  TermShape shape_;
  Inner inner_;
  Loss loss_;
};

}  // namespace touchdown::solvers
