// SPDX-License-Identifier: BSD-3-Clause
// touchdown profile: what replanning costs, stage by stage.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/machine.h"
#include "evaluation/base/output_path.h"
#include "evaluation/base/progress.h"
#include "evaluation/profile/profile.h"
#include "evaluation/profile/profile_backends.h"
#include "evaluation/profile/profile_report.h"
#include "evaluation/program/commands.h"
#include "evaluation/record/record_reader.h"

namespace touchdown::evaluation {
namespace {

constexpr const char* kAll = "all";

struct ProfileArguments {
  ScenarioArguments scenario;
  ProfileOptions options;
  std::string record;
  BackendsOptions backends;  // of --backends
  std::string trace;
  std::string db;
  std::optional<int> pin;
  bool json = false;
  bool allow_debug = false;
};

void CheckProfileOutputs(const ProfileArguments& arguments) {
  if (!arguments.db.empty() && arguments.db == arguments.trace) {
    throw BadInput(fmt::format("--db and --trace are the same file, {}.", arguments.db));
  }
  if (!arguments.trace.empty()) CheckOutputPath("--trace", arguments.trace);
  if (!arguments.db.empty()) CheckNewStudy("--db", arguments.db);
}

/// Refuses options of files that a comparison of backends does not write, and options without an
/// effect.
void CheckApplies(const Command& command) {
  if (!command.Given("--backends")) {
    if (command.Given("--gap")) throw BadInput("--gap has no effect without --backends.");
    return;
  }
  if (!command.Given("--from")) throw BadInput("--backends needs --from RECORD.");
  for (const char* alone : {"--backend", "--trace", "--db", "--deadline-ms"}) {
    if (command.Given(alone))
      throw BadInput(fmt::format("{} cannot be used with --backends.", alone));
  }
}

Profile Run(const ProfileArguments& arguments, const Registries& registries,
            MachineState* machine) {
  ProfileOptions options = arguments.options;
  options.spans = !arguments.trace.empty();
  const auto progress = [tell = Progress({.things = "runs"})](int done, int all) mutable {
    if (all > 1) tell(done, all);
  };
  const auto begin = [&] {
    CheckProfileOutputs(arguments);
    if (arguments.pin) PinToCpu(*arguments.pin);
    machine->load_before = LoadAverage();
  };
  if (!arguments.record.empty()) {
    const RecordedFlight flight =
        ReadRecord(arguments.record, arguments.scenario.Overrides(), registries);
    begin();
    return ProfileRecord(flight, options, registries, progress);
  }
  const Scenario scenario = arguments.scenario.Load(registries);
  begin();
  return ProfileFlights(scenario, options, registries, progress);
}

void WriteTrace(const std::string& path, const Profile& profile) {
  AtomicFile file(path);
  std::ofstream out(file.working_path());
  out << ChromeTrace(profile).dump() << std::endl;
  if (!out) throw std::runtime_error(fmt::format("--trace {}: it could not be written.", path));
  out.close();
  file.Commit();
}

int RunBackends(const ProfileArguments& arguments, const Registries& registries) {
  BackendsOptions options = arguments.backends;
  options.record = arguments.record;
  options.overrides = arguments.scenario.Overrides();
  options.repeats = arguments.options.repeats;
  const auto all = std::find(options.backends.begin(), options.backends.end(), kAll);
  if (all != options.backends.end()) {
    if (options.backends.size() > 1)
      throw BadInput("--backends all: it cannot be combined with other backends.");
    options.backends.clear();
  }
  for (const std::string& text : options.overrides) {
    if (text.rfind("solver.backend=", 0) == 0 || text.rfind("solver.gap=", 0) == 0) {
      throw BadInput(fmt::format("--set {}: it cannot be used with --backends.", text));
    }
  }
  MachineState machine;
  machine.pinned = arguments.pin;
  if (arguments.pin) PinToCpu(*arguments.pin);
  machine.load_before = LoadAverage();
  std::map<std::string, Progress> progress;
  const BackendsProfile profile =
      ProfileBackends(options, registries, [&](const char* things, int done, int of) {
        progress.try_emplace(things, ProgressText{.things = things}).first->second(done, of);
      });
  machine.load_after = LoadAverage();
  if (arguments.json) {
    std::cout << BackendsJson(profile, machine).dump(2) << std::endl;
  } else {
    std::cout << BackendsText(profile) << std::flush;
  }
  return kDone;
}

int RunProfile(const ProfileArguments& arguments, const Registries& registries) {
  CheckTimings(arguments.allow_debug);
  if (!arguments.backends.backends.empty()) return RunBackends(arguments, registries);
  MachineState machine;
  machine.pinned = arguments.pin;
  const Profile profile = Run(arguments, registries, &machine);
  machine.load_after = LoadAverage();
  if (arguments.json) {
    std::cout << ProfileJson(profile, machine).dump(2) << std::endl;
  } else {
    std::cout << ProfileText(profile) << std::flush;
  }
  if (!arguments.trace.empty()) WriteTrace(arguments.trace, profile);
  if (!arguments.db.empty()) WriteProfileTable(arguments.db, profile, machine);
  return kDone;
}

}  // namespace

void AddProfileCommand(Command app, const Registries& registries, CommandRun* run) {
  const Command command = app.AddCommand(
      "profile", "Replanning latency by stage, in flight or from a record", "profile.md");
  const auto arguments = std::make_shared<ProfileArguments>();
  ProfileOptions& options = arguments->options;
  arguments->scenario.AddTo(command, false);
  const Option seed = command.Add("--seed", arguments->scenario.seed, "Short for --set seed=");
  seed.TypeName("S");
  const Option trials = command.Add("--trials", options.trials,
                                    "Flights, with this seed and the ones that follow it");
  trials.Check(Range(1, 10000)).ShowDefault();
  const Option from = command.AddFile(
      "--from", &arguments->record,
      std::string("Time every step of a record (`land --record`) again, each with its recorded "
                  "map, prediction, committed trajectory and input. --backend, --set ") +
          kReplayKeys + " change the planner",
      "RECORD");
  from.Excludes(seed).Excludes(trials).Excludes(command.Find("SCENARIO"));
  command
      .Add("--repeats", options.repeats,
           "With --from: number of timed passes; one pass before them compares with the record and "
           "is not timed")
      .Check(Range(1, 10000))
      .Needs(from)
      .ShowDefault();
  command
      .Add("--deadline-ms", options.deadline_ms,
           "Steps that take longer than this wall time are misses; default: "
           "planning.latency, or the replanning period where that is measured or 0")
      .Check(Range(1e-3, 1e5));
  std::vector<std::string> names = BackendNames(registries);
  names.emplace_back(kAll);
  command.AddList("--backends", &arguments->backends.backends,
                  "With --from: compare these, or `all`, on the same steps: time of a solve to the "
                  "gap, and of the whole step",
                  "NAME,NAME,...", OneOf(names));
  command
      .Add("--gap", arguments->backends.gap,
           "With --backends: solve until the cost is within this share of the best known cost; "
           "default: the record's solver.gap")
      .Check(Range(1e-9, 1.0));
  command.Add("--pin", arguments->pin, "Run on this CPU only").Check(Range(0, 1023));
  command.AddFile("--trace", &arguments->trace,
                  "Write the spans in Chrome's trace format, for Perfetto or chrome://tracing",
                  "F.json");
  command.AddFile("--db", &arguments->db, "Write every sample, an SQLite file", "F.db");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.AddFlag("--allow-debug", arguments->allow_debug, "Time a build that is not optimised");
  command.OnChosen([arguments, &registries, run, command] {
    CheckApplies(command);
    *run = [arguments, &registries] { return RunProfile(*arguments, registries); };
  });
}

}  // namespace touchdown::evaluation
