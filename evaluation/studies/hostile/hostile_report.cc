// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/studies/hostile/hostile_report.h"

#include <algorithm>
#include <functional>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/statistics.h"
#include "evaluation/studies/hostile/hostile_family.h"
#include "evaluation/studies/hostile/hostile_tally.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

bool Has(const std::vector<SweepRow>& rows, const std::string& family) {
  return std::any_of(rows.begin(), rows.end(),
                     [&](const SweepRow& row) { return LabelOf(row.trial, "family") == family; });
}

// "bounced_off 3, tip_over 1"; "none" without any.
std::string CountsText(const std::map<std::string, int>& counts) {
  std::string text;
  for (const auto& [name, count] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count);
  }
  return text.empty() ? "none" : text;
}

std::string TableText(const std::vector<SweepRow>& rows, bool within) {
  const HostileTally all = TallyOf(rows, "", within);
  if (all.flights == 0) return {};
  std::string text = fmt::format("{} the assumptions\n", within ? "Within" : "Beyond");
  text += fmt::format("  {:<13}{:>8}{:>6}{:>11}{:>14}{:>9}{:>8}{:>7}{:>9}{:>7}\n", "family",
                      "flights", "way", "collisions", "arrived", "contacts", "landed", "stood",
                      "timeouts", "other");
  const auto line = [&](const std::string& name, const HostileTally& t) {
    text +=
        fmt::format("  {:<13}{:>8}{:>6}{:>11}{:>14}{:>9}{:>8}{:>7}{:>9}{:>7}\n", name, t.flights,
                    t.ways, t.collisions, fmt::format("{} of {}", t.seeing_landed, t.seeing),
                    t.all_contacts(), t.landed, t.all_stood(), t.timeouts, t.lost + t.other);
  };
  for (const HostileFamily& family : HostileFamilies()) {
    const HostileTally tally = TallyOf(rows, family.name, within);
    if (tally.flights > 0) line(family.name, tally);
  }
  line("all", all);
  text +=
      fmt::format("  collisions with what stands {}; other contacts {}\n",
                  RateText(all.collisions, all.flights), RateText(all.all_contacts(), all.flights));
  text += fmt::format("  a way exists {}; arrived of those that see at least once a second {}\n",
                      RateText(all.ways, all.flights), RateText(all.seeing_landed, all.seeing));
  text +=
      fmt::format("  contacts: {}; stood: {}\n", CountsText(all.contacts), CountsText(all.stood));
  for (const auto& [what, value] : SafetyFacts(all)) {
    text += fmt::format("  {}: {}\n", what, value);
  }
  return text + "\n";
}

// Flights of one kind, each with its command.
std::string ListText(const std::string& title, const std::vector<SweepRow>& rows,
                     const std::function<bool(const TrialResult&)>& holds) {
  std::string text;
  int count = 0;
  for (const SweepRow& row : rows) {
    if (!holds(row.result)) continue;
    ++count;
    text += fmt::format("  flight {}, {}, beyond: {}, at {:.1f} s. {}\n    {}\n", row.trial.index,
                        LabelOf(row.trial, "family"), LabelOf(row.trial, "beyond"),
                        row.result.simulated_s, row.result.detail, row.trial.Replay());
  }
  return count == 0 ? std::string() : fmt::format("{}: {}\n{}\n", title, count, text);
}

Json RateJson(int count, int of) {
  if (of == 0) return nullptr;
  const Interval interval = ClopperPearson(count, of);
  return {interval.lo, interval.hi};
}

Json TallyJson(const HostileTally& t) {
  return {{"flights", t.flights},
          {"ways", t.ways},
          {"ways_interval_95", RateJson(t.ways, t.flights)},
          {"collisions", t.collisions},
          {"collisions_interval_95", RateJson(t.collisions, t.flights)},
          {"contacts", t.contacts},
          {"contacts_interval_95", RateJson(t.all_contacts(), t.flights)},
          {"landed", t.landed},
          {"seeing_ways", t.seeing},
          {"seeing_ways_landed", t.seeing_landed},
          {"seeing_ways_landed_interval_95", RateJson(t.seeing_landed, t.seeing)},
          {"stood", t.stood},
          {"timeouts", t.timeouts},
          {"lost", t.lost},
          {"other", t.other},
          {"uncertified_steps", t.safety.uncertified_steps},
          {"escaping_steps", t.safety.escaping_steps},
          {"escaping_flights", t.escaping_flights},
          {"escaping_hit_flights", t.escaping_hit_flights},
          {"escaping_unknown_flights", t.escaping_unknown_flights},
          {"stops_flown", t.safety.stops_flown},
          {"map_errors", t.safety.map_errors},
          {"narrow_steps", t.safety.narrow_steps},
          {"margin_max_m", t.safety.margin_max_m},
          {"drift_events", t.safety.drift_events},
          {"drift_max_m", t.safety.drift_max_m},
          {"tracking_events", t.safety.tracking_events},
          {"tracking_max_m", t.safety.tracking_max_m},
          {"free_cells", t.safety.free_cells},
          {"falsely_free_cells", t.safety.falsely_free_cells}};
}

Json FlightJson(const SweepRow& row) {
  Json json = {{"flight", row.trial.index}, {"seed", row.trial.seed}};
  for (const auto& [key, value] : row.trial.varied) json[key] = value;
  json["outcome"] = ToString(row.result.outcome);
  json["cause"] = row.result.cause;
  json["detail"] = row.result.detail;
  json["simulated_s"] = row.result.simulated_s;
  json["replay"] = row.trial.Replay();
  return json;
}

}  // namespace

std::string RateText(int count, int of) {
  if (of == 0) return "0 of 0";
  const Interval interval = ClopperPearson(count, of);
  return fmt::format("{} of {} [{:.2f}, {:.2f}] %", count, of, 100.0 * interval.lo,
                     100.0 * interval.hi);
}

SafetyLines SafetyFacts(const HostileTally& tally) {
  const SafetyFigures& s = tally.safety;
  const auto margin = [&](double share) { return Quantile(tally.margins_m, share).value_or(0.0); };
  return {
      {"uncertified steps", fmt::format("{}", s.uncertified_steps)},
      {"flights that escaped",
       fmt::format("{}; from occupied cells {}, from unknown ones {}",
                   RateText(tally.escaping_flights, tally.flights), tally.escaping_hit_flights,
                   tally.escaping_unknown_flights)},
      {"stops flown", fmt::format("{}", s.stops_flown)},
      {"map errors", fmt::format("{}", s.map_errors)},
      {"steps with less than the margins", fmt::format("{}", s.narrow_steps)},
      {"margin of a flight",
       fmt::format("median {:.2f} m, p95 {:.2f} m, largest at any step {:.2f} m", margin(0.5),
                   margin(0.95), s.margin_max_m)},
      {"tracking beyond its share",
       fmt::format("{} times, at most {:.2f} m", s.tracking_events, s.tracking_max_m)},
      {"own state beyond its share",
       fmt::format("{} times, at most {:.2f} m", s.drift_events, s.drift_max_m)},
      {"falsely free", fmt::format("{} of {} cells", s.falsely_free_cells, s.free_cells)},
  };
}

std::string HostileText(const HostileOptions& options, const std::vector<SweepRow>& rows) {
  std::string text = fmt::format("{}: {} flights\n\n", HostileCommand(options), rows.size());
  text += TableText(rows, true) + TableText(rows, false);
  text += ListText("Collisions with what stands", rows, HitWhatStands);
  text += ListText("Other contacts", rows, WrongContact);
  text += ListText("Stood, or out of time", rows, CameToNothing);
  text += ListText("Ended otherwise", rows, EndedOtherwise);
  text += fmt::format("Flight N again: {} --only N\n", HostileCommand(options));
  return text;
}

nlohmann::ordered_json HostileJson(const HostileOptions& options,
                                   const std::vector<SweepRow>& rows) {
  Json json = {{"study", "hostile"},
               {"command", HostileCommand(options)},
               {"seed", options.seed},
               {"flights", rows.size()},
               {"set", options.set},
               {"share_beyond", options.share_beyond},
               {"within", TallyJson(TallyOf(rows, "", true))},
               {"beyond", TallyJson(TallyOf(rows, "", false))},
               {"families", Json::array()},
               {"results", Json::array()}};
  for (const HostileFamily& family : HostileFamilies()) {
    if (!Has(rows, family.name)) continue;
    json["families"].push_back({{"family", family.name},
                                {"what", family.what},
                                {"ranges", family.ranges},
                                {"within", TallyJson(TallyOf(rows, family.name, true))},
                                {"beyond", TallyJson(TallyOf(rows, family.name, false))}});
  }
  for (const SweepRow& row : rows) json["results"].push_back(FlightJson(row));
  return json;
}

std::string HostileWaysText(const std::vector<HostileFlight>& flights) {
  std::string text = fmt::format("  {:<13}{:>16}{:>16}{:>18}\n", "family", "way, within",
                                 "way, beyond", "longest way [m]");
  const auto line = [&](const std::string& family) {
    int of[2] = {0, 0}, ways[2] = {0, 0};
    double longest = 0.0;
    for (const HostileFlight& flight : flights) {
      if (family != "all" && flight.family != family) continue;
      const int beyond = flight.beyond.empty() ? 0 : 1;
      ++of[beyond];
      ways[beyond] += flight.way.exists ? 1 : 0;
      longest = std::max(longest, flight.way.length);
    }
    if (of[0] + of[1] == 0) return;
    text += fmt::format("  {:<13}{:>16}{:>16}{:>18.1f}\n", family,
                        fmt::format("{} of {}", ways[0], of[0]),
                        fmt::format("{} of {}", ways[1], of[1]), longest);
  };
  for (const HostileFamily& family : HostileFamilies()) line(family.name);
  line("all");
  return text;
}

}  // namespace touchdown::evaluation
