// SPDX-License-Identifier: BSD-3-Clause
// touchdown compare: solver backends on the same random landing problems, or on sets of known ones.
#include <algorithm>
#include <charconv>
#include <functional>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/commands.h"
#include "touchdown/evaluation/compare.h"
#include "touchdown/evaluation/compare_report.h"
#include "touchdown/evaluation/compare_table.h"
#include "touchdown/evaluation/machine.h"
#include "touchdown/evaluation/output_path.h"
#include "touchdown/evaluation/planner_options.h"
#include "touchdown/evaluation/progress.h"
#include "touchdown/evaluation/reference_compare.h"
#include "touchdown/evaluation/reference_table.h"
#include "touchdown/evaluation/report_program.h"
#include "touchdown/sim/forest.h"

namespace touchdown::evaluation {
namespace {

struct CompareArguments {
  CompareOptions options;
  std::string problem_set = "landing";
  ReferenceOptions references;  // of another set
  std::string start = "cold";
  std::string arrival = "fixed";
  std::string limits = "soft";
  std::string endpoint = "eliminated";
  std::string db;
  std::string picture;
  std::vector<std::string> set;
  std::optional<int> pin;
  bool json = false;
  bool allow_debug = false;

  CompareArguments() {
    // The limits that the published figures of the backends were measured with.
    options.cases.problem.limits = {4.0, 6.0};
  }
};

// D is B's map with a larger inflation, which is an option here.
std::vector<std::string> ComparedForests() {
  std::vector<std::string> kinds = sim::ForestKinds();
  std::erase(kinds, "D");
  return kinds;
}

/// "terms.reach.weight=3" becomes a setting of the problem.
planning::TermSettings ParseTermSetting(const std::string& text,
                                        const planning::TermRegistry& terms) {
  const std::size_t name = text.find('.'), key = text.find('.', name + 1), is = text.find('=');
  double value = 0.0;
  const bool shaped = text.starts_with("terms.") && key < is && is != std::string::npos;
  std::string number = shaped ? text.substr(is + 1) : "";
  if (number == "true") number = "1";
  if (number == "false") number = "0";
  const char* end = number.data() + number.size();
  const std::from_chars_result read = std::from_chars(number.data(), end, value);
  if (!shaped || read.ec != std::errc() || read.ptr != end || !std::isfinite(value)) {
    throw BadInput(fmt::format("--set {}: it must be terms.<term>.<key>=<number>.", text));
  }
  const std::string term = text.substr(name + 1, key - name - 1);
  const planning::TermSettings settings =
      TermSettingsOf(term, {{text.substr(key + 1, is - key - 1), value}});
  try {
    const planning::TermEntry& entry = planning::FindTerm(terms, term);
    planning::TermSetup setup = planning::DefaultSetup(entry, CaseMaker::kReferencePoints.front());
    planning::ApplySettings(entry, settings, &setup);
  } catch (const std::invalid_argument& error) {
    throw BadInput(fmt::format("--set {}: {}.", text, error.what()));
  }
  return settings;
}

/// Options that say nothing of what is asked for are refused, not ignored.
void CheckApplies(const Command& command, const std::string& set) {
  const bool landing = set == "landing";
  const std::vector<std::string> of_sets{"--problem-set", "--starts", "--backends",
                                         "--seed",        "--pin",    "--db",
                                         "--picture",     "--json",   "--allow-debug"};
  for (const std::string& name : command.Given()) {
    const bool of_set = std::find(of_sets.begin(), of_sets.end(), name) != of_sets.end();
    if (landing ? name != "--starts" : of_set) continue;
    throw BadInput(fmt::format("{} does not go with --problem-set {}.", name, set));
  }
}

MachineState BeginTiming(std::optional<int> pin) {
  MachineState machine;
  machine.pinned = pin;
  if (pin) PinToCpu(*pin);
  machine.load_before = LoadAverage();
  return machine;
}

/// The table and the picture that are asked for.
void Keep(const CompareArguments& arguments,
          void (*draw)(const std::string& table, const std::string& picture),
          const std::function<void(const std::string& path)>& write) {
  if (!arguments.db.empty()) write(arguments.db);
  if (!arguments.picture.empty()) DrawFrom(arguments.db, arguments.picture, write, draw);
}

int CompareReferences(CompareArguments arguments, const Registries& registries) {
  ReferenceOptions& options = arguments.references;
  options.set = arguments.problem_set;
  options.backends = arguments.options.backends;
  options.seed = arguments.options.cases.seed;
  CheckOutputs(arguments.db, arguments.picture);
  MachineState machine = BeginTiming(arguments.pin);
  const ReferenceResult result =
      RunReferences(options, registries.backends, Progress({.things = "problems"}));
  machine.load_after = LoadAverage();
  if (arguments.json) {
    std::cout << ReferenceJson(options, result).dump(2) << std::endl;
  } else {
    std::cout << ReferenceText(options, result) << std::flush;
  }
  Keep(arguments, DrawProblemSet,
       [&](const std::string& path) { WriteReferenceTable(path, options, result, machine); });
  return kDone;
}

int Compare(CompareArguments arguments, const Registries& registries) {
  CheckTimings(arguments.allow_debug);
  if (arguments.problem_set != "landing") return CompareReferences(arguments, registries);
  CompareOptions& options = arguments.options;
  std::sort(options.points.begin(), options.points.end());
  options.cases.warm = arguments.start == "warm";
  planning::LandingProblemOptions& problem = options.cases.problem;
  problem.terms = registries.terms;
  for (const std::string& text : arguments.set) {
    problem.settings.push_back(ParseTermSetting(text, registries.terms));
  }
  problem.arrival =
      arguments.arrival == "free" ? planning::ArrivalMode::kFree : planning::ArrivalMode::kFixed;
  problem.limits_mode =
      arguments.limits == "hard" ? planning::LimitsMode::kHard : planning::LimitsMode::kSoft;
  problem.endpoint = arguments.endpoint == "explicit" ? planning::EndpointMode::kExplicit
                                                      : planning::EndpointMode::kEliminated;
  CheckOutputs(arguments.db, arguments.picture);
  MachineState machine = BeginTiming(arguments.pin);
  const CompareResult result =
      RunCompare(options, registries.backends, Progress({.things = "problems"}));
  machine.load_after = LoadAverage();
  if (arguments.json) {
    std::cout << CompareJson(options, result, machine).dump(2) << std::endl;
  } else {
    std::cout << CompareText(options, result) << std::flush;
  }
  Keep(arguments, DrawComparison,
       [&](const std::string& path) { WriteCompareTable(path, options, result, machine); });
  return kDone;
}

}  // namespace

void AddCompareCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command command = app.AddCommand(
      "compare", "Compare solver backends on random landings, or on sets of known problems");
  const auto arguments = std::make_shared<CompareArguments>();
  CompareOptions& options = arguments->options;
  CaseOptions& cases = options.cases;
  command
      .Add("--problem-set", arguments->problem_set,
           "Random landings, or sets of known problems (docs/compare.md)")
      .Check(OneOf({"landing", "hs", "hs-pairs", "mgh", "shooting"}))
      .ShowDefault();
  command
      .Add("--starts", arguments->references.starts,
           "Of a known problem: the first is the published one, others are around it")
      .Check(Range(1, 1000))
      .ShowDefault();
  command.Add("--problems", options.problems, "Number of problems of each size")
      .Check(Range(1, 100000))
      .ShowDefault();
  command.AddList("--points", &options.points, "Control points: one size or several", "N,N,...",
                  Range(9, 1000));
  command.Add("--start", arguments->start, "From a Hermite guess, or shifted from 0.1 s ago")
      .Check(OneOf({"cold", "warm"}))
      .ShowDefault();
  command.Add("--arrival", arguments->arrival, "Arrival time")
      .Check(OneOf({"fixed", "free"}))
      .ShowDefault();
  command.Add("--limits", arguments->limits, "As a penalty, or as constraints")
      .Check(OneOf({"soft", "hard"}))
      .ShowDefault();
  command.Add("--endpoint", arguments->endpoint, "Eliminated, or as equality constraints")
      .Check(OneOf({"eliminated", "explicit"}))
      .ShowDefault();
  command.AddList(
      "--backends", &options.backends,
      "Which ones; default: all that can solve it. --problem-set shooting takes minutes with all",
      "NAME,NAME,...", OneOf(BackendNames(registries)));
  command
      .Add("--set", arguments->set,
           "Change a term: terms.<term>.<key>=<number>, as in a scenario; may be given again")
      .TypeName("KEY=VALUE")
      .OneWord();
  command.Add("--seed", cases.seed, "Seed of the problems")
      .Check(Range(std::uint64_t{0}, std::uint64_t{1} << 53))
      .ShowDefault();
  command.Add("--gap", options.gap, "Relative gap to the best known cost: solved")
      .Check(Range(1e-9, 1.0))
      .ShowDefault();
  command.Add("--repeats", options.repeats, "Timed solves of each problem; the median counts")
      .Check(Range(1, 1000))
      .ShowDefault();
  command.Add("--deadline-ms", options.deadline_ms, "Also stop solves after this wall time")
      .Check(Range(1e-3, 1e5));
  command.Add("--forest", cases.forest, "Kind of forest")
      .Check(OneOf(ComparedForests()))
      .ShowDefault();
  command.Add("--inflation", cases.inflation, "Obstacles are grown by this [m]")
      .Check(Range(0.0, 1.0))
      .ShowDefault();
  command.Add("--speed-limit", cases.problem.limits.speed, "[m/s]")
      .Check(Range(1.0, 30.0))
      .ShowDefault();
  command.Add("--acceleration-limit", cases.problem.limits.acceleration, "[m/s^2]")
      .Check(Range(1.0, 50.0))
      .ShowDefault();
  command
      .Add("--backend-seconds", options.backend_seconds,
           "A backend that used this much wall time at one size sits out the rest [s]")
      .Check(Range(0.1, 1e6))
      .ShowDefault();
  command.Add("--pin", arguments->pin, "Run on this CPU only").Check(Range(0, 1023));
  command.AddFile("--db", &arguments->db, "Write every solve, an SQLite file", "F.db");
  command.AddFile("--picture", &arguments->picture, "Draw performance profile, latency and scaling",
                  "F.png");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.AddFlag("--allow-debug", arguments->allow_debug, "Time a build that is not optimised");
  command.OnChosen([arguments, &registries, run, command] {
    CheckApplies(command, arguments->problem_set);
    *run = [arguments, &registries] { return Compare(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
