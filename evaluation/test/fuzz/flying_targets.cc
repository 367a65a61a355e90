// SPDX-License-Identifier: BSD-3-Clause
// What would fly. `Onboard` gets measurements and times of Step that are late, doubled, disordered, not finite, or of
// another century. `Replanner` gets maps, states and pads. Whatever comes, nothing is committed without its certificate,
// and every number that goes out is finite.
#include <cmath>
#include <limits>
#include <optional>

#include "evaluation/test/fuzz/fuzz_target.h"
#include "touchdown/control/onboard/envelope.h"
#include "touchdown/control/onboard/onboard.h"
#include "touchdown/planning/replan/replanner.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::evaluation::fuzz {
namespace {

using Eigen::Vector3d;

void RequireProven(const planning::ReplanResult& result) {
  if (!result.committed) return;
  Require(result.certificate.stops_in_observed_space, "a pair is committed whose stop is not proven");
  Require(result.certificate.clear || result.certificate.escaping, "a blocked plan is committed");
  Require(result.certificate.limits_kept, "a plan beyond its limits is committed");
}

void RequireFinite(const planning::FlatState& state) {
  Require(state.p_WB.allFinite() && state.v_WB.allFinite() && state.a_WB.allFinite(),
          "a reference is not finite");
}

class Pad : public estimation::PadPrediction {
 public:
  explicit Pad(Choices* choices)
      : p_{choices->Wild(-8.0, 8.0), choices->Wild(-8.0, 8.0), choices->Wild(0.0, 3.0)},
        v_{choices->Wild(-3.0, 3.0), choices->Wild(-3.0, 3.0), 0.0},
        a_{choices->Below(4) == 0 ? choices->Wild(-1.0, 1.0) : 0.0, 0.0, 0.0},
        sigma_(choices->Wild(0.0, 0.5)) {}
  estimation::PadState At(double t) const noexcept override {
    estimation::PadState state;
    state.p_WP = p_ + t * v_ + 0.5 * t * t * a_;
    state.v_WP = v_ + t * a_;
    state.a_WP = a_;
    state.cov_p = sigma_ * sigma_ * Eigen::Matrix2d::Identity();
    return state;
  }

 private:
  Vector3d p_, v_, a_;
  double sigma_;
};

// A pillar, a box or a sheet of cells.
void AddObstacle(Choices* choices, planning::OccupancyMap* map) {
  const Vector3d low(choices->In(-6.0, 6.0), choices->In(-6.0, 6.0), choices->In(0.0, 3.0));
  const Vector3d size(choices->In(0.0, 2.0), choices->In(0.0, 2.0), choices->In(0.0, 3.0));
  const double step = map->resolution();
  for (double x = 0.0; x <= size.x(); x += step) {
    for (double y = 0.0; y <= size.y(); y += step) {
      for (double z = 0.0; z <= size.z(); z += step) map->SetOccupied(low + Vector3d(x, y, z));
    }
  }
}

void FuzzReplanner(std::string_view bytes) {
  Choices choices(bytes);
  planning::OccupancyMapOptions map_options;
  map_options.inflation_radius = choices.In(0.1, 0.6);
  planning::OccupancyMap map(map_options);
  planning::ReplannerOptions options;
  options.arrival = choices.Below(2) == 0 ? planning::ArrivalMode::kFixed : planning::ArrivalMode::kFree;
  options.warm_start = choices.Below(4) != 0;
  options.max_guides = 1 + choices.Below(3);
  options.max_work = 100 + choices.Below(10000);
  planning::Replanner replanner(options, solvers::StandardBackends());
  Vector3d p(choices.In(-5.0, 5.0), choices.In(-5.0, 5.0), choices.In(0.5, 4.0));
  for (int i = choices.Below(3); i >= 0; --i) {
    map.MarkFree(p + Vector3d(choices.In(-4.0, 4.0), choices.In(-4.0, 4.0), 0.0), choices.In(0.3, 4.0));
  }
  for (int i = choices.Below(8); i > 0; --i) AddObstacle(&choices, &map);
  double t = choices.In(0.0, 1e3);
  replanner.CommitHover(p, t);
  for (int step = 0; step < 24 && !choices.empty(); ++step) {
    t += choices.In(0.0, 0.3);
    const Pad pad(&choices);
    planning::ReplanInput input;
    input.t_now = choices.Below(16) == 0 ? choices.Wild(0.0, 1e3) : t;
    input.t_start = input.t_now + choices.Wild(0.0, 0.1);
    const planning::FlatState at = replanner.Reference(t);
    RequireFinite(at);
    input.vehicle.t = input.t_now;
    input.vehicle.p_WB = at.p_WB + Vector3d(choices.Wild(-0.2, 0.2), choices.In(-0.1, 0.1), choices.In(-0.1, 0.1));
    input.vehicle.v_WB = at.v_WB + Vector3d(choices.Wild(-0.5, 0.5), 0.0, choices.In(-0.2, 0.2));
    input.endpoint = {input.t_now, choices.Wild(0.1, 2.0), choices.Wild(0.0, 1.0), choices.Wild(0.0, 2.0)};
    input.pull_W = {choices.Wild(-1.0, 1.0), 0.0, choices.Wild(-1.0, 1.0)};
    input.margins.tracking = choices.Wild(0.0, 0.1);
    if (choices.Below(8) == 0) {
      input.look_from_W =
          at.p_WB + Vector3d(choices.Wild(-2.0, 2.0), choices.In(-2.0, 2.0), choices.In(-1.0, 1.0));
    }
    input.pad = &pad;
    const int kind = choices.Below(8);
    const planning::ReplanResult& result =
        kind == 0   ? replanner.Rest(input, 0.0, map)
        : kind == 1 ? replanner.Rest(input, choices.Wild(0.0, 2.0), map)
                    : replanner.Replan(input, map);
    RequireProven(result);
    if (choices.Below(8) == 0) AddObstacle(&choices, &map);
    if (choices.Below(4) == 0) map.MarkFree(at.p_WB, choices.In(0.3, 3.0));
    if (choices.Below(8) == 0) map.Recentre(at.p_WB);
    const double later = t + choices.Wild(0.0, 5.0);
    if (!std::isnan(later)) RequireFinite(replanner.Reference(later));
  }
}

// Times of this century and the last, and what is no time at all.
double WildTime(Choices* choices, double t) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  switch (choices->Below(10)) {
    case 0: return t + choices->In(-1.0, 1.0);
    case 1: return t + choices->In(-30.0, 30.0);
    case 2: return choices->In(0.0, 4.2e9);  // 1970 to 2100
    case 3: return -choices->In(0.0, 1e9);
    case 4: return std::numeric_limits<double>::quiet_NaN();
    case 5: return choices->Below(2) == 0 ? kInfinity : -kInfinity;
    case 6: return choices->Take<double>();
    default: return t;
  }
}

// A point mass that flies what it is told, over a pad that drives straight on; its clock may be off.
class OnboardFlight {
 public:
  explicit OnboardFlight(Choices* choices) : choices_(*choices) {
    vehicle_.p_WB = {0.0, 0.0, 2.0};
    for (int i = 0; i < 4; ++i) {
      const Vector3d hub(i == 0 || i == 3 ? 0.12 : -0.12, i < 2 ? 0.12 : -0.12, 0.04);
      model_.actuators.push_back(estimation::RotorAt(hub, i % 2 == 0 ? 0.016 : -0.016, 7.0));
    }
    control::OnboardOptions options = control::LandingOptions(model_, 0.5);
    options.estimate_disturbance = choices_.Below(2) == 0;
    onboard_.emplace(options, control::LandingParts(options));
    for (int i = choices_.Below(3); i > 0; --i) Disturb();
    onboard_->Take(vehicle_);
  }

  void Fly() {
    try {
      onboard_->Begin(vehicle_.t, Eigen::Vector4d::Constant(0.25 * model_.HoverThrust()));
    } catch (const std::invalid_argument&) {
      return;  // what was taken before is no hover
    }
    for (int step = 0; step < 600 && (step < 100 || !choices_.empty()); ++step) {
      if (choices_.Below(32) == 0) Disturb();
      Measure(step);
      const control::Setpoint& setpoint = onboard_->Step(Clock());
      Look(setpoint);
      Move(setpoint);
    }
    Recovers();
  }

 private:
  static constexpr double kStep = 0.004;  // [s]

  double Clock() const { return vehicle_.t + offset_; }
  Vector3d PadAt() const { return {3.0 + 0.4 * vehicle_.t, 0.5, 0.5}; }

  void Look(const control::Setpoint& setpoint) {
    Require(setpoint.thrusts.allFinite() && std::isfinite(setpoint.wrench.thrust) &&
                setpoint.R_WB.allFinite(),
            "a set-point is not finite");
    RequireFinite(setpoint.reference);
    if (onboard_->plan().answer != nullptr) RequireProven(*onboard_->plan().answer);
  }

  void Move(const control::Setpoint& setpoint) {
    vehicle_.q_WB = vehicle_.q_WB.slerp(kStep / 0.05, Eigen::Quaterniond(setpoint.R_WB)).normalized();
    const Vector3d force = vehicle_.q_WB * Vector3d(0.0, 0.0, setpoint.wrench.thrust);
    vehicle_.v_WB += kStep / model_.mass_kg * (force - Vector3d(0.0, 0.0, model_.HoverThrust()));
    vehicle_.p_WB += kStep * vehicle_.v_WB;
    vehicle_.t += kStep;
  }

  void Measure(int step) {
    estimation::VehicleState state = vehicle_;
    state.t = Clock();
    onboard_->Take(state);
    onboard_->Take(estimation::FootForce{Clock(), 0.0});
    if (step % 25 == 0) {
      onboard_->Take(estimation::PadGpsFix{Clock(), PadAt().head<2>(), 0.05});
      onboard_->Take(Depth(Clock()));
    }
    const Vector3d p_BP = vehicle_.q_WB.conjugate() * (PadAt() - vehicle_.p_WB);
    if (step % 12 == 0 && p_BP.z() < -0.15) {
      onboard_->Take(estimation::PadSighting{Clock(), p_BP, 0.0, Vector3d::Constant(0.005), 0.01, 5});
    }
  }

  // Open ground and nothing else.
  estimation::DepthImage Depth(double t) const {
    estimation::DepthImage image;
    image.t = t;
    image.p_BC = {0.1, 0.0, 0.0};
    image.R_BC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    image.depth.assign(80 * 60, std::numeric_limits<float>::infinity());
    return image;
  }

  // One call that is wrong: in its time, in its numbers, or both.
  void Disturb() {
    const double t = WildTime(&choices_, Clock());
    switch (choices_.Below(9)) {
      case 0: onboard_->Step(t); break;
      case 1: {
        estimation::VehicleState state = vehicle_;
        state.t = t;
        state.p_WB.x() += choices_.Wild(-1.0, 1.0);
        state.v_WB.y() += choices_.Wild(-1.0, 1.0);
        onboard_->Take(state);
        break;
      }
      case 2: onboard_->Take(estimation::FootForce{t, choices_.Wild(0.0, 30.0)}); break;
      case 3:
        onboard_->Take(estimation::PadGpsFix{t, {choices_.Wild(-9, 9), choices_.Wild(-9, 9)}, choices_.Wild(0, 1)});
        break;
      case 4:
        onboard_->Take(estimation::PadSighting{t, {choices_.Wild(-3, 3), choices_.Wild(-3, 3), choices_.Wild(-3, 0)},
                                               choices_.Wild(-4, 4), Vector3d::Constant(choices_.Wild(0, 0.1)), choices_.Wild(0, 0.1), choices_.Below(6)});
        break;
      case 5: {
        estimation::DepthImage image = Depth(t);
        image.depth.assign(static_cast<std::size_t>(choices_.Below(2) == 0 ? 4800 : choices_.Below(5000)),
                           static_cast<float>(choices_.Wild(0.0, 8.0)));
        image.max_range = choices_.Wild(1.0, 10.0);
        onboard_->Take(image);
        break;
      }
      case 6: vehicle_.t += choices_.In(0.0, 3.0); break;  // a stall: nothing is called meanwhile
      case 7: offset_ += choices_.In(0.0, 1.0) < 0.5 ? choices_.In(-10.0, 10.0) : choices_.In(0.0, 1.7e9); break;
      default: onboard_->Take(vehicle_);
    }
  }

  // After a second of right calls its time is that of the clock again.
  void Recovers() {
    for (int step = 0; step < 250; ++step) {
      Measure(step);
      const control::Setpoint& setpoint = onboard_->Step(Clock());
      Look(setpoint);
      Move(setpoint);
    }
    const double t = Clock();
    if (t < 0.0 || t > 1e10) return;
    const control::Setpoint& last = onboard_->Step(t);
    Require(last.t == t && last.CountsAt(t), "the set-point stays frozen");
  }

  Choices& choices_;
  estimation::VehicleModel model_;
  estimation::VehicleState vehicle_;
  std::optional<control::Onboard> onboard_;
  double offset_ = 0.0;
};

void FuzzOnboard(std::string_view bytes) {
  Choices choices(bytes);
  OnboardFlight(&choices).Fly();
}

}  // namespace

std::vector<Target> FlyingTargets() {
  return {{"onboard", FuzzOnboard}, {"replanner", FuzzReplanner}};
}

}  // namespace touchdown::evaluation::fuzz
