// SPDX-License-Identifier: BSD-3-Clause
// Two campaigns of the same flights under another key, compared flight by flight.
#include <fmt/format.h>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/statistics.h"
#include "evaluation/campaign/campaign_facts.h"
#include "evaluation/studies/hostile/hostile_family.h"
#include "evaluation/studies/hostile/hostile_report.h"
#include "evaluation/studies/hostile/hostile_tally.h"

namespace touchdown::evaluation {

HostileTimes ReadHostileTimes(const HostileOptions& options, const std::string& path) {
  HostileTimes times;
  NamingFile(path, kFileOfTrials, [&] {
    SqliteDb db(path, SqliteDb::Mode::kReadOnly);
    Manifest manifest = ReadManifest(db, path);
    if (manifest["campaign"] != "study hostile" ||
        manifest["sweep_seed"] != std::to_string(options.seed)) {
      throw BadInput(fmt::format("--against {}: it is no file of `study hostile --seed {}`.", path,
                                 options.seed));
    }
    SqliteStatement rows = db.Prepare("SELECT seed, time_to_land_s FROM trial WHERE landed");
    while (rows.Step()) {
      times.emplace(static_cast<std::uint64_t>(rows.Integer(0)), rows.Real(1));
    }
  });
  return times;
}

std::string HostilePairsText(const std::vector<SweepRow>& rows, const HostileTimes& others) {
  std::string text = fmt::format(
      "Time to land over that of the same flight in --against\n  {:<13}{:>8}{:>9}{:>9}{:>9}\n",
      "family", "pairs", "median", "p95", "mean");
  const auto line = [&](const std::string& family) {
    std::vector<double> ratios;
    double sum = 0.0;
    for (const SweepRow& row : rows) {
      if (family != "all" && LabelOf(row.trial, "family") != family) continue;
      const auto other = others.find(row.trial.seed);
      if (!row.result.landed() || other == others.end()) continue;
      ratios.push_back(row.result.touchdown->t / other->second);
      sum += ratios.back();
    }
    if (ratios.empty()) return;
    text += fmt::format("  {:<13}{:>8}{:>9.3f}{:>9.3f}{:>9.3f}\n", family, ratios.size(),
                        *Quantile(ratios, 0.5), *Quantile(ratios, 0.95),
                        sum / static_cast<double>(ratios.size()));
  };
  for (const HostileFamily& family : HostileFamilies()) line(family.name);
  line("all");
  return text;
}

}  // namespace touchdown::evaluation
