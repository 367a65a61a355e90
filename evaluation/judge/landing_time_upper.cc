// SPDX-License-Identifier: BSD-3-Clause
// A contact that is possible, and how early (docs/t_star.md). The acceleration is constant on each of kSegments equal
// parts of [0, T], so the position is a uniform quadratic B-spline. Velocity is linear between knots. So limits on the
// norms of velocity and acceleration hold everywhere if they hold at the knots. At a fixed T both are convex. The end
// set is convex too: the vehicle is level, comes from above and has a foot on the deck. (The lower bound has a larger
// end set of necessary conditions.) The backend `banded` minimises the distance to the end set under these limits, from
// hovering. The answer is checked independently. T is found by bisection. Any T found is a valid upper bound, whatever
// the solver does.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "evaluation/judge/landing_judge.h"
#include "evaluation/judge/landing_time.h"
#include "solvers/banded/banded_solver.h"
#include "touchdown/solvers/problem/window_term.h"

namespace touchdown::evaluation {
namespace {

constexpr int kSegments = 64;
constexpr int kPoints = kSegments + 2;      // control points
constexpr double kLimitShare = 1.0 - 1e-6;  // of the limits: the solver's rows are not exact
constexpr double kEndMargin = 1e-3;         // by which the end set is aimed at inside [m, m/s]
constexpr double kHeightMargin = 1e-4;      // how far the feet may end from the deck's face [m]
constexpr double kFirstStretch = 1.02;      // of the lower bound
constexpr double kStretch = 1.2;
constexpr double kBisectionTolerance = 5e-4;  // share of T
constexpr double kMet = 1e-9;                 // cost of an end that the check will let pass
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

/// Conditions of contact for a level vehicle, for all errors of the pad that the task allows.
struct EndSet {
  EndSet() = default;
  EndSet(const LandingTimeTask& task, const estimation::PadState& pad_then)
      : pad(pad_then),
        half_size(task.deck_half_size - task.pad_position_error -
                  task.deck_radius() * task.pad_yaw_error),
        foot_radius(task.foot_radius),
        height(task.foot_depth),
        horizontal_speed(task.horizontal_speed - task.pad_velocity_error -
                         (task.deck_radius() + task.foot_radius) * task.pad_yaw_rate_error -
                         std::abs(pad_then.yaw_rate) * task.pad_position_error),
        vertical_speed(task.vertical_speed) {}

  /// How far B is beyond the deck, per side: of the square in the pad's yaw [m].
  template <class T>
  std::array<T, 2> Beyond(const T& x, const T& y) const {
    const auto beyond = [&](const T& s) {
      return s > half_size ? T(s - half_size) : s < -half_size ? T(s + half_size) : T(0.0);
    };
    return {beyond(x), beyond(y)};
  }

  estimation::PadState pad;
  double half_size = 0.75;        ///< of that square [m]
  double foot_radius = 0.16;      ///< B is no farther beyond it: a foot can be on it [m]
  double height = 0.12;           ///< of B above the deck [m]
  double horizontal_speed = 0.6;  ///< relative to the deck point below B [m/s]
  double vertical_speed = 0.5;    ///< [m/s]
};

/// The end set's bounds on the last two control points: place, horizontal and vertical speed.
struct EndBounds : EndSet {
  static constexpr int kBlockSize = 3, kWindow = 2, kOutputs = 3;
  static constexpr bool kUsesInterval = true, kLinearInBlocks = false;

  int windows() const { return 1; }
  int first_block(int /*k*/) const { return kPoints - 2; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& h, const T& /*t*/, T* u) const {
    const auto over = [](const T& square, double limit) {
      return (square - limit * limit) * (0.5 / limit);
    };
    T p[2], v[3];
    for (int c = 0; c < 2; ++c) p[c] = 0.5 * (q[c] + q[3 + c]) - pad.p_WP[c];
    for (int c = 0; c < 3; ++c) v[c] = (q[3 + c] - q[c]) / h - pad.v_WP[c];
    const double cos = std::cos(pad.yaw), sin = std::sin(pad.yaw);
    const T x = cos * p[0] + sin * p[1], y = cos * p[1] - sin * p[0];
    v[0] += pad.yaw_rate * p[1];
    v[1] -= pad.yaw_rate * p[0];
    const auto [beyond_x, beyond_y] = Beyond(x, y);
    u[0] = over(beyond_x * beyond_x + beyond_y * beyond_y, foot_radius);
    u[1] = over(v[0] * v[0] + v[1] * v[1], horizontal_speed);
    u[2] = over(v[2] * v[2], vertical_speed);
  }
};

/// The feet end on the deck.
struct EndHeight : EndSet {
  static constexpr int kBlockSize = 3, kWindow = 2, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = true;

  int windows() const { return 1; }
  int first_block(int /*k*/) const { return kPoints - 2; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = 0.5 * (q[2] + q[5]) - (pad.p_WP.z() + height);
  }
};

/// The flight comes from above: no control point but the last is lower than the end. So no part of
/// the flight is lower, and it ends sinking.
struct FromAbove : EndSet {
  static constexpr int kBlockSize = 3, kWindow = 1, kOutputs = 1;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = true;

  int windows() const { return kPoints - 3; }
  int first_block(int k) const { return k + 2; }
  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    u[0] = (pad.p_WP.z() + height - 0.5 * kHeightMargin) - q[2];
  }
};

/// Hovering at the start fixes the first two control points.
class StartOffset final : public solvers::LiftOffset {
 public:
  explicit StartOffset(const Eigen::Vector3d& p) : p_(p) {}
  void At(double /*h*/, double* l, double* dl, double* d2l) const noexcept override {
    const int size = 3 * kPoints;
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
  lift.reduced_blocks = kPoints - 2;
  for (int i = 0; i < kPoints; ++i) lift.block.push_back(i < 2 ? -1 : i - 2);
  lift.coefficient.assign(kPoints, 1.0);
  lift.offset = std::make_shared<StartOffset>(p);
  return lift;
}

class Attainable {
 public:
  Attainable(const LandingTimeTask& task, const estimation::PadPrediction& pad)
      : task_(task),
        pad_(pad),
        bounds_(std::make_shared<BoundsTerm>(Info("end set"), EndBounds{}, Loss(), 1)),
        height_(std::make_shared<HeightTerm>(Info("end height"), EndHeight{},
                                             solvers::SquareLoss(1.0), 1)),
        above_(std::make_shared<AboveTerm>(Info("from above"), FromAbove{}, Loss(), kPoints)),
        problem_({.blocks = kPoints, .block_size = 3}),
        view_(AddTerms(), StartLift(task.p_WB)),
        backend_(solvers::MakeBandedSolver()) {
    backend_->Prepare(view_);
    y_ = task.p_WB.replicate(kPoints - 2, 1);
    stop_.max_iterations = kMostIterations;
    stop_.confirm = false;  // the found flight is checked here
    stop_.callback = [](const solvers::StopQuery& at) {
      return at.cost <= kMet && at.max_violation <= 0.0;
    };
  }

  /// A flight that makes contact at T was found and passed the check: `flight`.
  bool At(double T, LandingFlight* flight) {
    EndSet end(task_, pad_.At(T));
    if (task_.p_WB.z() < end.pad.p_WP.z() + end.height) return false;
    end.half_size -= kEndMargin;
    end.horizontal_speed -= kEndMargin;
    end.vertical_speed -= kEndMargin;
    if (std::min({end.half_size, end.foot_radius, end.horizontal_speed, end.vertical_speed}) <=
        0.0) {
      return false;
    }
    static_cast<EndSet&>(bounds_->inner()) = end;
    static_cast<EndSet&>(height_->inner()) = end;
    static_cast<EndSet&>(above_->inner()) = end;
    problem_.set_interval(T / kSegments);
    backend_->Solve(view_, solvers::WarmStart(y_), stop_, &result_);
    if (result_.x.size() == 0) return false;
    LandingFlight found{T, std::vector<Eigen::Vector3d>(kPoints, task_.p_WB)};
    for (int i = 2; i < kPoints; ++i) {
      found.control_points[i] = result_.x.segment<3>(3 * (i - 2));
    }
    if (!Check(found)) return false;
    *flight = std::move(found);
    return true;
  }

 private:
  using Loss_ = solvers::HingeLoss;
  using BoundsTerm = solvers::WindowTerm<EndBounds, Loss_>;
  using HeightTerm = solvers::WindowTerm<EndHeight, solvers::SquareLoss>;
  using AboveTerm = solvers::WindowTerm<FromAbove, Loss_>;

  static solvers::TermInfo Info(const char* name) { return {name, "", "", "", true}; }
  static Loss_ Loss() { return Loss_(1.0, 0.1); }

  const solvers::Problem& AddTerms() {
    problem_.AddTerm(bounds_, solvers::Role::kCost);
    problem_.AddTerm(height_, solvers::Role::kCost);
    problem_.AddTerm(above_, solvers::Role::kConstraint);
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
  bool Check(const LandingFlight& flight) const {
    const double h = flight.time / kSegments;
    const std::vector<Eigen::Vector3d>& q = flight.control_points;
    const EndSet end(task_, pad_.At(flight.time));
    const double end_z = end.pad.p_WP.z() + end.height;
    for (int i = 0; i + 1 < kPoints; ++i) {
      if (!((q[i + 1] - q[i]).norm() <= task_.speed * h)) return false;
      if (!(q[i].z() >= end_z - kHeightMargin)) return false;
    }
    for (int i = 0; i + 2 < kPoints; ++i) {
      if (!((q[i + 2] - 2.0 * q[i + 1] + q[i]).norm() <= task_.acceleration * h * h)) return false;
    }
    const Eigen::Vector3d p = 0.5 * (q[kPoints - 2] + q[kPoints - 1]);
    const Eigen::Vector3d v = (q[kPoints - 1] - q[kPoints - 2]) / h - DeckPointVelocity(end.pad, p);
    const Eigen::Vector2d on_deck = Eigen::Rotation2Dd(-end.pad.yaw) * (p - end.pad.p_WP).head<2>();
    const auto [beyond_x, beyond_y] = end.Beyond(on_deck.x(), on_deck.y());
    return std::hypot(beyond_x, beyond_y) <= end.foot_radius &&
           std::abs(p.z() - end_z) <= kHeightMargin && v.head<2>().norm() <= end.horizontal_speed &&
           std::abs(v.z()) <= end.vertical_speed;
  }

  LandingTimeTask task_;
  const estimation::PadPrediction& pad_;
  std::shared_ptr<BoundsTerm> bounds_;
  std::shared_ptr<HeightTerm> height_;
  std::shared_ptr<AboveTerm> above_;
  solvers::Problem problem_;
  solvers::View view_;
  std::unique_ptr<solvers::SolverBackend> backend_;
  Eigen::VectorXd y_;
  solvers::Stop stop_;
  solvers::SolverResult result_;
};

}  // namespace

std::optional<LandingFlight> LandingTimeUpperBound(const LandingTimeTask& task,
                                                   const estimation::PadPrediction& pad,
                                                   double lower_bound) {
  Attainable attainable(task, pad);
  LandingFlight flight;
  double missed = std::max(lower_bound, 1e-3);
  double met = kFirstStretch * missed;
  while (met <= task.horizon && !attainable.At(met, &flight)) {
    missed = met;
    met *= kStretch;
  }
  if (met > task.horizon) return std::nullopt;
  while (met - missed > kBisectionTolerance * met) {
    const double middle = 0.5 * (missed + met);
    (attainable.At(middle, &flight) ? met : missed) = middle;
  }
  return flight;
}

}  // namespace touchdown::evaluation
