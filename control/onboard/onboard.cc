// SPDX-License-Identifier: BSD-3-Clause
// Senses turn measurements into estimates, and the pilot decides by them: mission, plan, control, each at its rate.
#include "touchdown/control/onboard/onboard.h"

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "control/onboard/flight_clock.h"
#include "control/onboard/pilot.h"
#include "control/onboard/senses.h"
#include "estimation/base/argument_check.h"
#include "estimation/base/sample_clock.h"
#include "touchdown/solvers/backend/thread_clock.h"

namespace touchdown::control {
namespace {

using solvers::AddThreadCpu;

// So many steps without a time, and a set-point has been flown for as long as it counts, at 500 Hz.
constexpr int kMostRefused = 50;

const OnboardParts& Whole(const OnboardParts& parts) {
  if (!parts.planner) throw std::invalid_argument("OnboardParts::planner is missing");
  if (!parts.controller) throw std::invalid_argument("OnboardParts::controller is missing");
  if (!parts.predictor) throw std::invalid_argument("OnboardParts::predictor is missing");
  return parts;
}

}  // namespace

std::string_view ToString(Taken taken) {
  switch (taken) {
    case Taken::kUsed:
      return "used";
    case Taken::kWaiting:
      return "waiting";
    case Taken::kGated:
      return "gated";
    case Taken::kEmpty:
      return "empty";
    case Taken::kIgnored:
      return "ignored";
    case Taken::kDoubled:
      return "doubled";
    case Taken::kTooOld:
      return "too_old";
    case Taken::kInvalid:
      return "invalid";
    case Taken::kUnasked:
      return "unasked";
  }
  return "invalid";
}

struct Onboard::Parts {
  Parts(OnboardOptions given, OnboardParts made)
      : options(std::move(given)),
        parts(std::move(made)),
        senses(options, std::move(parts.memory)),
        mission_clock(options.mission_rate),
        replan_clock(options.replan_rate),
        close_clock(options.close_rate) {}

  double FootForceAt(double t) const { return std::abs(t - force_t) <= kCounts ? foot_force : 0.0; }

  void Mission(double t) {
    pilot->StepMission(senses.own(), senses.pad(), senses.DepthAge(t), FootForceAt(t),
                       1.0 / options.mission_rate);
  }

  void Plan(double t) {
    if (awaits_own) return;
    const bool usual = replan_clock.Due(t), close = close_clock.Due(t);
    if (!(pilot->plans_often() ? close : usual)) return;
    if (keep_before) plan.before = pilot->replanner_state();
    AddThreadCpu(&times.planning, [&] {
      plan.answer = pilot->Replan(senses.own().now(), senses.pad(), senses.cameras(), senses.map());
    });
    plan.idle = pilot->idle();
    if (plan.answer != nullptr) plan.asked = &pilot->last_replan();
  }

  Taken TakeForce(const estimation::FootForce& force) {
    if (!senses.own().known()) return Taken::kUnasked;
    if (senses.IsAhead(force.t) || !std::isfinite(force.force)) return Taken::kInvalid;
    if (force.t == force_t) return Taken::kDoubled;
    if (force.t < force_t) return Taken::kTooOld;
    force_t = force.t;
    foot_force = force.force;
    return Taken::kUsed;
  }

  /// A new time is known, or none.
  void Judge(double t) {
    status.time = clock.Step(t);
    ++steps[static_cast<std::size_t>(status.time)];
    status.mission_step = false;
    plan.asked = nullptr;
    plan.answer = nullptr;
    plan.idle = false;
    refused = IsFlown(status.time) ? 0 : refused + 1;
    senses.Doubt(refused > 0 && status.time != StepTime::kStands);
    if (refused == kMostRefused) Command(pilot->Hold(senses.own().now().t));
    if (status.time != StepTime::kResumed) return;
    senses.Forget();
    awaits_own = true;
  }

  /// After a stall or another clock. An estimated state may jump before it is usable again.
  void Resume(double t) {
    if (!awaits_own) return;
    awaits_own = !IsUsable(senses.own().Status(t));
    const bool leapt = status.time == StepTime::kResumed;
    pilot->Resume(senses.own().now(), (leapt ? setpoint.reference : pilot->Reference(t)).a_WB);
  }

  /// From the caller's time t on [s].
  void StampSetpoint(double t) {
    setpoint.t = t;
    setpoint.valid_until = t + kCounts;
  }

  void Command(const PilotCommand& command) {
    setpoint.armed = pilot->mission().motors_armed;
    setpoint.level = command.level;
    setpoint.thrusts = command.mix.thrusts;
    setpoint.saturated = command.mix.saturated;
    setpoint.wrench = command.law.wrench;
    setpoint.R_WB = command.law.R_WB_desired;
    setpoint.reference = command.reference;
  }

  void Report(double t) {
    status.mission = pilot->mission();
    status.own = senses.own().Status(t);
    status.foot_force = FootForceAt(t);
    status.pad_known = options.to_goal || senses.pad().initialized();
    status.pad_sure = options.to_goal || senses.pad().Converged(t);
    status.plan_valid = pilot->plan_valid(t);
    status.no_way = pilot->no_way();
    status.look = pilot->look_words();
  }

  OnboardOptions options;
  OnboardParts parts;
  Senses senses;
  std::optional<Pilot> pilot;  ///< since Begin
  estimation::SampleClock mission_clock, replan_clock, close_clock;
  double foot_force = 0.0;  ///< [N]
  double force_t = -std::numeric_limits<double>::infinity();
  FlightClock clock;
  int refused = 0;          ///< steps in a row
  bool awaits_own = false;  ///< a usable state, since it resumed: before it no plan begins
  bool keep_before = false;
  Setpoint setpoint;
  OnboardStatus status;
  OnboardPlan plan;
  OnboardTimes times;
  std::array<int, kTakenKinds> taken{};
  std::array<int, kStepTimes> steps{};
};

Onboard::Onboard(OnboardOptions options, OnboardParts parts) {
  Validate(options);
  Whole(parts);
  it_ = std::make_unique<Parts>(std::move(options), std::move(parts));
  it_->setpoint.armed = false;
  it_->setpoint.thrusts.setZero(static_cast<Eigen::Index>(it_->options.model.actuators.size()));
}

Onboard::~Onboard() = default;
Onboard::Onboard(Onboard&&) noexcept = default;
Onboard& Onboard::operator=(Onboard&&) noexcept = default;

Taken Onboard::Counted(Taken taken) {
  ++it_->taken[static_cast<std::size_t>(taken)];
  return taken;
}

template <typename Measurement>
Measurement Onboard::InFlight(Measurement measured) const {
  measured.t = FlightTime(measured.t);
  return measured;
}

Taken Onboard::Take(const estimation::VehicleState& s) {
  return Counted(it_->senses.TakeOwn(InFlight(s)));
}
Taken Onboard::Take(const estimation::ImuSample& s) {
  return Counted(it_->senses.TakeOwn(InFlight(s)));
}
Taken Onboard::Take(const estimation::OwnPositionFix& s) {
  return Counted(it_->senses.TakeOwn(InFlight(s)));
}
Taken Onboard::Take(const estimation::OwnVelocityFix& s) {
  return Counted(it_->senses.TakeOwn(InFlight(s)));
}
Taken Onboard::Take(const estimation::HeightSample& s) {
  return Counted(it_->senses.TakeOwn(InFlight(s)));
}
Taken Onboard::Take(const estimation::HeadingSample& s) {
  return Counted(it_->senses.TakeOwn(InFlight(s)));
}
Taken Onboard::Take(const estimation::PadGpsFix& s) {
  return Counted(it_->senses.Take(InFlight(s)));
}
Taken Onboard::Take(const estimation::PadSighting& s) {
  return Counted(it_->senses.Take(InFlight(s)));
}
Taken Onboard::Take(const estimation::PadImage& s) {
  return Counted(it_->senses.Take(s, FlightTime(s.t)));
}
Taken Onboard::Take(const estimation::DepthImage& s) {
  return Counted(it_->senses.Take(s, FlightTime(s.t)));
}
Taken Onboard::Take(const estimation::FootForce& s) { return Counted(it_->TakeForce(InFlight(s))); }

const std::array<int, kTakenKinds>& Onboard::taken() const { return it_->taken; }
const std::array<int, kStepTimes>& Onboard::steps() const { return it_->steps; }
double Onboard::FlightTime(double t) const { return it_->clock.At(t); }

void Onboard::Begin(double t, const estimation::Commands& thrusts) {
  if (it_->pilot) throw std::invalid_argument("Onboard::Begin: the flight has begun");
  estimation::CheckWithin("Onboard::Begin: t [s]", t, 0.0, kLatestTime);
  const estimation::VehicleModel& model = it_->options.model;
  const auto count = static_cast<Eigen::Index>(model.actuators.size());
  if (thrusts.size() != count) {
    estimation::ThrowOutOfRange("Onboard::Begin: number of thrusts",
                                static_cast<double>(thrusts.size()), std::to_string(count));
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const estimation::Actuator& actuator = model.actuators[static_cast<std::size_t>(i)];
    estimation::CheckWithin("Onboard::Begin: one of the thrusts [N]", thrusts[i], actuator.min,
                            actuator.max);
  }
  it_->senses.Advance(t);
  const estimation::OwnStatus status = it_->senses.own().Status(t);
  if (!KnowsAttitude(status)) {
    throw std::invalid_argument("Onboard::Begin: the own state at t [s] is " +
                                std::string(estimation::ToString(status)) +
                                "; allowed: good, outage, uncertain");
  }
  const Eigen::Vector3d& place = it_->senses.own().now().p_WB;
  if (!(place.cwiseAbs().maxCoeff() < planning::kFarthestPlace)) {
    estimation::ThrowOutOfRange("Onboard::Begin: a coordinate of the own state [m]",
                                place.cwiseAbs().maxCoeff(),
                                "below a million: subtract an origin near the flight from all "
                                "positions");
  }
  const double height = place.z();
  if (!(height < it_->options.envelope.ceiling)) {
    estimation::ThrowOutOfRange("Onboard::Begin: the height of the own state [m]", height,
                                "below the envelope's ceiling");
  }
  it_->senses.Begin();
  it_->pilot.emplace(it_->options, it_->parts, it_->senses.own().now(), thrusts, it_->senses.map());
  it_->clock.Begin(t);
  it_->Command(it_->pilot->Level(t));
  it_->setpoint.thrusts = thrusts;
  it_->StampSetpoint(t);
}

const Setpoint& Onboard::Step(double callers_t) {
  if (!it_->pilot) return it_->setpoint;
  it_->Judge(callers_t);
  if (!IsFlown(it_->status.time)) return it_->setpoint;
  const double t = it_->clock.At(callers_t);
  it_->senses.Advance(t);
  it_->Resume(t);
  AddThreadCpu(&it_->times.control, [&] {
    it_->status.mission_step = it_->mission_clock.Due(t);
    if (it_->status.mission_step) it_->Mission(t);
  });
  it_->Plan(t);
  AddThreadCpu(&it_->times.control, [&] { it_->Command(it_->pilot->Control(it_->senses.own())); });
  it_->StampSetpoint(callers_t);
  it_->Report(t);
  return it_->setpoint;
}

const OnboardStatus& Onboard::status() const { return it_->status; }
const OnboardPlan& Onboard::plan() const { return it_->plan; }
const OnboardTimes& Onboard::times() const { return it_->times; }

planning::FlatState Onboard::Reference(double t) const {
  return it_->pilot ? it_->pilot->Reference(FlightTime(t)) : planning::FlatState{};
}
Disturbance Onboard::disturbance() const {
  return it_->pilot ? it_->pilot->disturbance() : Disturbance{};
}

const estimation::VehicleState& Onboard::own() const { return it_->senses.own().now(); }
estimation::VehicleState Onboard::OwnAt(double t) const {
  return it_->senses.own().At(FlightTime(t));
}
bool Onboard::own_estimated() const { return it_->senses.own().estimated(); }
const estimation::PadFilter& Onboard::pad() const { return it_->senses.pad(); }
const planning::OccupancyMap& Onboard::map() const { return it_->senses.map(); }
const OnboardOptions& Onboard::options() const { return it_->options; }

void Onboard::KeepBefore(bool keep) { it_->keep_before = keep; }
void Onboard::LogPadTo(std::vector<estimation::PadArrival>* log) { it_->senses.LogPadTo(log); }
planning::OccupancyMap* Onboard::mutable_map() { return it_->senses.mutable_map(); }
planning::PersistentMap Onboard::TakeMemory() { return it_->senses.TakeMemory(); }

}  // namespace touchdown::control
