// SPDX-License-Identifier: BSD-3-Clause
// Assembles the landing problem from the terms of a registry. With the terms that are on by
// default, a fixed interval and fixed pairs it is convex: every backend must find the one optimum.

#include "touchdown/planning/problem/landing_problem.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "planning/problem/warm_start.h"

namespace touchdown::planning {

namespace {

void Require(bool ok, const char* name, double value, const char* range) {
  if (ok) return;
  throw std::invalid_argument(std::string("LandingProblem: ") + name + " is " +
                              std::to_string(value) + ", it must be " + range);
}

void RequireFinite(const char* name, const Eigen::Vector3d& numbers) {
  for (const double number : numbers) Require(std::isfinite(number), name, number, "finite");
}

solvers::ProblemShape Shape(int segments, const LandingProblemOptions& options) {
  Require(segments >= 6, "number of segments", segments, ">= 6");
  Require(options.limits.speed > 0.0, "limits.speed", options.limits.speed, "> 0 m/s");
  Require(options.limits.acceleration > 0.0, "limits.acceleration", options.limits.acceleration,
          "> 0 m/s^2");
  Require(options.max_pairs_per_point >= 0, "max_pairs_per_point", options.max_pairs_per_point,
          ">= 0");
  Require(options.max_obstacles >= 0, "max_obstacles", options.max_obstacles, ">= 0");
  solvers::ProblemShape shape;
  shape.blocks = segments + 3;
  shape.free_interval = options.arrival == ArrivalMode::kFree;
  shape.interval_min = options.min_duration / segments;
  shape.interval_max = options.max_duration / segments;
  return shape;
}

}  // namespace

LandingProblem::LandingProblem(int segments, const LandingProblemOptions& options)
    : segments_(segments),
      max_pairs_(options.max_pairs_per_point * (segments + 3)),
      max_obstacles_(options.max_obstacles),
      free_end_acceleration_(options.free_end_acceleration),
      lift_(std::make_shared<BoundaryLift>(segments, options.free_end_acceleration)),
      shifted_(3, segments + 3),
      between_(3, segments + 3),
      problem_(Shape(segments, options)) {
  context_.segments = segments;
  context_.limits = limits_ = options.limits;
  vehicle_ = options.vehicle;
  pairs_.reserve(static_cast<std::size_t>(max_pairs_));
  obstacles_.reserve(static_cast<std::size_t>(max_obstacles_));
  x_.reserve(static_cast<std::size_t>(3 * (segments_ + 3)));
  AddTerms(options);
  solvers::AffineLift structure = solvers::AffineLift::Identity(segments + 3);
  if (options.endpoint == EndpointMode::kEliminated) {
    structure = lift_->Structure();
    structure.offset = lift_;
  }
  view_ = std::make_unique<solvers::View>(problem_, std::move(structure));
}

void LandingProblem::AddTerms(const LandingProblemOptions& options) {
  RequireDistinct(options.terms);
  for (const TermSettings& settings : options.settings) FindTerm(options.terms, settings.name);
  for (const TermEntry& entry : options.terms) AddTerm(entry, options);
}

void LandingProblem::AddTerm(const TermEntry& entry, const LandingProblemOptions& options) {
  TermSetup setup = DefaultSetup(entry, segments_ + 3);
  setup.weight = entry.default_weight;
  setup.free_end_acceleration = options.free_end_acceleration;
  setup.limits = options.limits;
  setup.vehicle = options.vehicle;
  setup.max_pairs = max_pairs_;
  setup.max_obstacles = options.max_obstacles;
  const bool explicit_end = options.endpoint == EndpointMode::kExplicit;
  if (entry.use == TermUse::kFreeArrival && options.arrival != ArrivalMode::kFree) return;
  if (entry.use == TermUse::kExplicitEndpoint && !explicit_end) return;
  setup.hard = entry.use == TermUse::kExplicitEndpoint ||
               (entry.is_limit && options.limits_mode == LimitsMode::kHard);
  bool asked_for = setup.weight > 0.0;
  for (const TermSettings& settings : options.settings) {
    if (settings.name != entry.info.name) continue;
    ApplySettings(entry, settings, &setup);
    asked_for = setup.weight > 0.0 || settings.hard.value_or(false);
  }
  if (!asked_for) return;
  if (entry.use == TermUse::kMovingObstacles && options.max_obstacles == 0) {
    throw std::invalid_argument("LandingProblem: term " + entry.info.name +
                                " is asked for, and max_obstacles is 0: there is no room for any");
  }
  // A row's weight counts in the whitening's metric alone, which must not lose it.
  if (setup.hard && !(setup.weight > 0.0)) setup.weight = 1.0;
  if (entry.zones) {
    for (const TermZone& zone : entry.zones(setup)) zones_.push_back({entry.info.name, zone});
  }
  const std::shared_ptr<solvers::Term> term = entry.make(setup);
  problem_.AddTerm(term, setup.hard ? solvers::Role::kConstraint : solvers::Role::kCost);
  auto* const user = dynamic_cast<ContextUser*>(term.get());
  if (user == nullptr) return;
  context_users_.push_back(user);
  if (entry.is_clearance) clearances_.push_back(user);
  if (entry.is_limit && !setup.hard) soft_limits_.push_back(user);
}

void LandingProblem::Update() {
  if (!has_boundary_) return;
  for (ContextUser* user : context_users_) user->Update(context_);
}

void LandingProblem::SetBoundary(const SplineState& start, double t0,
                                 const estimation::PadPrediction& pad, const EndpointTarget& target,
                                 const Eigen::Vector3d& pull_W) {
  Require(std::isfinite(t0), "time of the start", t0, "finite");
  Require(std::isfinite(target.height), "height of the end", target.height, "finite");
  RequireFinite("position of the start", start.p);
  RequireFinite("velocity of the start", start.v);
  RequireFinite("acceleration of the start", start.a);
  RequireFinite("pull", pull_W);
  has_boundary_ = true;
  context_.limits = LimitsUnder(limits_, vehicle_, pull_W);
  context_.pull_W = pull_W;
  context_.start = start;
  context_.t0 = t0;
  context_.pad = &pad;
  context_.target = target;
  problem_.set_t0(t0);
  lift_->Set(start, t0, pad, target);
  Update();
}

void LandingProblem::RequireBoundary(const char* call) const {
  if (has_boundary_) return;
  throw std::invalid_argument(std::string("LandingProblem: ") + call +
                              " before SetBoundary: there is no start and no end");
}

void LandingProblem::SetDuration(double T) {
  Require(T > 0.0 && std::isfinite(T), "duration", T, "> 0 s and finite");
  context_.interval = T / segments_;
  problem_.set_interval(context_.interval);
  Update();
}

void LandingProblem::SetPairs(std::span<const ObstaclePair> pairs) {
  if (pairs.size() > static_cast<std::size_t>(max_pairs_)) {
    throw std::invalid_argument("LandingProblem: " + std::to_string(pairs.size()) +
                                " pairs, there is room for " + std::to_string(max_pairs_));
  }
  for (const ObstaclePair& pair : pairs) {
    Require(pair.control_point >= 0 && pair.control_point < segments_ + 3,
            "control point of a pair", pair.control_point, "one of the spline's");
  }
  pairs_.assign(pairs.begin(), pairs.end());
  context_.pairs = pairs_;
  Update();
}

void LandingProblem::SetPairWeightScale(double scale) {
  for (ContextUser* term : clearances_) term->ScaleWeight(scale);
}

void LandingProblem::SetLimitWeightScale(double scale) {
  for (ContextUser* term : soft_limits_) term->ScaleWeight(scale);
}

void LandingProblem::SetObstacles(std::span<const MovingObstacle> obstacles) {
  if (obstacles.size() > static_cast<std::size_t>(max_obstacles_)) {
    throw std::invalid_argument("LandingProblem: " + std::to_string(obstacles.size()) +
                                " moving obstacles, there is room for " +
                                std::to_string(max_obstacles_));
  }
  obstacles_.assign(obstacles.begin(), obstacles.end());
  context_.obstacles = obstacles_;
  Update();
}

void LandingProblem::SetPrevious(const UniformBspline* previous) {
  context_.previous = previous;
  Update();
}

BoundaryFacts LandingProblem::boundary_facts() const {
  RequireBoundary("boundary_facts()");
  const double h = context_.interval;
  BoundaryFacts facts;
  facts.start_speed = context_.start.v.norm();
  facts.start_acceleration = context_.start.a.norm();
  facts.first_hull_speed = (context_.start.v + 0.5 * h * context_.start.a).norm();
  facts.end_speed = context_.End(h).state.v.norm();
  facts.recovering = std::max(facts.start_speed, facts.first_hull_speed) > context_.limits.speed ||
                     facts.start_acceleration > context_.limits.acceleration;
  facts.end_too_fast = facts.end_speed > kFastestEndShare * context_.limits.speed;
  return facts;
}

Eigen::VectorXd LandingProblem::Guess() const {
  Eigen::VectorXd y;
  Guess(&y);
  return y;
}

void LandingProblem::Guess(Eigen::VectorXd* y) const {
  RequireBoundary("Guess()");
  y->setZero(view_->num_variables());
  if (!view_->lift().offset) lift_->At(context_.interval, y->data(), nullptr, nullptr);
  if (view_->free_interval()) (*y)[y->size() - 1] = context_.interval;
}

// The difference of the previous curve from the quintic between its own ends. The view's lift adds
// the quintic between the new ends.
void LandingProblem::WarmGuess(const UniformBspline& previous, Eigen::VectorXd* y) {
  Guess(y);
  const solvers::AffineLift& lift = view_->lift();
  if (!lift.offset) return;
  const double h = context_.interval;
  const int n = segments_ + 3;
  ShiftedControlPoints(previous, context_.t0, segments_ * h, shifted_);
  const auto at_knot = [&](int k) -> SplineState {
    const auto q0 = shifted_.col(k), q1 = shifted_.col(k + 1), q2 = shifted_.col(k + 2);
    return {(q0 + 4.0 * q1 + q2) / 6.0, (q2 - q0) / (2.0 * h), (q0 - 2.0 * q1 + q2) / (h * h)};
  };
  SplineState end = at_knot(segments_);
  if (free_end_acceleration_) end.a.setZero();  // its block holds all of it
  HermiteControlPoints(at_knot(0), end, segments_ * h, between_);
  for (int i = 0; i < n; ++i) {
    if (lift.block[i] < 0 || lift.coefficient[i] != 1.0) continue;
    y->segment<3>(3 * lift.block[i]) = shifted_.col(i) - between_.col(i);
  }
}

UniformBspline LandingProblem::Curve(const Eigen::VectorXd& y) const {
  RequireBoundary("Curve()");
  std::vector<double> x;
  double h = 0.0;
  view_->Lift(y.data(), &x, &h);
  return UniformBspline(Eigen::Map<const ControlPoints>(x.data(), 3, segments_ + 3), h,
                        context_.t0);
}

void LandingProblem::Curve(const Eigen::VectorXd& y, UniformBspline* curve) {
  RequireBoundary("Curve()");
  double h = 0.0;
  view_->Lift(y.data(), &x_, &h);
  curve->Assign(Eigen::Map<const ControlPoints>(x_.data(), 3, segments_ + 3), h, context_.t0);
}

}  // namespace touchdown::planning
