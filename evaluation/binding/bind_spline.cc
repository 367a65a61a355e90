// SPDX-License-Identifier: BSD-3-Clause
// Curves, their ends and limits; plain types; predictions.
#include <cmath>

#include "evaluation/binding/bind.h"
#include "evaluation/binding/call.h"
#include "evaluation/binding/predictions.h"
#include "evaluation/binding/python_term.h"
#include "touchdown/estimation/base/vehicle_state.h"
#include "touchdown/planning/replan/goal.h"
#include "touchdown/planning/spline/boundary_lift.h"
#include "touchdown/planning/spline/rest_trajectory.h"

namespace touchdown::binding {

using namespace pybind11::literals;
using estimation::PadPrediction;
using estimation::PadState;
using planning::SplineState;
using planning::Taylor;
using planning::UniformBspline;
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

PadState Unknown() {
  PadState state;
  state.p_WP.setConstant(kNaN);
  return state;
}

/// A prediction that is written in Python: an object with at(t).
class PythonPrediction : public PadPrediction {
 public:
  explicit PythonPrediction(Kept object) : object_(std::move(object)) {
    has_deck_ =
        !py::hasattr(object_.get(), "has_deck") || object_.get().attr("has_deck").cast<bool>();
  }
  PadState At(double t) const noexcept override {
    try {
      return WithLock([&] {
        const py::object state = object_.get().attr("at")(t);
        if (!py::isinstance<PadState>(state)) {
          throw py::type_error("at(t) gave " + std::string(py::repr(state)) +
                               ", it must be a PadState");
        }
        return state.cast<PadState>();
      });
    } catch (const std::exception&) {
      return Unknown();  // the raised error is kept for the end of the call
    }
  }
  bool has_deck() const noexcept override { return has_deck_; }

 private:
  Kept object_;
  bool has_deck_;
};

std::shared_ptr<const PadPrediction> MovingGoalOf(const py::object& position) {
  if (!PyCallable_Check(position.ptr())) throw py::type_error("position is no function");
  const auto ask = [function = Kept(position)](const Taylor& t) {
    return WithLock([&] {
      const py::sequence p = function.get()(t);
      if (py::len(p) != 3) throw py::value_error("the goal's position has not three numbers");
      planning::MovingGoal::Position at;
      for (std::size_t i = 0; i < 3; ++i) {
        const py::object x = p[i];
        at[i] = py::isinstance<Taylor>(x) ? x.cast<Taylor>() : Taylor(x.cast<double>());
      }
      return at;
    });
  };
  return std::make_shared<planning::MovingGoal>(ask);
}

/// What a prediction says. What a goal or a prediction of Python raises is raised.
template <class Work>
auto Asked(const Prediction& prediction, Work&& work) {
  const PadPrediction& it = prediction.get();
  return WithoutLock([&] { return work(it); });
}

Points PositionsAt(const Prediction& prediction, const Eigen::VectorXd& times) {
  return Asked(prediction, [&](const PadPrediction& it) {
    Points points(times.size(), 3);
    for (Eigen::Index i = 0; i < times.size(); ++i) {
      points.row(i) = it.MeanAt(times[i]).p_WP.transpose();
    }
    return points;
  });
}

/// Control points of the shape that Python gives them in: one per row.
UniformBspline MakeCurve(const Eigen::Ref<const Points>& control_points, double interval,
                         double t0) {
  return UniformBspline(control_points.transpose(), interval, t0);
}

Points CurveAt(const UniformBspline& curve, const Eigen::VectorXd& times, int derivative) {
  Points points(times.size(), 3);
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    const planning::FlatState at = curve.Evaluate(times[i]);
    const Eigen::Vector3d* of[] = {&at.p_WB, &at.v_WB, &at.a_WB, &at.j_WB};
    points.row(i) = of[derivative]->transpose();
  }
  return points;
}

void BindPlainTypes(py::module_& m) {
  Plain<SplineState>(m, "SplineState")
      .Field("p", &SplineState::p)
      .Field("v", &SplineState::v)
      .Field("a", &SplineState::a)
      .Done();
  using planning::FlatState;
  Plain<FlatState>(m, "FlatState")
      .Field("p_WB", &FlatState::p_WB)
      .Field("v_WB", &FlatState::v_WB)
      .Field("a_WB", &FlatState::a_WB)
      .Field("j_WB", &FlatState::j_WB)
      .Field("yaw", &FlatState::yaw)
      .Field("yaw_rate", &FlatState::yaw_rate)
      .Done();
  using planning::Limits;
  Plain<Limits>(m, "Limits")
      .Field("speed", &Limits::speed)
      .Field("acceleration", &Limits::acceleration)
      .Field("braking_factor", &Limits::braking_factor)
      .Field("body_rate", &Limits::body_rate)
      .Field("pull_W", &Limits::pull_W)
      .Done();
  using planning::VehicleFacts;
  Plain<VehicleFacts>(m, "VehicleFacts")
      .Field("thrust_min", &VehicleFacts::thrust_min)
      .Field("thrust_max", &VehicleFacts::thrust_max)
      .Field("tilt_max", &VehicleFacts::tilt_max)
      .Field("stop_tilt_max", &VehicleFacts::stop_tilt_max)
      .Field("camera_half_angle", &VehicleFacts::camera_half_angle)
      .Done();
  using planning::EndpointTarget;
  Plain<EndpointTarget>(m, "EndpointTarget")
      .Field("t_reference", &EndpointTarget::t_reference)
      .Field("height", &EndpointTarget::height)
      .Field("sink_rate", &EndpointTarget::sink_rate)
      .Field("height_floor", &EndpointTarget::height_floor)
      .Field("arrival_sink", &EndpointTarget::arrival_sink)
      .Field("at_rest", &EndpointTarget::at_rest)
      .Field("passing_W", &EndpointTarget::passing_W)
      .Look("touches", &EndpointTarget::touches)
      .Look("leads_to_contact", &EndpointTarget::leads_to_contact)
      .Done();
  Plain<PadState>(m, "PadState")
      .Field("p_WP", &PadState::p_WP)
      .Field("v_WP", &PadState::v_WP)
      .Field("a_WP", &PadState::a_WP)
      .Field("j_WP", &PadState::j_WP)
      .Field("yaw", &PadState::yaw)
      .Field("yaw_rate", &PadState::yaw_rate)
      .Field("cov_p", &PadState::cov_p)
      .Done();
  using estimation::VehicleState;
  // A unit quaternion of C++ is an array w, x, y, z here.
  Plain<VehicleState>(m, "VehicleState")
      .Field("t", &VehicleState::t)
      .Field("p_WB", &VehicleState::p_WB)
      .Field("v_WB", &VehicleState::v_WB)
      .Field(
          "q_WB",
          [](const VehicleState& s) {
            return Eigen::Vector4d(s.q_WB.w(), s.q_WB.x(), s.q_WB.y(), s.q_WB.z());
          },
          [](VehicleState& s, const Eigen::Vector4d& q) {
            s.q_WB = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
          })
      .Field("w_WB_B", &VehicleState::w_WB_B)
      .Done();
}

void BindTaylor(py::module_& m) {
  py::class_<Taylor>(m, "Taylor", Doc("Taylor"))
      .def(py::init<double>(), "constant"_a)
      .def_property_readonly("value", &Taylor::value, "At its time.")
      .def_property_readonly("first", &Taylor::first, "First derivative.")
      .def_property_readonly("second", &Taylor::second, "Second derivative.")
      .def_property_readonly("third", &Taylor::third, "Third derivative.")
      .def("__neg__", [](const Taylor& a) { return -a; })
      .def("__add__", [](const Taylor& a, const Taylor& b) { return a + b; })
      .def("__radd__", [](const Taylor& a, const Taylor& b) { return b + a; })
      .def("__sub__", [](const Taylor& a, const Taylor& b) { return a - b; })
      .def("__rsub__", [](const Taylor& a, const Taylor& b) { return b - a; })
      .def("__mul__", [](const Taylor& a, const Taylor& b) { return a * b; })
      .def("__rmul__", [](const Taylor& a, const Taylor& b) { return b * a; })
      .def("__truediv__", [](const Taylor& a, const Taylor& b) { return a / b; })
      .def("__rtruediv__", [](const Taylor& a, const Taylor& b) { return b / a; })
      // What numpy.sin and the others call.
      .def("sqrt", [](const Taylor& a) { return sqrt(a); })
      .def("exp", [](const Taylor& a) { return exp(a); })
      .def("sin", [](const Taylor& a) { return sin(a); })
      .def("cos", [](const Taylor& a) { return cos(a); });
  py::implicitly_convertible<double, Taylor>();
  py::implicitly_convertible<int, Taylor>();
}

}  // namespace

std::shared_ptr<const PadPrediction> PredictionOf(const py::object& object) {
  if (py::isinstance<Prediction>(object)) {
    const auto& prediction = object.cast<const Prediction&>();
    if (prediction.owned()) return prediction.owned();
    throw py::value_error("this prediction is lent for one call: it cannot be kept");
  }
  if (!py::hasattr(object, "at")) {
    throw py::type_error(std::string(py::repr(object)) +
                         " predicts nothing: it has no function at(t)");
  }
  return std::make_shared<PythonPrediction>(Kept(object));
}

PredictionLoan::PredictionLoan(const PadPrediction* prediction) {
  if (prediction == nullptr) {
    object_ = py::none();
    return;
  }
  lent_ = std::make_shared<Prediction>();
  lent_->lent.Lend(prediction);
  object_ = py::cast(lent_);
}

PredictionLoan::~PredictionLoan() {
  if (lent_) lent_->lent.Return();
}

void BindSpline(py::module_& m) {
  BindPlainTypes(m);
  BindTaylor(m);
  py::class_<Prediction, std::shared_ptr<Prediction>>(m, "PadPrediction", Doc("PadPrediction"))
      .def(
          "at",
          [](const Prediction& p, double t) {
            return Asked(p, [&](const PadPrediction& it) { return it.At(t); });
          },
          "t"_a, Doc("PadPrediction::At"))
      .def("positions", &PositionsAt, "times"_a, "Positions at times of shape (n,): (n, 3) [m].")
      .def_property_readonly(
          "has_deck", [](const Prediction& p) { return p.get().has_deck(); },
          Doc("PadPrediction::has_deck"))
      .def(
          "end_state",
          [](const Prediction& p, const planning::EndpointTarget& endpoint, double t_arrival) {
            return Asked(p, [&](const PadPrediction& it) {
              return planning::EndStateAt(it, endpoint, t_arrival).state;
            });
          },
          "endpoint"_a, "t_arrival"_a, Doc("EndStateAt"));
  m.def(
      "GoalAt",
      [](const Eigen::Vector3d& p_W) {
        return std::make_shared<Prediction>(std::make_shared<planning::GoalAt>(p_W));
      },
      "p_W"_a, Doc("GoalAt"));
  m.def(
      "MovingGoal",
      [](const py::object& position) {
        return std::make_shared<Prediction>(MovingGoalOf(position));
      },
      "position"_a,
      "A point that moves as a function of time says: `position(t)` gives x, y and z in W [m] with "
      "+ - * / and "
      "numpy's sqrt, exp, sin and cos. Velocity, acceleration and jerk follow from it exactly.");
  py::class_<UniformBspline>(m, "UniformBspline", Doc("UniformBspline"))
      .def(py::init(&MakeCurve), "control_points"_a, "interval"_a, "t0"_a = 0.0,
           "Control points of shape (N, 3) [m], the knot interval [s] and the time of its start "
           "[s]. Raises ValueError "
           "if there are fewer than 4, the interval is not positive, or a number is not finite.")
      .def_property_readonly(
          "control_points",
          [](const py::object& self) {
            const auto& curve = self.cast<const UniformBspline&>();
            const auto n = static_cast<py::ssize_t>(curve.control_points().cols());
            py::array_t<double> view({n, py::ssize_t{3}}, curve.control_points().data(), self);
            view.attr("flags").attr("writeable") = false;
            return view;
          },
          "Of shape (N, 3) [m]: a view of the spline, to be read alone.")
      .def_property_readonly("interval", &UniformBspline::interval, Doc("UniformBspline::interval"))
      .def_property_readonly("t0", &UniformBspline::t0, Doc("UniformBspline::t0"))
      .def_property_readonly("segments", &UniformBspline::segments, "M = N - 3.")
      .def_property_readonly("duration", &UniformBspline::duration, Doc("UniformBspline::duration"))
      .def_property_readonly("t_end", &UniformBspline::t_end, Doc("UniformBspline::t_end"))
      .def("at", &UniformBspline::Evaluate, "t"_a, Doc("UniformBspline::Evaluate"))
      .def("at_onward", &UniformBspline::EvaluateOnward, "t"_a,
           Doc("UniformBspline::EvaluateOnward"))
      .def("at_knot", &UniformBspline::AtKnot, "k"_a, Doc("UniformBspline::AtKnot"))
      .def("squared_jerk", &UniformBspline::SquaredJerk, Doc("UniformBspline::SquaredJerk"))
      .def(
          "sample",
          [](const UniformBspline& curve, const Eigen::VectorXd& times, int derivative) {
            if (derivative < 0 || derivative > 3) {
              throw py::value_error("derivative is " + std::to_string(derivative) +
                                    ", it must be 0 to 3");
            }
            return CurveAt(curve, times, derivative);
          },
          "times"_a, "derivative"_a = 0,
          "Position [m], or its first, second or third derivative, at times of shape (n,) [s]: (n, "
          "3).")
      .def(
          "bounds",
          [](const UniformBspline& curve, const Eigen::Vector3d& pull_W) {
            const planning::DerivativeBounds bounds = planning::BoundDerivatives(curve, pull_W);
            return py::dict("speed"_a = bounds.speed, "acceleration"_a = bounds.acceleration,
                            "body_rate"_a = bounds.body_rate);
          },
          "pull_W"_a = Eigen::Vector3d(Eigen::Vector3d::Zero()), Doc("DerivativeBounds"))
      .def(py::pickle(
          [](const UniformBspline& curve) {
            return py::make_tuple(Points(curve.control_points().transpose()), curve.interval(),
                                  curve.t0());
          },
          [](const py::tuple& state) {
            return MakeCurve(state[0].cast<Points>(), state[1].cast<double>(),
                             state[2].cast<double>());
          }))
      .def("__copy__", [](const UniformBspline& curve) { return UniformBspline(curve); })
      .def("__deepcopy__",
           [](const UniformBspline& curve, const py::dict&) { return UniformBspline(curve); })
      .def("__repr__", [](const UniformBspline& curve) {
        return "UniformBspline(" + std::to_string(curve.segments() + 3) +
               " control points, t = " + std::string(py::str(py::float_(curve.t0()))) + " to " +
               std::string(py::str(py::float_(curve.t_end()))) + " s)";
      });
  m.def(
      "hermite",
      [](const SplineState& start, const SplineState& end, int segments, double duration,
         double t0) {
        if (segments < 4) throw py::value_error("segments must be at least 4");
        if (!(duration > 0.0)) throw py::value_error("duration must be > 0");
        return UniformBspline(planning::HermiteControlPoints(start, end, segments, duration),
                              duration / segments, t0);
      },
      "start"_a, "end"_a, "segments"_a, "duration"_a, "t0"_a = 0.0, Doc("HermiteControlPoints"));
  m.def(
      "rest_trajectory",
      [](const SplineState& start, double t0, const Eigen::Vector3d& shift,
         const planning::Limits& limits) {
        if (!start.p.allFinite() || !start.v.allFinite() || !start.a.allFinite() ||
            !shift.allFinite() || !std::isfinite(t0)) {
          throw py::value_error("start, t0 and shift must be finite");
        }
        if (!(limits.speed > 0.0 && limits.acceleration > 0.0)) {
          throw py::value_error("limits.speed and limits.acceleration must be > 0");
        }
        return planning::MakeRestTrajectory(start, t0, shift, limits);
      },
      "start"_a, "t0"_a, "shift"_a = Eigen::Vector3d(Eigen::Vector3d::Zero()),
      "limits"_a = planning::Limits(), Doc("MakeRestTrajectory"));
}

}  // namespace touchdown::binding
