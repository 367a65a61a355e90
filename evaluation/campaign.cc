// SPDX-License-Identifier: BSD-3-Clause
// Workers are forked before the file is opened; then trials are handed out one by one, and each reply is
// written before the next is looked at. A trial is a pure function of its scenario and seed, so that the rows
// do not depend on who flew them, nor in which order.
#include "touchdown/evaluation/campaign.h"

#include <algorithm>
#include <charconv>
#include <exception>
#include <map>

#include <fmt/format.h>

#include "touchdown/evaluation/bad_input.h"
#include "touchdown/evaluation/closed_loop.h"
#include "touchdown/evaluation/interrupt_watch.h"
#include "touchdown/evaluation/trial_columns.h"
#include "touchdown/evaluation/trial_store.h"
#include "touchdown/evaluation/work_sharing.h"

namespace touchdown::evaluation {
namespace {

// One word of a shell's command line.
std::string Quoted(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_./=:,+-").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// A shipped scenario by its name.
std::string ScenarioWord(const std::string& path, const std::string& name) {
  const std::vector<std::string> shipped = ListScenarios();
  const bool known = std::find(shipped.begin(), shipped.end(), name) != shipped.end();
  return known && FindScenario(name) == path ? name : path;
}

TrialResult Fly(const SweepTrial& trial, const Registries& registries) {
  try {
    return RunTrial(trial.scenario, trial.seed, registries);
  } catch (const std::exception& error) {
    TrialResult failed;
    failed.seed = trial.seed;
    failed.outcome = Outcome::kError;
    failed.detail = error.what();
    return failed;
  }
}

TrialResult ResultFrom(const WorkerReply& reply, const SweepTrial& trial, double limit_s) {
  if (reply.end == WorkerReply::End::kDone) return UnpackResult(reply.text);
  TrialResult lost;
  lost.seed = trial.seed;
  if (reply.end == WorkerReply::End::kDied) {
    lost.outcome = Outcome::kCrashed;
    lost.detail = fmt::format("Its process ended by {}.", reply.text);
  } else {
    lost.outcome = Outcome::kHung;
    lost.detail = fmt::format("It had not ended after {:g} s.", limit_s);
  }
  return lost;
}

// @throws BadInput
void CheckLatency(const Campaign& campaign, int jobs) {
  for (const SweepTrial& trial : campaign.trials) {
    if (jobs > 1 && trial.scenario.planning.latency.measured) {
      throw BadInput(
          "--jobs must be 1 with planning.latency=measured: trials would slow each other.");
    }
  }
}

int Number(const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : 0;
}

}  // namespace

SweepTrial MakeTrial(int index, std::uint64_t seed, const std::string& scenario_path,
                     const std::vector<std::string>& overrides,
                     std::vector<std::pair<std::string, std::string>> varied,
                     const Registries& registries) {
  SweepTrial trial;
  trial.index = index;
  trial.seed = seed;
  trial.varied = std::move(varied);
  trial.scenario = LoadScenario(scenario_path, overrides, registries);
  trial.replay =
      fmt::format("touchdown land {}", Quoted(ScenarioWord(scenario_path, trial.scenario.name)));
  for (const std::string& text : overrides) {
    if (text.rfind("seed=", 0) != 0) trial.replay += " --set " + Quoted(text);
  }
  trial.replay += fmt::format(" --seed {}", seed);
  return trial;
}

Shard Shard::Parse(const std::string& text) {
  const std::size_t slash = text.find('/');
  Shard shard;
  if (slash != std::string::npos) {
    shard.number = Number(text.substr(0, slash));
    shard.of = Number(text.substr(slash + 1));
  }
  if (slash == std::string::npos || shard.number < 1 || shard.of < shard.number) {
    throw BadInput(
        fmt::format("--shard {}: write K/N, the K-th of N shards, K from 1 to N.", text));
  }
  return shard;
}

std::string Shard::ToString() const { return fmt::format("{}/{}", number, of); }

CampaignResult RunCampaign(const Campaign& campaign, const CampaignOptions& options,
                           const Registries& registries,
                           const std::function<void(const CampaignState&)>& progress) {
  CheckLatency(campaign, options.jobs);
  const auto trial = [&](int i) -> const SweepTrial& {
    return campaign.trials.at(static_cast<std::size_t>(i));
  };
  const InterruptWatch watch;
  const auto fly = [&](int i) { return PackResult(Fly(trial(i), registries)); };
  std::vector<WorkerProcess> workers;
  for (int job = 0; job < std::min(options.jobs, static_cast<int>(campaign.trials.size())); ++job) {
    workers.emplace_back(fly, options.trial_limit_s);
  }
  TrialStore store(options.db, campaign, options.shard);

  CampaignResult campaign_result;
  CampaignState& state = campaign_result.state;
  std::vector<int> missing;
  for (const SweepTrial& planned : campaign.trials) {
    if (!options.shard.Takes(planned.index)) continue;
    ++state.all;
    if (!store.Holds(planned.index)) missing.push_back(planned.index);
  }
  state.resumed = state.flown = state.all - static_cast<int>(missing.size());
  for (const auto& [index, result] : store.Results()) state.succeeded += result.succeeded() ? 1 : 0;
  progress(state);
  ShareWork(
      workers, missing,
      [&](const WorkerReply& reply) {
        const TrialResult result = ResultFrom(reply, trial(reply.item), options.trial_limit_s);
        store.Add(reply.item, result);
        ++state.flown;
        state.succeeded += result.succeeded() ? 1 : 0;
        progress(state);
      },
      [&] { return watch.signal() != 0; });
  if (state.flown < state.all) campaign_result.interrupted_by = watch.signal();
  for (auto& [index, result] : store.Results()) {
    campaign_result.rows.push_back({trial(index), std::move(result)});
  }
  return campaign_result;
}

}  // namespace touchdown::evaluation
