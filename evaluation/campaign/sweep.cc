// SPDX-License-Identifier: BSD-3-Clause
// Monte Carlo: the trials of a sweep, each with its own seed and its own values of the varied keys.
#include "evaluation/campaign/sweep.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/suggestion.h"
#include "evaluation/base/words.h"
#include "evaluation/scenario/scenario_schema.h"
#include "evaluation/scenario/scenario_value.h"
#include "sim/base/random_stream.h"

namespace touchdown::evaluation {
namespace {

double RangeEnd(const std::string& text, const std::string& variation) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw BadInput(fmt::format("--vary {}: '{}' must be a number.", variation, text));
  }
  return value;
}

// Every value of a variation must be allowed, whatever a seed draws. The ends of a range stand for
// all of it. @throws BadInput
void CheckValues(const Variation& variation, const Registries& registries) {
  const auto key = FindScenarioKey(variation.key, ScenarioKeys(registries));
  std::vector<std::string> values = variation.values;
  if (values.empty()) values = {WriteNumber(variation.lo), WriteNumber(variation.hi)};
  for (const std::string& value : values) {
    Scenario probe;
    key->set(probe, YAML::Node(value), {.file = "--vary " + variation.text});
  }
}

// A key that is varied is decided by the variation alone. @throws BadInput
void CheckKeys(const SweepOptions& options) {
  std::set<std::string> varied;
  for (const Variation& variation : options.variations) {
    if (!varied.insert(variation.key).second) {
      throw BadInput(fmt::format("--vary {}: {} is varied twice.", variation.text, variation.key));
    }
  }
  for (const std::string& text : options.overrides) {
    const std::string key = text.substr(0, text.find('='));
    if (varied.count(key) > 0) {
      throw BadInput(fmt::format("--set {}: it has no effect beside --vary of {}.", text, key));
    }
  }
}

std::size_t Combinations(const std::vector<Variation>& variations) {
  std::size_t count = 1;
  for (const Variation& v : variations) count *= std::max<std::size_t>(1, v.values.size());
  return count;
}

// A refusal may be due to the varied values, so the sentence names them.
SweepTrial MakeVaried(const SweepOptions& options, const std::vector<std::string>& overrides,
                      const std::vector<std::pair<std::string, std::string>>& varied,
                      const Registries& registries) {
  try {
    return MakeTrial(options.scenario_path, overrides, registries);
  } catch (const BadInput& refusal) {
    if (varied.empty()) throw;
    std::string words;
    for (const auto& [key, value] : varied) words += fmt::format(" --vary {}={}", key, value);
    throw BadInput(fmt::format("With{}: {}", words, refusal.what()));
  }
}

}  // namespace

Variation Variation::Parse(const std::string& text, const Registries& registries) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw BadInput(fmt::format("--vary {}: write KEY=LO..HI or KEY=a,b,c.", text));
  }
  Variation variation;
  variation.text = text;
  variation.key = text.substr(0, equals);
  const std::string rest = text.substr(equals + 1);
  const std::vector<SchemaKey<Scenario>> keys = ScenarioKeys(registries);
  if (!FindScenarioKey(variation.key, keys) || variation.key == "seed") {
    std::vector<std::string> names;
    for (const SchemaKey<Scenario>& key : keys) names.push_back(key.name);
    throw BadInput(fmt::format("--vary {}: {} is no key that can be varied{}.", text, variation.key,
                               DidYouMean(variation.key, names)));
  }
  if (const std::size_t dots = rest.find(".."); dots != std::string::npos) {
    variation.lo = RangeEnd(rest.substr(0, dots), text);
    variation.hi = RangeEnd(rest.substr(dots + 2), text);
    if (variation.lo > variation.hi) {
      throw BadInput(fmt::format("--vary {}: LO must not be above HI.", text));
    }
    CheckValues(variation, registries);
    return variation;
  }
  for (const std::string& value : Split(rest, ',')) {
    std::vector<std::string>& values = variation.values;
    if (std::find(values.begin(), values.end(), value) != values.end()) {
      throw BadInput(fmt::format("--vary {}: {} is given twice.", text, value));
    }
    values.push_back(value);
  }
  CheckValues(variation, registries);
  return variation;
}

std::uint64_t TrialSeed(std::uint64_t sweep_seed, int index) {
  // SplitMix64 (Steele, Lea, Flood 2014) of the pair; 53 bits, so that every reader keeps it
  // exactly.
  std::uint64_t z = sweep_seed * 0x9E3779B97F4A7C15ULL + static_cast<std::uint64_t>(index);
  z += 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return (z ^ (z >> 31)) >> 11;
}

std::vector<SweepTrial> PlanSweep(const SweepOptions& options, const Registries& registries) {
  CheckKeys(options);
  // Without a range only few scenarios differ. Each is read and checked once.
  std::map<std::vector<std::string>, SweepTrial> loaded;
  std::vector<SweepTrial> trials;
  for (int i = 0; i < options.trials; ++i) {
    const std::uint64_t seed = TrialSeed(options.seed, i);
    std::vector<std::string> overrides = options.overrides;
    std::vector<std::pair<std::string, std::string>> varied;
    std::size_t combination = static_cast<std::size_t>(i) % Combinations(options.variations);
    for (const Variation& variation : options.variations) {
      std::string value;
      if (variation.values.empty()) {
        sim::RandomStream stream(seed, "vary " + variation.key);
        value = WriteNumber(stream.Uniform(variation.lo, variation.hi));
      } else {
        value = variation.values[combination % variation.values.size()];
        combination /= variation.values.size();
      }
      varied.emplace_back(variation.key, value);
      overrides.push_back(variation.key + "=" + value);
    }
    auto same = loaded.find(overrides);
    if (same == loaded.end()) {
      same = loaded.emplace(overrides, MakeVaried(options, overrides, varied, registries)).first;
    }
    SweepTrial& trial = trials.emplace_back(same->second);
    trial.index = i;
    trial.seed = seed;
    trial.varied = std::move(varied);
  }
  return trials;
}

Campaign SweepCampaign(const SweepOptions& options, const Registries& registries) {
  Campaign campaign;
  campaign.name = "sweep";
  campaign.seed = options.seed;
  nlohmann::json vary = nlohmann::json::array();
  for (const Variation& variation : options.variations) {
    vary.push_back(variation.text);
    campaign.keys.push_back({variation.key,
                             FindScenarioKey(variation.key, ScenarioKeys(registries))->unit,
                             variation.values.empty()});
  }
  campaign.facts = {{"set", nlohmann::json(options.overrides).dump()}, {"vary", vary.dump()}};
  campaign.trials = PlanSweep(options, registries);
  return campaign;
}

}  // namespace touchdown::evaluation
