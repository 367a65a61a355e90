// SPDX-License-Identifier: BSD-3-Clause
// One MuJoCo model and its data behind plain types. A step sets the pad's drives to follow its path
// (velocity plus a pull towards the position), the rotors' commands and the aerodynamic force. It
// then calls mj_step and reads the contacts. mj_step evaluates contacts, forces and velocities
// (cvel) at the beginning of the step and then integrates. After it, qpos and qvel are new;
// everything else is old. MuJoCo's free joint: qpos is position and quaternion (w first) in W,
// qvel[0:3] is the velocity in W, qvel[3:6] is the angular rate in B. Source:
// https://mujoco.readthedocs.io, "Computation"; traps measured on 2.2.2.

#include "sim/world/world.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "estimation/base/argument_check.h"
#include "sim/air/drag.h"
#include "sim/air/ground_effect.h"
#include "sim/mujoco/mujoco_call.h"
#include "sim/mujoco/mujoco_model.h"
#include "sim/vehicle/trim.h"
#include "sim/vehicle/vehicle_file.h"
#include "sim/world/obstacle_touch.h"
#include "sim/world/start_check.h"
#include "sim/world/world_mjcf.h"

namespace touchdown::sim {
namespace {

constexpr double kMaxWind = 100.0;  // [m/s]

// What a geom is in the world.
struct GeomRole {
  enum class Part { kGround, kDeck, kPadBody, kFoot, kHull };
  Part part = Part::kGround;

  bool OfVehicle() const { return part == Part::kFoot || part == Part::kHull; }
};

Eigen::Map<const Eigen::Vector3d> Vec3(const mjtNum* data) {
  return Eigen::Map<const Eigen::Vector3d>(data);
}

template <typename Vector>
void Put(const Vector& v, mjtNum* data) {
  std::copy_n(v.data(), v.size(), data);
}

ContactKind KindOf(GeomRole::Part vehicle, GeomRole::Part other) {
  switch (other) {
    case GeomRole::Part::kDeck:
      return vehicle == GeomRole::Part::kFoot ? ContactKind::kFootDeck : ContactKind::kHullDeck;
    case GeomRole::Part::kPadBody:
      return ContactKind::kPadVehicle;
    default:
      return ContactKind::kGround;
  }
}

const char* WarningSentence(int warning) {
  switch (warning) {
    case mjWARN_INERTIA:
      return "the inertia matrix became singular";
    case mjWARN_CONTACTFULL:
      return "more contacts at once than there is room for";
    case mjWARN_CNSTRFULL:
      return "more contact constraints at once than there is room for";
    default:
      return "the state became infinite, too large or not a number";
  }
}

}  // namespace

const char* ToString(ContactKind kind) {
  switch (kind) {
    case ContactKind::kFootDeck:
      return "foot-deck";
    case ContactKind::kHullDeck:
      return "hull-deck";
    case ContactKind::kPadVehicle:
      return "pad-vehicle";
    case ContactKind::kObstacle:
      return "obstacle";
    case ContactKind::kGround:
      return "ground";
  }
  return "unknown";
}

class World::Impl {
 public:
  explicit Impl(const WorldConfig& config);

  void Step(const estimation::Commands& commands, const Eigen::Vector3d& wind_W);
  estimation::VehicleState Vehicle() const;
  estimation::PadState Pad() const;
  estimation::Commands RotorThrusts() const;
  estimation::Commands RotorCommands() const;
  double Time() const { return static_cast<double>(steps_) * config_.timestep; }

  WorldConfig config_;
  estimation::VehicleModel model_;  // as the file says
  estimation::VehicleModel plant_;  // as it is simulated
  std::shared_ptr<const PadCourse> course_;
  Eigen::Vector3d drag_ = Eigen::Vector3d::Zero();
  std::vector<Contact> contacts_;
  double foot_force_ = 0.0;
  double ground_effect_ = 0.0;

 private:
  void FindIndices();
  void AlterPlant();
  void SetInitialState(double thrust);
  void DrivePad();
  void PushByAir(const Eigen::Vector3d& wind_W);
  void ReadContacts();
  void ThrowOnWarning();
  Eigen::Vector3d PointVelocity(int body, const Eigen::Vector3d& p_W) const;

  MujocoModel mujoco_;
  MujocoData data_;
  long steps_ = 0;
  bool failed_ = false;
  std::vector<GeomRole> roles_;  // by geom
  std::optional<ObstacleTouch> touch_;
  int vehicle_body_ = -1;
  int vehicle_qpos_ = -1;
  int vehicle_qvel_ = -1;
  std::array<int, 3> pad_qpos_{};  // x, y, yaw
  std::array<int, 3> pad_qvel_{};
  std::array<int, 3> pad_actuator_{};
  std::vector<int> rotor_actuator_;
  std::vector<int> rotor_activation_;
};

World::Impl::Impl(const WorldConfig& config) : config_(config), course_(CourseOf(config)) {
  estimation::CheckWithin("timestep [s]", config.timestep, 1.0e-4, 0.005);
  if (config_.vehicle_mjcf.empty()) config_.vehicle_mjcf = DefaultVehicleMjcf();
  model_ = LoadVehicleModel(config_.vehicle_mjcf);
  plant_ = AlteredVehicle(model_, config_.plant);
  if (config_.ground_effect) {
    estimation::CheckAbove("rotor radius for ground effect [m]", model_.rotor_radius, 0.0, 10.0);
  }
  double thrust = plant_.HoverThrust();
  if (config_.hover_air_W) {
    estimation::CheckWithin("air of the start [m/s]", config_.hover_air_W->norm(), 0.0, kMaxWind);
    const auto trim = TrimAt(plant_, config_.start.v_WB - *config_.hover_air_W,
                             estimation::Yaw(config_.start.q_WB));
    if (trim) {
      config_.start.q_WB = trim->q_WB;
      thrust = trim->thrust;
    }
  }
  CheckStart(config_, model_);
  mujoco_ = CompileMjcf(WorldMjcf(config_), config_.vehicle_mjcf);
  data_ = MakeMujocoData(*mujoco_);
  contacts_.reserve(static_cast<std::size_t>(mujoco_->nconmax) + 1);
  FindIndices();
  AlterPlant();
  SetInitialState(thrust);
}

void World::Impl::FindIndices() {
  const mjModel* m = mujoco_.get();
  constexpr std::array<const char*, 3> kPadNames = {"pad_x", "pad_y", "pad_yaw"};
  for (std::size_t i = 0; i < 3; ++i) {
    const int joint = mj_name2id(m, mjOBJ_JOINT, kPadNames[i]);
    pad_qpos_[i] = m->jnt_qposadr[joint];
    pad_qvel_[i] = m->jnt_dofadr[joint];
    pad_actuator_[i] = mj_name2id(m, mjOBJ_ACTUATOR, kPadNames[i]);
  }
  // Activations belong to the last na actuators, in their order.
  const int first_stateful = m->nu - m->na;
  for (std::size_t i = 0; i < model_.actuators.size(); ++i) {
    const std::string name = "rotor" + std::to_string(i);
    rotor_actuator_.push_back(mj_name2id(m, mjOBJ_ACTUATOR, name.c_str()));
    rotor_activation_.push_back(rotor_actuator_.back() - first_stateful);
  }
  vehicle_body_ = mj_name2id(m, mjOBJ_BODY, "vehicle");
  vehicle_qpos_ = m->jnt_qposadr[m->body_jntadr[vehicle_body_]];
  vehicle_qvel_ = m->body_dofadr[vehicle_body_];

  std::vector<int> parts;  // of the vehicle, that can touch obstacles
  roles_.resize(static_cast<std::size_t>(m->ngeom));
  for (int geom = 0; geom < m->ngeom; ++geom) {
    const std::string_view name = m->names + m->name_geomadr[geom];
    GeomRole& role = roles_[static_cast<std::size_t>(geom)];
    if (m->geom_bodyid[geom] == vehicle_body_) {
      role.part = name.starts_with("foot") ? GeomRole::Part::kFoot : GeomRole::Part::kHull;
      if ((m->geom_conaffinity[geom] & 1) != 0) parts.push_back(geom);
    } else if (name == "deck") {
      role.part = GeomRole::Part::kDeck;
    } else if (name == "pad_body") {
      role.part = GeomRole::Part::kPadBody;
    }
  }
  touch_.emplace(config_.obstacles, *m, parts);
}

void World::Impl::AlterPlant() {
  if (config_.plant == PlantFactors{}) return;
  mjModel* m = mujoco_.get();
  m->body_mass[vehicle_body_] = plant_.mass_kg;
  Put(plant_.inertia, m->body_inertia + 3 * vehicle_body_);
  for (const int rotor : rotor_actuator_) {
    m->actuator_dynprm[mjNDYN * rotor] = plant_.rotor_lag_s;
    m->actuator_gainprm[mjNGAIN * rotor] = config_.plant.thrust;
  }
  CallMujoco(
      [&] { mj_setConst(m, data_.get()); });  // what the compiler derived from mass and inertia
}

void World::Impl::SetInitialState(double thrust) {
  mjData* d = data_.get();
  const estimation::PadState pad = course_->At(0.0);
  const std::array<double, 3> position = {pad.p_WP.x(), pad.p_WP.y(), pad.yaw};
  const std::array<double, 3> velocity = {pad.v_WP.x(), pad.v_WP.y(), pad.yaw_rate};
  for (std::size_t i = 0; i < 3; ++i) {
    d->qpos[pad_qpos_[i]] = position[i];
    d->qvel[pad_qvel_[i]] = velocity[i];
  }
  const estimation::VehicleState& start = config_.start;
  mjtNum* qpos = d->qpos + vehicle_qpos_;
  mjtNum* qvel = d->qvel + vehicle_qvel_;
  const Eigen::Quaterniond q = start.q_WB.normalized();
  Put(start.p_WB, qpos);
  Put(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()), qpos + 3);
  Put(start.v_WB, qvel);
  Put(start.w_WB_B, qvel + 3);
  // Activations are what the rotors were told, with its lag.
  const estimation::Commands told =
      estimation::AllocationOf(model_).Shares() * thrust / config_.plant.thrust;
  for (Eigen::Index i = 0; i < told.size(); ++i) {
    d->act[rotor_activation_[static_cast<std::size_t>(i)]] = told(i);
  }
}

void World::Impl::DrivePad() {
  mjData* d = data_.get();
  const estimation::PadState ref = course_->At(Time());
  const std::array<double, 3> position = {ref.p_WP.x(), ref.p_WP.y(), ref.yaw};
  const std::array<double, 3> velocity = {ref.v_WP.x(), ref.v_WP.y(), ref.yaw_rate};
  for (std::size_t i = 0; i < 3; ++i) {
    d->ctrl[pad_actuator_[i]] =
        velocity[i] + PadDrive::kPositionGain * (position[i] - d->qpos[pad_qpos_[i]]);
  }
}

void World::Impl::Step(const estimation::Commands& commands, const Eigen::Vector3d& wind_W) {
  if (failed_) throw std::runtime_error("this simulation failed at an earlier step");
  const std::size_t count = rotor_actuator_.size();
  if (static_cast<std::size_t>(commands.size()) != count) {
    estimation::ThrowOutOfRange("number of thrust commands", static_cast<double>(commands.size()),
                                std::to_string(count));
  }
  for (Eigen::Index i = 0; i < commands.size(); ++i) {
    if (!std::isfinite(commands(i))) {
      estimation::ThrowOutOfRange("thrust command of rotor " + std::to_string(i) + " [N]",
                                  commands(i), "a finite number");
    }
  }
  estimation::CheckWithin("wind speed [m/s]", wind_W.norm(), 0.0, kMaxWind);

  mjData* d = data_.get();
  DrivePad();
  for (std::size_t i = 0; i < count; ++i) {
    d->ctrl[rotor_actuator_[i]] = commands(static_cast<Eigen::Index>(i));
  }
  PushByAir(wind_W);

  failed_ = true;  // until the step came back whole
  CallMujoco([&] { mj_step(mujoco_.get(), d); });
  ThrowOnWarning();
  failed_ = false;
  ++steps_;
  ReadContacts();
}

// Drag acts at the centre of mass. The ground effect on a rotor's thrust acts at its hub.
void World::Impl::PushByAir(const Eigen::Vector3d& wind_W) {
  const estimation::VehicleState now = Vehicle();
  const Eigen::Matrix3d R_WB = now.q_WB.toRotationMatrix();
  const Eigen::Vector3d u_W = now.v_WB - wind_W;
  drag_ = DragForce(plant_, R_WB, u_W);
  mjtNum* push = data_->xfrc_applied + 6 * vehicle_body_;
  Put(drag_, push);
  if (!config_.ground_effect) return;

  const GroundEffect ground = GroundEffectOf(plant_, now, RotorThrusts(),
                                             DeckBox(config_.pad, Pad()), u_W.head<2>().norm());
  ground_effect_ = ground.thrust;
  Put(Eigen::Vector3d(drag_ + ground.thrust * R_WB.col(2)), push);
  Put(Eigen::Vector3d(R_WB * ground.moment_B), push + 3);
}

void World::Impl::ThrowOnWarning() {
  for (int warning = 0; warning < mjNWARNING; ++warning) {
    if (data_->warning[warning].number == 0) continue;
    throw std::runtime_error("the simulation failed at t = " + estimation::NumberText(Time()) +
                             " s: " + WarningSentence(warning));
  }
}

Eigen::Vector3d World::Impl::PointVelocity(int body, const Eigen::Vector3d& p_W) const {
  std::array<mjtNum, 6> spatial{};  // rotation, then translation of the body's centre of mass
  mj_objectVelocity(mujoco_.get(), data_.get(), mjOBJ_BODY, body, spatial.data(), 0);
  const Eigen::Vector3d arm = p_W - Vec3(data_->xipos + 3 * body);
  return Vec3(spatial.data() + 3) + Vec3(spatial.data()).cross(arm);
}

void World::Impl::ReadContacts() {
  const mjModel* m = mujoco_.get();
  const mjData* d = data_.get();
  contacts_.clear();
  foot_force_ = 0.0;
  for (int i = 0; i < d->ncon; ++i) {
    const mjContact& found = d->contact[i];
    int mine = found.geom1;
    int theirs = found.geom2;
    if (!roles_[static_cast<std::size_t>(mine)].OfVehicle()) std::swap(mine, theirs);
    const GeomRole& vehicle = roles_[static_cast<std::size_t>(mine)];
    const GeomRole& other = roles_[static_cast<std::size_t>(theirs)];

    Contact contact;
    contact.kind = KindOf(vehicle.part, other.part);
    std::array<mjtNum, 6> force{};  // in the contact frame, the normal first
    mj_contactForce(m, d, i, force.data());
    contact.normal_force = force[0];
    contact.p_W = Vec3(found.pos);
    contact.v_rel_W = PointVelocity(vehicle_body_, contact.p_W) -
                      PointVelocity(m->geom_bodyid[theirs], contact.p_W);
    if (vehicle.part == GeomRole::Part::kFoot) foot_force_ += contact.normal_force;
    contacts_.push_back(contact);
  }
  // Positions are still those at the step's beginning, like all results of a step.
  const auto touch = touch_->Find(*d, Vec3(d->xpos + 3 * vehicle_body_));
  if (!touch) return;
  const Eigen::Vector3d v_W = PointVelocity(vehicle_body_, touch->p_W);
  contacts_.push_back({ContactKind::kObstacle, touch->obstacle, 0.0, touch->p_W, v_W});
}

estimation::VehicleState World::Impl::Vehicle() const {
  const mjtNum* qpos = data_->qpos + vehicle_qpos_;
  const mjtNum* qvel = data_->qvel + vehicle_qvel_;
  estimation::VehicleState state;
  state.t = Time();
  state.p_WB = Vec3(qpos);
  state.q_WB = Eigen::Quaterniond(qpos[3], qpos[4], qpos[5], qpos[6]);
  state.v_WB = Vec3(qvel);
  state.w_WB_B = Vec3(qvel + 3);
  return state;
}

estimation::PadState World::Impl::Pad() const {
  const mjData* d = data_.get();
  estimation::PadState pad;
  pad.p_WP << d->qpos[pad_qpos_[0]], d->qpos[pad_qpos_[1]], config_.pad_motion.p_start.z();
  pad.v_WP.head<2>() << d->qvel[pad_qvel_[0]], d->qvel[pad_qvel_[1]];
  pad.a_WP.head<2>() << d->qacc[pad_qvel_[0]], d->qacc[pad_qvel_[1]];
  pad.yaw = d->qpos[pad_qpos_[2]];
  pad.yaw_rate = d->qvel[pad_qvel_[2]];
  return pad;
}

estimation::Commands World::Impl::RotorCommands() const {
  estimation::Commands commands(static_cast<Eigen::Index>(rotor_activation_.size()));
  for (Eigen::Index i = 0; i < commands.size(); ++i) {
    commands(i) = data_->act[rotor_activation_[static_cast<std::size_t>(i)]];
  }
  return commands;
}

estimation::Commands World::Impl::RotorThrusts() const {
  return RotorCommands() * config_.plant.thrust;
}

World::World(const WorldConfig& config) : impl_(std::make_unique<Impl>(config)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

void World::Step(const estimation::Commands& rotor_thrust_commands, const Eigen::Vector3d& wind_W) {
  impl_->Step(rotor_thrust_commands, wind_W);
}

double World::time() const { return impl_->Time(); }
double World::timestep() const { return impl_->config_.timestep; }
const estimation::VehicleModel& World::model() const { return impl_->model_; }
const estimation::VehicleModel& World::plant() const { return impl_->plant_; }
const std::shared_ptr<const PadCourse>& World::pad_course() const { return impl_->course_; }

std::shared_ptr<const PadCourse> CourseOf(const WorldConfig& config) {
  if (config.pad_course) {
    const double height = config.pad_course->At(0.0).p_WP.z();
    if (!(std::abs(height - config.pad_motion.p_start.z()) <= 1e-9)) {
      estimation::ThrowOutOfRange(
          "height of the pad's course [m]", height,
          std::to_string(config.pad_motion.p_start.z()) + ", as pad_motion says");
    }
    return config.pad_course;
  }
  return std::make_shared<PadMotion>(config.pad_motion);
}

// A drive's velocity lags by inertia / gain times the acceleration. Its position lags by this over the position gain.
// Twice that is allowed, plus the error of one step of the physics.
World::PadLag World::MaxPadLag() const {
  const PadMotionBounds motion = impl_->course_->bounds();
  const double velocity = 2.0 * PadDrive::kMass / PadDrive::kVelocityGain * motion.acceleration;
  const double yaw_rate =
      2.0 * PadDrive::YawInertia(impl_->config_.pad) / PadDrive::kYawGain * motion.yaw_acceleration;
  return {0.001 + velocity / PadDrive::kPositionGain, 0.002 + velocity,
          0.0002 + yaw_rate / PadDrive::kPositionGain, 0.0005 + yaw_rate};
}
const WorldConfig& World::config() const { return impl_->config_; }
estimation::VehicleState World::vehicle() const { return impl_->Vehicle(); }
estimation::PadState World::pad() const { return impl_->Pad(); }
estimation::Commands World::rotor_thrusts() const { return impl_->RotorThrusts(); }
estimation::Commands World::rotor_commands() const { return impl_->RotorCommands(); }
Eigen::Vector3d World::drag_force() const { return impl_->drag_; }
double World::ground_effect_thrust() const { return impl_->ground_effect_; }
const std::vector<Contact>& World::contacts() const { return impl_->contacts_; }
estimation::FootForce World::foot_force() const { return {time(), impl_->foot_force_}; }

Eigen::Vector3d World::velocity_over_deck() const {
  const estimation::VehicleState vehicle = impl_->Vehicle();
  const estimation::PadState pad = impl_->Pad();
  const Eigen::Vector3d arm = vehicle.p_WB - pad.p_WP;
  return vehicle.v_WB - pad.v_WP - pad.yaw_rate * Eigen::Vector3d(-arm.y(), arm.x(), 0.0);
}

}  // namespace touchdown::sim
