// SPDX-License-Identifier: BSD-3-Clause
// One trial. Each step of 2 ms runs the sensors that are due, mission, replanning if due, tracking
// and physics. Then follow the judge and the figures on the true state. The judge is given the
// state from before the step together with the contacts found in it: the velocity before the
// impact.
#include "evaluation/flight/closed_loop.h"

#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/rendering_check.h"
#include "evaluation/base/sliding_mean.h"
#include "evaluation/flight/air.h"
#include "evaluation/flight/onboard_setup.h"
#include "evaluation/flight/pad_log.h"
#include "evaluation/flight/perception.h"
#include "evaluation/judge/failure_words.h"
#include "evaluation/judge/landing_time.h"
#include "evaluation/judge/metrics.h"
#include "evaluation/judge/safety_watch.h"
#include "evaluation/judge/stand_watch.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/obstacles/true_clearance.h"
#include "sim/vehicle/trim.h"
#include "touchdown/solvers/backend/thread_clock.h"

namespace touchdown::evaluation {
namespace {

constexpr double kSecond = 1.0;              // [s]
constexpr double kMapLookRate = 1.0;         // of the safety figures [Hz]
constexpr double kSampleRate = kPadLogRate;  // of metrics, record and pad log [Hz]

// What T* is asked: the trial's world without its obstacles, in still air.
LandingTimeTask LandingTimeTaskOf(const Scenario& scenario, const sim::World& world) {
  const LandingRule rule;
  LandingTimeTask task;
  task.p_WB = world.vehicle().p_WB;
  task.speed = scenario.limits.speed;
  task.acceleration = scenario.limits.acceleration;
  task.deck_half_size = world.config().pad.deck_half_size;
  task.deck_thickness = world.config().pad.deck_thickness;
  task.foot_reach = world.model().foot_reach;
  task.foot_radius = world.model().foot_radius;
  task.foot_depth = world.model().foot_depth;
  task.horizontal_speed = rule.horizontal_speed;
  task.vertical_speed = rule.vertical_speed;
  task.horizon = scenario.timeout;
  task.pad_rates = world.pad_course()->bounds();
  const sim::World::PadLag lag = world.MaxPadLag();
  task.pad_position_error = lag.position;
  task.pad_velocity_error = lag.velocity;
  task.pad_yaw_error = lag.yaw;
  task.pad_yaw_rate_error = lag.yaw_rate;
  return task;
}

std::optional<SafetyWatch> SafetyWatchOf(const PlannerEntry& planner, const sim::World& world) {
  if (!planner.proves) return std::nullopt;
  return SafetyWatch(world.config().obstacles);
}

std::optional<HoldTask> StayOf(const Scenario& scenario) {
  switch (scenario.task) {
    case TaskKind::kLand:
      break;
    case TaskKind::kFollow:
      return HoldTask{Outcome::kFollowed, scenario.follow.distance, scenario.follow.time};
    case TaskKind::kGoTo:
      return HoldTask{Outcome::kArrived, scenario.go_to.distance, scenario.go_to.time};
  }
  return std::nullopt;
}

class Trial {
 public:
  Trial(const Scenario& scenario, std::uint64_t seed, const Registries& registries,
        TrialRecord* record, TrialSamples* samples)
      : Trial(scenario, seed, DrawTrial(scenario, seed), PlannerOf(scenario, registries),
              registries, record, samples) {}

  TrialResult Run(const std::function<void()>& each_step) {
    try {
      while (!judge_.outcome()) {
        Step();
        if (each_step) each_step();
      }
    } catch (const std::exception& error) {
      throw std::runtime_error(fmt::format("internal error in flight at {:.3f} s (seed {}): {}",
                                           world_.time(), result_.seed, error.what()));
    }
    Finish();
    if (has_prior_) solvers::AddThreadCpu(&result_.timing.judging_cpu_s, [&] { ComparePrior(); });
    return result_;
  }

  planning::PersistentMap TakePersistentMap() {
    return memory_ ? std::move(*memory_) : onboard_.TakeMemory();
  }

 private:
  Trial(const Scenario& scenario, std::uint64_t seed, const TrialDraw& draw,
        const PlannerEntry& planner, const Registries& registries, TrialRecord* record,
        TrialSamples* samples)
      : world_(WorldOf(scenario, draw, registries)),
        air_(scenario, draw, seed),
        perception_(scenario, world_, seed),
        onboard_(MakeOnboard(scenario, world_.model(), world_.pad_course(), registries)),
        clearance_(world_.config().obstacles, world_.model()),
        has_prior_(scenario.map_prior != "none"),
        task_(scenario.task),
        stay_(StayOf(scenario)),
        goal_(GoalOf(scenario)),
        limits_(scenario.limits),
        floor_(control::LowestPlan(world_.model())),
        ceiling_(scenario.planning.ceiling),
        landing_time_(LandingTimeTaskOf(scenario, world_)),
        judge_(LandingRule{}, scenario.timeout, stay_),
        stand_watch_(scenario.stand_limit),
        safety_watch_(SafetyWatchOf(planner, world_)),
        map_look_clock_(kMapLookRate),
        sample_clock_(kSampleRate),
        record_(record),
        samples_(samples) {
    result_.seed = seed;
    perception_.Hover(world_, &onboard_);
    onboard_.Begin(world_.time(), world_.rotor_commands());
    if (samples_ != nullptr) onboard_.LogPadTo(&samples_->pad.arrivals);
    if (record_ != nullptr) {
      onboard_.KeepBefore(true);
      record_->map_resolution = onboard_.map().resolution();
      record_->map_size = onboard_.map().size();
      record_->outside = OutsideFilesOf(scenario);
      record_->hover_W = onboard_.own().p_WB;
      if (planner.solver.empty()) {
        record_->zones = ZonesOf(PlannerOptions(scenario, world_.model(), registries.terms));
      }
    }
  }

  void Step() {
    perception_.Sense(world_, &onboard_);
    CheckTaken();
    if (perception_.image_taken()) stand_watch_.Image();
    if (samples_ != nullptr) {
      for (const FrameTimes& times : perception_.frame_times()) {
        samples_->frames.push_back({world_.time(), times});
      }
    }
    const estimation::VehicleState vehicle = world_.vehicle();
    const estimation::PadState pad = world_.pad();
    const control::Setpoint& setpoint = onboard_.Step(world_.time());
    NoteMode(vehicle.t);
    NotePlan(vehicle.t);
    NoteNoWay(vehicle.t);
    solvers::AddThreadCpu(&result_.timing.physics_cpu_s, [&] { StepPhysics(setpoint.thrusts); });
    solvers::AddThreadCpu(&result_.timing.judging_cpu_s,
                          [&] { Judge(vehicle, pad, setpoint.saturated); });
  }

  // std::runtime_error is the physics' own way to fail; it leaves the state from before the step.
  void StepPhysics(const estimation::Commands& command) {
    try {
      world_.Step(command, air_.Step(world_));
    } catch (const std::runtime_error& error) {
      physics_failure_ = error.what();
    }
  }

  void NoteMode(double t) {
    const control::OnboardStatus& status = onboard_.status();
    if (status.own != own_status_) {
      own_status_ = status.own;
      Note(t, "own_state", std::string(estimation::ToString(own_status_)));
    }
    const control::MissionOutputs& mission = status.mission;
    if (status.mission_step && mission.reason != control::TransitionReason::kNone) {
      mode_ = fmt::format("{} ({})", control::ToString(mission.mode),
                          control::ToString(mission.reason));
      Note(t, "mode", mode_);
    }
    if (status.mission_step && task_ == TaskKind::kLand && !judge_.touchdown()) {
      ++result_.gate_steps[std::string(control::ToString(mission.gate))];
    }
    if (!result_.first_tag_s && std::isfinite(onboard_.pad().TagAge(t))) result_.first_tag_s = t;
    if (status.mission_step && mission.gate != gate_) {
      gate_ = mission.gate;
      Note(t, "gate", std::string(control::ToString(gate_)));
    }
    if (status.mission_step && mission.descent_hold != descent_hold_) {
      descent_hold_ = mission.descent_hold;
      Note(t, "descent", std::string(control::ToString(descent_hold_)));
    }
    if (status.look != look_) {
      look_ = status.look;
      result_.looks += look_.starts_with("begins");
      Note(t, "look", std::string(look_));
    }
  }

  /// Where the widest way is narrowest is asked once, when the answer comes.
  void NoteNoWay(double t) {
    const std::optional<planning::NoWay>& no_way = onboard_.status().no_way;
    if (no_way.has_value() == result_.no_way.has_value()) return;
    if (!no_way) {
      result_.no_way.reset();
      return Note(t, "no_way", "over");
    }
    const planning::OccupancyMap& map = onboard_.map();
    result_.no_way = {no_way->since, no_way->looks, {}, planning::LeastGap(map)};
    const Eigen::Vector3d target =
        task_ == TaskKind::kGoTo ? goal_.At(t).p_WP : onboard_.pad().Estimate(t).p_WP;
    solvers::AddThreadCpu(&result_.timing.judging_cpu_s, [&] {
      result_.no_way->narrowest =
          planning::FindNarrowPlace(map, onboard_.own().p_WB, target, floor_, ceiling_);
    });
    Note(t, "no_way", NoWaySentence(result_).substr(1));
  }

  void NotePlan(double t) {
    const planning::ReplanResult* plan = onboard_.plan().answer;
    if (plan == nullptr) {
      if (record_ != nullptr && onboard_.plan().idle) ++record_->idle_steps;
      return;
    }
    const control::OnboardReplan& asked = *onboard_.plan().asked;
    ++result_.replans;
    ++result_.replans_by_status[planning::ToString(plan->status)];
    no_plan_reason_.clear();
    if (plan->reason != planning::ReplanReason::kNone) {
      const bool named =
          !plan->detail.empty() && plan->reason != planning::ReplanReason::kInvalidInput;
      no_plan_reason_ = named ? std::string(plan->detail) : planning::ToString(plan->reason);
      ++result_.replans_by_reason[no_plan_reason_];
    }
    if (!plan->forbidden_by.empty())
      ++result_.replans_forbidden_by[std::string(plan->forbidden_by)];
    if (plan->status == planning::ReplanStatus::kPlanned) stand_watch_.Planned();
    if (safety_watch_ && !judge_.touchdown())
      safety_watch_->Step(*plan, asked.request.input.margins, asked.late);
    planning::StageTimes times = plan->times;
    times.look = asked.look;
    times.total.Add(asked.look);
    const planning::StageTimes::Span& total = times.total;
    result_.timing.replan_wall_ms.push_back(1e3 * total.wall);
    result_.timing.replan_cpu_ms.push_back(1e3 * total.cpu);
    if (total.wall > asked.latency_s) ++result_.timing.deadline_misses;
    if (total.cpu > asked.latency_s) ++result_.timing.deadline_misses_cpu;
    if (samples_ != nullptr) samples_->replans.push_back(SampleOf(t, *plan, times));
    if (record_ == nullptr) return;
    RecordPlan row;
    row.request = asked.request;
    row.pad = asked.pad;
    row.before = onboard_.plan().before;
    row.map_change = map_recorder_.Take(onboard_.map());
    row.result = OutcomeOf(*plan);
    row.latency_s = asked.latency_s;
    row.wall_s = total.wall;
    row.cpu_s = total.cpu;
    record_->plans.push_back(std::move(row));
  }

  void Judge(const estimation::VehicleState& vehicle, const estimation::PadState& pad,
             bool saturated) {
    const control::OnboardStatus& status = onboard_.status();
    JudgeSample sample;
    sample.t = vehicle.t;
    sample.vehicle = vehicle;
    sample.pad = pad;
    sample.simulated = physics_failure_.empty();
    if (sample.simulated) {
      for (const sim::Contact& contact : world_.contacts()) TakeContact(contact, &sample);
    }
    sample.armed = status.mission.motors_armed;
    sample.pad_known = status.pad_sure;
    sample.plan_valid = status.plan_valid;
    sample.at_target = AtTarget(vehicle, pad);
    sample.stood = stand_watch_.Stands(vehicle.t, vehicle.p_WB) && !sample.at_target;

    const bool in_flight = !judge_.touchdown();
    if (sample_clock_.Due(vehicle.t)) {
      through_air_.Add(vehicle.t, vehicle.v_WB - air_.velocity());
      if (in_flight) {
        metrics_.Sample(vehicle.t, vehicle, task_ == TaskKind::kGoTo ? goal_.At(vehicle.t) : pad);
        if (onboard_.own_estimated()) metrics_.OwnState(onboard_.own(), vehicle);
      }
      if (record_ != nullptr) RecordState(vehicle, pad);
      if (samples_ != nullptr) samples_->pad.truth.push_back({vehicle.t, in_flight, pad});
    }
    if (in_flight && safety_watch_) WatchSafety(vehicle);
    if (in_flight) {
      metrics_.Step(world_.rotor_thrusts(), saturated, world_.timestep());
      clearance_.Add(vehicle);
      if (perception_.pad_measured() && onboard_.pad().Converged(vehicle.t)) {
        metrics_.Estimate(onboard_.pad().Estimate(vehicle.t), pad,
                          onboard_.own().p_WB - vehicle.p_WB);
      }
    }
    if (in_flight && sample.foot_on_pad) {
      // Tilt is measured from the attitude that steady flight through the air needs.
      const auto trim = sim::TrimAt(world_.plant(), through_air_.Mean(), 0.0);
      if (trim) sample.equilibrium_axis = trim->q_WB * Eigen::Vector3d::UnitZ();
    }
    judge_.Observe(sample);
    if (in_flight && judge_.touchdown()) Note(vehicle.t, "contact", "foot-deck");
  }

  bool AtTarget(const estimation::VehicleState& vehicle, const estimation::PadState& pad) const {
    if (!stay_) return false;  // a landing has no such place
    if (task_ == TaskKind::kFollow) {
      return (vehicle.p_WB - pad.p_WP).head<2>().norm() <= stay_->distance;
    }
    const estimation::PadState goal = goal_.At(vehicle.t);
    return (vehicle.p_WB - goal.p_WP).norm() <= stay_->distance &&
           (vehicle.v_WB - goal.v_WP).norm() <= stay_->distance / kSecond;
  }

  void WatchSafety(const estimation::VehicleState& vehicle) {
    const Eigen::Vector3d believed = onboard_.own().p_WB;
    safety_watch_->Tracked(believed, vehicle.p_WB, onboard_.Reference(vehicle.t).p_WB);
    if (!map_look_clock_.Due(vehicle.t)) return;
    safety_watch_->LookAt(onboard_.map(), believed, believed - vehicle.p_WB);
  }

  void TakeContact(const sim::Contact& contact, JudgeSample* sample) {
    switch (contact.kind) {
      case sim::ContactKind::kFootDeck:
        sample->foot_on_pad = true;
        return;
      case sim::ContactKind::kGround:
      case sim::ContactKind::kPadVehicle:
        sample->beside_pad = true;
        break;
      case sim::ContactKind::kObstacle:
        sample->on_obstacle = true;
        break;
      case sim::ContactKind::kHullDeck:
        sample->hull_on_deck = true;
        break;
    }
    touched_ = sim::ToString(contact.kind);
    if (contact.obstacle >= 0) touched_ += fmt::format(" {}", contact.obstacle);
  }

  void RecordState(const estimation::VehicleState& vehicle, const estimation::PadState& pad) {
    RecordSample row;
    row.t = vehicle.t;
    row.vehicle = vehicle;
    row.vehicle_estimate = onboard_.own();
    row.pad = pad;
    row.pad_known = onboard_.pad().initialized();
    if (row.pad_known) row.pad_estimate = onboard_.pad().Estimate(vehicle.t);
    row.reference = onboard_.Reference(vehicle.t);
    row.rotor_thrusts = world_.rotor_thrusts();
    row.air = air_.velocity();
    row.disturbance = onboard_.disturbance();
    row.mode = control::ToString(onboard_.status().mission.mode).data();
    record_->samples.push_back(row);
  }

  void Note(double t, const char* kind, const std::string& text) {
    if (record_ != nullptr) record_->events.push_back({t, kind, text});
  }

  // The simulated sensors are right by construction. A measurement that the vehicle refuses is a bug of this program.
  void CheckTaken() const {
    const int invalid = onboard_.taken()[static_cast<std::size_t>(control::Taken::kInvalid)];
    if (invalid > 0) throw std::logic_error(fmt::format("{} measurements were invalid", invalid));
  }

  void Finish() {
    result_.outcome = *judge_.outcome();
    result_.touchdown = judge_.touchdown();
    result_.simulated_s = world_.time();
    if (result_.succeeded()) {
      result_.no_way.reset();
    } else {
      result_.detail = Explain(result_.outcome);
      if (const auto& touchdown = judge_.touchdown()) {
        const std::string broken = Broken(LandingRule(), *touchdown);
        if (!broken.empty()) result_.detail += " At first contact: " + broken + ".";
      }
      if (!physics_failure_.empty()) result_.detail += " Simulator: " + physics_failure_ + ".";
      if (!touched_.empty()) result_.detail += " Touched: " + touched_ + ".";
      result_.cause = touched_;
      const bool too_late =
          result_.outcome == Outcome::kStood || result_.outcome == Outcome::kTimeout ||
          result_.outcome == Outcome::kLostPad || result_.outcome == Outcome::kInfeasible;
      if (too_late && !judge_.touchdown()) {
        result_.detail += NoPlanSentence(result_, no_plan_reason_);
        result_.detail += NoWaySentence(result_);
        if (task_ != TaskKind::kGoTo && !result_.first_tag_s) {
          result_.detail += " No tag of the pad was ever seen.";
        }
        result_.detail += GateSentence(result_, control::ToString(gate_));
      }
      if (result_.outcome == Outcome::kStood) {
        const control::MissionMode mode = onboard_.status().mission.mode;
        const bool held = mode == control::MissionMode::kHold;
        if (!no_plan_reason_.empty()) {
          result_.cause = no_plan_reason_;
        } else {
          result_.cause = held ? mode_ : std::string(control::ToString(mode));
        }
      }
      result_.detail += fmt::format(" Mode: {}.", mode_);
    }
    metrics_.Fill(&result_);
    if (!world_.config().obstacles.empty()) {
      solvers::AddThreadCpu(&result_.timing.judging_cpu_s,
                            [&] { result_.min_clearance_m = clearance_.Least(); });
    }
    result_.within_limits = result_.max_speed_mps <= limits_.speed &&
                            result_.max_acceleration_mps2 <= limits_.acceleration;
    if (task_ == TaskKind::kLand) {
      solvers::AddThreadCpu(&result_.timing.judging_cpu_s, [&] { BoundLandingTime(); });
    }
    if (task_ == TaskKind::kFollow) result_.following = metrics_.LastFollowing();
    if (safety_watch_) result_.safety = safety_watch_->figures();
    result_.timing.simulated_s = world_.time();
    result_.timing.control_cpu_s = onboard_.times().control;
    result_.timing.planning_cpu_s = onboard_.times().planning;
    result_.timing.sensing_cpu_s = perception_.sensing_cpu_s();
    result_.timing.sensing_stages = perception_.sensing_times();
    result_.timing.mapping_cpu_s = perception_.mapping_cpu_s();
    Note(world_.time(), "outcome", ToString(result_.outcome));
  }

  // The observed part of the prior, and for the record its part near the flight.
  void ComparePrior() {
    memory_ = onboard_.TakeMemory();
    const planning::PriorCheck check = memory_->CheckPrior();
    PriorFigures& figures = result_.prior.emplace();
    figures.occupied = check.occupied;
    figures.looked_at = check.looked_at;
    figures.gone = std::ssize(check.gone);
    figures.appeared = std::ssize(check.appeared);
    if (record_ == nullptr || record_->samples.empty()) return;
    const planning::OccupancyMap& map = onboard_.map();
    planning::CellBox near = {map.origin(), map.origin() + map.size()};
    for (const RecordSample& sample : record_->samples) {
      if (!map.HasIndex(sample.vehicle.p_WB)) continue;
      const planning::CellIndex cell = map.CellOf(sample.vehicle.p_WB);
      near.low = near.low.cwiseMin(cell - map.size() / 2);
      near.high = near.high.cwiseMax(cell + map.size() / 2);
    }
    record_->prior = {memory_->PriorObstacles(near), check.gone, check.appeared};
  }

  void BoundLandingTime() {
    const sim::OraclePadPrediction pad(world_.pad_course());
    result_.t_star_s = LandingTimeLowerBound(landing_time_, pad);
    if (const auto flight = LandingTimeUpperBound(landing_time_, pad, *result_.t_star_s)) {
      result_.t_star_upper_s = flight->time;
    }
  }

  sim::World world_;
  Air air_;
  Perception perception_;
  control::Onboard onboard_;
  sim::LeastClearance clearance_;
  bool has_prior_;
  TaskKind task_;
  std::optional<HoldTask> stay_;
  planning::MovingGoal goal_;  ///< of the task go_to
  Scenario::Limits limits_;
  double floor_, ceiling_;        ///< of the body's origin [m]
  LandingTimeTask landing_time_;  ///< at the start
  LandingJudge judge_;
  StandWatch stand_watch_;
  std::optional<SafetyWatch> safety_watch_;  ///< of the landing planner
  estimation::SampleClock map_look_clock_;
  Metrics metrics_;
  estimation::OwnStatus own_status_ = estimation::OwnStatus::kGood;
  control::DescentHold descent_hold_ = control::DescentHold::kNone;
  std::string_view look_;
  std::string mode_ = "hovering";  // of the mission, and why
  control::Gate gate_ = control::Gate::kNoPad;
  SlidingMean through_air_;
  estimation::SampleClock sample_clock_;
  TrialRecord* record_;
  MapRecorder map_recorder_;
  TrialSamples* samples_;
  TrialResult result_;
  std::string touched_;
  std::string no_plan_reason_;   ///< of the last replanning step; empty: it made a plan
  std::string physics_failure_;  ///< empty while the physics works
  std::optional<planning::PersistentMap> memory_;  ///< of a flight with a prior, at its end
};

// A refusal by the simulator or a backend before the flight is a user error.
Trial SetUp(const Scenario& scenario, std::uint64_t seed, const Registries& registries,
            TrialRecord* record, TrialSamples* samples) {
  if (scenario.sensing == SensingKind::kRendered) RequireRenderedSensing();
  try {
    return Trial(scenario, seed, registries, record, samples);
  } catch (const std::invalid_argument& error) {
    throw BadInput(fmt::format("{}: it cannot be set up with seed {}: {}.", scenario.name, seed,
                               error.what()));
  }
}

}  // namespace

TrialResult RunTrial(const Scenario& scenario, std::uint64_t seed, const Registries& registries,
                     TrialRecord* record, std::optional<planning::PersistentMap>* map,
                     TrialSamples* samples, const std::function<void()>& each_step) {
  const auto wall = std::chrono::steady_clock::now();
  const double cpu = solvers::ThreadCpuSeconds();
  Trial trial = SetUp(scenario, seed, registries, record, samples);
  TrialResult result = trial.Run(each_step);
  result.timing.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  result.timing.cpu_s = solvers::ThreadCpuSeconds() - cpu;
  if (map != nullptr) *map = trial.TakePersistentMap();
  return result;
}

}  // namespace touchdown::evaluation
