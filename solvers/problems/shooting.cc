// SPDX-License-Identifier: BSD-3-Clause
// One template makes a problem of a vehicle's equations of motion. The transcription is from J.
// Betts, "Practical Methods for Optimal Control and Estimation Using Nonlinear Programming", 2nd
// ed., SIAM 2010, chapter 4.

#include "touchdown/solvers/problems/shooting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "touchdown/solvers/problem/window_term.h"

namespace touchdown::solvers {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kGravity = 9.81;

/// x' = f(x, u) between neighbours: x1 - x0 - dt / 2 (f0 + f1) = 0.
template <class Motion>
class Trapezoid {
 public:
  static constexpr int kStates = Motion::kStates, kBlockSize = Motion::kStates + Motion::kInputs;
  static constexpr int kWindow = 2, kOutputs = kStates;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = false;

  Trapezoid(Motion motion, int steps, double dt) : motion_(motion), steps_(steps), dt_(dt) {}
  int windows() const { return steps_; }
  int first_block(int k) const { return k; }

  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    const T* next = q + kBlockSize;
    std::array<T, kStates> here, there;
    motion_(q, q + kStates, here.data());
    motion_(next, next + kStates, there.data());
    for (int i = 0; i < kStates; ++i) u[i] = next[i] - q[i] - 0.5 * dt_ * (here[i] + there[i]);
  }

  // By duals of one block each: the two do not meet in a product.
  void Jacobian(int /*k*/, const double* q, double /*h*/, double /*t*/, double* u, double* du,
                double* du_dh) const {
    using D = Dual<kBlockSize>;
    std::fill_n(du, kOutputs * 2 * kBlockSize, 0.0);
    std::fill_n(du_dh, kOutputs, 0.0);
    for (int i = 0; i < kStates; ++i) u[i] = q[kBlockSize + i] - q[i];
    for (const int first : {0, kBlockSize}) {
      std::array<D, kBlockSize> block;
      std::array<D, kStates> slope;
      for (int j = 0; j < kBlockSize; ++j) block[j] = D(q[first + j], j);
      motion_(block.data(), block.data() + kStates, slope.data());
      for (int i = 0; i < kStates; ++i) {
        double* row = du + i * 2 * kBlockSize + first;
        u[i] -= 0.5 * dt_ * slope[i].v;
        for (int j = 0; j < kBlockSize; ++j) row[j] = -0.5 * dt_ * slope[i].d[j];
        row[i] += first == 0 ? -1.0 : 1.0;
      }
    }
  }

  void Curvature(int /*k*/, const double* q, double /*h*/, double /*t*/, bool /*free_interval*/,
                 const double* m, double* d2) const {
    using D = SecondDual<kBlockSize>;
    constexpr int n = 2 * kBlockSize + 1;
    for (const int first : {0, kBlockSize}) {
      std::array<D, kBlockSize> block;
      std::array<D, kStates> slope;
      for (int j = 0; j < kBlockSize; ++j) block[j] = D(q[first + j], j);
      motion_(block.data(), block.data() + kStates, slope.data());
      for (int c = 0; c < kStates; ++c) {
        slope[c].ForEachCurvature([&](int i, int j, double curvature) {
          d2[(first + i) * n + first + j] -= 0.5 * dt_ * m[c] * curvature;
          if (i != j) d2[(first + j) * n + first + i] -= 0.5 * dt_ * m[c] * curvature;
        });
      }
    }
  }

 private:
  Motion motion_;
  int steps_;
  double dt_;
};

/// The inputs of every block, from what holds still.
template <class Motion>
class Effort {
 public:
  static constexpr int kBlockSize = Motion::kStates + Motion::kInputs;
  static constexpr int kWindow = 1, kOutputs = Motion::kInputs;
  static constexpr bool kUsesInterval = false, kLinearInBlocks = true;

  explicit Effort(int blocks) : blocks_(blocks) {}
  int windows() const { return blocks_; }
  int first_block(int k) const { return k; }

  template <class T>
  void operator()(int /*k*/, const T* q, const T& /*h*/, const T& /*t*/, T* u) const {
    for (int i = 0; i < kOutputs; ++i) u[i] = q[Motion::kStates + i] - Motion::kAtRest[i];
  }

 private:
  int blocks_;
};

/// States at a time, as a share of the duration; NaN where they are free.
struct Knot {
  double share;
  std::vector<double> states;
};

template <class Motion>
ReferenceProblem Shooting(std::string name, int steps, double duration,
                          const std::vector<Knot>& knots, const std::vector<double>& lower,
                          const std::vector<double>& upper) {
  constexpr int n = Motion::kStates, d = n + Motion::kInputs;
  const int blocks = steps + 1;
  const double dt = duration / steps;
  auto problem = std::make_shared<Problem>(ProblemShape{.blocks = blocks, .block_size = d});
  problem->AddTerm(
      std::make_shared<WindowTerm<Effort<Motion>, SquareLoss>>(
          TermInfo{.name = "effort"}, Effort<Motion>(blocks), SquareLoss(2.0 * dt), blocks),
      Role::kCost);
  problem->AddTerm(std::make_shared<WindowTerm<Trapezoid<Motion>, SquareLoss>>(
                       TermInfo{.name = "motion"}, Trapezoid<Motion>(Motion(), steps, dt),
                       SquareLoss(1.0), steps),
                   Role::kConstraint);
  std::vector<double> lo, hi, start;
  for (int k = 0; k < blocks; ++k) {
    lo.insert(lo.end(), lower.begin(), lower.end());
    hi.insert(hi.end(), upper.begin(), upper.end());
    for (int i = 0; i < d; ++i) start.push_back(i < n ? 0.0 : Motion::kAtRest[i - n]);
  }
  for (std::size_t m = 0; m < knots.size(); ++m) {
    const int at = static_cast<int>(std::lround(knots[m].share * steps));
    for (int i = 0; i < n; ++i) {
      const double value = knots[m].states[static_cast<std::size_t>(i)];
      if (std::isnan(value)) continue;
      lo[static_cast<std::size_t>(at * d + i)] = hi[static_cast<std::size_t>(at * d + i)] = value;
      // The first guess: straight from knot to knot.
      if (m == 0) continue;
      const int from = static_cast<int>(std::lround(knots[m - 1].share * steps));
      const double before = knots[m - 1].states[static_cast<std::size_t>(i)];
      for (int k = from; k <= at && !std::isnan(before); ++k) {
        start[static_cast<std::size_t>(k * d + i)] =
            before + (value - before) * (k - from) / (at - from);
      }
    }
  }
  problem->SetBounds(std::move(lo), std::move(hi));
  return {std::move(name),
          problem,
          Eigen::Map<const Eigen::VectorXd>(start.data(), static_cast<Eigen::Index>(start.size())),
          std::nan(""),
          {}};
}

/// Angle from hanging and rate; torque. Half a metre long, one kilogram.
struct Pendulum {
  static constexpr int kStates = 2, kInputs = 1;
  static constexpr double kAtRest[] = {0.0};
  template <class T>
  void operator()(const T* x, const T* u, T* dx) const {
    using std::sin;
    dx[0] = x[1];
    dx[1] = u[0] - 0.5 * kGravity * sin(x[0]);
  }
};

/// Position of the cart, angle of the pole from hanging, their rates; force. 1 kg, 0.3 kg at 0.5 m.
struct CartPole {
  static constexpr int kStates = 4, kInputs = 1;
  static constexpr double kAtRest[] = {0.0};
  template <class T>
  void operator()(const T* x, const T* u, T* dx) const {
    using std::cos, std::sin;
    constexpr double cart = 1.0, pole = 0.3, length = 0.5;
    const T s = sin(x[1]), c = cos(x[1]);
    const T swing = pole * length * x[3] * x[3] * s;
    const T mass = cart + pole * s * s;
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = (u[0] + swing + pole * kGravity * s * c) / mass;
    dx[3] = -(u[0] * c + swing * c + (cart + pole) * kGravity * s) / (length * mass);
  }
};

/// Six masses in a row between springs, each with its rate; forces at both ends.
struct MassChain {
  static constexpr int kMasses = 6, kStates = 2 * kMasses, kInputs = 2;
  static constexpr double kAtRest[] = {0.0, 0.0};
  template <class T>
  void operator()(const T* x, const T* u, T* dx) const {
    for (int i = 0; i < kMasses; ++i) {
      dx[i] = x[kMasses + i];
      const T left = i > 0 ? x[i - 1] : T(0.0), right = i < kMasses - 1 ? x[i + 1] : T(0.0);
      dx[kMasses + i] = left + right - 2.0 * x[i];
    }
    dx[kMasses] += u[0];
    dx[2 * kMasses - 1] += u[1];
  }
};

/// In a vertical plane: position, tilt, their rates; thrust and angular acceleration.
struct PlanarQuadrotor {
  static constexpr int kStates = 6, kInputs = 2;
  static constexpr double kAtRest[] = {kGravity, 0.0};
  template <class T>
  void operator()(const T* x, const T* u, T* dx) const {
    using std::cos, std::sin;
    for (int i = 0; i < 3; ++i) dx[i] = x[3 + i];
    dx[3] = u[0] * sin(x[2]);
    dx[4] = u[0] * cos(x[2]) - kGravity;
    dx[5] = u[1];
  }
};

/// Position, velocity, roll, pitch and yaw; thrust and body rates.
struct Quadrotor {
  static constexpr int kStates = 9, kInputs = 4;
  static constexpr double kAtRest[] = {kGravity, 0.0, 0.0, 0.0};
  template <class T>
  void operator()(const T* x, const T* u, T* dx) const {
    using std::cos, std::sin, std::tan;
    const T sr = sin(x[6]), cr = cos(x[6]), sp = sin(x[7]), cp = cos(x[7]), sy = sin(x[8]),
            cy = cos(x[8]);
    for (int i = 0; i < 3; ++i) dx[i] = x[3 + i];
    dx[3] = u[0] * (cr * sp * cy + sr * sy);
    dx[4] = u[0] * (cr * sp * sy - sr * cy);
    dx[5] = u[0] * cr * cp - kGravity;
    const T turn = sr * u[2] + cr * u[3];
    dx[6] = u[1] + turn * sp / cp;
    dx[7] = cr * u[2] - sr * u[3];
    dx[8] = turn / cp;
  }
};

/// The same with body rates as states; thrust and angular accelerations.
struct HeavyQuadrotor {
  static constexpr int kStates = 12, kInputs = 4;
  static constexpr double kAtRest[] = {kGravity, 0.0, 0.0, 0.0};
  template <class T>
  void operator()(const T* x, const T* u, T* dx) const {
    const std::array<T, 4> light = {u[0], x[9], x[10], x[11]};
    Quadrotor()(x, light.data(), dx);
    for (int i = 0; i < 3; ++i) dx[9 + i] = u[1 + i];
  }
};

constexpr double kFree = std::numeric_limits<double>::quiet_NaN();

/// States without bounds, then the inputs' own.
std::vector<double> Limits(int states, double sign, std::vector<double> inputs) {
  std::vector<double> all(static_cast<std::size_t>(states), sign * Problem::kInfinity);
  all.insert(all.end(), inputs.begin(), inputs.end());
  return all;
}

ReferenceProblem SwingUp(const std::string& name, int steps, double torque) {
  return Shooting<Pendulum>(name, steps, 5.0, {{0.0, {0.0, 0.0}}, {1.0, {kPi, 0.0}}},
                            Limits(2, -1.0, {-torque}), Limits(2, 1.0, {torque}));
}

ReferenceProblem CartPoleUp(int steps) {
  std::vector<double> lower = Limits(4, -1.0, {-20.0}), upper = Limits(4, 1.0, {20.0});
  lower[0] = -1.5;
  upper[0] = 1.5;
  return Shooting<CartPole>("cart_pole_" + std::to_string(steps), steps, 2.5,
                            {{0.0, {0.0, 0.0, 0.0, 0.0}}, {1.0, {1.0, kPi, 0.0, 0.0}}}, lower,
                            upper);
}

ReferenceProblem ThroughWaypoints(int steps) {
  std::vector<double> hover(9, 0.0), first(9, kFree), second(9, kFree), last(9, 0.0);
  first[0] = 2.0, first[1] = 1.5, first[2] = 1.0;
  second[0] = 4.0, second[1] = -1.0, second[2] = 0.5;
  last[0] = 6.0;
  return Shooting<Quadrotor>("quadrotor_" + std::to_string(steps), steps, 4.0,
                             {{0.0, hover}, {0.35, first}, {0.65, second}, {1.0, last}},
                             Limits(9, -1.0, {0.3 * kGravity, -6.0, -6.0, -2.0}),
                             Limits(9, 1.0, {1.8 * kGravity, 6.0, 6.0, 2.0}));
}

}  // namespace

std::vector<ReferenceProblem> ShootingProblems() {
  std::vector<ReferenceProblem> all;
  all.push_back(SwingUp("pendulum_20", 20, Problem::kInfinity));
  all.push_back(SwingUp("pendulum_200", 200, Problem::kInfinity));
  all.push_back(SwingUp("pendulum_weak_60", 60, 3.0));
  all.push_back(SwingUp("pendulum_weak_200", 200, 3.0));
  all.push_back(CartPoleUp(50));
  std::vector<double> apart = std::vector<double>(12, 0.0);
  for (std::size_t i = 0; i < 6; ++i) apart[i] = i % 2 == 0 ? 0.5 : -0.3;
  all.push_back(Shooting<MassChain>("mass_chain_100", 100, 10.0,
                                    {{0.0, apart}, {1.0, std::vector<double>(12, 0.0)}},
                                    Limits(12, -1.0, {-1.5, -1.5}), Limits(12, 1.0, {1.5, 1.5})));
  all.push_back(Shooting<PlanarQuadrotor>("planar_quadrotor_60", 60, 3.0,
                                          {{0.0, std::vector<double>(6, 0.0)},
                                           {0.5, {2.0, 1.0, kFree, kFree, kFree, kFree}},
                                           {1.0, {4.0, 0.0, 0.0, 0.0, 0.0, 0.0}}},
                                          Limits(6, -1.0, {0.2 * kGravity, -30.0}),
                                          Limits(6, 1.0, {2.0 * kGravity, 30.0})));
  all.push_back(ThroughWaypoints(40));
  all.push_back(ThroughWaypoints(200));
  std::vector<double> there = std::vector<double>(12, 0.0);
  there[0] = 3.0, there[1] = 1.0, there[2] = -1.0;
  all.push_back(Shooting<HeavyQuadrotor>("heavy_quadrotor_30", 30, 2.5,
                                         {{0.0, std::vector<double>(12, 0.0)}, {1.0, there}},
                                         Limits(12, -1.0, {0.2 * kGravity, -40.0, -40.0, -10.0}),
                                         Limits(12, 1.0, {2.0 * kGravity, 40.0, 40.0, 10.0})));
  return all;
}

}  // namespace touchdown::solvers
