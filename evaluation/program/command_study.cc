// SPDX-License-Identifier: BSD-3-Clause
// touchdown study: the standing studies. `replan`: the replanner's latency, success and safety in
// random forests, and how faithful its baseline is. The others: command_study_run.cc,
// command_study_hostile.cc, command_study_pad.cc and command_study_tags.cc.
#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/machine.h"
#include "evaluation/base/progress.h"
#include "evaluation/program/command_study_hostile.h"
#include "evaluation/program/command_study_pad.h"
#include "evaluation/program/command_study_run.h"
#include "evaluation/program/command_study_tags.h"
#include "evaluation/program/commands.h"
#include "evaluation/report/report_program.h"
#include "evaluation/studies/fidelity/ego_fidelity.h"
#include "evaluation/studies/replan/forest_flight_report.h"
#include "evaluation/studies/replan/oracle_verdicts.h"
#include "evaluation/studies/replan/replan_growth.h"
#include "evaluation/studies/replan/replan_report.h"
#include "evaluation/studies/replan/replan_study.h"
#include "evaluation/studies/replan/scene_sets.h"
#include "evaluation/studies/replan/step_sensitivity.h"

namespace touchdown::evaluation {
namespace {

struct StudyArguments {
  std::vector<std::string> parts = {"safety"};
  std::vector<std::string> sets = {"crossing"};
  std::vector<std::string> kinds = {"A", "B", "C", "D"};
  std::vector<std::string> planners = {"landing", "ego"};
  int flights = 100;
  std::string arrival = "fixed";
  std::string limits = "soft";
  ReplanStudyOptions options;
  std::optional<int> pin;
  std::string db;
  std::string picture;
  std::string verdicts;
  bool json = false;
  bool allow_debug = false;
};

planning::ArrivalMode ArrivalOf(const StudyArguments& arguments) {
  return arguments.arrival == "free" ? planning::ArrivalMode::kFree : planning::ArrivalMode::kFixed;
}

void RunSafety(const StudyArguments& arguments, const Registries& registries,
               std::vector<ReplanStudyPart>* parts) {
  const auto verdict = [verdicts = StandardOracleVerdicts()](const SceneOptions& scenes,
                                                             int index) {
    return verdicts.Find(scenes, index);
  };
  for (const std::string& set : arguments.sets) {
    for (const std::string& kind : arguments.kinds) {
      ReplanStudyPart part;
      part.part = "safety";
      part.options = arguments.options;
      part.options.scenes.set = set;
      part.options.scenes.kind = SceneKindNamed(kind);
      part.options.verdict = verdict;
      part.rows = RunReplanStudy(
          part.options, registries.backends,
          Progress({.things = "scenes", .of = fmt::format("{}, kind {}", set, kind)}));
      parts->push_back(std::move(part));
    }
  }
}

void RunGrowth(const StudyArguments& arguments, const Registries& registries,
               std::vector<ReplanStudyPart>* parts) {
  ReplanStudyOptions usual = arguments.options;
  usual.scenes.kind = SceneKindNamed(arguments.kinds.size() == 1 ? arguments.kinds.front() : "C");
  for (const GrowthPoint& point : GrowthPoints(usual)) {
    ReplanStudyPart part;
    part.part = "growth";
    part.varied = point.varied;
    part.options = point.options;
    const double value = VariedValue(point.varied, point.options.scenes);
    part.rows = RunReplanStudy(
        part.options, registries.backends,
        Progress({.things = "scenes", .of = fmt::format("{} = {:.4g}", point.varied, value)}));
    parts->push_back(std::move(part));
  }
}

/// The first calls of the EGO-Planner baseline beside those of the released program.
int RunFidelity(const StudyArguments& arguments) {
  const std::string path = EgoQuantilesPath();
  std::vector<EgoFidelityRow> rows;
  for (const std::string& name : arguments.kinds) {
    const SceneKind& kind = SceneKindNamed(name);
    const auto results = RunEgoScenes(kind, arguments.options.count, arguments.options.scenes.seed,
                                      Progress({.things = "scenes", .of = "kind " + name}));
    const auto compared = CompareWithUpstream(kind, results, path);
    rows.insert(rows.end(), compared.begin(), compared.end());
  }
  if (arguments.json) {
    std::cout << EgoFidelityJson(rows, arguments.options.scenes.seed).dump(2) << std::endl;
  } else {
    std::cout << EgoFidelityText(rows) << std::flush;
  }
  return Faithful(rows) ? kDone : kFellShort;
}

/// Whole flights, of this project's planner and of the baseline.
int RunFlights(const StudyArguments& arguments, const Registries& registries) {
  CheckTimings(arguments.allow_debug);
  CheckOutputs(arguments.db, "");
  std::vector<ForestFlightPart> parts;
  bool all_reached = true;
  for (const std::string& kind : arguments.kinds) {
    for (const std::string& planner : arguments.planners) {
      ForestFlightPart part;
      part.options.kind = SceneKindNamed(kind);
      part.options.ego = planner == "ego";
      part.options.replanner = arguments.options.replanner;
      part.options.replanner.problem.terms = registries.terms;
      part.options.seed = arguments.options.scenes.seed;
      Progress progress({.things = "flights", .of = fmt::format("kind {}, {}", kind, planner)});
      for (int index = 0; index < arguments.flights; ++index) {
        part.flights.push_back(FlyThroughForest(part.options, registries.backends, index));
        const bool reached = part.flights.back().outcome == FlightOutcome::kReached;
        all_reached = all_reached && (reached || part.options.ego);
        progress(index + 1, arguments.flights);
      }
      parts.push_back(std::move(part));
    }
  }
  if (arguments.json) {
    std::cout << ForestFlightJson(parts).dump(2) << std::endl;
  } else {
    std::cout << ForestFlightText(parts) << std::flush;
  }
  if (!arguments.db.empty()) WriteForestFlights(arguments.db, parts);
  return all_reached ? kDone : kFellShort;
}

/// The effect of each constant of the step, over all sets and kinds.
int RunSensitivity(const StudyArguments& arguments, const Registries& registries) {
  CheckTimings(arguments.allow_debug);
  if (arguments.pin) PinToCpu(*arguments.pin);
  std::vector<ReplanStudyOptions> parts;
  for (const std::string& set : arguments.sets) {
    for (const std::string& kind : arguments.kinds) {
      ReplanStudyOptions& part = parts.emplace_back(arguments.options);
      part.replanner.problem.terms = registries.terms;
      part.replanner.arrival = ArrivalOf(arguments);
      part.scenes.set = set;
      part.scenes.kind = SceneKindNamed(kind);
    }
  }
  const std::vector<SensitivityRow> rows =
      MeasureSensitivity(parts, registries.backends, Progress({.things = "parts"}));
  if (arguments.json) {
    std::cout << SensitivityJson(rows).dump(2) << std::endl;
  } else {
    std::cout << SensitivityText(rows) << std::flush;
  }
  return kDone;
}

/// A part that excludes all others, and the options that it takes.
struct ExclusivePart {
  const char* name;
  std::vector<const char*> options;
};

const std::vector<ExclusivePart>& ExclusiveParts() {
  static const std::vector<ExclusivePart> parts = {
      {"fidelity", {"--parts", "--scenes", "--kinds", "--seed", "--json"}},
      {"flights",
       {"--parts", "--flights", "--planners", "--kinds", "--seed", "--backend", "--guides", "--db",
        "--json", "--allow-debug"}},
      {"sensitivity",
       {"--parts", "--sets", "--scenes", "--kinds", "--seed", "--backend", "--guides", "--arrival",
        "--pin", "--json", "--allow-debug"}}};
  return parts;
}

void CheckExclusive(const ExclusivePart& part, const StudyArguments& arguments,
                    const Command& command) {
  if (arguments.parts.size() > 1)
    throw BadInput(fmt::format("--parts: {} cannot be combined with other parts.", part.name));
  for (const std::string& name : command.Given()) {
    const bool fits =
        std::find(part.options.begin(), part.options.end(), name) != part.options.end();
    if (fits) continue;
    throw BadInput(fmt::format("{} cannot be used with --parts {}.", name, part.name));
  }
}

bool Named(const std::vector<std::string>& list, const char* name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// Options that change nothing beside the others are refused. @throws BadInput
void CheckEffects(const StudyArguments& arguments, const Command& command) {
  const bool flights = Named(arguments.parts, "flights");
  for (const char* option : {"--flights", "--planners"}) {
    if (!command.Given(option) || flights) continue;
    throw BadInput(fmt::format("{} needs --parts flights.", option));
  }
  for (const char* option : {"--backend", "--guides"}) {
    if (!command.Given(option) || !flights || Named(arguments.planners, "landing")) continue;
    throw BadInput(fmt::format("{} needs --planners landing.", option));
  }
  for (const char* option : {"--sets", "--later", "--oracle"}) {
    if (!command.Given(option) || Named(arguments.parts, "safety")) continue;
    if (Named(arguments.parts, "sensitivity")) continue;
    throw BadInput(fmt::format("{} needs --parts safety.", option));
  }
  if (command.Given("--verdicts") && !command.Given("--oracle")) {
    throw BadInput("--verdicts needs --oracle.");
  }
  const bool only_growth = Named(arguments.parts, "growth") && !Named(arguments.parts, "safety");
  if (only_growth && command.Given("--kinds") && arguments.kinds.size() != 1) {
    throw BadInput("--kinds: the part growth takes one kind.");
  }
  for (const ExclusivePart& part : ExclusiveParts()) {
    if (Named(arguments.parts, part.name)) CheckExclusive(part, arguments, command);
  }
}

/// No accepted plan that was looked at collides or is beyond a limit.
bool AllSafe(const std::vector<ReplanStudyPart>& parts) {
  return std::all_of(parts.begin(), parts.end(), [](const ReplanStudyPart& part) {
    return std::all_of(std::begin(kSceneSteps), std::end(kSceneSteps), [&](SceneStep step) {
      const ReplanSummary summary = Summarise(part.rows, step);
      return summary.colliding == 0 && summary.beyond_limits == 0;
    });
  });
}

int Study(StudyArguments arguments, const Registries& registries) {
  CheckTimings(arguments.allow_debug);
  CheckOutputs(arguments.db, arguments.picture);
  if (!arguments.picture.empty() && !Named(arguments.parts, "growth")) {
    throw BadInput("--picture needs --parts growth.");
  }
  planning::ReplannerOptions& replanner = arguments.options.replanner;
  replanner.problem.terms = registries.terms;
  replanner.arrival = ArrivalOf(arguments);
  replanner.problem.limits_mode =
      arguments.limits == "hard" ? planning::LimitsMode::kHard : planning::LimitsMode::kSoft;
  MachineState machine;
  machine.pinned = arguments.pin;
  if (arguments.pin) PinToCpu(*arguments.pin);
  machine.load_before = LoadAverage();
  std::vector<ReplanStudyPart> parts;
  if (Named(arguments.parts, "safety")) RunSafety(arguments, registries, &parts);
  if (Named(arguments.parts, "growth")) RunGrowth(arguments, registries, &parts);
  machine.load_after = LoadAverage();
  if (arguments.json) {
    std::cout << ReplanStudyJson(parts, machine).dump(2) << std::endl;
  } else {
    std::cout << ReplanStudyText(parts) << std::flush;
  }
  const auto write = [&](const std::string& path) { WriteReplanStudy(path, parts, machine); };
  if (!arguments.db.empty()) write(arguments.db);
  if (!arguments.verdicts.empty()) {
    OracleVerdicts verdicts;
    for (const ReplanStudyPart& part : parts) {
      if (part.varied.empty()) verdicts.Add(part.options.scenes, part.rows);
    }
    verdicts.Write(arguments.verdicts);
  }
  if (!arguments.picture.empty()) DrawFrom(arguments.db, arguments.picture, write, DrawGrowth);
  return AllSafe(parts) ? kDone : kFellShort;
}

}  // namespace

void AddStudyCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command study = app.AddCommand("study", "The standing studies", "evaluation_protocol.md");
  study.RequireCommand();
  AddHostileStudyCommand(study, registries, run);
  AddPadStudyCommand(study, registries, run);
  AddStudyRunCommands(study, registries, run);
  AddTagStudyCommand(study, run);
  const Command command = study.AddCommand(
      "replan", "Latency, success and safety of replanning steps in random forests",
      "replan_study.md");
  const auto arguments = std::make_shared<StudyArguments>();
  ReplanStudyOptions& options = arguments->options;
  command.AddList(
      "--parts", &arguments->parts,
      "Parts of the study. growth takes one kind, C by default. flights (36 m), fidelity (of the "
      "EGO-Planner baseline) and sensitivity (to each constant of a step) run alone",
      "safety,growth,...", OneOf({"safety", "growth", "flights", "fidelity", "sensitivity"}));
  command.Add("--scenes", options.count, "Scenes of each kind")
      .Check(Range(1, 100000))
      .ShowDefault();
  command.AddList("--sets", &arguments->sets, "Sets of scenes, of the parts safety and sensitivity",
                  "crossing,...", OneOf(SceneSetNames()));
  command.AddFlag("--later", options.later,
                  "Ask for the steps 0.1 and 0.2 s after the first one, too");
  command.AddFlag(
      "--oracle", options.oracle,
      "Search in each scene whether a plan exists, up to seconds; default: the stored verdicts");
  command.AddFile("--verdicts", &arguments->verdicts,
                  "Write what the oracle says, a letter a scene", "F.csv");
  command.AddList("--kinds", &arguments->kinds, "Kinds of scenes", "A,B,...",
                  OneOf({"A", "B", "C", "D"}));
  command.Add("--flights", arguments->flights, "Flights of each kind and planner")
      .Check(Range(1, 100000))
      .ShowDefault();
  command.AddList("--planners", &arguments->planners, "Whose flights", "landing,ego",
                  OneOf({"landing", "ego"}));
  command.Add("--backend", options.replanner.backend, "Solver backend")
      .Check(OneOf(BackendNames(registries)))
      .ShowDefault();
  command.Add("--arrival", arguments->arrival, "Arrival time")
      .Check(OneOf({"fixed", "free"}))
      .ShowDefault();
  command.Add("--limits", arguments->limits, "As a penalty, or as constraints")
      .Check(OneOf({"soft", "hard"}))
      .ShowDefault();
  command.Add("--guides", options.replanner.max_guides, "Most guide paths to try")
      .Check(Range(1, 8))
      .ShowDefault();
  command.Add("--max-work", options.replanner.max_work, "Units of work that a step may do at most")
      .Check(Range(1000, 1000000))
      .ShowDefault();
  command.Add("--horizon", options.scenes.horizon, "Start to end [m]")
      .Check(Range(3.0, 40.0))
      .ShowDefault();
  command.Add("--resolution", options.scenes.resolution, "Of the map [m]")
      .Check(Range(0.05, 0.4))
      .ShowDefault();
  command.Add("--repeats", options.repeats, "Timed steps of each scene; the median counts")
      .Check(Range(1, 1000))
      .ShowDefault();
  command.Add("--seed", options.scenes.seed, "Seed of the scenes")
      .Check(Range(std::uint64_t{0}, std::uint64_t{1} << 53))
      .ShowDefault();
  command.Add("--pin", arguments->pin, "Run on this CPU only").Check(Range(0, 1023));
  command.AddFile("--db", &arguments->db, "Write every step, an SQLite file", "F.db");
  command.AddFile("--picture", &arguments->picture, "Draw the part growth", "F.png");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.AddFlag("--allow-debug", arguments->allow_debug, "Time a build that is not optimised");
  command.OnChosen([arguments, &registries, run, command] {
    *run = [arguments, &registries, command] {
      CheckEffects(*arguments, command);
      if (Named(arguments->parts, "fidelity")) return RunFidelity(*arguments);
      if (Named(arguments->parts, "flights")) return RunFlights(*arguments, registries);
      if (Named(arguments->parts, "sensitivity")) return RunSensitivity(*arguments, registries);
      return Study(*arguments, registries);
    };
  });
}

}  // namespace touchdown::evaluation
