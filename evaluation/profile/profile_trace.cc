// SPDX-License-Identifier: BSD-3-Clause
// The trace event format of Chrome: "X" is a complete event, "M" names a process or a thread. Times
// in microseconds.
#include <cstring>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/profile/profile_report.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kProcess = 1;
constexpr int kPerception = 1;
constexpr int kPlanning = 2;

Json Name(const char* what, int track, const std::string& name) {
  return {
      {"name", what}, {"ph", "M"}, {"pid", kProcess}, {"tid", track}, {"args", {{"name", name}}}};
}

}  // namespace

Json ChromeTrace(const Profile& profile) {
  Json events = Json::array();
  events.push_back(Name("process_name", 0, "touchdown " + profile.scenario.name));
  events.push_back(Name("thread_name", kPerception, "perception"));
  events.push_back(Name("thread_name", kPlanning, "planning"));
  // Spans are in the order in which they began: the totals are a run's steps, one after the other.
  std::size_t run = 0;
  int step = -1;
  const std::vector<planning::LoggedSpan>& spans = profile.spans.spans();
  for (std::size_t i = 0; i < spans.size(); ++i) {
    for (; run + 1 < profile.runs.size() && i >= profile.runs[run + 1].first_span; ++run) step = -1;
    const planning::LoggedSpan& span = spans[i];
    const bool total = std::strcmp(span.stage, "total") == 0;
    const bool perception =
        std::strcmp(span.stage, "sense") == 0 || std::strcmp(span.stage, "map") == 0;
    Json event = {{"name", span.stage},
                  {"cat", perception ? "perception" : "planning"},
                  {"ph", "X"},
                  {"pid", kProcess},
                  {"tid", perception ? kPerception : kPlanning},
                  {"ts", 1e6 * span.begin},
                  {"dur", 1e6 * span.wall}};
    Json& args = event["args"];
    if (total) {
      ++step;
      const ReplanSample& sample =
          profile.runs[run].samples.replans.at(static_cast<std::size_t>(step));
      event["name"] = fmt::format("replan {}", step);
      args["status"] = planning::ToString(sample.status);
      args["reason"] = planning::ToString(sample.reason);
      if (!sample.forbidden_by.empty()) args["forbidden_by"] = sample.forbidden_by;
      args["t_now"] = sample.t_now;
    }
    if (!perception) {
      args["run"] = run;
      args["replan"] = step;
    }
    args["cpu_us"] = 1e6 * span.cpu;
    events.push_back(std::move(event));
  }
  return {{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}};
}

}  // namespace touchdown::evaluation
