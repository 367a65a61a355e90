// SPDX-License-Identifier: BSD-3-Clause
// One replanning step, its proof, and its attempts.
#include <map>
#include <memory>

#include <nlohmann/json.hpp>

#include "evaluation/binding/bind.h"
#include "evaluation/binding/call.h"
#include "evaluation/binding/map_view.h"
#include "evaluation/binding/part_registries.h"
#include "evaluation/binding/predictions.h"
#include "evaluation/binding/replanned.h"
#include "evaluation/record/step_json.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::binding {

using namespace pybind11::literals;
using planning::ReplanInput;
using planning::ReplannerOptions;
using planning::ReplanResult;

namespace {

/// A replanner with the registries that its backends and terms are from.
class OwnReplanner {
 public:
  OwnReplanner(const ReplannerOptions& options, const PartRegistries* registries)
      : use("Replanner"), planner_(Made(With(options, registries))) {}

  ~OwnReplanner() {
    const CallGuard under_way;
    const py::gil_scoped_release release;  // a backend may wait for another one's solve
    planner_.reset();
  }
  OwnReplanner(const OwnReplanner&) = delete;
  OwnReplanner& operator=(const OwnReplanner&) = delete;

  void CommitHover(const Eigen::Vector3d& p_W, double t) {
    const InUse::Claim claim(use);
    if (!p_W.allFinite() || !std::isfinite(t)) throw py::value_error("p_W and t must be finite");
    WithoutLock([&] { planner_->CommitHover(p_W, t); });
    hovers_ = true;
  }

  std::unique_ptr<Replanned> Replan(const MapView& map, const ReplanInput& input,
                                    const py::object& pad, bool explain) {
    return Ask(map, input, pad, explain, [&](const ReplanInput& asked) -> const ReplanResult& {
      return planner_->Replan(asked, map.get());
    });
  }
  std::unique_ptr<Replanned> Rest(const MapView& map, const ReplanInput& input,
                                  const py::object& pad, double climb, bool explain) {
    if (!std::isfinite(climb)) throw py::value_error("climb must be finite");
    return Ask(map, input, pad, explain, [&](const ReplanInput& asked) -> const ReplanResult& {
      return planner_->Rest(asked, climb, map.get());
    });
  }

  void TakeOverAt(double t) {
    const InUse::Claim claim(use);
    planner_->TakeOverAt(t);
  }
  planning::FlatState Reference(double t) {
    const InUse::Share share(use);
    if (!hovers_) throw py::value_error("reference before commit_hover: nothing is flown");
    return planner_->Reference(t);
  }

  InUse use;

 private:
  static ReplannerOptions With(ReplannerOptions options, const PartRegistries* registries) {
    if (registries != nullptr) options.problem.terms = registries->all.terms;
    return options;
  }

  template <class Question>
  std::unique_ptr<Replanned> Ask(const MapView& map, ReplanInput input, const py::object& pad,
                                 bool explain, const Question& question) {
    const InUse::Claim claim(use);
    const InUse::Share share(map.use);
    const auto prediction = pad.is_none() ? nullptr : PredictionOf(pad);
    input.pad = prediction.get();
    auto replanned = std::make_unique<Replanned>();
    planning::ReplanLog log;
    planner_->set_log(explain ? &log : nullptr);
    try {
      WithoutLock([&] { replanned->result = question(input); });
    } catch (...) {
      planner_->set_log(nullptr);
      throw;
    }
    planner_->set_log(nullptr);
    replanned->Keep();
    if (explain) replanned->attempts = evaluation::AttemptsJson(log).dump();
    return replanned;
  }

  static std::unique_ptr<planning::Replanner> Made(const ReplannerOptions& options) {
    return WithoutLock([&] {
      return std::make_unique<planning::Replanner>(options, solvers::StandardBackends());
    });
  }

  std::unique_ptr<planning::Replanner> planner_;
  bool hovers_ = false;
};

py::object FromJson(const std::string& text) {
  return py::module_::import("json").attr("loads")(text);
}

py::dict Times(const Replanned& r) {
  py::dict times;
  const auto add = [&](const planning::StageTimes::Span& span) {
    times[span.stage] = py::dict("wall_s"_a = span.wall, "allocations"_a = span.allocations);
  };
  for (const auto* stage : r.result.times.Stages()) add(*stage);
  add(r.result.times.total);
  return times;
}

void BindOptions(py::module_& m) {
  using Options = ReplannerOptions;
  Plain<Options>(m, "ReplannerOptions")
      .Field("backend", &Options::backend)
      .Field(
          "solver_options",
          [](const Options& o) {
            py::dict options;
            for (const auto& [name, value] : o.solver_options) options[py::str(name)] = value;
            return options;
          },
          [](Options& o, const std::map<std::string, double>& options) {
            o.solver_options.assign(options.begin(), options.end());
          })
      .Field("arrival", &Options::arrival)
      .Field("limits", &Options::limits)
      .Field("floor_height", &Options::floor_height)
      .Field("ceiling_height", &Options::ceiling_height)
      .Field("pad_radius", &Options::pad_radius)
      .Field("contact_height", &Options::contact_height)
      .Field("max_duration", &Options::max_duration)
      .Field("min_duration", &Options::min_duration)
      .Field("min_contact_duration", &Options::min_contact_duration)
      .Field("odometry_threshold", &Options::odometry_threshold)
      .Field("reaction", &Options::reaction)
      .Field("segment_length", &Options::segment_length)
      .Field("hull_radius", &Options::hull_radius)
      .Field("deck_half_size", &Options::deck_half_size)
      .Field("vertical_cost", &Options::vertical_cost)
      .Field("max_guides", &Options::max_guides)
      .Field("warm_start", &Options::warm_start)
      .Field("max_rebinds", &Options::max_rebinds)
      .Field("max_iterations", &Options::max_iterations)
      .Field("gap", &Options::gap)
      .Field("max_work", &Options::max_work)
      .Field(
          "terms",
          [](const Options& o) {
            py::dict terms;
            for (const planning::TermSettings& settings : o.problem.settings) {
              py::dict keys;
              if (settings.weight) keys["weight"] = *settings.weight;
              if (settings.hard) keys["hard"] = *settings.hard;
              for (const auto& [key, value] : settings.parameters) keys[py::str(key)] = value;
              terms[py::str(settings.name)] = keys;
            }
            return terms;
          },
          [](Options& o, const py::dict& terms) { o.problem.settings = TermSettingsOf(terms); },
          "{name: {\"weight\": ..., \"hard\": ..., parameter: ...}}, where terms differ from their "
          "entries' defaults.")
      .Field(
          "limits_mode", [](const Options& o) { return o.problem.limits_mode; },
          [](Options& o, planning::LimitsMode mode) { o.problem.limits_mode = mode; },
          Doc("LimitsMode"))
      .Field(
          "endpoint", [](const Options& o) { return o.problem.endpoint; },
          [](Options& o, planning::EndpointMode mode) { o.problem.endpoint = mode; },
          Doc("EndpointMode"))
      .Done();
}

void BindCertificate(py::module_& m) {
  using planning::Certificate;
  py::class_<Certificate> certificate(m, "Certificate", Doc("Certificate"));
  const auto field = [&](const char* name, auto member) {
    certificate.def_readonly(name, member, Doc(std::string("Certificate::") + name));
  };
  field("endpoint_required", &Certificate::endpoint_required);
  field("endpoint_tolerance", &Certificate::endpoint_tolerance);
  field("start_position_residual", &Certificate::start_position_residual);
  field("start_velocity_residual", &Certificate::start_velocity_residual);
  field("endpoint_position_residual", &Certificate::endpoint_position_residual);
  field("endpoint_velocity_residual", &Certificate::endpoint_velocity_residual);
  field("earlier", &Certificate::earlier);
  field("speed_bound", &Certificate::speed_bound);
  certificate.def_readonly("acceleration_bound", &Certificate::acceleration_bound, "[m/s^2]");
  certificate.def_readonly("body_rate_bound", &Certificate::body_rate_bound, "[rad/s]");
  field("limits_kept", &Certificate::limits_kept);
  field("recovering", &Certificate::recovering);
  field("clear", &Certificate::clear);
  field("escaping", &Certificate::escaping);
  field("stops_in_observed_space", &Certificate::stops_in_observed_space);
  field("clearance", &Certificate::clearance);
  field("first_hit_t", &Certificate::first_hit_t);
  certificate
      .def_property_readonly("passed", &Certificate::passed, "All that is needed to be flown.")
      .def("__repr__", [](const Certificate& c) {
        return "Certificate(" + evaluation::CertificateJson(c).dump() + ")";
      });
}

}  // namespace

void BindReplanned(py::module_& m) {
  py::class_<Replanned>(m, "ReplanResult", Doc("ReplanResult"))
      .def_property_readonly(
          "status", [](const Replanned& r) { return r.result.status; }, Doc("ReplanStatus"))
      .def_property_readonly(
          "reason", [](const Replanned& r) { return r.result.reason; }, Doc("ReplanReason"))
      .def_property_readonly(
          "explanation",
          [](const Replanned& r) -> std::string {
            return r.result.reason == planning::ReplanReason::kNone
                       ? planning::Explain(r.result.status)
                       : planning::Explain(r.result.reason);
          },
          "One sentence on the reason; without one, on the status.")
      .def_readonly("detail", &Replanned::detail, Doc("ReplanResult::detail"))
      .def_property_readonly(
          "committed", [](const Replanned& r) { return r.result.committed; },
          Doc("ReplanResult::committed"))
      .def_property_readonly(
          "curve", [](const Replanned& r) { return r.result.curve; },
          "What is flown from its start on.")
      .def_property_readonly(
          "stop", [](const Replanned& r) { return r.result.stop; },
          "The stop that was proven with it.")
      .def_property_readonly(
          "t_stop", [](const Replanned& r) { return r.result.t_stop; }, Doc("FlightPair::t_stop"))
      .def_property_readonly(
          "certificate", [](const Replanned& r) { return r.result.certificate; },
          "What is proven of the curve.")
      .def_property_readonly(
          "ends_in_contact", [](const Replanned& r) { return r.result.ends_in_contact; },
          Doc("ReplanResult::ends_in_contact"))
      .def_property_readonly(
          "from_odometry", [](const Replanned& r) { return r.result.from_odometry; },
          Doc("ReplanResult::from_odometry"))
      .def_property_readonly(
          "map_error", [](const Replanned& r) { return r.result.map_error; },
          Doc("ReplanResult::map_error"))
      .def_property_readonly(
          "unseen_W", [](const Replanned& r) { return r.result.unseen_W; },
          Doc("ReplanResult::unseen_W"))
      .def_property_readonly(
          "guide_paths",
          [](const Replanned& r) {
            py::list paths;
            for (const auto& path : r.result.guide_paths) {
              Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> points(
                  static_cast<Eigen::Index>(path.size()), 3);
              for (std::size_t i = 0; i < path.size(); ++i) {
                points.row(static_cast<Eigen::Index>(i)) = path[i].transpose();
              }
              paths.append(py::cast(points));
            }
            return paths;
          },
          "Ways around obstacles that were searched for, each of shape (n, 3) in W [m].")
      .def_property_readonly(
          "pairs", [](const Replanned& r) { return r.result.pairs; }, Doc("ReplanResult::pairs"))
      .def_property_readonly(
          "solves", [](const Replanned& r) { return r.result.solves; }, Doc("ReplanResult::solves"))
      .def_property_readonly(
          "rebinds", [](const Replanned& r) { return r.result.rebinds; },
          Doc("ReplanResult::rebinds"))
      .def_property_readonly(
          "work", [](const Replanned& r) { return r.result.work; }, Doc("ReplanResult::work"))
      .def_property_readonly(
          "cost", [](const Replanned& r) { return r.result.solver.cost; },
          "Of the last solve of that plan.")
      .def_property_readonly(
          "iterations", [](const Replanned& r) { return r.result.solver.iterations; },
          "Of the last solve of that plan.")
      .def_property_readonly(
          "attempts",
          [](const Replanned& r) -> py::object {
            if (r.attempts.empty()) return py::none();
            return FromJson(r.attempts);
          },
          "What the step tried, with `explain=True`: as `touchdown plan --json` has it under "
          "`attempts`.")
      .def_property_readonly("times", &Times, Doc("StageTimes"))
      .def("__repr__", [](const Replanned& r) {
        return std::string("ReplanResult(status='") + planning::ToString(r.result.status) +
               "', reason='" + planning::ToString(r.result.reason) + "')";
      });
}

void BindReplan(py::module_& m) {
  BindOptions(m);
  BindCertificate(m);
  BindReplanned(m);
  using planning::Margins;
  Plain<Margins>(m, "Margins")
      .Field("own_state", &Margins::own_state)
      .Field("attitude", &Margins::attitude)
      .Field("tracking", &Margins::tracking)
      .Done();
  Plain<ReplanInput>(m, "ReplanInput")
      .Field("t_now", &ReplanInput::t_now)
      .Field("t_start", &ReplanInput::t_start)
      .Field("vehicle", &ReplanInput::vehicle)
      .Field("endpoint", &ReplanInput::endpoint, Doc("EndpointTarget"))
      .Field("look_from_W", &ReplanInput::look_from_W)
      .Field("pull_W", &ReplanInput::pull_W)
      .Field("margins", &ReplanInput::margins)
      .Done();
  py::class_<OwnReplanner>(m, "Replanner", Doc("Replanner"))
      .def(py::init<const ReplannerOptions&, const PartRegistries*>(),
           "options"_a = ReplannerOptions(), "registries"_a = py::none(),
           Doc("Replanner::Replanner"))
      .def("commit_hover", &OwnReplanner::CommitHover, "p_W"_a, "t"_a = 0.0,
           Doc("Replanner::CommitHover"))
      .def("replan", &OwnReplanner::Replan, "map"_a, "input"_a, "pad"_a, "explain"_a = false,
           Doc("Replanner::Replan"))
      .def("rest", &OwnReplanner::Rest, "map"_a, "input"_a, "pad"_a = py::none(), "climb"_a = 0.0,
           "explain"_a = false, Doc("Replanner::Rest"))
      .def("take_over_at", &OwnReplanner::TakeOverAt, "t"_a, Doc("Planner::TakeOverAt"))
      .def("reference", &OwnReplanner::Reference, "t"_a, Doc("Replanner::Reference"));
  m.def(
      "explain_reason",
      [](planning::ReplanReason reason) { return std::string(planning::Explain(reason)); },
      "reason"_a, "One sentence for people.");
}

}  // namespace touchdown::binding
