// SPDX-License-Identifier: BSD-3-Clause
// Scenarios and flights. Documents go to Python as the program's JSON, which touchdown's Python reads.
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "evaluation/base/machine.h"
#include "evaluation/binding/bind.h"
#include "evaluation/binding/call.h"
#include "evaluation/binding/part_registries.h"
#include "evaluation/campaign/sweep.h"
#include "evaluation/compare/compare_table.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/record/plan_case.h"
#include "evaluation/record/plan_report.h"
#include "evaluation/record/record.h"
#include "evaluation/record/trial_json.h"
#include "evaluation/scenario/scenario_world.h"
#include "sim/vehicle/vehicle_file.h"
#include "touchdown/evaluation/base/shipped_files.h"
#include "touchdown/evaluation/scenario/scenario.h"

namespace touchdown::binding {

using namespace pybind11::literals;
using evaluation::Scenario;

namespace {

/// Ctrl-C, or an error of Python code that the flight called.
struct Ended {};

evaluation::Registries Of(const PartRegistries* registries) {
  return registries != nullptr ? registries->all : evaluation::StandardRegistries();
}

Scenario Load(const py::object& given, const std::vector<std::string>& overrides,
              const PartRegistries* registries) {
  const std::string name_or_path = PathOf(given);
  const evaluation::Registries parts = Of(registries);
  return WithoutLock([&] {
    return evaluation::LoadScenario(evaluation::FindScenario(name_or_path), overrides, parts);
  });
}

Scenario Parse(const std::string& yaml, const std::vector<std::string>& overrides,
               const PartRegistries* registries) {
  const evaluation::Registries parts = Of(registries);
  return WithoutLock(
      [&] { return evaluation::ParseScenario(yaml, "own", "the dictionary", overrides, parts); });
}

/// The `land --json` document; a record where there is a path.
std::string Run(const Scenario& scenario, const PartRegistries* registries,
                const std::string& record_path) {
  const evaluation::Registries parts = Of(registries);
  return WithoutLock([&]() -> std::string {
    evaluation::TrialRecord record;
    const auto end = [call = Call::Now()] {
      if (call->MustEnd()) throw Ended();
    };
    const bool recorded = !record_path.empty();
    try {
      const evaluation::TrialResult result = evaluation::RunTrial(
          scenario, scenario.seed, parts, recorded ? &record : nullptr, nullptr, nullptr, end);
      if (recorded) evaluation::WriteRecord(record_path, scenario, result, record);
      return evaluation::LandJson(scenario, result).dump();
    } catch (const Ended&) {
      return "";  // the call raises
    }
  });
}

/// The `plan --json` document of a recorded step.
std::string Explain(const std::string& record, int step, const std::vector<std::string>& overrides,
                    const PartRegistries* registries) {
  const evaluation::Registries parts = Of(registries);
  return WithoutLock([&] {
    const evaluation::RecordedFlight flight = evaluation::ReadRecord(record, overrides, parts);
    const int steps = static_cast<int>(flight.plans.size());
    if (step < 0 || step >= steps) {
      throw py::index_error("step is " + std::to_string(step) + ", the record has the steps 0 to " +
                            std::to_string(steps - 1));
    }
    evaluation::SolvedStep solved = evaluation::SolveStep(flight, step, parts);
    solved.source = "step " + std::to_string(step) + " of " + record;
    solved.same = evaluation::Same(solved.outcome, solved.recorded.result);
    return evaluation::PlanJson(solved, false).dump();
  });
}

/// A sweep in this process. Its rows are in the file `db`.
void Sweep(const std::string& scenario_path, const std::vector<std::string>& overrides,
           const std::vector<std::string>& variations, int trials, std::uint64_t seed,
           const std::string& db, const PartRegistries* registries, const py::object& progress) {
  const evaluation::Registries parts = Of(registries);
  evaluation::SweepOptions options;
  options.scenario_path = evaluation::FindScenario(scenario_path);
  options.overrides = overrides;
  for (const std::string& text : variations) {
    options.variations.push_back(evaluation::Variation::Parse(text, parts));
  }
  options.trials = trials;
  options.seed = seed;
  const evaluation::Campaign campaign =
      WithoutLock([&] { return evaluation::SweepCampaign(options, parts); });
  const Kept tell(progress);
  const auto fly = [&](const evaluation::SweepTrial& trial) {
    // What a part raises is the trial's own error; Ctrl-C ends the sweep.
    Call call;
    try {
      return evaluation::RunTrial(trial.scenario, trial.seed, parts, nullptr, nullptr, nullptr,
                                  [&] {
                                    if (call.MustEnd()) throw Ended();
                                  });
    } catch (const Ended&) {
    } catch (const std::exception& error) {
      if (!call.failed()) return evaluation::FailedTrial(trial, error.what());
    }
    if (call.interrupted()) throw Ended();
    return evaluation::FailedTrial(trial, call.what());
  };
  WithoutLock([&] {
    evaluation::CampaignOptions flown;
    flown.db = db;
    try {
      evaluation::FlyHere(campaign, flown, fly, [&](const evaluation::CampaignState& state) {
        WithLock([&] {
          if (!tell.get().is_none()) tell.get()(state.all, state.flown, state.succeeded);
        });
      });
    } catch (const Ended&) {
    }
  });
}

/// A comparison in this process, of all that registries hold. Its tables are in the file `db`.
void Compare(const evaluation::CompareOptions& options, const std::string& db,
             const PartRegistries& registries, const py::object& progress) {
  const Kept tell(progress);
  evaluation::Registries parts = registries.all;
  WithoutLock([&] {
    const auto end = [call = Call::Now()] {
      if (call->MustEnd()) throw Ended();
    };
    parts.backends =
        solvers::Overheard(parts.backends, [&](const solvers::SolveRequest&) { end(); });
    try {
      evaluation::MachineState machine;
      machine.load_before = evaluation::LoadAverage();
      const evaluation::CompareResult result =
          evaluation::RunCompare(options, parts, [&](int done, int all) {
            WithLock([&] {
              if (!tell.get().is_none()) tell.get()(done, all);
            });
            end();
          });
      machine.load_after = evaluation::LoadAverage();
      evaluation::WriteCompareTable(db, options, result, machine);
    } catch (const Ended&) {
    }
  });
}

void CompareByWords(const py::dict& given, const std::string& db, const PartRegistries& registries,
                    const py::object& progress) {
  evaluation::CompareOptions options;
  const auto take = [&](const char* name, auto* to) {
    if (!given.contains(name) || given[name].is_none()) return;
    *to = given[name].cast<std::decay_t<decltype(*to)>>();
  };
  take("source", &options.from);
  take("seed", &options.seed);
  take("set", &options.set);
  take("problems", &options.problems);
  take("every", &options.every);
  take("backends", &options.bench.backends);
  take("gap", &options.bench.gap);
  take("repeats", &options.bench.repeats);
  take("deadline_ms", &options.bench.deadline_ms);
  take("backend_seconds", &options.bench.backend_seconds);
  options.bench.seed = options.seed;
  Compare(options, db, registries, progress);
}

}  // namespace

void BindFlight(py::module_& m) {
  py::class_<Scenario>(
      m, "Scenario",
      "A scenario: a flight's world, vehicle, sensors and planner (docs/scenario.md).")
      .def_static("load", &Load, "name_or_path"_a, "overrides"_a = std::vector<std::string>(),
                  "registries"_a = py::none(),
                  "A shipped scenario by its name, or a file; `overrides` as `--set` takes them. "
                  "Raises BadInput.")
      .def_static("parse", &Parse, "yaml"_a, "overrides"_a = std::vector<std::string>(),
                  "registries"_a = py::none(), "The text of a scenario file. Raises BadInput.")
      .def_readonly("name", &Scenario::name, "Its file's.")
      .def_readonly("description", &Scenario::description, "In the file's words.")
      .def_readwrite("seed", &Scenario::seed, "Of what is drawn.")
      .def_readonly("planner", &Scenario::planner, "Name of the planner.")
      .def(
          "vehicle_model",
          [](const Scenario& s) { return sim::LoadVehicleModel(evaluation::VehicleMjcf(s)); },
          "What planner and controller know of its vehicle.")
      .def_property_readonly("yaml", &evaluation::DumpScenario, Doc("DumpScenario"))
      .def("__repr__", [](const Scenario& s) {
        return "Scenario(" + s.name + ", planner " + s.planner + ", seed " +
               std::to_string(s.seed) + ")";
      });
  m.def("_run", &Run, "scenario"_a, "registries"_a, "record"_a);
  m.def("_explain", &Explain, "record"_a, "step"_a, "overrides"_a, "registries"_a);
  m.def("_sweep", &Sweep, "scenario"_a, "overrides"_a, "variations"_a, "trials"_a, "seed"_a, "db"_a,
        "registries"_a, "progress"_a);
  m.def("_compare", &CompareByWords, "options"_a, "db"_a, "registries"_a, "progress"_a);
  m.def("_use_share", &evaluation::UseShare, "directory"_a);
  m.def("scenarios", &evaluation::ListScenarios, Doc("ListScenarios"));
}

}  // namespace touchdown::binding
