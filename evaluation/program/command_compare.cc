// SPDX-License-Identifier: BSD-3-Clause
// touchdown compare: solver backends on the problems that flights pose, or on sets of known ones.
#include <algorithm>
#include <functional>
#include <iostream>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/machine.h"
#include "evaluation/base/output_path.h"
#include "evaluation/base/progress.h"
#include "evaluation/compare/compare.h"
#include "evaluation/compare/compare_report.h"
#include "evaluation/compare/compare_table.h"
#include "evaluation/compare/reference_compare.h"
#include "evaluation/compare/reference_table.h"
#include "evaluation/program/commands.h"
#include "evaluation/record/record_reader.h"
#include "evaluation/report/report_program.h"

namespace touchdown::evaluation {
namespace {

struct CompareArguments {
  CompareOptions options;
  std::string problem_set = "landing";
  ReferenceOptions references;  // of another set
  std::string arrival, limits, endpoint;
  std::string db;
  std::string picture;
  std::optional<int> pin;
  bool json = false;
  bool allow_debug = false;
};

/// Options without an effect are refused, not ignored.
void CheckApplies(const Command& command, const CompareArguments& arguments) {
  const std::string& set = arguments.problem_set;
  const bool landing = set == "landing";
  const std::vector<std::string> of_sets{"--problem-set", "--starts", "--backends",
                                         "--seed",        "--pin",    "--db",
                                         "--picture",     "--json",   "--allow-debug"};
  for (const std::string& name : command.Given()) {
    const bool of_set = std::find(of_sets.begin(), of_sets.end(), name) != of_sets.end();
    if (landing ? name != "--starts" : of_set) continue;
    throw BadInput(fmt::format("{} cannot be used with --problem-set {}.", name, set));
  }
  if (command.Given("--seed") && command.Given("--from")) {
    throw BadInput("--seed cannot be used with --from: the flights have their own.");
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
  options.backends = arguments.options.bench.backends;
  options.seed = arguments.options.seed;
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
  options.bench.seed = options.seed;
  for (const auto& [key, value] : {std::pair("solver.arrival", arguments.arrival),
                                   std::pair("solver.limits", arguments.limits),
                                   std::pair("solver.endpoint", arguments.endpoint)}) {
    if (value.empty()) continue;
    for (const std::string& text : options.set) {
      if (text.rfind(std::string(key) + "=", 0) == 0) {
        throw BadInput(
            fmt::format("--set {}: --{} already sets it.", text, std::string(key).substr(7)));
      }
    }
    options.set.push_back(fmt::format("{}={}", key, value));
  }
  CheckOutputs(arguments.db, arguments.picture);
  MachineState machine = BeginTiming(arguments.pin);
  const CompareResult result = RunCompare(options, registries, Progress({.things = "problems"}));
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
      "compare", "Compare solver backends on what flights ask for, or on sets of known problems",
      "compare.md");
  const auto arguments = std::make_shared<CompareArguments>();
  CompareOptions& options = arguments->options;
  BenchOptions& bench = options.bench;
  command
      .Add("--problem-set", arguments->problem_set,
           "Problems of flights (landing), or a known set (docs/compare.md)")
      .Check(OneOf({"landing", "hs", "hs-pairs", "mgh", "shooting"}))
      .ShowDefault();
  command
      .Add("--starts", arguments->references.starts,
           "Starts of each known problem; the first is the published one, others are around it")
      .Check(Range(1, 1000))
      .ShowDefault();
  command.AddFile("--from", &options.from,
                  std::string("Problems of a flight's record (`land --record`) or of the flights "
                              "in a file of `sweep` or "
                              "`study`, which are flown again; default: flights are drawn. Of a "
                              "record --set changes ") +
                      kReplayKeys,
                  "FILE");
  command
      .Add("--problems", options.problems,
           "Most problems that are taken; default: all of a record, else 20")
      .Check(Range(1, 100000));
  command
      .Add("--every", options.every,
           "Take every N-th solve that the flights ask for; default: 1 of a record, else 25")
      .Check(Range(1, 100000));
  command.Add("--arrival", arguments->arrival, "Short for --set solver.arrival=")
      .Check(OneOf({"fixed", "free"}));
  command.Add("--limits", arguments->limits, "Short for --set solver.limits=")
      .Check(OneOf({"soft", "hard"}));
  command.Add("--endpoint", arguments->endpoint, "Short for --set solver.endpoint=")
      .Check(OneOf({"eliminated", "explicit"}));
  command.AddList(
      "--backends", &bench.backends,
      "Which ones; default: all that can solve it. --problem-set shooting takes minutes with all",
      "NAME,NAME,...", OneOf(BackendNames(registries)));
  command
      .Add("--set", options.set,
           "Change a key of every flight's scenario (docs/scenario.md); may be given again")
      .TypeName("KEY=VALUE")
      .OneWord();
  command.Add("--seed", options.seed, "Seed of the drawn flights")
      .Check(Range(std::uint64_t{0}, std::uint64_t{1} << 53))
      .ShowDefault();
  command.Add("--gap", bench.gap, "Relative gap to the best known cost: solved")
      .Check(Range(1e-9, 1.0))
      .ShowDefault();
  command.Add("--repeats", bench.repeats, "Timed solves of each problem; the median counts")
      .Check(Range(1, 1000))
      .ShowDefault();
  command.Add("--deadline-ms", bench.deadline_ms, "Also stop solves after this wall time")
      .Check(Range(1e-3, 1e5));
  command.Add("--backend-seconds", bench.backend_seconds, "Skip a backend after this wall time [s]")
      .Check(Range(0.1, 1e6))
      .ShowDefault();
  command.Add("--pin", arguments->pin, "Run on this CPU only").Check(Range(0, 1023));
  command.AddFile("--db", &arguments->db, "Write every solve, an SQLite file", "F.db");
  command.AddFile("--picture", &arguments->picture, "Draw performance profile, latency and scaling",
                  "F.png");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.AddFlag("--allow-debug", arguments->allow_debug, "Time a build that is not optimised");
  command.OnChosen([arguments, &registries, run, command] {
    CheckApplies(command, *arguments);
    *run = [arguments, &registries] { return Compare(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
