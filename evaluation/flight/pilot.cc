// SPDX-License-Identifier: BSD-3-Clause
// The on-board loop around the libraries: the state machine says what to do, the replanner how to
// fly there from the committed trajectory, the heading follows the way ahead so that the depth
// camera sees where the vehicle is going, and the tracking law turns the reference into rotor
// thrusts.
#include "evaluation/flight/pilot.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "control/tracking/lean.h"
#include "control/tracking/tracking_law.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_world.h"

namespace touchdown::evaluation {
namespace {

constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;
constexpr double kLookAhead = 0.8;              // the heading is where the vehicle will be then [s]
constexpr double kLookDistance = 0.3;           // nearer than this the way ahead says nothing [m]
constexpr double kInSight = 30.0 * kRadPerDeg;  // what is to be seen is no farther off the heading
constexpr double kNearest = 0.1;          // of what is to be seen, from the vehicle's axis [m]
constexpr double kAlignTolerance = 0.35;  // heading counts as aligned within this [rad]
constexpr double kContactShare = 0.2;     // of the weight, on the feet: enough to be a contact
constexpr double kLeaning = 0.1;          // of steady force over weight: a foot goes ahead
constexpr double kTurnTime = 2.0;         // ... so long before a planned contact [s]
constexpr double kFarAside = 70.0 * kRadPerDeg;  // of the way: half a foot's sector and more
constexpr double kUpright = 0.07;                // ... until it is less than that
constexpr double kFlareMargin = 5.0 * kRadPerDeg;
constexpr double kBlownOff = 0.15;        // of the reference [m]: far below the 0.5 m that lose it
constexpr double kFlareBegins = 0.2;      // from there on the position loop is softened ...
constexpr double kFlareSoftness = 0.8;    // ... to so many times its frequency at contact_height
constexpr double kTouchForce = 0.2;       // on the feet: something holds them [N]
constexpr double kLevelTimeInPull = 0.2;  // more level time in wind [s per m/s^2 of its force]
constexpr double kSofterInPull = 0.05;    // contact in wind: 0.2 m/s from 7 m/s on [m/s per m/s^2]
constexpr double kMeasuredMargin = 1.2;   // a measured latency is flown with this factor
constexpr double kAttitudeLag = 0.1;      // of the vehicle behind its plans [s]
constexpr double kTurning = 0.8;  // and then it takes so long to turn away from the deck [s]

control::DescentStyle StyleOf(const Scenario& scenario) {
  if (scenario.task != TaskKind::kLand) return control::DescentStyle::kNone;
  return PlansContact(scenario) ? control::DescentStyle::kPlanned
                                : control::DescentStyle::kVertical;
}

std::optional<PadKnowledge> KnowledgeOf(const Scenario& scenario,
                                        const estimation::PadFilter& filter) {
  if (scenario.task == TaskKind::kGoTo) return PadKnowledge();  // a goal needs none
  if (!filter.initialized()) return std::nullopt;
  return PadKnowledge{filter.belief(), filter.options().pad_height, filter.options().noise};
}

control::ControllerOptions TrackingOptions(const Scenario& scenario) {
  control::ControllerOptions options;
  options.tilt_max = TrackingTilt(scenario);
  return options;
}

const ControllerEntry& LawOf(const Scenario& scenario, const Registries& registries) {
  return PartNamed(registries.controllers, scenario.controller, "controller");
}

std::unique_ptr<control::Controller> MakeLaw(const Scenario& scenario,
                                             const estimation::VehicleModel& model,
                                             const ControllerEntry& entry) {
  const ControllerSetup setup{{scenario, entry.parameters}, model, TrackingOptions(scenario)};
  return MadeBy(entry, setup, "controller");
}

}  // namespace

planning::EndpointTarget ContactTarget(const estimation::VehicleModel& model, double touchdown_rate,
                                       double level_time) {
  planning::EndpointTarget target;
  target.height = target.height_floor = model.foot_depth + touchdown_rate * level_time;
  target.arrival_sink = touchdown_rate;
  return target;
}

Pilot::Pilot(const Scenario& scenario, const estimation::VehicleModel& model,
             std::shared_ptr<const sim::PadCourse> truth, const Registries& registries,
             const estimation::VehicleState& start, const Eigen::Vector4d& start_thrusts,
             const planning::OccupancyMap& map)
    : scenario_(scenario),
      model_(model),
      shortest_contact_plan_(
          PlannerOptions(scenario, model, registries.terms).min_contact_duration),
      predictor_(PredictorOf(scenario, registries, std::move(truth))),
      planner_entry_(PlannerOf(scenario, registries)),
      planner_(MakePlanner(scenario, model, registries)),
      controller_(MakeLaw(scenario, model, LawOf(scenario, registries))),
      mixer_(model) {
  parameters_.foothold = 0.5 * scenario.pad.deck_size - model.foot_radius;
  if (!(parameters_.foothold > 0.0)) {
    throw std::invalid_argument(fmt::format("pad.deck_size is {:g}, it must be > {:g} for the feet",
                                            scenario.pad.deck_size, 2.0 * model.foot_radius));
  }
  // The pad off by three standard deviations, and feet led to its middle are still on the deck.
  parameters_.bridge_sigma = parameters_.foothold / 3.0;
  // What TiltMost leaves towards a foot, which the heading turns there.
  const double lean = control::FeetFirstTilt(model) - kFlareMargin;
  if (lean > 0.0) parameters_.lean_max = lean;
  parameters_.gate_sigma = std::min(parameters_.gate_sigma, parameters_.bridge_sigma);
  // A light vehicle never presses as hard as the default asks.
  parameters_.contact_force =
      std::min(parameters_.contact_force, kContactShare * model.HoverThrust());
  parameters_.corridor_radius = scenario.mission.corridor_radius;
  parameters_.contact_distance = scenario.pad.deck_size * std::sqrt(0.5) + model.foot_radius;
  // A plan that turns away from the deck is made at the next step, flown a latency later and followed when
  // the attitude is there.
  const double latency = scenario.planning.latency.measured ? LongestLatency(scenario) : Latency();
  parameters_.turn_time = 1.0 / PlannerRate(scenario, planner_entry_) + latency + kAttitudeLag;
  parameters_.climb_time =
      1.0 / ClosePlannerRate(scenario, planner_entry_) + latency + kAttitudeLag;
  parameters_.decide_time = std::max(parameters_.decide_time, parameters_.turn_time + kTurning);
  if (LawOf(scenario, registries).compensates) {
    lead_.emplace(model).Hover(start_thrusts);
    if (scenario.control.disturbance) observer_.emplace(model).Hover(start, start_thrusts);
  }
  planner_->Prepare(map);
  planner_->CommitHover(start.p_WB, start.t);
  yaw_.yaw = estimation::Yaw(start.q_WB);
  yaw_t_ = start.t;
  heading_ = heading_ahead_ = yaw_.yaw;
}

void Pilot::StepMission(const OwnEstimate& own, const estimation::PadFilter& filter,
                        double foot_force, double dt) {
  const estimation::VehicleState& vehicle = own.now();
  const double t = vehicle.t;
  own_position_sigma_ = own.PositionSigma();
  own_attitude_sigma_ = own.AttitudeSigma();
  if (meets_vehicle_at_ && t >= *meets_vehicle_at_) {  // a plan from the vehicle has taken over
    recent_error_ = {};
    meets_vehicle_at_.reset();
  }
  recent_error_.Note(t, (planner_->Reference(t).p_WB - vehicle.p_WB).norm());
  control::MissionInputs inputs;
  inputs.t = t;
  inputs.pad_available = KnowsTarget(filter);
  inputs.pad_converged = IsSureOfTarget(filter, t);
  if (inputs.pad_available) {
    const estimation::PadState pad = TargetAt(filter, t);
    inputs.horizontal_distance = (vehicle.p_WB - pad.p_WP).head<2>().norm();
    inputs.height = vehicle.p_WB.z() - model_.foot_depth - pad.p_WP.z();
    inputs.foot_drop = control::FootDrop(model_, vehicle.q_WB);
    inputs.horizontal_speed = (vehicle.v_WB - pad.v_WP).head<2>().norm();
    inputs.sink_rate = pad.v_WP.z() - vehicle.v_WB.z();
  }
  foot_height_ = inputs.height;
  inputs.lean = control::LeanUnder(model_.HoverThrust(), disturbance().force_W);
  inputs.tag_age = to_goal() ? 0.0 : filter.TagAge(t);
  inputs.pad_sigma = to_goal() ? 0.0 : filter.PositionSigma(t);
  inputs.descent = StyleOf(scenario_);
  inputs.arrival_in = plan_end_t_ + level_time_ - t;
  const double contact_in = control::ContactIn(mission_state_, inputs, parameters_);
  if (std::isfinite(contact_in)) inputs.contact_sigma = filter.PositionSigma(t + contact_in);
  const estimation::OwnStatus status = own.status();
  inputs.own_fresh = status == estimation::OwnStatus::kGood;
  inputs.own_usable = inputs.own_fresh || status == estimation::OwnStatus::kOutage;
  own_usable_ = inputs.own_usable;
  inputs.foot_force = foot_force_ = foot_force;
  inputs.has_plan = has_plan_;
  inputs.at_goal = at_goal_;
  inputs.lands = lands_;
  // Between replans the last one counts: no plan has failed since it succeeded.
  if (requested_t_ && !last_planned_) {
    inputs.plan_failed_for =
        t - (planned_t_ ? std::max(*planned_t_, *requested_t_) : *requested_t_);
  }
  heading_ahead_ = HeadingAhead(vehicle, filter);
  const double heading = DesiredHeading();
  inputs.yaw_aligned = control::YawAligned(yaw_.yaw, heading, kAlignTolerance);

  const control::MissionStep step = control::Step(mission_state_, inputs, parameters_);
  mission_state_ = step.state;
  mission_ = step.outputs;
  if (mission_.plan_requested && !requested_t_) requested_t_ = t;
  if (!mission_.plan_requested) requested_t_.reset();
  const bool landing = Landing();
  at_deck_ = inputs.pad_available && !to_goal() &&
             std::abs(foot_height_) <= parameters_.contact_height &&
             inputs.horizontal_distance <= parameters_.contact_distance;
  const double off = (planner_->Reference(t).p_WB - vehicle.p_WB).head<2>().norm();
  blown_off_ = at_deck_ && !landing && (blown_off_ || off > kBlownOff);
  settling_.Note(t, at_deck_ && foot_force > kTouchForce, landing);

  yaw_ = control::StepYaw(yaw_, heading, dt);
  yaw_t_ = t + dt;
}

const planning::ReplanResult* Pilot::Replan(const estimation::VehicleState& vehicle,
                                            const estimation::PadFilter& filter,
                                            const planning::OccupancyMap& map) {
  idle_ = false;
  if (mission_.mode == control::MissionMode::kHovering || !mission_.motors_armed) {
    has_plan_ = false;
    return nullptr;
  }
  if (vehicle.t < busy_until_) return nullptr;
  replan_.latency_s = Latency();
  planning::ReplanInput& input = replan_.request.input;
  input.t_now = vehicle.t;
  input.t_start = vehicle.t + replan_.latency_s;
  input.vehicle = vehicle;
  if (observer_) input.pull_W = observer_->steady_force_W() / model_.mass_kg;
  input.margins = planning::MarginsOf(own_position_sigma_, own_attitude_sigma_,
                                      recent_error_.value(), input.pull_W);
  if (!arriving()) {
    touchdown_rate_ = TouchdownRate(input.pull_W);
    level_time_ = LevelTime(input.pull_W);
  }
  input.endpoint = Endpoint(vehicle.t);

  const bool wants_plan = WantsPlan(filter, vehicle.t);
  // No plan is missing while none is tried: a climb must not end as a failure to plan.
  if (!wants_plan && requested_t_) requested_t_ = vehicle.t;
  const auto begin = std::chrono::steady_clock::now();
  const planning::ReplanResult& result = Ask(wants_plan, filter, map);
  idle_ = result.idle;
  if (idle_) return nullptr;
  look_W_ = result.unseen_W;
  way_ = &result.curve;
  if (result.from_odometry) meets_vehicle_at_ = input.t_start;
  measured_latency_ =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  replan_.late = DeliverLate(vehicle.t) && result.committed;
  // Where there is nothing left to plan, or what is flown lands, no plan is missing.
  const bool kept = result.status == planning::ReplanStatus::kKept;
  lands_ = planner_entry_.lands && result.Lands();
  const bool lands_as_wanted = wants_plan && input.endpoint.leads_to_contact() && kept && lands_ &&
                               result.reason != planning::ReplanReason::kInvalidInput;
  at_goal_ = result.reason == planning::ReplanReason::kAtGoal;
  last_planned_ = result.status == planning::ReplanStatus::kPlanned || at_goal_ || lands_as_wanted;
  has_plan_ = last_planned_ || kept;
  if (last_planned_) planned_t_ = vehicle.t;
  if (!kept && !Levelled(vehicle.t)) {
    const bool touches = last_planned_ && wants_plan && input.endpoint.touches();
    plan_end_t_ = touches ? result.curve.t_end() : std::numeric_limits<double>::infinity();
  }
  return &result;
}

// A measured step that took longer than was reckoned with: its plan is flown from when it was there, and
// no other step is begun before.
bool Pilot::DeliverLate(double t) {
  if (!scenario_.planning.latency.measured || measured_latency_ <= replan_.latency_s) return false;
  busy_until_ = t + measured_latency_;
  planner_->TakeOverAt(busy_until_);
  return true;
}

// Gusts add to it. But a pad that brakes is not seen any more in the last decimetre.
double Pilot::TouchdownRate(const Eigen::Vector3d& pull_W) const {
  const double gusts = kSofterInPull * pull_W.head<2>().norm();
  const double least = std::min(parameters_.contact_rate, parameters_.touchdown_rate);
  return std::max(least, parameters_.touchdown_rate - gusts);
}

// Longer, and the shortest plan would end too early to be decided on.
double Pilot::LevelTime(const Eigen::Vector3d& pull_W) const {
  const double gusts = kLevelTimeInPull * pull_W.head<2>().norm();
  const double errors = recent_error_.value() / touchdown_rate_;
  return std::min(kLevelTime + std::max(gusts, errors),
                  parameters_.decide_time - 1.3 * shortest_contact_plan_);
}

// A goal is known from the beginning, and for sure.
bool Pilot::to_goal() const { return scenario_.task == TaskKind::kGoTo; }

bool Pilot::KnowsTarget(const estimation::PadFilter& filter) const {
  return to_goal() || filter.initialized();
}

bool Pilot::IsSureOfTarget(const estimation::PadFilter& filter, double t) const {
  return to_goal() || filter.Converged(t);
}

estimation::PadState Pilot::TargetAt(const estimation::PadFilter& filter, double t) const {
  return to_goal() ? predictor_->Predict({}).At(t) : filter.Estimate(t);
}

bool Pilot::WantsPlan(const estimation::PadFilter& filter, double t) const {
  if (!KnowsTarget(filter)) return false;
  if (mission_.guidance == control::Guidance::kFollowPad ||
      mission_.guidance == control::Guidance::kTouchDown) {
    return true;
  }
  // Holding ends with a plan to a known pad, so one is tried; without the pad, or without knowing
  // where it is itself, the vehicle rests.
  return mission_.mode == control::MissionMode::kHold && own_usable_ && IsSureOfTarget(filter, t);
}

double Pilot::RestClimb() const {
  return mission_.guidance == control::Guidance::kClimb ? parameters_.follow_height : 0.0;
}

// Who comes to rest may start above the deck, and is told where that is, too.
const planning::ReplanResult& Pilot::Ask(bool for_plan, const estimation::PadFilter& filter,
                                         const planning::OccupancyMap& map) {
  ReplanRequest& request = replan_.request;
  request.rest_climb.reset();
  if (!for_plan) request.rest_climb = RestClimb();
  request.pad = KnowledgeOf(scenario_, filter);
  planning::ReplanInput& input = request.input;
  if (request.pad) input.pad = &predictor_->Predict(*request.pad);
  if (input.pad != nullptr) replan_.pad = input.pad->At(input.t_now);
  const planning::ReplanResult& result =
      for_plan ? planner_->Replan(input, map) : planner_->Rest(input, *request.rest_climb, map);
  input.pad = nullptr;  // the prediction is the predictor's own
  return result;
}

control::MixerOutput Pilot::Control(const estimation::VehicleState& vehicle) {
  if (!mission_.motors_armed) return {};
  if (observer_) observer_->Update(vehicle, foot_force_ > kTouchForce);
  estimation::VehicleState told = vehicle;
  planning::FlatState reference = Reference(vehicle.t);
  control::Disturbance compensated = disturbance();
  const bool landing = Landing();
  // In a gust at contact the lean matters more than centimetres. But without an estimate of the wind the
  // errors of position are what holds the vehicle against it.
  if (landing && observer_) {
    const double share =
        (kFlareBegins - foot_height_) / (kFlareBegins - parameters_.contact_height);
    control::SoftenHorizontally(1.0 - (1.0 - kFlareSoftness) * std::clamp(share, 0.0, 1.0), told,
                                &reference);
  }
  settling_.Apply(&told, &reference, &compensated);
  control::MixerOutput mix =
      mixer_.Mix(controller_->Update(told, reference, compensated, TiltMost(vehicle)).wrench);
  if (lead_) mix.thrusts = lead_->Command(mix.thrusts, vehicle.t);
  if (observer_) observer_->Command(mix.thrusts);
  return mix;
}

// Leaning farther so close to the deck, the hull's rim would touch it before the feet do. But who is blown off
// a way that is not to end there needs all the lean there is. The margin is also for a lean that turns meanwhile.
double Pilot::TiltMost(const estimation::VehicleState& vehicle) const {
  const double lean = control::FeetFirstTilt(model_, vehicle.q_WB) - kFlareMargin;
  return at_deck_ && lean > 0.0 && !blown_off_ ? lean : std::numeric_limits<double>::infinity();
}

control::Disturbance Pilot::disturbance() const {
  return observer_ ? observer_->disturbance() : control::Disturbance{};
}

planning::FlatState Pilot::Reference(double t) const {
  planning::FlatState reference = planner_->Reference(t);
  // The heading was stepped to the end of the mission's period: go back from there.
  reference.yaw = estimation::WrapAngle(yaw_.yaw - yaw_.rate * (yaw_t_ - t));
  reference.yaw_rate = yaw_.rate;
  return reference;
}

// Nearer to its end a new plan to it would put it off: from here on it is the level stretch that is
// planned, along the pad's way as it is known by now.
bool Pilot::Levelled(double t) const {
  const double left = plan_end_t_ - (t + replan_.latency_s);
  return arriving() && left < shortest_contact_plan_;
}

// Whatever the mission wants: where nothing else is proven, a landing that has begun is flown to its end.
bool Pilot::Landing() const { return mission_.mode == control::MissionMode::kLanding || lands_; }

// A landing that is given up is turned away from the deck at once.
bool Pilot::plans_often() const {
  return arriving() || (mission_.mode == control::MissionMode::kGoAround &&
                        foot_height_ < parameters_.gate_height);
}

// A planned landing that is decided.
bool Pilot::arriving() const {
  return mission_.mode == control::MissionMode::kLanding &&
         mission_.guidance == control::Guidance::kTouchDown;
}

planning::ReplannerState Pilot::replanner_state() const {
  const auto* replanner = dynamic_cast<const planning::Replanner*>(planner_.get());
  return replanner != nullptr ? replanner->state() : planning::ReplannerState{};
}

bool Pilot::plan_valid(double t) const {
  if (!requested_t_) return true;
  // A planner that is not asked for a new plan all the time still flies its last one.
  return planned_t_ && (last_planned_ || t - *planned_t_ <= parameters_.plan_timeout);
}

double Pilot::HeadingAhead(const estimation::VehicleState& vehicle,
                           const estimation::PadFilter& filter) const {
  // The way, not the reference: that of a pair soon turns into its stop.
  const Eigen::Vector3d ahead = WayAt(vehicle.t + kLookAhead) - WayAt(vehicle.t);
  if (ahead.head<2>().norm() > kLookDistance) {
    return Seeing(std::atan2(ahead.y(), ahead.x()), vehicle.p_WB);
  }
  if (look_W_) return Seeing(heading_ahead_, vehicle.p_WB);
  if (mission_.mode != control::MissionMode::kHovering || !KnowsTarget(filter)) {
    return heading_ahead_;
  }
  const Eigen::Vector3d p_BP = TargetAt(filter, vehicle.t).p_WP - vehicle.p_WB;
  return p_BP.head<2>().norm() > kLookDistance ? std::atan2(p_BP.y(), p_BP.x()) : heading_ahead_;
}

Eigen::Vector3d Pilot::WayAt(double t) const {
  return way_ != nullptr ? way_->EvaluateOnward(t).p_WB : planner_->Reference(t).p_WB;
}

// The heading nearest to the given one at which the camera sees what the next stops need.
double Pilot::Seeing(double heading, const Eigen::Vector3d& p_WB) const {
  if (!look_W_) return heading;
  const Eigen::Vector3d to = *look_W_ - p_WB;
  if (to.head<2>().norm() < kNearest) return heading;
  const double off = estimation::WrapAngle(std::atan2(to.y(), to.x()) - heading);
  return estimation::WrapAngle(heading + off - std::clamp(off, -kInSight, kInSight));
}

// Where the camera sees the way ahead, but over the deck in wind a foot to the side that comes first: the
// one next to the heading so far, unless another one leads much nearer to the way and there is time.
double Pilot::DesiredHeading() {
  const Eigen::Vector3d force_W =
      observer_ ? observer_->steady_force_W() : Eigen::Vector3d(Eigen::Vector3d::Zero());
  const double share = force_W.head<2>().norm() / model_.HoverThrust();
  const bool lands =
      mission_.mode == control::MissionMode::kLanding || plan_end_t_ - yaw_t_ < kTurnTime;
  leans_ = lands && share > (leans_ ? kUpright : kLeaning);
  if (!leans_) return heading_ = heading_ahead_;
  heading_ = control::HeadingIntoWind(model_, force_W, heading_);
  const bool aside = foot_height_ > parameters_.gate_height &&
                     std::abs(estimation::WrapAngle(heading_ - heading_ahead_)) > kFarAside;
  return heading_ = aside ? control::HeadingIntoWind(model_, force_W, heading_ahead_) : heading_;
}

planning::EndpointTarget Pilot::Endpoint(double t) const {
  const bool contact = mission_.guidance == control::Guidance::kTouchDown;
  planning::EndpointTarget target;
  if (contact) target = ContactTarget(model_, touchdown_rate_, level_time_);
  target.t_reference = t;
  if (to_goal()) {
    target.height = 0.0;
    return target;
  }
  target.at_rest = scenario_.planning.endpoint_velocity == EndpointVelocityKind::kRest;
  if (contact) {
    if (!Levelled(t)) return target;
    target.t_reference = plan_end_t_;
    target.sink_rate = std::exchange(target.arrival_sink, 0.0);
    target.height_floor = model_.foot_depth - parameters_.press_depth;
    return target;
  }
  target.height = mission_.foot_height + model_.foot_depth;
  target.sink_rate = std::max(0.0, -mission_.foot_height_rate);
  const bool landing = mission_.mode == control::MissionMode::kLanding;
  const double lowest = landing ? -parameters_.press_depth : mission_.foot_height;
  target.height_floor = std::min(lowest, mission_.foot_height) + model_.foot_depth;
  return target;
}

double Pilot::Latency() const {
  if (!scenario_.planning.latency.measured) return 1e-3 * scenario_.planning.latency.ms;
  return std::clamp(kMeasuredMargin * measured_latency_, 1e-3, LongestLatency(scenario_));
}

}  // namespace touchdown::evaluation
