// SPDX-License-Identifier: BSD-3-Clause
// The on-board loop around the libraries. The state machine says what to do. The replanner finds a way there from the
// committed trajectory. The heading follows the way ahead, so that the depth camera sees where the vehicle is going. The
// tracking law turns the reference into rotor thrusts.
#include "control/onboard/pilot.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "control/tracking/lean.h"
#include "control/tracking/tracking_law.h"
#include "control/tracking/vehicle_frequencies.h"
#include "estimation/base/degrees.h"
#include "touchdown/planning/replan/replanner.h"
#include "touchdown/planning/replan/stage_timer.h"

namespace touchdown::control {
namespace {

constexpr double kLookAhead = 0.8;     // the heading is where the vehicle will be then [s]
constexpr double kLookDistance = 0.3;  // nearer than this the way ahead says nothing [m]
constexpr double kTurnsToLook =
    2.0;  // before a place to look from; farther off it sees the way there [m]
constexpr double kInSight =
    15.0 * estimation::kRadPerDeg;        // what is to be seen is no farther off the heading
constexpr double kNearest = 0.1;          // of what is to be seen, from the vehicle's axis [m]
constexpr double kAlignTolerance = 0.35;  // heading counts as aligned within this [rad]
constexpr double kContactShare = 0.2;     // of the weight, on the feet: enough to be a contact
constexpr double kLeaning = 0.1;          // of steady force over weight: a foot goes ahead
constexpr double kTurnTime = 2.0;         // ... so long before a planned contact [s]
constexpr double kHeadingSlack = 5.0 * estimation::kRadPerDeg;  // beside half a foot's sector
constexpr double kUpright = 0.07;   // ... until it is less than that
constexpr double kFlareMargin = 5.0 * estimation::kRadPerDeg;
constexpr double kBlownOff = 0.15;        // of the reference [m]: far below the 0.5 m that lose it
constexpr double kFlareBegins = 0.2;      // from there on the position loop is softened ...
constexpr double kFlareSoftness = 0.8;    // ... to so many times its frequency at contact_height
constexpr double kTouchForce = 0.2;       // on the feet: something holds them [N]
constexpr double kLevelTimeInPull = 0.2;  // more level time in wind [s per m/s^2 of its force]
constexpr double kSofterInPull = 0.05;    // contact in wind: 0.2 m/s from 7 m/s on [m/s per m/s^2]
constexpr double kGustHorizon = 0.5;      // the force's change is extrapolated so far [s]
constexpr double kMeasuredMargin = 1.2;   // a measured latency is flown with this factor
constexpr double kAttitudeLag = 0.1;      // of the vehicle behind its plans [s]
constexpr double kTurning = 0.8;  // and then it takes so long to turn away from the deck [s]

std::optional<estimation::PadKnowledge> KnowledgeOf(const OnboardOptions& options,
                                                    const estimation::PadFilter& filter) {
  if (options.to_goal) return estimation::PadKnowledge();  // a goal needs none
  if (!filter.initialized()) return std::nullopt;
  return estimation::PadKnowledge{filter.belief(), filter.options().pad_height,
                                  filter.options().noise};
}

}  // namespace

planning::EndpointTarget ContactTarget(const estimation::VehicleModel& model, double touchdown_rate,
                                       double level_time) {
  planning::EndpointTarget target;
  target.height = target.height_floor = model.foot_depth + touchdown_rate * level_time;
  target.arrival_sink = touchdown_rate;
  return target;
}

Pilot::Pilot(const OnboardOptions& options, const OnboardParts& parts,
             const estimation::VehicleState& start, const estimation::Commands& start_thrusts,
             const planning::OccupancyMap& map)
    : options_(options), parts_(parts), model_(options.model), mixer_(options.model) {
  parameters_.foothold = 0.5 * options.deck_size - model_.foot_radius;
  // The pad off by three standard deviations, and feet led to its middle are still on the deck.
  parameters_.bridge_sigma = parameters_.foothold / 3.0;
  // What TiltMost leaves towards a foot, which the heading turns there.
  const double lean = FeetFirstTilt(model_) - kFlareMargin;
  if (lean > 0.0) parameters_.lean_max = lean;
  parameters_.gate_sigma = std::min(parameters_.gate_sigma, parameters_.bridge_sigma);
  // A light vehicle never presses as hard as the default asks.
  parameters_.contact_force =
      std::min(parameters_.contact_force, kContactShare * model_.HoverThrust());
  parameters_.corridor_radius = options.corridor_radius;
  parameters_.contact_distance = options.deck_size * std::sqrt(0.5) + model_.foot_radius;
  // A plan that turns away from the deck is made at the next step and flown a latency later. Then
  // the attitude has to follow.
  const double latency = options.latency.measured ? options.latency.longest : Latency();
  parameters_.turn_time = 1.0 / options.replan_rate + latency + kAttitudeLag;
  parameters_.climb_time = 1.0 / options.close_rate + latency + kAttitudeLag;
  parameters_.decide_time = std::max(parameters_.decide_time, parameters_.turn_time + kTurning);
  if (parts.law_compensates) {
    lead_.emplace(model_).Hover(start_thrusts);
    if (options.estimate_disturbance) {
      observer_.emplace(model_, ObserverFor(model_)).Hover(start, start_thrusts);
    }
  }
  parts_.planner->Prepare(map);
  if (parts_.scout) parts_.scout->Prepare(map);
  parts_.planner->CommitHover(start.p_WB, start.t);
  yaw_.yaw = estimation::Yaw(start.q_WB);
  yaw_t_ = start.t;
  heading_ = heading_ahead_ = yaw_.yaw;
}

void Pilot::StepMission(const OwnState& own, const estimation::PadFilter& filter, double depth_age,
                        double foot_force, double dt) {
  const estimation::VehicleState& vehicle = own.now();
  const double t = vehicle.t;
  own_position_sigma_ = own.PositionSigma();
  own_attitude_sigma_ = own.AttitudeSigma();
  if (meets_vehicle_at_ && t >= *meets_vehicle_at_) {  // a plan from the vehicle has taken over
    recent_error_ = {};
    meets_vehicle_at_.reset();
  }
  const planning::FlatState reference = parts_.planner->Reference(t);
  recent_error_.Note(t, (reference.p_WB - vehicle.p_WB).norm());
  MissionInputs inputs;
  inputs.t = t;
  inputs.pad_available = KnowsTarget(filter);
  inputs.pad_converged = IsSureOfTarget(filter, t);
  if (inputs.pad_available) {
    const estimation::PadState pad = TargetAt(filter, t);
    inputs.horizontal_distance = (vehicle.p_WB - pad.p_WP).head<2>().norm();
    inputs.height = vehicle.p_WB.z() - model_.foot_depth - pad.p_WP.z();
    inputs.foot_drop = FootDrop(model_, vehicle.q_WB);
    inputs.horizontal_speed = (vehicle.v_WB - pad.v_WP).head<2>().norm();
    inputs.sink_rate = pad.v_WP.z() - vehicle.v_WB.z();
    // A vehicle that sinks follows its reference until a climb begins.
    if (inputs.sink_rate > 0.0) {
      inputs.sink_rate = std::max(inputs.sink_rate, pad.v_WP.z() - reference.v_WB.z());
    }
  }
  foot_height_ = inputs.height;
  inputs.tag_age = to_goal() ? 0.0 : filter.TagAge(t);
  inputs.pad_sigma = to_goal() ? 0.0 : filter.PositionSigma(t);
  inputs.looks = looks_from_.has_value();
  inputs.descent = options_.descent;
  inputs.arrival_in = plan_end_t_ + level_time_ - t;
  inputs.lean = LeanAtContact(inputs.arrival_in);
  const double contact_in = ContactIn(mission_state_, inputs, parameters_);
  if (std::isfinite(contact_in)) inputs.contact_sigma = filter.PositionSigma(t + contact_in);
  const estimation::OwnStatus status = own.Status(t);
  inputs.own_fresh = status == estimation::OwnStatus::kGood;
  inputs.own_usable = IsUsable(status);
  own_usable_ = inputs.own_usable;
  inputs.depth_age = depth_age;
  sees_ = depth_age <= parameters_.depth_timeout;
  inputs.foot_force = foot_force_ = foot_force;
  inputs.has_plan = has_plan_;
  inputs.at_goal = at_goal_;
  inputs.rests = rests_;
  inputs.lands = lands_;
  // Between replans the last one counts: no plan has failed since it succeeded.
  if (requested_t_ && !last_planned_) {
    inputs.plan_failed_for =
        t - (planned_t_ ? std::max(*planned_t_, *requested_t_) : *requested_t_);
  }
  heading_ahead_ = HeadingAhead(vehicle, filter);
  const double heading = DesiredHeading();
  inputs.yaw_aligned = YawAligned(yaw_.yaw, heading, kAlignTolerance);

  const MissionStep step = Step(mission_state_, inputs, parameters_);
  mission_state_ = step.state;
  mission_ = step.outputs;
  if (mission_.plan_requested && !requested_t_) requested_t_ = t;
  if (!mission_.plan_requested) requested_t_.reset();
  const bool landing = Landing();
  at_deck_ = inputs.pad_available && !to_goal() &&
             std::abs(foot_height_) <= parameters_.contact_height &&
             inputs.horizontal_distance <= parameters_.contact_distance;
  const double off = (reference.p_WB - vehicle.p_WB).head<2>().norm();
  blown_off_ = at_deck_ && !landing && (blown_off_ || off > kBlownOff);
  settling_.Note(t, at_deck_ && foot_force > kTouchForce, landing);

  yaw_ = StepYaw(yaw_, heading, dt);
  yaw_t_ = t + dt;
}

void Pilot::Resume(const estimation::VehicleState& vehicle, const Eigen::Vector3d& a_WB) {
  planning::FlatState from;
  from.p_WB = vehicle.p_WB;
  from.v_WB = vehicle.v_WB;
  from.a_WB = a_WB;
  parts_.planner->CommitStop(from, vehicle.t);
  way_ = nullptr;
  lands_ = false;
  plan_end_t_ = std::numeric_limits<double>::infinity();
}

const planning::ReplanResult* Pilot::Replan(const estimation::VehicleState& vehicle,
                                            const estimation::PadFilter& filter,
                                            const std::vector<planning::LookCamera>& cameras,
                                            const planning::OccupancyMap& map) {
  idle_ = false;
  if (mission_.mode == MissionMode::kHovering || !mission_.motors_armed) {
    has_plan_ = false;
    return nullptr;
  }
  if (vehicle.t < busy_until_) return nullptr;
  replan_.latency_s = Latency();
  planning::ReplanInput& input = replan_.request.input;
  input.t_now = vehicle.t;
  input.t_start = vehicle.t + replan_.latency_s;
  input.vehicle = vehicle;
  double gust = 0.0;
  if (observer_) {
    input.pull_W = observer_->steady_force_W() / model_.mass_kg;
    gust = observer_->gust_force() / model_.mass_kg;
  }
  input.margins =
      planning::MarginsOf(own_position_sigma_, own_attitude_sigma_, recent_error_.value(), gust);
  if (!arriving()) {
    touchdown_rate_ = TouchdownRate(input.pull_W);
    level_time_ = LevelTime(input.pull_W);
  }
  input.endpoint = Endpoint(vehicle.t);

  const bool wants_plan = WantsPlan(filter, vehicle.t);
  // No plan is missing while none is tried: a climb must not end as a failure to plan.
  if (!wants_plan && requested_t_) requested_t_ = vehicle.t;
  const auto begin = std::chrono::steady_clock::now();
  const planning::ReplanResult& result = Ask(wants_plan, filter, cameras, map);
  idle_ = result.idle;
  if (idle_) return nullptr;
  look_W_ = result.unseen_W;
  way_ = &result.curve;
  if (result.from_odometry) meets_vehicle_at_ = input.t_start;
  measured_latency_ =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  replan_.late = DeliverLate(vehicle.t) && result.committed;
  // Only one answer is ever pending, also where steps become more frequent.
  if (result.committed) busy_until_ = std::max(busy_until_, input.t_start);
  // Where there is nothing left to plan, or what is flown lands, no plan is missing.
  const bool kept = result.status == planning::ReplanStatus::kKept;
  lands_ = parts_.planner_lands && result.Lands();
  const bool to_contact = wants_plan && !looks_from_ && input.endpoint.leads_to_contact();
  const bool lands_as_wanted =
      to_contact && kept && lands_ && result.reason != planning::ReplanReason::kInvalidInput;
  at_goal_ = result.reason == planning::ReplanReason::kAtGoal;
  rests_ = !wants_plan && result.status == planning::ReplanStatus::kHolding;
  out_of_reach_ = result.reason == planning::ReplanReason::kPadUnreachable;
  last_planned_ = result.status == planning::ReplanStatus::kPlanned || at_goal_ || lands_as_wanted;
  has_plan_ = last_planned_ || kept;
  if (last_planned_) planned_t_ = vehicle.t;
  if (!kept && !Levelled(vehicle.t)) {
    const bool touches =
        last_planned_ && to_contact && input.endpoint.touches() && result.ends_in_contact;
    plan_end_t_ = touches ? result.curve.t_end() : std::numeric_limits<double>::infinity();
  }
  return &result;
}

// A measured step that took longer than expected. Its plan is flown from the time it was ready, and
// no other step begins before.
bool Pilot::DeliverLate(double t) {
  if (!options_.latency.measured || measured_latency_ <= replan_.latency_s) return false;
  busy_until_ = t + measured_latency_;
  parts_.planner->TakeOverAt(busy_until_);
  return true;
}

// Gusts add to it. But a pad that brakes is not seen any more in the last decimetre.
double Pilot::TouchdownRate(const Eigen::Vector3d& pull_W) const {
  const double gusts = kSofterInPull * pull_W.head<2>().norm();
  const double least = std::min(parameters_.contact_rate, parameters_.touchdown_rate);
  return std::max(least, parameters_.touchdown_rate - gusts);
}

// What holding still there will take, if the wind goes on to change as it does now, but no farther ahead than
// kGustHorizon. In a gust that is felt later there is no height left to climb.
double Pilot::LeanAtContact(double arrival_in) const {
  if (!observer_) return 0.0;
  const double ahead = std::clamp(arrival_in, 0.0, kGustHorizon);
  return LeanUnder(model_.HoverThrust(),
                   observer_->disturbance().force_W + ahead * observer_->force_rate_W());
}

// Longer, and the shortest plan would end too early to be decided on.
double Pilot::LevelTime(const Eigen::Vector3d& pull_W) const {
  const double gusts = kLevelTimeInPull * pull_W.head<2>().norm();
  const double errors = recent_error_.value() / touchdown_rate_;
  return std::min(kLevelTime + std::max(gusts, errors),
                  parameters_.decide_time - 1.3 * options_.shortest_contact_plan);
}

// A goal is known from the beginning, and for sure.
bool Pilot::to_goal() const { return options_.to_goal; }

bool Pilot::KnowsTarget(const estimation::PadFilter& filter) const {
  return to_goal() || filter.initialized();
}

bool Pilot::IsSureOfTarget(const estimation::PadFilter& filter, double t) const {
  return to_goal() || filter.Converged(t);
}

estimation::PadState Pilot::TargetAt(const estimation::PadFilter& filter, double t) const {
  return to_goal() ? parts_.predictor->Predict({}).At(t) : filter.Estimate(t);
}

bool Pilot::WantsPlan(const estimation::PadFilter& filter, double t) const {
  if (!KnowsTarget(filter)) return false;
  if (mission_.guidance == Guidance::kFollowPad || mission_.guidance == Guidance::kTouchDown) {
    return true;
  }
  // Hold ends with a plan to a known pad, so one is tried. Without the pad, a usable own state or
  // depth images, the vehicle rests.
  return mission_.mode == MissionMode::kHold && own_usable_ && sees_ && IsSureOfTarget(filter, t);
}

double Pilot::RestClimb() const {
  return mission_.guidance == Guidance::kClimb ? parameters_.follow_height : 0.0;
}

// A vehicle that comes to rest may start above the deck, so its request holds the pad, too.
const planning::ReplanResult& Pilot::Ask(bool for_plan, const estimation::PadFilter& filter,
                                         const std::vector<planning::LookCamera>& cameras,
                                         const planning::OccupancyMap& map) {
  ReplanRequest& request = replan_.request;
  request.rest_climb.reset();
  if (!for_plan) request.rest_climb = RestClimb();
  request.pad = KnowledgeOf(options_, filter);
  planning::ReplanInput& input = request.input;
  if (request.pad) input.pad = &parts_.predictor->Predict(*request.pad);
  if (input.pad != nullptr) replan_.pad = input.pad->At(input.t_now);
  looks_from_.reset();
  input.look_from_W.reset();
  replan_.look = {"look"};
  if (parts_.scout && input.pad != nullptr) {
    planning::StageTimer timer(&replan_.look);
    const bool may_look = for_plan && !arriving() && !lands_ && !out_of_reach_;
    looks_from_ = parts_.scout->Step(input, cameras, map, may_look);
    if (looks_from_) input.look_from_W = looks_from_->p_WB;
  }
  const planning::ReplanResult& result =
      for_plan ? parts_.planner->Replan(input, map)
               : parts_.planner->Rest(input, *request.rest_climb, map);
  input.pad = nullptr;  // the prediction is the predictor's own
  return result;
}

std::optional<planning::NoWay> Pilot::no_way() const {
  if (!parts_.scout) return std::nullopt;
  return parts_.scout->no_way();
}

std::string_view Pilot::look_words() const {
  return parts_.scout ? parts_.scout->look_words() : std::string_view();
}

PilotCommand Pilot::Control(const OwnState& own) {
  const double t = own.now().t;
  PilotCommand command = Level(t);
  if (!mission_.motors_armed) return command;
  if (KnowsAttitude(own.Status(t))) {
    command.law = Tracked(own.now(), command.reference);
    command.level = false;
  }
  MixerOutput& mix = command.mix;
  mix = mixer_.Mix(command.law.wrench);
  if (lead_) mix.thrusts = lead_->Command(mix.thrusts, t);
  if (observer_) observer_->Command(mix.thrusts);
  return command;
}

// A lead is for the moment, and this may be flown for long.
PilotCommand Pilot::Hold(double t) {
  PilotCommand command = Level(t);
  if (!mission_.motors_armed) return command;
  command.mix = mixer_.Mix(command.law.wrench);
  if (lead_) lead_->Hover(command.mix.thrusts);
  if (observer_) observer_->Command(command.mix.thrusts);
  return command;
}

PilotCommand Pilot::Level(double t) const {
  PilotCommand command;
  command.reference = Reference(t);
  command.mix.thrusts.setZero(mixer_.min().size());
  command.level = mission_.motors_armed;
  if (command.level) command.law = Blind(t, command.reference);
  return command;
}

// The attitude is unknown, so no moment can be right. An autopilot with its own attitude levels
// out.
ControlOutput Pilot::Blind(double t, const planning::FlatState& reference) const {
  ControlOutput level;
  level.wrench.thrust =
      settling_.CarriedShare(t) * model_.HoverThrust() / disturbance().thrust_gain;
  level.R_WB_desired.setIdentity();  // its third axis is upright to the last bit
  level.R_WB_desired.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(reference.yaw).toRotationMatrix();
  return level;
}

ControlOutput Pilot::Tracked(const estimation::VehicleState& vehicle,
                             const planning::FlatState& committed) {
  if (observer_) observer_->Update(vehicle, foot_force_ > kTouchForce);
  estimation::VehicleState told = vehicle;
  planning::FlatState reference = committed;
  Disturbance compensated = disturbance();
  const bool landing = Landing();
  // In a gust at contact the lean matters more than centimetres. But without an estimate of the
  // wind, only errors of position hold the vehicle against it.
  if (landing && observer_) {
    const double share =
        (kFlareBegins - foot_height_) / (kFlareBegins - parameters_.contact_height);
    SoftenHorizontally(1.0 - (1.0 - kFlareSoftness) * std::clamp(share, 0.0, 1.0), told,
                       &reference);
  }
  settling_.Apply(&told, &reference, &compensated);
  return parts_.controller->Update(told, reference, compensated, TiltMost(vehicle));
}

// If it leaned farther so close to the deck, the hull's rim would touch before the feet. But a
// vehicle that is blown off a path that does not land needs all the lean there is. The margin is
// also for a lean that turns meanwhile.
double Pilot::TiltMost(const estimation::VehicleState& vehicle) const {
  const double lean = FeetFirstTilt(model_, vehicle.q_WB) - kFlareMargin;
  return at_deck_ && lean > 0.0 && !blown_off_ ? lean : std::numeric_limits<double>::infinity();
}

Disturbance Pilot::disturbance() const {
  return observer_ ? observer_->disturbance() : Disturbance{};
}

planning::FlatState Pilot::Reference(double t) const {
  planning::FlatState reference = parts_.planner->Reference(t);
  // The heading was stepped to the end of the mission's period: go back from there.
  reference.yaw = estimation::WrapAngle(yaw_.yaw - yaw_.rate * (yaw_t_ - t));
  reference.yaw_rate = yaw_.rate;
  return reference;
}

// So near to the plan's end a new plan to it would postpone the end. From then on only the level
// stretch is planned, along the pad's path as predicted now.
bool Pilot::Levelled(double t) const {
  const double left = plan_end_t_ - (t + replan_.latency_s);
  return arriving() && left < options_.shortest_contact_plan;
}

// A landing that has begun is flown to its end where nothing else is proven, whatever the mission
// wants.
bool Pilot::Landing() const { return mission_.mode == MissionMode::kLanding || lands_; }

// A landing that is given up is turned away from the deck at once.
bool Pilot::plans_often() const {
  return arriving() ||
         (mission_.mode == MissionMode::kGoAround && foot_height_ < parameters_.gate_height);
}

// A planned landing that is decided.
bool Pilot::arriving() const {
  return mission_.mode == MissionMode::kLanding && mission_.guidance == Guidance::kTouchDown;
}

planning::ReplannerState Pilot::replanner_state() const {
  const auto* replanner = dynamic_cast<const planning::Replanner*>(parts_.planner.get());
  return replanner != nullptr ? replanner->state() : planning::ReplannerState{};
}

bool Pilot::plan_valid(double t) const {
  if (!requested_t_) return true;
  // A planner that is not asked for a new plan all the time still flies its last one.
  return planned_t_ && (last_planned_ || t - *planned_t_ <= parameters_.plan_timeout);
}

double Pilot::HeadingAhead(const estimation::VehicleState& vehicle,
                           const estimation::PadFilter& filter) const {
  const bool looks = looks_from_ && (vehicle.p_WB - looks_from_->p_WB).norm() < kTurnsToLook;
  if (looks) return looks_from_->yaw;
  // The path, not the reference: the reference of a pair soon turns into its stop.
  const Eigen::Vector3d ahead = WayAt(vehicle.t + kLookAhead) - WayAt(vehicle.t);
  if (ahead.head<2>().norm() > kLookDistance) {
    return Seeing(std::atan2(ahead.y(), ahead.x()), vehicle.p_WB);
  }
  if (look_W_) return Seeing(heading_ahead_, vehicle.p_WB);
  if (mission_.mode != MissionMode::kHovering || !KnowsTarget(filter)) {
    return heading_ahead_;
  }
  const Eigen::Vector3d p_BP = TargetAt(filter, vehicle.t).p_WP - vehicle.p_WB;
  return p_BP.head<2>().norm() > kLookDistance ? std::atan2(p_BP.y(), p_BP.x()) : heading_ahead_;
}

Eigen::Vector3d Pilot::WayAt(double t) const {
  return way_ != nullptr ? way_->EvaluateOnward(t).p_WB : parts_.planner->Reference(t).p_WB;
}

// The heading nearest to the given one at which the camera sees what the next stops need.
double Pilot::Seeing(double heading, const Eigen::Vector3d& p_WB) const {
  if (!look_W_) return heading;
  const Eigen::Vector3d to = *look_W_ - p_WB;
  if (to.head<2>().norm() < kNearest) return heading;
  const double off = estimation::WrapAngle(std::atan2(to.y(), to.x()) - heading);
  return estimation::WrapAngle(heading + off - std::clamp(off, -kInSight, kInSight));
}

// The camera should see the path ahead. But over the deck in wind a foot should point to the low
// side, so that it touches first. The nearest such heading to the present one is taken. If that is
// far off the path, it is the nearest to the path.
double Pilot::DesiredHeading() {
  const Eigen::Vector3d force_W =
      observer_ ? observer_->steady_force_W() : Eigen::Vector3d(Eigen::Vector3d::Zero());
  const double share = force_W.head<2>().norm() / model_.HoverThrust();
  const bool lands = mission_.mode == MissionMode::kLanding || plan_end_t_ - yaw_t_ < kTurnTime;
  leans_ = lands && share > (leans_ ? kUpright : kLeaning);
  if (!leans_) return heading_ = heading_ahead_;
  heading_ = HeadingIntoWind(model_, force_W, heading_);
  const double feet = std::max(1.0, static_cast<double>(model_.foot_azimuths.size()));
  const double off = std::abs(estimation::WrapAngle(heading_ - heading_ahead_));
  const bool aside = off > std::numbers::pi / feet + kHeadingSlack;
  return heading_ = aside ? HeadingIntoWind(model_, force_W, heading_ahead_) : heading_;
}

planning::EndpointTarget Pilot::Endpoint(double t) const {
  const bool contact = mission_.guidance == Guidance::kTouchDown;
  planning::EndpointTarget target;
  if (contact) target = ContactTarget(model_, touchdown_rate_, level_time_);
  target.t_reference = t;
  if (to_goal()) {
    target.height = 0.0;
    return target;
  }
  target.at_rest = options_.end_at_rest;
  if (contact) {
    if (!Levelled(t)) return target;
    target.t_reference = plan_end_t_;
    target.sink_rate = std::exchange(target.arrival_sink, 0.0);
    target.height_floor = model_.foot_depth - parameters_.press_depth;
    return target;
  }
  target.height = mission_.foot_height + model_.foot_depth;
  target.sink_rate = std::max(0.0, -mission_.foot_height_rate);
  const bool landing = mission_.mode == MissionMode::kLanding;
  const double lowest = landing ? -parameters_.press_depth : mission_.foot_height;
  target.height_floor = std::min(lowest, mission_.foot_height) + model_.foot_depth;
  return target;
}

double Pilot::Latency() const {
  if (!options_.latency.measured) return options_.latency.time;
  return std::clamp(kMeasuredMargin * measured_latency_, 1e-3, options_.latency.longest);
}

}  // namespace touchdown::control
