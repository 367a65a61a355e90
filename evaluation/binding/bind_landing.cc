// SPDX-License-Identifier: BSD-3-Clause
// The landing problem, and what its terms are told.

#include "evaluation/binding/bind.h"
#include "evaluation/binding/call.h"
#include "evaluation/binding/part_registries.h"
#include "evaluation/binding/predictions.h"
#include "evaluation/binding/python_term.h"
#include "evaluation/binding/solvable.h"
#include "touchdown/planning/problem/landing_problem.h"
#include "touchdown/planning/problem/term_check.h"

namespace touchdown::binding {

using namespace pybind11::literals;
using planning::LandingProblem;
using planning::LandingProblemOptions;
using planning::UniformBspline;

namespace {

/// A landing problem with the objects that must outlive it.
class OwnLanding : public Solvable {
 public:
  OwnLanding(int segments, const LandingProblemOptions& options)
      : Solvable("LandingProblem"), problem_(segments, options) {}

  const solvers::View& view() const override { return problem_.view(); }
  LandingProblem& problem() { return problem_; }
  const LandingProblem& problem() const { return problem_; }

  void SetBoundary(const planning::SplineState& start, const py::object& pad, double t0,
                   const planning::EndpointTarget& target, const Eigen::Vector3d& pull_W) {
    // Where a term raises the problem may look at this one or at the one before.
    pads_.push_back(PredictionOf(pad));
    WithoutLock([&] { problem_.SetBoundary(start, t0, *pads_.back(), target, pull_W); });
    pads_.erase(pads_.begin(), pads_.end() - 1);
  }
  void SetPrevious(const UniformBspline* previous) {
    std::optional<UniformBspline> kept;
    if (previous != nullptr) kept = *previous;
    WithoutLock([&] {
      problem_.SetPrevious(nullptr);
      previous_ = std::move(kept);
      problem_.SetPrevious(previous_ ? &*previous_ : nullptr);
    });
  }

 private:
  std::vector<std::shared_ptr<const estimation::PadPrediction>> pads_;
  std::optional<UniformBspline> previous_;
  LandingProblem problem_;
};

std::unique_ptr<OwnLanding> Make(int segments, planning::ArrivalMode arrival,
                                 planning::EndpointMode endpoint, planning::LimitsMode limits_mode,
                                 const planning::Limits& limits,
                                 const planning::VehicleFacts& vehicle, const py::dict& terms,
                                 const PartRegistries* registries, bool free_end_acceleration) {
  LandingProblemOptions options;
  options.arrival = arrival;
  options.endpoint = endpoint;
  options.limits_mode = limits_mode;
  options.limits = limits;
  options.vehicle = vehicle;
  options.free_end_acceleration = free_end_acceleration;
  if (registries != nullptr) options.terms = registries->all.terms;
  options.settings = TermSettingsOf(terms);
  return WithoutLock([&] { return std::make_unique<OwnLanding>(segments, options); });
}

template <class Work>
auto Alone(OwnLanding& self, Work&& work) {
  const InUse::Claim claim(self.use);
  return WithoutLock([&] { return work(self.problem()); });
}

py::dict Facts(const planning::BoundaryFacts& facts) {
  return py::dict("start_speed"_a = facts.start_speed,
                  "start_acceleration"_a = facts.start_acceleration,
                  "first_hull_speed"_a = facts.first_hull_speed, "end_speed"_a = facts.end_speed,
                  "recovering"_a = facts.recovering, "end_too_fast"_a = facts.end_too_fast);
}

void SetPairs(
    OwnLanding& self, const Eigen::VectorXi& control_points,
    const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>& p,
    const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>& v) {
  if (p.rows() != control_points.size() || v.rows() != control_points.size()) {
    throw py::value_error("control_points, p and v must have as many rows");
  }
  std::vector<planning::ObstaclePair> pairs;
  for (Eigen::Index i = 0; i < control_points.size(); ++i) {
    pairs.push_back({control_points[i], p.row(i), v.row(i)});
  }
  Alone(self, [&](LandingProblem& problem) { problem.SetPairs(pairs); });
}

/// Of a class of Python, or of the name of a term.
py::list CheckTerm(const py::object& term, const PartRegistries* registries, int trials,
                   std::uint64_t seed) {
  const PartRegistries standard;
  const bool named = py::isinstance<py::str>(term);
  const planning::TermEntry entry =
      named ? planning::FindTerm((registries ? *registries : standard).all.terms,
                                 term.cast<std::string>())
            : PythonTermEntry(term);
  planning::TermCheckOptions options;
  options.trials = trials;
  options.seed = seed;
  const auto rows = WithoutLock([&] { return planning::CheckTerm(entry, options); });
  py::list told;
  for (const planning::TermCheckRow& row : rows) {
    told.append(py::dict(
        "view"_a = row.view, "arrival"_a = row.arrival, "hard"_a = row.hard, "point"_a = row.point,
        "points"_a = row.points, "windows"_a = row.windows, "gradient"_a = row.errors.gradient,
        "hessian"_a = row.errors.hessian, "residual_jacobian"_a = row.errors.residual_jacobian,
        "row_jacobian"_a = row.errors.row_jacobian, "least_curvature"_a = row.least_curvature));
  }
  const std::string complaint = planning::Complaint(rows);
  if (complaint.empty()) return told;
  throw py::value_error(WhatIsWrong(named ? py::none() : term, entry.info.name, complaint, rows));
}

}  // namespace

std::vector<planning::TermSettings> TermSettingsOf(const py::dict& terms) {
  std::vector<planning::TermSettings> all;
  for (const auto& [name, keys] : terms) {
    planning::TermSettings settings;
    settings.name = name.cast<std::string>();
    if (!py::isinstance<py::dict>(keys)) {
      throw py::type_error("terms[\"" + settings.name +
                           "\"] must be a dictionary, as {\"weight\": 1.0}");
    }
    for (const auto& [key, value] : keys.cast<py::dict>()) {
      const auto word = key.cast<std::string>();
      if (word == "weight") {
        settings.weight = value.cast<double>();
      } else if (word == "hard") {
        settings.hard = value.cast<bool>();
      } else {
        settings.parameters.emplace_back(word, value.cast<double>());
      }
    }
    all.push_back(std::move(settings));
  }
  return all;
}

void BindLanding(py::module_& m) {
  using Setup = planning::TermSetup;
  py::class_<Setup>(m, "TermSetup", Doc("TermSetup"))
      .def_readonly("control_points", &Setup::control_points, Doc("TermSetup::control_points"))
      .def_readonly("weight", &Setup::weight, "Of the loss.")
      .def_readonly("hard", &Setup::hard, Doc("TermSetup::hard"))
      .def_readonly("limits", &Setup::limits, "Of the vehicle's plans.")
      .def_readonly("vehicle", &Setup::vehicle, Doc("VehicleFacts"));
  py::class_<TermContext>(m, "LandingContext", Doc("LandingContext"))
      .def_readonly("segments", &TermContext::segments, Doc("LandingContext::segments"))
      .def_readonly("start", &TermContext::start, Doc("LandingContext::start"))
      .def_readonly("t0", &TermContext::t0, Doc("LandingContext::t0"))
      .def_readonly("interval", &TermContext::interval, Doc("LandingContext::interval"))
      .def_readonly("target", &TermContext::target, Doc("EndpointTarget"))
      .def_readonly("limits", &TermContext::limits, Doc("Limits"))
      .def_readonly("pull_W", &TermContext::pull_W, Doc("LandingContext::pull_W"))
      .def_readonly("pad", &TermContext::pad,
                    "Where the pad will be. It may be asked while the term is: not after `update` "
                    "or `value`.");
  py::class_<OwnLanding, Solvable>(m, "LandingProblem", Doc("LandingProblem"))
      .def(py::init(&Make), "segments"_a, py::kw_only(),
           "arrival"_a = planning::ArrivalMode::kFixed,
           "endpoint"_a = planning::EndpointMode::kEliminated,
           "limits_mode"_a = planning::LimitsMode::kSoft, "limits"_a = planning::Limits(),
           "vehicle"_a = planning::VehicleFacts(), "terms"_a = py::dict(),
           "registries"_a = py::none(), "free_end_acceleration"_a = true,
           "`terms`: {name: {\"weight\": ..., \"hard\": ..., parameter: ...}}, where they differ "
           "from the entries' "
           "defaults. Raises ValueError if there are fewer than 6 segments, an option is out of "
           "range, or `terms` names "
           "what `registries` do not know.")
      .def(
          "set_boundary",
          [](OwnLanding& self, const planning::SplineState& start, const py::object& pad, double t0,
             const planning::EndpointTarget& target, const Eigen::Vector3d& pull_W) {
            const InUse::Claim claim(self.use);
            self.SetBoundary(start, pad, t0, target, pull_W);
          },
          "start"_a, "pad"_a, "t0"_a = 0.0, "target"_a = planning::EndpointTarget(),
          "pull_W"_a = Eigen::Vector3d(Eigen::Vector3d::Zero()), Doc("LandingProblem::SetBoundary"))
      .def(
          "set_duration",
          [](OwnLanding& self, double duration) {
            Alone(self, [&](LandingProblem& p) { p.SetDuration(duration); });
          },
          "duration"_a, Doc("LandingProblem::SetDuration"))
      .def("set_pairs", &SetPairs, "control_points"_a, "p"_a, "v"_a,
           "Half-spaces (x - p) . v >= 0 of control points: indices of shape (n,), p [m] and unit "
           "vectors v of shape "
           "(n, 3). Raises ValueError if there are too many or one is out of range.")
      .def(
          "set_previous",
          [](OwnLanding& self, const UniformBspline* previous) {
            const InUse::Claim claim(self.use);
            self.SetPrevious(previous);
          },
          "previous"_a, "The plan that the term consistency stays near to; None: none.")
      .def_property_readonly(
          "segments", [](const OwnLanding& self) { return self.problem().segments(); }, "M.")
      .def(
          "guess",
          [](OwnLanding& self) { return Alone(self, [](LandingProblem& p) { return p.Guess(); }); },
          Doc("LandingProblem::Guess"))
      .def(
          "warm_guess",
          [](OwnLanding& self, const UniformBspline& previous) {
            return Alone(self, [&](LandingProblem& p) {
              Eigen::VectorXd y(p.view().num_variables());
              p.WarmGuess(previous, &y);
              return y;
            });
          },
          "previous"_a, Doc("LandingProblem::WarmGuess"))
      .def(
          "curve",
          [](OwnLanding& self, const Eigen::VectorXd& y) {
            RequireSize(self.view(), y, "y");
            return Alone(self, [&](LandingProblem& p) { return p.Curve(y); });
          },
          "y"_a, Doc("LandingProblem::Curve"))
      .def(
          "boundary_facts",
          [](OwnLanding& self) {
            return Facts(Alone(self, [](LandingProblem& p) { return p.boundary_facts(); }));
          },
          Doc("BoundaryFacts"));
  m.def("check_term", &CheckTerm, "term"_a, "registries"_a = py::none(), "trials"_a = 8,
        "seed"_a = 1,
        "Compares the derivatives of a term, a class of one's own or the name of one of "
        "`registries`, with central "
        "differences: on every view, as cost and as rows, in random landings. Raises ValueError "
        "that says what is "
        "wrong; else gives a list of dictionaries, the worst relative errors of each kind.");
}

}  // namespace touchdown::binding
