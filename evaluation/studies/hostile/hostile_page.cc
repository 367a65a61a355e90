// SPDX-License-Identifier: BSD-3-Clause
// The report as one page that needs no other file: tables, and the worlds from above as SVG.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "estimation/base/degrees.h"
#include "evaluation/base/build_info.h"
#include "evaluation/base/html.h"
#include "evaluation/campaign/sweep_page.h"
#include "evaluation/scenario/scenario_world.h"
#include "evaluation/studies/hostile/hostile_conditions.h"
#include "evaluation/studies/hostile/hostile_family.h"
#include "evaluation/studies/hostile/hostile_report.h"
#include "evaluation/studies/hostile/hostile_tally.h"

namespace touchdown::evaluation {
namespace {

constexpr double kPictureWidth = 280.0;  // [pixel]
constexpr double kBorder = 1.5;          // around the world [m]
constexpr double kLaneTime = 60.0;       // of the pad's lane that is drawn [s]
constexpr double kLaneStep = 0.5;        // [s]

// A box that starts above the ground, or ends low, is lighter.
const char* Fill(double base, double top) {
  if (base > 0.0) return "#9ecae1";
  return top < 1.0 ? "#c7c7c7" : "#636363";
}

// From above: obstacles grey, what hangs blue, the lane green, start and heading red. y points up.
std::string TopView(const Scenario& s, const Registries& registries) {
  const auto course = PadCourseOf(s, registries, s.pad.phase, 0);
  Eigen::AlignedBox2d view(Eigen::Vector2d(s.start.position.head<2>()));
  std::string lane;
  for (double t = 0.0; t <= kLaneTime; t += kLaneStep) {
    const Eigen::Vector2d p = course->At(t).p_WP.head<2>();
    view.extend(p);
    lane += fmt::format("{:.2f},{:.2f} ", p.x(), -p.y());
  }
  std::string shapes;
  for (const BoxObstacle& box : s.boxes) {
    const Eigen::Vector2d half = 0.5 * box.size.head<2>();
    view.extend(Eigen::Vector2d(box.centre - half));
    view.extend(Eigen::Vector2d(box.centre + half));
    shapes += fmt::format(
        "<rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}' fill='{}' fill-opacity='.8'/>",
        box.centre.x() - half.x(), -box.centre.y() - half.y(), box.size.x(), box.size.y(),
        Fill(box.base, box.base + box.size.z()));
  }
  for (const CylinderObstacle& post : s.cylinders) {
    view.extend(post.centre);
    shapes += fmt::format("<circle cx='{:.2f}' cy='{:.2f}' r='{:.2f}' fill='{}'/>", post.centre.x(),
                          -post.centre.y(), post.radius, Fill(0.0, post.height));
  }
  const Eigen::Vector2d low = view.min() - Eigen::Vector2d::Constant(kBorder);
  const Eigen::Vector2d size = view.sizes() + Eigen::Vector2d::Constant(2.0 * kBorder);
  const double yaw = estimation::Radians(s.start.yaw_deg);
  const Eigen::Vector2d start = s.start.position.head<2>();
  const Eigen::Vector2d pad = course->At(0.0).p_WP.head<2>();
  const double deck = s.pad.deck_size;
  return fmt::format(
      "<svg width='{:.0f}' height='{:.0f}' viewBox='{:.2f} {:.2f} {:.2f} {:.2f}'>"
      "<polyline points='{}' fill='none' stroke='#2ca25f' stroke-width='.12'/>"
      "<rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}' fill='#2ca25f' "
      "fill-opacity='.5'/>{}"
      "<circle cx='{:.2f}' cy='{:.2f}' r='.32' fill='#d7301f'/>"
      "<line x1='{:.2f}' y1='{:.2f}' x2='{:.2f}' y2='{:.2f}' stroke='#d7301f' "
      "stroke-width='.12'/></svg>",
      kPictureWidth, kPictureWidth * size.y() / size.x(), low.x(), -low.y() - size.y(), size.x(),
      size.y(), lane, pad.x() - 0.5 * deck, -pad.y() - 0.5 * deck, deck, deck, shapes, start.x(),
      -start.y(), start.x(), -start.y(), start.x() + std::cos(yaw), -start.y() - std::sin(yaw));
}

std::string Row(const std::string& name, const HostileTally& t) {
  return fmt::format(
      "<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</"
      "td>"
      "<td>{}</td><td>{}</td></tr>\n",
      t.collisions + t.safety.uncertified_steps > 0 ? " class='bad'" : "", name, t.flights, t.ways,
      RateText(t.collisions, t.flights), t.all_contacts(), t.landed,
      RateText(t.seeing_landed, t.seeing), t.all_stood(), t.timeouts, t.lost + t.other);
}

std::string Table(const std::vector<SweepRow>& rows, bool within) {
  const HostileTally all = TallyOf(rows, "", within);
  if (all.flights == 0) return {};
  std::string html =
      fmt::format("<h2>{} the assumptions</h2>\n<table><tr>", within ? "Within" : "Beyond");
  for (const char* head : {"family", "flights", "a way exists", "collisions", "other contacts",
                           "landed", "landed, of those with a way that see at least once a second",
                           "stood", "timeouts", "other"}) {
    html += fmt::format("<th>{}</th>", head);
  }
  html += "</tr>\n";
  for (const HostileFamily& family : HostileFamilies()) {
    const HostileTally tally = TallyOf(rows, family.name, within);
    if (tally.flights > 0) html += Row(family.name, tally);
  }
  return html + Row("all", all) + "</table>\n";
}

template <typename Holds>
std::string List(const std::string& title, const std::vector<SweepRow>& rows,
                 const std::map<int, std::string>& flights, const Holds& holds) {
  std::string items;
  for (const SweepRow& row : rows) {
    if (!holds(row.result)) continue;
    items +=
        fmt::format("<li>flight {}, {}, beyond: {}, at {:.1f} s. {} {}<br><code>{}</code></li>\n",
                    row.trial.index, LabelOf(row.trial, "family"), LabelOf(row.trial, "beyond"),
                    row.result.simulated_s, FlightLink(flights, row.trial.index),
                    Escaped(row.result.detail), Escaped(row.trial.Replay()));
  }
  return items.empty() ? std::string() : fmt::format("<h2>{}</h2>\n<ul>\n{}</ul>\n", title, items);
}

// All that can be looked at, whatever came of them.
std::string RecordedFlights(const std::vector<SweepRow>& rows,
                            const std::map<int, std::string>& flights) {
  if (flights.empty()) return {};
  std::string html =
      "<h2>Flights to look at</h2>\n<table><tr><th>flight</th><th>family</th><th>outcome</th>"
      "<th>flight ended after [s]</th><th>least clearance [m]</th><th></th></tr>\n";
  for (const SweepRow& row : rows) {
    if (!flights.contains(row.trial.index)) continue;
    const TrialResult& r = row.result;
    html += fmt::format(
        "<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{:.2f}</td><td>{}</td><td>{}</td></tr>\n",
        r.succeeded() ? "" : " class='bad'", row.trial.index, LabelOf(row.trial, "family"),
        ToString(r.outcome), r.simulated_s,
        r.min_clearance_m ? fmt::format("{:.3f}", *r.min_clearance_m) : "",
        FlightLink(flights, row.trial.index));
  }
  return html + "</table>\n";
}

std::string CountTable(const std::string& title, const std::map<std::string, int>& within,
                       const std::map<std::string, int>& beyond) {
  std::map<std::string, std::pair<int, int>> both;
  for (const auto& [name, count] : within) both[name].first = count;
  for (const auto& [name, count] : beyond) both[name].second = count;
  if (both.empty()) return {};
  std::string html =
      fmt::format("<h2>{}</h2>\n<table><tr><th></th><th>within</th><th>beyond</th></tr>\n", title);
  for (const auto& [name, counts] : both) {
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", Escaped(name), counts.first,
                        counts.second);
  }
  return html + "</table>\n";
}

std::string Safety(const HostileTally& within, const HostileTally& beyond) {
  std::string html =
      "<h2>The safety rule</h2>\n<table><tr><th></th><th>within</th><th>beyond</th></tr>\n";
  const SafetyLines first = SafetyFacts(within), second = SafetyFacts(beyond);
  for (std::size_t i = 0; i < first.size(); ++i) {
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", first[i].first,
                        within.flights > 0 ? first[i].second : "-",
                        beyond.flights > 0 ? second[i].second : "-");
  }
  return html + "</table>\n";
}

std::string Worlds(const std::vector<SweepRow>& rows, const Registries& registries) {
  std::string html =
      "<h2>The worlds</h2>\n<p>The first flight of each family from above. Dark: walls; light: "
      "lower "
      "than 1 m; blue: off the ground; green: the pad and its lane; red: the start and its "
      "heading.</p>\n";
  for (const HostileFamily& family : HostileFamilies()) {
    const auto first = std::find_if(rows.begin(), rows.end(), [&](const SweepRow& row) {
      return LabelOf(row.trial, "family") == family.name;
    });
    if (first == rows.end()) continue;
    html +=
        fmt::format("<figure>{}<figcaption><b>{}</b>, flight {}: {}. {}.</figcaption></figure>\n",
                    TopView(first->trial.scenario, registries), family.name, first->trial.index,
                    family.what, family.ranges);
  }
  return html;
}

std::string Conditions() {
  std::string html =
      "<h2>The conditions</h2>\n<table><tr><th>name</th><th>keys</th><th>within</th>"
      "<th>beyond</th></tr>\n";
  for (const HostileCondition& c : HostileConditions()) {
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", c.name, c.keys,
                        c.within, c.beyond);
  }
  return html + "</table>\n";
}

}  // namespace

std::string HostilePage(const HostileOptions& options, const std::vector<SweepRow>& rows,
                        const std::map<int, std::string>& flights, const Registries& registries) {
  const HostileTally within = TallyOf(rows, "", true), beyond = TallyOf(rows, "", false);
  std::string build;
  for (const auto& [key, value] : BuildManifest()) {
    if (key == "touchdown_version" || key == "revision" || key == "build_type" || key == "cpu") {
      build += fmt::format("{}{} {}", build.empty() ? "" : ", ", key, value);
    }
  }
  std::string html = fmt::format(
      "<h1>Hostile worlds: {} "
      "flights</h1>\n<p><code>{}</code><br>{}. "
      "Rates stand with their 95 % Clopper-Pearson interval.</p>\n",
      rows.size(), Escaped(HostileCommand(options)), Escaped(build));
  html += Table(rows, true) + Table(rows, false) + Safety(within, beyond);
  html += List("Collisions with what stands", rows, flights, HitWhatStands);
  html += CountTable("Other contacts, by kind", within.contacts, beyond.contacts);
  html += List("Other contacts", rows, flights, WrongContact);
  html += CountTable("Why flights stood", within.stood, beyond.stood);
  html += List("Stood, or out of time", rows, flights, CameToNothing);
  html += List("Ended otherwise", rows, flights, EndedOtherwise);
  html += RecordedFlights(rows, flights);
  return HtmlPage("Hostile worlds", html + Worlds(rows, registries) + Conditions());
}

}  // namespace touchdown::evaluation
