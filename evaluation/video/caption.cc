// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/video/caption.h"

#include <algorithm>

#include <fmt/format.h>

namespace touchdown::evaluation {
namespace {

std::string Spoken(std::string words) {
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

// What the last events leave to be said.
std::string StateOf(const FlightTrack& track, double t_next) {
  std::string mode, end, touched;
  for (const TrackEvent& event : track.events()) {
    if (event.t >= t_next) break;
    if (event.kind == "mode") mode = Spoken(event.text);
    if (event.kind == "contact" && touched.empty()) {
      touched = fmt::format(", contact of {} at {:.2f} s", event.text, event.t);
    }
    if (event.kind == "outcome") end = Spoken(event.text);
  }
  const auto& touchdown = track.touchdown();
  if (touchdown && touchdown->t < t_next) {
    touched = fmt::format(", touchdown at {:.2f} s, {:.3f} m from the middle", touchdown->t,
                          touchdown->error_m);
  }
  return (end.empty() ? mode : end) + touched;
}

}  // namespace

const RecordPlan* PlanAt(const std::vector<RecordPlan>& plans, double t) {
  const auto after = std::upper_bound(
      plans.begin(), plans.end(), t,
      [](double time, const RecordPlan& plan) { return time < plan.request.input.t_start; });
  return after == plans.begin() ? nullptr : &*(after - 1);
}

std::string Fitting(const std::string& text, int width, const sim::Font& font) {
  std::size_t letters = 0;
  for (; letters < text.size(); ++letters) {
    width -= font.Of(text[letters]).width;
    if (width < 0) break;
  }
  return text.substr(0, letters);
}

Caption CaptionOf(const RecordedFlight& flight, const FlightTrack& track, const TrackSample& now,
                  double t_next, const Eigen::Vector3d& target_W) {
  const Scenario& scenario = flight.scenario;
  Caption caption;
  caption.flight =
      fmt::format("{}, planner {}, seed {}", scenario.name, scenario.planner, scenario.seed);
  caption.time = fmt::format("{:.2f} s", now.vehicle.t);
  caption.state = StateOf(track, t_next);
  const RecordPlan* const plan = PlanAt(flight.plans, now.vehicle.t);
  if (plan != nullptr && plan->result.reason != planning::ReplanReason::kNone) {
    caption.state +=
        fmt::format("; no new plan: {}, {}", Spoken(planning::ToString(plan->result.reason)),
                    Spoken(planning::ToString(plan->result.status)));
  }
  const Eigen::Vector3d way = now.vehicle.p_WB - target_W;
  caption.distance = fmt::format("{:.2f} m to the {}, {:.2f} m above it", way.head<2>().norm(),
                                 scenario.task == TaskKind::kGoTo ? "goal" : "pad", way.z());
  return caption;
}

}  // namespace touchdown::evaluation
