// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/campaign/sweep_page.h"

#include <algorithm>

#include <fmt/format.h>

#include "evaluation/base/html.h"
#include "evaluation/campaign/sweep_report.h"

namespace touchdown::evaluation {
namespace {

std::string NumberOf(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : std::string();
}

std::string TrialRow(const SweepRow& row, const std::map<int, std::string>& flights) {
  const TrialResult& r = row.result;
  std::string labels;
  for (const auto& [key, value] : row.trial.varied) {
    labels += fmt::format("{}{}={}", labels.empty() ? "" : ", ", Escaped(key), Escaped(value));
  }
  const bool landed = r.landed();
  return fmt::format(
      "<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{:.2f}</td><td>{}</td><td>{}</td><td>{}</td>"
      "<td style='text-align:left'>{} {}<br><code>{}</code></td></tr>\n",
      r.succeeded() ? "" : " class='bad'", row.trial.index, labels, ToString(r.outcome),
      r.simulated_s, landed ? fmt::format("{:.3f}", r.touchdown->error_m) : "",
      NumberOf(r.min_clearance_m, 3), r.replans, FlightLink(flights, row.trial.index),
      Escaped(r.detail), Escaped(row.trial.Replay()));
}

}  // namespace

std::string FlightLink(const std::map<int, std::string>& flights, int trial) {
  const auto found = flights.find(trial);
  if (found == flights.end()) return {};
  return fmt::format("<a href='{}'>look at it</a>", Escaped(found->second));
}

std::string SweepPage(const Campaign& campaign, const std::vector<SweepRow>& rows,
                      const std::map<int, std::string>& flights) {
  std::vector<SweepRow> ordered = rows;
  std::stable_sort(ordered.begin(), ordered.end(), [](const SweepRow& a, const SweepRow& b) {
    return !a.result.succeeded() && b.result.succeeded();
  });
  const std::string title =
      fmt::format("{} of {}", campaign.name,
                  rows.empty() ? std::string("nothing") : rows.front().trial.scenario.name);
  std::string body = fmt::format("<h1>{}: {} flights</h1>\n<pre>{}</pre>\n<h2>Every flight</h2>\n",
                                 Escaped(title), rows.size(), Escaped(SweepText(campaign, rows)));
  body +=
      "<table><tr><th>trial</th><th>varied</th><th>outcome</th><th>flight ended after "
      "[s]</th><th>touchdown "
      "error "
      "[m]</th><th>least clearance [m]</th><th>replans</th><th>what went wrong; the command that "
      "flies it alone</th></tr>\n";
  for (const SweepRow& row : ordered) body += TrialRow(row, flights);
  return HtmlPage(title, body + "</table>\n");
}

}  // namespace touchdown::evaluation
