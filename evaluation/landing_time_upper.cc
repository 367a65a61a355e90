// SPDX-License-Identifier: BSD-3-Clause
// A landing that is possible, and how early (docs/t_star.md). The acceleration is constant on each of
// kSegments equal parts of [0, T]: the position is a uniform quadratic B-spline, and limits on the
// norms of velocity (linear between knots) and acceleration hold everywhere if they hold at the
// knots. At a fixed T both are convex, and so is the end set; what is missed of it is minimised under
// these limits by the backend `banded`, from hovering, and the answer is checked by itself. T is
// found by bisection. Any T found is a valid upper bound, whatever the solver does.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "touchdown/evaluation/landing_judge.h"
#include "touchdown/evaluation/landing_time.h"
#include "touchdown/solvers/banded_solver.h"
#include "touchdown/solvers/window_term.h"

namespace touchdown::evaluation {
namespace {

constexpr int kSegments = 64;
constexpr int kPoints = kSegments + 2;      // control points; one more block is the leg, see EndSet
constexpr double kLimitShare = 1.0 - 1e-6;  // of the limits: the solver's rows are not exact
constexpr double kEndMargin = 1e-3;         // by which the end set is aimed at inside [m, m/s]
constexpr double kFirstStretch = 1.02;      // of the lower bound
constexpr double kStretch = 1.2;
constexpr double kBisected = 5e-4;  // share of T
constexpr double kMet = 1e-9;       // cost of an end that the check will let pass
constexpr int kMostIterations = 60;

/// |difference of order kOrder / h^kOrder| <= limit at every knot, as (|d|^2 - L^2) / (2 L) <= 0.
template <int kOrder>
struct DifferenceNorm {
  static constexpr int kBlockSize = 3, kWindow = kOrder + 1, kOutputs = 1;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = false;
  static constexpr double kRow[3] = {kOrder == 1 ? -1.0 : 1.0, kOrder == 1 ? 1.0 : -2.0, 1.0};
  double limit;

  int windows() const { return kPoints - kOrder; }
  int first_block(int k) const { return k; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& /*t*/, T* u) const {
    T sum(0.0);
    for (int c = 0; c < 3; ++c) {
      T d(0.0);
      for (int i = 0; i <= kOrder; ++i) d += kRow[i] * q[3 * i + c];
      sum += d * d;
    }
    for (int i = 0; i < kOrder; ++i) sum = sum / (h * h);
    u[0] = (sum - limit * limit) * (0.5 / limit);
  }
  // At a fixed interval alone, which is all that is asked here.
  void Jacobian(int k, const double* q, double h, double t, double* u, double* du,
                double* du_dh) const {
    (*this)(k, q, h, t, u);
    du_dh[0] = 0.0;
    for (int c = 0; c < 3; ++c) {
      double d = 0.0;
      for (int i = 0; i <= kOrder; ++i) d += kRow[i] * q[3 * i + c];
      for (int i = 0; i <= kOrder; ++i) du[3 * i + c] = kRow[i] * d * Scale(h);
    }
  }
  void Curvature(int /*k*/, const double* /*q*/, double h, double /*t*/, bool /*free_interval*/,
                 const double* m, double* d2) const {
    constexpr int n = 3 * kWindow + 1;
    for (int i = 0; i <= kOrder; ++i) {
      for (int j = i; j <= kOrder; ++j) {
        for (int c = 0; c < 3; ++c) {
          d2[(3 * i + c) * n + 3 * j + c] += m[0] * kRow[i] * kRow[j] * Scale(h);
        }
      }
    }
  }
  double Scale(double h) const { return 1.0 / (limit * (kOrder == 1 ? h * h : h * h * h * h)); }
};

/// What contact asks of the last two control points and of the leg, the block after them: B is at
/// the contact point on the deck plus the leg. The leg's height is that of B above the deck.
struct EndSet {
  estimation::PadState pad;
  double deck_radius = 1.0, foot_reach = 0.2, horizontal_speed = 0.6, vertical_speed = 0.5;

  template <class T>
  struct Relative {
    T contact[2], leg[3], height, v_h[2], v_z;  // of the pad; v_h to the deck point below B
  };
  template <class T>
  Relative<T> At(const T* q, const T& h) const {
    Relative<T> r{};
    T p[3], v[3];
    for (int c = 0; c < 3; ++c) {
      p[c] = 0.5 * (q[c] + q[3 + c]) - pad.p_WP[c];
      v[c] = (q[3 + c] - q[c]) / h - pad.v_WP[c];
      r.leg[c] = q[6 + c];
    }
    for (int c = 0; c < 2; ++c) r.contact[c] = p[c] - r.leg[c];
    r.height = p[2];
    r.v_h[0] = v[0] + pad.yaw_rate * p[1];
    r.v_h[1] = v[1] - pad.yaw_rate * p[0];
    r.v_z = v[2];
    return r;
  }
};

/// The end set's norms: contact point, leg, horizontal and vertical speed.
struct EndNorms : EndSet {
  static constexpr int kBlockSize = 3, kWindow = 3, kOutputs = 4;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = false;

  int windows() const { return 1; }
  int first_block(int /*k*/) const { return kPoints - 2; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& /*t*/, T* u) const {
    const Relative<T> r = At(q, h);
    const auto over = [](const T& square, double limit) {
      return (square - limit * limit) * (0.5 / limit);
    };
    u[0] = over(r.contact[0] * r.contact[0] + r.contact[1] * r.contact[1], deck_radius);
    u[1] = over(r.leg[0] * r.leg[0] + r.leg[1] * r.leg[1] + r.leg[2] * r.leg[2], foot_reach);
    u[2] = over(r.v_h[0] * r.v_h[0] + r.v_h[1] * r.v_h[1], horizontal_speed);
    u[3] = over(r.v_z * r.v_z, vertical_speed);
  }
};

/// The leg ends on the deck.
struct LegHeight : EndSet {
  static constexpr int kBlockSize = 3, kWindow = 3, kOutputs = 1;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = true;

  int windows() const { return 1; }
  int first_block(int /*k*/) const { return kPoints - 2; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& /*t*/, T* u) const {
    const Relative<T> r = At(q, h);
    u[0] = r.leg[2] - r.height;
  }
};

/// Hovering at the start fixes the first two control points.
class StartOffset final : public solvers::LiftOffset {
 public:
  explicit StartOffset(const Eigen::Vector3d& p) : p_(p) {}
  void At(double /*h*/, double* l, double* dl, double* d2l) const noexcept override {
    const int size = 3 * (kPoints + 1);
    std::fill(l, l + size, 0.0);
    if (dl != nullptr) std::fill(dl, dl + size, 0.0);
    if (d2l != nullptr) std::fill(d2l, d2l + size, 0.0);
    for (int c = 0; c < 3; ++c) l[c] = l[3 + c] = p_[c];
  }

 private:
  Eigen::Vector3d p_;
};

solvers::AffineLift StartLift(const Eigen::Vector3d& p) {
  solvers::AffineLift lift;
  lift.reduced_blocks = kPoints - 1;
  for (int i = 0; i <= kPoints; ++i) lift.block.push_back(i - 2 < 0 ? -1 : i - 2);
  lift.coefficient.assign(kPoints + 1, 1.0);
  lift.offset = std::make_shared<StartOffset>(p);
  return lift;
}

class Attainable {
 public:
  Attainable(const LandingTimeTask& task, const estimation::PadPrediction& pad)
      : task_(task),
        pad_(pad),
        norms_(std::make_shared<NormsTerm>(Info("end set"), EndNorms{}, Loss(), 1)),
        height_(
            std::make_shared<HeightTerm>(Info("leg"), LegHeight{}, solvers::SquareLoss(1.0), 1)),
        problem_({.blocks = kPoints + 1, .block_size = 3}),
        view_(AddTerms(), StartLift(task.p_WB)),
        backend_(solvers::MakeBandedSolver()) {
    backend_->Prepare(view_);
    y_ = task.p_WB.replicate(kPoints - 1, 1);
    y_.tail<3>().setZero();
    stop_.max_iterations = kMostIterations;
    stop_.callback = [](const solvers::StopQuery& at) {
      return at.cost <= kMet && at.max_violation <= 0.0;
    };
  }

  /// A trajectory that makes contact at T was found and passed the check.
  bool At(double T) {
    EndSet end;
    end.pad = pad_.At(T);
    end.deck_radius = task_.deck_radius - kEndMargin;
    end.foot_reach = task_.foot_reach - kEndMargin;
    end.horizontal_speed = task_.horizontal_speed - kEndMargin;
    end.vertical_speed = task_.vertical_speed - kEndMargin;
    static_cast<EndSet&>(norms_->inner()) = end;
    static_cast<EndSet&>(height_->inner()) = end;
    problem_.set_interval(T / kSegments);
    backend_->Solve(view_, solvers::WarmStart(y_), stop_, &result_);
    return result_.x.size() > 0 && Check(T);
  }

 private:
  using Loss_ = solvers::HingeLoss;
  using NormsTerm = solvers::WindowTerm<EndNorms, Loss_>;
  using HeightTerm = solvers::WindowTerm<LegHeight, solvers::SquareLoss>;

  static solvers::TermInfo Info(const char* name) { return {name, "", "", "", true}; }
  static Loss_ Loss() { return Loss_(1.0, 0.1); }

  const solvers::Problem& AddTerms() {
    problem_.AddTerm(norms_, solvers::Role::kCost);
    problem_.AddTerm(height_, solvers::Role::kCost);
    problem_.AddTerm(
        std::make_shared<solvers::WindowTerm<DifferenceNorm<1>, Loss_>>(
            Info("speed"), DifferenceNorm<1>{kLimitShare * task_.speed}, Loss(), kPoints),
        solvers::Role::kConstraint);
    problem_.AddTerm(std::make_shared<solvers::WindowTerm<DifferenceNorm<2>, Loss_>>(
                         Info("acceleration"), DifferenceNorm<2>{kLimitShare * task_.acceleration},
                         Loss(), kPoints),
                     solvers::Role::kConstraint);
    return problem_;
  }

  // The definition itself, on the control points: nothing of the solver's is trusted.
  bool Check(double T) const {
    const double h = T / kSegments;
    std::vector<Eigen::Vector3d> q(kPoints, task_.p_WB);
    for (int i = 2; i < kPoints; ++i) q[i] = result_.x.segment<3>(3 * (i - 2));
    for (int i = 0; i + 1 < kPoints; ++i) {
      if (!((q[i + 1] - q[i]).norm() <= task_.speed * h)) return false;
    }
    for (int i = 0; i + 2 < kPoints; ++i) {
      if (!((q[i + 2] - 2.0 * q[i + 1] + q[i]).norm() <= task_.acceleration * h * h)) return false;
    }
    const estimation::PadState pad = pad_.At(T);
    const Eigen::Vector3d p = 0.5 * (q[kPoints - 2] + q[kPoints - 1]);
    const Eigen::Vector3d v = (q[kPoints - 1] - q[kPoints - 2]) / h - DeckPointVelocity(pad, p);
    const Eigen::Vector3d offset = p - pad.p_WP;
    const double beyond = std::max(0.0, offset.head<2>().norm() - task_.deck_radius);
    return std::hypot(beyond, offset.z()) <= task_.foot_reach &&
           v.head<2>().norm() <= task_.horizontal_speed && std::abs(v.z()) <= task_.vertical_speed;
  }

  LandingTimeTask task_;
  const estimation::PadPrediction& pad_;
  std::shared_ptr<NormsTerm> norms_;
  std::shared_ptr<HeightTerm> height_;
  solvers::Problem problem_;
  solvers::View view_;
  std::unique_ptr<solvers::SolverBackend> backend_;
  Eigen::VectorXd y_;
  solvers::Stop stop_;
  solvers::SolverResult result_;
};

}  // namespace

std::optional<double> LandingTimeUpperBound(const LandingTimeTask& task,
                                            const estimation::PadPrediction& pad,
                                            double lower_bound) {
  Attainable attainable(task, pad);
  double missed = std::max(lower_bound, 1e-3);
  double met = kFirstStretch * missed;
  while (met <= task.horizon && !attainable.At(met)) {
    missed = met;
    met *= kStretch;
  }
  if (met > task.horizon) return std::nullopt;
  while (met - missed > kBisected * met) {
    const double middle = 0.5 * (missed + met);
    (attainable.At(middle) ? met : missed) = middle;
  }
  return met;
}

}  // namespace touchdown::evaluation
