// SPDX-License-Identifier: BSD-3-Clause
// touchdown merge: the shards of a sweep as one file.
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "evaluation/campaign/trial_merge.h"
#include "evaluation/program/commands.h"

namespace touchdown::evaluation {
namespace {

struct MergeArguments {
  std::string out;
  std::vector<std::string> files;
  bool partial = false;
};

int Merge(const MergeArguments& arguments) {
  CheckNewStudy("OUT", arguments.out);
  const MergedTrials merged = MergeTrials(arguments.out, arguments.files, arguments.partial);
  std::cout << fmt::format("{}: {} of {} trials, from {} files\n", arguments.out, merged.flown,
                           merged.planned, arguments.files.size());
  return kDone;
}

}  // namespace

void AddMergeCommand(Command app, CommandRun* run) {
  const Command command =
      app.AddCommand("merge", "Make one file of the shards of a sweep", "sweep.md");
  const auto arguments = std::make_shared<MergeArguments>();
  command.Add("OUT", arguments->out, "The file to write, as if one process had flown all")
      .Required();
  command.Add("SHARD", arguments->files, "Files of `touchdown sweep --shard`").Required();
  command.AddFlag("--partial", arguments->partial,
                  "Trials may be missing: `touchdown sweep --db OUT` flies them");
  command.OnChosen([arguments, run] { *run = [arguments] { return Merge(*arguments); }; });
}

}  // namespace touchdown::evaluation
