// SPDX-License-Identifier: BSD-3-Clause
// The part that would fly.
#include <memory>

#include "evaluation/binding/bind.h"
#include "evaluation/binding/call.h"
#include "evaluation/binding/map_view.h"
#include "evaluation/binding/replanned.h"
#include "touchdown/control/onboard/envelope.h"
#include "touchdown/control/onboard/onboard.h"

namespace touchdown::binding {

using namespace pybind11::literals;
using control::Onboard;
using control::OnboardOptions;

namespace {

/// With the objects that it was made from.
class OwnOnboard {
 public:
  explicit OwnOnboard(const OnboardOptions& options)
      : use("Onboard"), onboard_(options, control::LandingParts(options)) {}

  template <class Measurement>
  control::Taken Take(const Measurement& measurement) {
    const InUse::Claim claim(use);
    return WithoutLock([&] { return onboard_.Take(measurement); });
  }
  void Begin(double t, const Eigen::VectorXd& thrusts) {
    const InUse::Claim claim(use);
    if (thrusts.size() > estimation::kMostActuators) {
      throw py::value_error("thrusts has " + std::to_string(thrusts.size()) + " numbers, at most " +
                            std::to_string(estimation::kMostActuators) + " are possible");
    }
    const estimation::Commands commands = thrusts;
    WithoutLock([&] { onboard_.Begin(t, commands); });
  }
  control::Setpoint Step(double t) {
    const InUse::Claim claim(use);
    return WithoutLock([&] { return onboard_.Step(t); });
  }
  template <class Look>
  auto See(Look&& look) {
    const InUse::Share share(use);
    return look(onboard_);
  }

  InUse use;

 private:
  Onboard onboard_;
};

py::dict Status(OwnOnboard& self) {
  return self.See([](const Onboard& o) {
    const control::OnboardStatus& s = o.status();
    return py::dict("time"_a = std::string(ToString(s.time)), "mode"_a = s.mission.mode,
                    "reason"_a = s.mission.reason, "gate"_a = s.mission.gate,
                    "descent_hold"_a = s.mission.descent_hold, "mission_step"_a = s.mission_step,
                    "own"_a = s.own, "foot_force"_a = s.foot_force, "pad_known"_a = s.pad_known,
                    "pad_sure"_a = s.pad_sure, "plan_valid"_a = s.plan_valid);
  });
}

std::unique_ptr<Replanned> Plan(OwnOnboard& self) {
  return self.See([](const Onboard& o) -> std::unique_ptr<Replanned> {
    if (o.plan().answer == nullptr) return nullptr;
    auto plan = std::make_unique<Replanned>();
    plan->result = *o.plan().answer;
    plan->Keep();
    return plan;
  });
}

py::array_t<double> Floats(const std::vector<float>& numbers) {
  return py::array_t<double>(
      py::array_t<float>(static_cast<py::ssize_t>(numbers.size()), numbers.data()));
}

void BindMeasurements(py::module_& m) {
  using estimation::DepthImage;
  Plain<DepthImage>(m, "DepthImage")
      .Field("t", &DepthImage::t)
      .Field("intrinsics", &DepthImage::intrinsics, Doc("CameraIntrinsics"))
      .Field("p_BC", &DepthImage::p_BC)
      .Field("R_BC", &DepthImage::R_BC)
      .Field("max_range", &DepthImage::max_range)
      .Field(
          "depth", [](const DepthImage& i) { return Floats(i.depth); },
          [](DepthImage& i,
             const py::array_t<float, py::array::c_style | py::array::forcecast>& depth) {
            i.depth.assign(depth.data(), depth.data() + depth.size());
          })
      .Done();
  using estimation::PadGpsFix;
  Plain<PadGpsFix>(m, "PadGpsFix")
      .Field("t", &PadGpsFix::t)
      .Field("p_WP", &PadGpsFix::p_WP)
      .Field("sigma", &PadGpsFix::sigma)
      .Done();
  using estimation::PadSighting;
  Plain<PadSighting>(m, "PadSighting")
      .Field("t", &PadSighting::t)
      .Field("p_BP_B", &PadSighting::p_BP_B)
      .Field("yaw_BP", &PadSighting::yaw_BP)
      .Field("sigma_p", &PadSighting::sigma_p)
      .Field("sigma_yaw", &PadSighting::sigma_yaw)
      .Field("tags_seen", &PadSighting::tags_seen)
      .Done();
  using estimation::FootForce;
  Plain<FootForce>(m, "FootForce")
      .Field("t", &FootForce::t)
      .Field("force", &FootForce::force)
      .Done();
  using estimation::ImuSample;
  Plain<ImuSample>(m, "ImuSample")
      .Field("t", &ImuSample::t)
      .Field("f_B", &ImuSample::f_B)
      .Field("w_WB_B", &ImuSample::w_WB_B)
      .Done();
  using estimation::OwnPositionFix;
  Plain<OwnPositionFix>(m, "OwnPositionFix")
      .Field("t", &OwnPositionFix::t)
      .Field("p_WB", &OwnPositionFix::p_WB)
      .Field("sigma_horizontal", &OwnPositionFix::sigma_horizontal)
      .Field("sigma_vertical", &OwnPositionFix::sigma_vertical)
      .Done();
  using estimation::OwnVelocityFix;
  Plain<OwnVelocityFix>(m, "OwnVelocityFix")
      .Field("t", &OwnVelocityFix::t)
      .Field("v_WB_B", &OwnVelocityFix::v_WB_B)
      .Field("sigma", &OwnVelocityFix::sigma)
      .Done();
  using estimation::HeightSample;
  Plain<HeightSample>(m, "HeightSample")
      .Field("t", &HeightSample::t)
      .Field("height", &HeightSample::height)
      .Field("sigma", &HeightSample::sigma)
      .Done();
  using estimation::HeadingSample;
  Plain<HeadingSample>(m, "HeadingSample")
      .Field("t", &HeadingSample::t)
      .Field("yaw", &HeadingSample::yaw)
      .Field("sigma", &HeadingSample::sigma)
      .Done();
}

}  // namespace

void BindOnboard(py::module_& m) {
  BindMeasurements(m);
  using control::Envelope;
  Plain<Envelope>(m, "Envelope")
      .Field("speed", &Envelope::speed)
      .Field("acceleration", &Envelope::acceleration)
      .Field("tilt_deg", &Envelope::tilt_deg)
      .Field("ceiling", &Envelope::ceiling)
      .Done();
  py::class_<control::Setpoint>(m, "Setpoint", Doc("Setpoint"))
      .def_readonly("t", &control::Setpoint::t, Doc("Setpoint::t"))
      .def_readonly("valid_until", &control::Setpoint::valid_until, Doc("Setpoint::valid_until"))
      .def_readonly("armed", &control::Setpoint::armed, Doc("Setpoint::armed"))
      .def_readonly("level", &control::Setpoint::level, Doc("Setpoint::level"))
      .def_property_readonly(
          "thrusts", [](const control::Setpoint& s) { return Eigen::VectorXd(s.thrusts); },
          Doc("Setpoint::thrusts"))
      .def_readonly("saturated", &control::Setpoint::saturated, Doc("Setpoint::saturated"))
      .def_readonly("wrench", &control::Setpoint::wrench, Doc("Setpoint::wrench"))
      .def_readonly("R_WB", &control::Setpoint::R_WB, Doc("Setpoint::R_WB"))
      .def_readonly("reference", &control::Setpoint::reference, Doc("Setpoint::reference"));
  py::class_<OwnOnboard>(m, "Onboard", Doc("Onboard"))
      .def(py::init([](const estimation::VehicleModel& vehicle, double deck_height,
                       double deck_size, const Envelope& envelope, bool estimate_disturbance) {
             OnboardOptions options = control::LandingOptions(vehicle, deck_height, envelope);
             options.deck_size = deck_size;
             options.estimate_disturbance = estimate_disturbance;
             return std::make_unique<OwnOnboard>(options);
           }),
           "vehicle"_a, "deck_height"_a, "deck_size"_a = OnboardOptions().deck_size,
           "envelope"_a = Envelope(), "estimate_disturbance"_a = true, Doc("LandingOptions"))
      .def("take", &OwnOnboard::Take<estimation::VehicleState>, "measurement"_a,
           "The own state, given, or a measurement: in any order, with its own time stamp. Gives "
           "what became of it.")
      .def("take", &OwnOnboard::Take<estimation::ImuSample>, "measurement"_a)
      .def("take", &OwnOnboard::Take<estimation::OwnPositionFix>, "measurement"_a)
      .def("take", &OwnOnboard::Take<estimation::OwnVelocityFix>, "measurement"_a)
      .def("take", &OwnOnboard::Take<estimation::HeightSample>, "measurement"_a)
      .def("take", &OwnOnboard::Take<estimation::HeadingSample>, "measurement"_a)
      .def("take", &OwnOnboard::Take<estimation::PadGpsFix>, "measurement"_a)
      .def("take", &OwnOnboard::Take<estimation::PadSighting>, "measurement"_a)
      .def("take", &OwnOnboard::Take<estimation::DepthImage>, "measurement"_a)
      .def("take", &OwnOnboard::Take<estimation::FootForce>, "measurement"_a)
      .def("begin", &OwnOnboard::Begin, "t"_a, "thrusts"_a, Doc("Onboard::Begin"))
      .def("step", &OwnOnboard::Step, "t"_a, Doc("Onboard::Step"))
      .def_property_readonly("status", &Status, Doc("OnboardStatus"))
      .def_property_readonly("plan", &Plan,
                             "The planner's answer in the last step; None: it was not asked.")
      .def_property_readonly(
          "own",
          [](OwnOnboard& self) { return self.See([](const Onboard& o) { return o.own(); }); },
          "What it takes for its own state now.")
      .def(
          "pad_at",
          [](OwnOnboard& self, double t) {
            return self.See([&](const Onboard& o) -> std::optional<estimation::PadState> {
              if (!o.pad().initialized()) return std::nullopt;
              return o.pad().Estimate(o.FlightTime(t));
            });
          },
          "t"_a, "What it takes for the pad's state at t [s]; None before it was measured.")
      .def(
          "reference",
          [](OwnOnboard& self, double t) {
            return self.See([&](const Onboard& o) { return o.Reference(t); });
          },
          "t"_a, Doc("Onboard::Reference"))
      .def(
          "map",
          [](OwnOnboard& self) {
            return self.See([](const Onboard& o) {
              auto copy = std::make_shared<OwnMap>(o.map().options());
              copy->map() = o.map();
              return copy;
            });
          },
          "A copy of its map.");
}

}  // namespace touchdown::binding
