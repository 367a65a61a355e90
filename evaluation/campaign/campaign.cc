// SPDX-License-Identifier: BSD-3-Clause
// Workers are forked before MPI is started and the file opened. Then trials are handed out one by one, and each reply
// is written before the next is read. A trial is a pure function of its scenario and seed. So the rows do not depend on
// who flew them, or in which order.
#include "evaluation/campaign/campaign.h"

#include <algorithm>
#include <charconv>
#include <exception>
#include <memory>

#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/interrupt_watch.h"
#include "evaluation/base/launch.h"
#include "evaluation/base/rendering_check.h"
#include "evaluation/base/work_sharing.h"
#include "evaluation/campaign/campaign_facts.h"
#include "evaluation/campaign/ranks.h"
#include "evaluation/campaign/trial_columns.h"
#include "evaluation/campaign/trial_store.h"
#include "evaluation/flight/closed_loop.h"
#include "touchdown/evaluation/base/shipped_files.h"

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
    return FailedTrial(trial, error.what());
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

const SweepTrial& TrialOf(const Campaign& campaign, int index) {
  return campaign.trials.at(static_cast<std::size_t>(index));
}

// The file and its progress.
class Flight {
 public:
  Flight(const Campaign& campaign, const CampaignOptions& options,
         const std::function<void(const CampaignState&)>& progress)
      : campaign_(campaign),
        limit_s_(options.trial_limit_s),
        progress_(progress),
        store_(options.db, campaign, options.shard,
               options.retry ? TrialStore::Again::kLost : TrialStore::Again::kNone) {
    for (const SweepTrial& trial : campaign.trials) {
      if (!options.shard.Takes(trial.index)) continue;
      ++state_.all;
      if (store_.Holds(trial.index)) {
        ++state_.flown;
      } else {
        (trial.FliesAlone() ? alone_ : together_).push_back(trial.index);
      }
    }
    state_.resumed = state_.flown;
    state_.succeeded = store_.succeeded();
    progress_(state_);
  }

  /// The trials that the file lacks, without those that fly alone.
  const std::vector<int>& together() const { return together_; }
  const std::vector<int>& alone() const { return alone_; }

  void Take(const WorkerReply& reply) {
    Add(reply.item, ResultFrom(reply, TrialOf(campaign_, reply.item), limit_s_));
  }

  void Add(int index, const TrialResult& result) {
    store_.Add(index, result);
    ++state_.flown;
    state_.succeeded = store_.succeeded();
    progress_(state_);
  }

  CampaignResult Result(int signal) {
    CampaignResult result;
    result.state = state_;
    if (state_.flown < state_.all) result.interrupted_by = signal;
    for (auto& [index, flown] : store_.Results()) {
      result.rows.push_back({TrialOf(campaign_, index), std::move(flown)});
    }
    return result;
  }

 private:
  const Campaign& campaign_;
  double limit_s_;
  const std::function<void(const CampaignState&)>& progress_;
  TrialStore store_;
  CampaignState state_;
  std::vector<int> together_;
  std::vector<int> alone_;
};

int Number(const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : 0;
}

}  // namespace

SweepTrial MakeTrial(const std::string& scenario_path, const std::vector<std::string>& overrides,
                     const Registries& registries) {
  SweepTrial trial;
  trial.scenario = LoadScenario(scenario_path, overrides, registries);
  trial.command =
      fmt::format("touchdown {} {}", trial.scenario.task == TaskKind::kLand ? "land" : "fly",
                  Quoted(ScenarioWord(scenario_path, trial.scenario.name)));
  for (const std::string& text : overrides) {
    if (text.rfind("seed=", 0) != 0) trial.command += " --set " + Quoted(text);
  }
  return trial;
}

std::string SweepTrial::Replay() const { return fmt::format("{} --seed {}", command, seed); }

bool SweepTrial::FliesAlone() const { return scenario.planning.latency.measured; }

void CheckTrials(const Campaign& campaign) {
  const bool rendered = std::any_of(
      campaign.trials.begin(), campaign.trials.end(),
      [](const SweepTrial& trial) { return trial.scenario.sensing == SensingKind::kRendered; });
  if (rendered) RequireRenderedSensing();
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

TrialResult FailedTrial(const SweepTrial& trial, const std::string& what) {
  TrialResult failed;
  failed.seed = trial.seed;
  failed.outcome = Outcome::kError;
  failed.detail = what;
  return failed;
}

CampaignResult FlyHere(const Campaign& campaign, const CampaignOptions& options,
                       const std::function<TrialResult(const SweepTrial&)>& fly,
                       const std::function<void(const CampaignState&)>& progress) {
  CheckTrials(campaign);
  Flight flight(campaign, options, progress);
  for (const std::vector<int>* indices : {&flight.together(), &flight.alone()}) {
    for (const int index : *indices) flight.Add(index, fly(TrialOf(campaign, index)));
  }
  return flight.Result(0);
}

CampaignResult RunCampaign(const Campaign& campaign, const CampaignOptions& options,
                           const Registries& registries,
                           const std::function<void(const CampaignState&)>& progress) {
  const bool ranked = LaunchedAsOneOfSeveral();
  CheckTrials(campaign);
  const InterruptWatch watch;
  const auto fly = [&](int i) { return PackResult(Fly(TrialOf(campaign, i), registries)); };
  std::vector<WorkerProcess> workers;
  const int most = ranked ? 1 : std::min(options.jobs, static_cast<int>(campaign.trials.size()));
  while (static_cast<int>(workers.size()) < most) {
    workers.emplace_back(fly, options.trial_limit_s);
  }
  std::unique_ptr<Ranks> ranks;
  if (ranked) {
    ranks = std::make_unique<Ranks>();
    if (ranks->size() == 1) {
      throw BadInput(
          "The launcher started several processes, but MPI sees one: the launcher's MPI is not the "
          "program's MPI.");
    }
    const bool alike = ranks->Agree(CampaignHash(campaign));
    if (!ranks->leads()) {
      ranks->Follow(workers.front());
      CampaignResult none;
      none.reports = false;
      return none;
    }
    if (!alike) {
      throw BadInput(
          "The ranks were not started in the same way: builds, processors or trials differ.");
    }
  }
  Flight flight(campaign, options, progress);
  const auto take = [&](const WorkerReply& reply) { flight.Take(reply); };
  const auto stop = [&] { return watch.signal() != 0; };
  const int at_a_time = flight.together().empty() ? 1
                        : ranks                   ? ranks->size()
                                                  : static_cast<int>(workers.size());
  if (ranks) {
    ranks->Lead(workers.front(), flight.together(), take, stop);
    ranks.reset();  // the others' looking for messages would disturb what flies alone
  } else {
    ShareWork(workers, options.jobs, flight.together(), take, stop);
  }
  ShareWork(workers, 1, flight.alone(), take, stop);
  CampaignResult result = flight.Result(watch.signal());
  result.at_a_time = at_a_time;
  return result;
}

}  // namespace touchdown::evaluation
