// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/binding/python_parts.h"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "evaluation/binding/bind.h"
#include "evaluation/binding/call.h"
#include "evaluation/binding/map_view.h"
#include "evaluation/binding/predictions.h"
#include "evaluation/binding/python_term.h"
#include "touchdown/planning/replan/stage_timer.h"
#include "touchdown/planning/spline/rest_trajectory.h"

namespace touchdown::binding {

using planning::FlatState;
using planning::OccupancyMap;
using planning::ReplanInput;
using planning::ReplanReason;
using planning::ReplanResult;
using planning::ReplanStatus;
using planning::SplineState;
using planning::UniformBspline;

namespace {

std::string NameOf(const py::object& type) {
  const auto name = type.attr("name").cast<std::string>();
  if (name.empty()) throw py::value_error("a part's name is empty");
  return name;
}

void FillPart(const py::object& type, evaluation::Part* part) {
  part->name = NameOf(type);
  part->summary = type.attr("summary").cast<std::string>();
  for (const auto& [key, parameter] : type.attr("parameters").cast<py::dict>()) {
    evaluation::ValueRange range;
    range.lo = parameter.attr("lo").cast<double>();
    range.hi = parameter.attr("hi").cast<double>();
    part->parameters.push_back({part->name + "." + key.cast<std::string>(),
                                parameter.attr("value").cast<double>(), range,
                                parameter.attr("help").cast<std::string>()});
  }
}

/// An instance with the scenario's parameters as attributes.
py::object MakePart(const py::object& type, const evaluation::PartSetup& setup) {
  const std::string group = NameOf(type) + ".";
  py::dict settings;
  for (const evaluation::Parameter& parameter : setup.parameters) {
    settings[py::str(parameter.key.substr(group.size()))] = setup.Get(parameter.key);
  }
  return type(**settings);
}

/// Lends a map for a call.
class MapLoan {
 public:
  explicit MapLoan(const OccupancyMap& map) { lent_->lent.Lend(&map); }
  ~MapLoan() { lent_->lent.Return(); }
  MapLoan(const MapLoan&) = delete;
  MapLoan& operator=(const MapLoan&) = delete;
  py::object object() const { return py::cast(lent_); }

 private:
  std::shared_ptr<MapView> lent_ = std::make_shared<MapView>();
};

/// Holds what `plan` of the object gives; brakes and climbs by itself.
class PythonPlanner : public planning::Planner {
 public:
  PythonPlanner(Kept planner, const planning::Limits& limits, std::string name)
      : planner_(std::move(planner)),
        limits_(limits),
        name_(std::move(name)),
        keep_(Kept(py::module_::import("touchdown._parts").attr("KEEP"))) {}

  void CommitHover(const Eigen::Vector3d& p_W, double t) override {
    next_ = planning::MakeRestTrajectory({.p = p_W}, t, Eigen::Vector3d::Zero(), limits_);
    current_ = next_;
    takes_over_ = t;
    climb_.reset();
    touches_ = false;
  }

  const ReplanResult& Replan(const ReplanInput& input, const OccupancyMap& map) override {
    if (input.pad == nullptr) return Rest(input, 0.0, map);
    result_.times = {};
    planning::StageTimer total(&result_.times.total);
    // Shortly before contact the plan to contact goes on, because a new one would delay it.
    const bool goes_on = touches_ && next_.t_end() - input.t_start < kShortest;
    if (goes_on && input.endpoint.leads_to_contact()) return Keep();
    std::optional<UniformBspline> curve;
    ReplanReason reason = ReplanReason::kSearchFailed;
    const bool keeps = Ask(input, map, &curve, &reason);
    if (keeps) return Keep();
    const SplineState start = StartAt(input.t_start);
    if (!curve) {
      return Commit(
          planning::MakeRestTrajectory(start, input.t_start, Eigen::Vector3d::Zero(), limits_),
          ReplanStatus::kBraking, reason);
    }
    Commit(std::move(*curve), ReplanStatus::kPlanned, ReplanReason::kNone);
    touches_ = input.endpoint.touches();
    result_.ends_in_contact = touches_;
    return result_;
  }

  const ReplanResult& Rest(const ReplanInput& input, double climb,
                           const OccupancyMap& /*map*/) override {
    if (climb_ == climb) {  // asked again at every step while it lasts
      result_.committed = false;
      return result_;
    }
    const Eigen::Vector3d up = climb * Eigen::Vector3d::UnitZ();
    Commit(planning::MakeRestTrajectory(StartAt(input.t_start), input.t_start, up, limits_),
           climb > 0.0 ? ReplanStatus::kClimbing : ReplanStatus::kBraking, ReplanReason::kNone);
    climb_ = climb;
    return result_;
  }

  void TakeOverAt(double t) override { takes_over_ = t; }

  FlatState Reference(double t) const override {
    return (t < takes_over_ ? current_ : next_).EvaluateOnward(t);
  }

 private:
  static constexpr double kShortest = 0.8;  // [s]

  /// True: what is committed goes on.
  bool Ask(const ReplanInput& input, const OccupancyMap& map, std::optional<UniformBspline>* curve,
           ReplanReason* reason) {
    return WithLock([&] {
      const PredictionLoan pad(input.pad);
      const MapLoan lent(map);
      py::object request =
          py::module_::import("touchdown._parts")
              .attr("PlanRequest")(input.t_now, input.t_start, py::cast(StartAt(input.t_start)),
                                   py::cast(input.vehicle), pad.object(), py::cast(input.endpoint),
                                   lent.object(), py::cast(limits_));
      const py::object got = planner_.get().attr("plan")(request);
      if (got.is(keep_.get())) return true;
      if (py::isinstance<py::str>(got)) {
        *reason = got.cast<ReplanReason>();
        return false;
      }
      if (got.is_none()) return false;
      if (!py::isinstance<UniformBspline>(got)) {
        throw py::type_error("planner " + name_ + ": plan gave " + std::string(py::repr(got)) +
                             ", it must be a UniformBspline, KEEP, None or a reason");
      }
      *curve = got.cast<UniformBspline>();
      constexpr double kSlack = 1e-6;  // [s]
      if (std::abs((*curve)->t0() - input.t_start) > kSlack) {
        throw py::value_error(
            "planner " + name_ + ": the curve starts at t0 = " + std::to_string((*curve)->t0()) +
            " s, it must be request.t_start = " + std::to_string(input.t_start) + " s");
      }
      const Eigen::Vector3d p = (*curve)->Position(input.t_start);
      const double off =
          std::min((p - StartAt(input.t_start).p).norm(), (p - input.vehicle.p_WB).norm());
      constexpr double kFarthest = 0.1;  // [m]
      if (off > kFarthest) {
        throw py::value_error("planner " + name_ + ": the curve starts " + std::to_string(off) +
                              " m from request.start.p");
      }
      return false;
    });
  }

  const ReplanResult& Keep() {
    result_.status = ReplanStatus::kKept;
    result_.reason = ReplanReason::kNone;
    result_.committed = false;
    return result_;
  }

  const ReplanResult& Commit(UniformBspline curve, ReplanStatus status, ReplanReason reason) {
    current_ = std::exchange(next_, std::move(curve));
    takes_over_ = next_.t0();
    climb_.reset();
    touches_ = false;
    const planning::StageTimes times = result_.times;
    result_ = {};
    result_.times = times;
    result_.status = status;
    result_.reason = reason;
    result_.committed = true;
    result_.curve = next_;
    return result_;
  }

  SplineState StartAt(double t) const {
    const FlatState at = Reference(t);
    return {at.p_WB, at.v_WB, at.a_WB};
  }

  Kept planner_;
  planning::Limits limits_;
  std::string name_;
  Kept keep_;
  UniformBspline current_, next_;
  double takes_over_ = 0.0;
  std::optional<double> climb_;
  bool touches_ = false;
  ReplanResult result_;
};

class PythonController : public control::Controller {
 public:
  explicit PythonController(Kept controller) : controller_(std::move(controller)) {}

  control::ControlOutput Update(const estimation::VehicleState& state, const FlatState& reference,
                                const control::Disturbance& disturbance,
                                double tilt_most) const noexcept override {
    control::ControlOutput output;
    try {
      WithLock([&] {
        const py::object got =
            controller_.get().attr("update")(state, reference, disturbance, tilt_most);
        if (!py::isinstance<control::ControlOutput>(got)) {
          throw py::type_error("update gave " + std::string(py::repr(got)) +
                               ", it must be a ControlOutput");
        }
        output = got.cast<control::ControlOutput>();
      });
    } catch (const std::exception&) {
      output.wrench.thrust = std::numeric_limits<double>::quiet_NaN();
    }
    return output;
  }

 private:
  Kept controller_;
};

/// Belief, as Python asks it.
class PythonPredictor : public estimation::PadPredictor {
 public:
  explicit PythonPredictor(Kept predictor) : predictor_(std::move(predictor)) {}

  const estimation::PadPrediction& Predict(const estimation::PadKnowledge& known) override {
    prediction_ =
        WithLock([&] { return PredictionOf(predictor_.get().attr("predict")(py::cast(known))); });
    return *prediction_;
  }

 private:
  Kept predictor_;
  std::shared_ptr<const estimation::PadPrediction> prediction_;
};

}  // namespace

evaluation::PlannerEntry PythonPlannerEntry(const py::object& type) {
  evaluation::PlannerEntry entry;
  FillPart(type, &entry);
  entry.lands = type.attr("lands").cast<bool>();
  entry.avoids = type.attr("avoids").cast<bool>();
  entry.rate = type.attr("rate").cast<double>();
  entry.make = [type = Kept(type), name = entry.name](const evaluation::PlannerSetup& setup) {
    return WithLock([&] {
      py::object planner = MakePart(type.get(), setup);
      planner.attr("limits") = setup.limits;
      planner.attr("floor_height") = setup.floor_height;
      planner.attr("ceiling_height") = setup.ceiling_height;
      return std::make_unique<PythonPlanner>(Kept(planner), setup.limits, name);
    });
  };
  return entry;
}

evaluation::ControllerEntry PythonControllerEntry(const py::object& type) {
  evaluation::ControllerEntry entry;
  FillPart(type, &entry);
  entry.compensates = type.attr("compensates").cast<bool>();
  entry.make = [type = Kept(type)](const evaluation::ControllerSetup& setup) {
    return WithLock([&] {
      py::object controller = MakePart(type.get(), setup);
      controller.attr("vehicle") = setup.model;
      return std::make_unique<PythonController>(Kept(controller));
    });
  };
  return entry;
}

evaluation::PredictorEntry PythonPredictorEntry(const py::object& type) {
  evaluation::PredictorEntry entry;
  FillPart(type, &entry);
  entry.make = [type = Kept(type)](const evaluation::PredictorSetup& setup) {
    return WithLock(
        [&] { return std::make_unique<PythonPredictor>(Kept(MakePart(type.get(), setup))); });
  };
  return entry;
}

}  // namespace touchdown::binding
