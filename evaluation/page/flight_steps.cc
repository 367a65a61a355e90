// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/page/flight_steps.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/page/rounded.h"
#include "evaluation/record/plan_case.h"
#include "evaluation/record/plan_report.h"
#include "evaluation/scenario/planner_options.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

Json CurveOf(const planning::UniformBspline& curve) {
  return {{"t0", Rounded(curve.t0(), 4)},
          {"h", Rounded(curve.interval(), 5)},
          {"q", RoundedPoints(curve.control_points())}};
}

Json PathsOf(const std::vector<std::vector<Eigen::Vector3d>>& paths) {
  Json json = Json::array();
  for (const std::vector<Eigen::Vector3d>& path : paths) {
    Json& points = json.emplace_back(Json::array());
    for (const Eigen::Vector3d& p : path) {
      for (const double x : p) points.push_back(Rounded(x, kMilli));
    }
  }
  return json;
}

// The data that every planner's record has.
Json RecordedStep(const RecordPlan& plan) {
  const planning::ReplanInput& input = plan.request.input;
  const ReplanOutcome& result = plan.result;
  const planning::Certificate& c = result.certificate;
  Json json = {{"t", Rounded(input.t_now, kMilli)},
               {"t_start", Rounded(input.t_start, kMilli)},
               {"status", planning::ToString(result.status)},
               {"reason", planning::ToString(result.reason)},
               {"curve", CurveOf(result.curve)},
               {"guides", PathsOf(result.guide_paths)},
               {"look", input.look_from_W ? RoundedPoint(*input.look_from_W) : Json()},
               {"earlier", c.earlier},
               {"clearance", Rounded(c.clearance, kMilli)},
               {"solves", result.solves},
               {"iterations", result.iterations},
               {"work", result.work},
               {"latency_ms", Rounded(1e3 * plan.latency_s, 2)},
               {"wall_ms", Rounded(1e3 * plan.wall_s, kMilli)}};
  return json;
}

std::string RecordedWords(const RecordPlan& plan) {
  const ReplanOutcome& r = plan.result;
  std::string text = fmt::format("asked at t = {:.3f} s for a curve that takes over at {:.3f} s\n",
                                 plan.request.input.t_now, plan.request.input.t_start);
  text += fmt::format("{}: {}\n", planning::ToString(r.status), planning::Explain(r.status));
  if (r.reason != planning::ReplanReason::kNone) {
    text += fmt::format("  no new plan: {}: {}\n", planning::ToString(r.reason),
                        planning::Explain(r.reason));
  }
  return text + fmt::format("  {} solves, {} pairs\n", r.solves, r.pairs);
}

// The answer's attempt is the last one that failed for no reason; none where there is no new plan.
const planning::AttemptLog* Winner(const SolvedStep& solved) {
  if (solved.outcome.status != planning::ReplanStatus::kPlanned) return nullptr;
  const auto& attempts = solved.log.attempts;
  const auto won = std::find_if(attempts.rbegin(), attempts.rend(), [](const auto& attempt) {
    return attempt.reason == planning::ReplanReason::kNone && attempt.best >= 0;
  });
  return won == attempts.rend() ? nullptr : &*won;
}

// The curve of the last solve of every attempt and way around, without the answer.
Json LostWays(const SolvedStep& solved, const planning::AttemptLog* winner) {
  Json lost = Json::array();
  for (const planning::AttemptLog& attempt : solved.log.attempts) {
    const int rounds = static_cast<int>(attempt.rounds.size());
    for (int i = 0; i < rounds; ++i) {
      const planning::RoundLog& round = attempt.rounds[static_cast<std::size_t>(i)];
      const bool last_of_way =
          i + 1 == rounds || attempt.rounds[static_cast<std::size_t>(i) + 1].guide != round.guide;
      if (!last_of_way || !round.solver.usable() || (&attempt == winner && i == attempt.best))
        continue;
      lost.push_back(RoundedPoints(round.curve.control_points()));
    }
  }
  return lost;
}

Json PairsOf(const planning::AttemptLog* winner, const SolvedStep& solved) {
  Json json = Json::array();
  const planning::RoundLog* round = nullptr;
  if (winner != nullptr) {
    round = &winner->rounds[static_cast<std::size_t>(winner->best)];
  } else if (!solved.log.attempts.empty() && !solved.log.attempts.back().rounds.empty()) {
    round = &solved.log.attempts.back().rounds.back();
  }
  if (round == nullptr) return json;
  for (const planning::ObstaclePair& pair : round->pairs) {
    for (const double x : pair.p) json.push_back(Rounded(x, kMilli));
    for (const double x : pair.v) json.push_back(Rounded(x, kMilli));
  }
  return json;
}

Json StagesOf(const planning::StageTimes& times) {
  Json json = Json::object();
  for (const planning::StageTimes::Span* stage : times.Stages()) {
    if (stage == &times.look) continue;  // the scout is not asked again
    json[stage->stage] = Rounded(1e3 * stage->cpu, kMilli);
  }
  json["total"] = Rounded(1e3 * times.total.cpu, kMilli);
  return json;
}

Json PadOf(const SolvedStep& solved) {
  Json json = Json::array();
  for (const estimation::PadState& pad : solved.pad) {
    for (const double x : pad.p_WP) json.push_back(Rounded(x, kMilli));
  }
  return json;
}

// A stored stop is flown, for want of a newer pair.
bool FliesStop(const SolvedStep& solved) {
  return solved.outcome.status == planning::ReplanStatus::kBraking && !solved.committed &&
         std::isfinite(solved.pair.t_stop);
}

void AddAskedAgain(const RecordedFlight& flight, Replay* replay, Json* json) {
  SolvedStep solved = SolveSought(flight, replay);
  solved.same = Same(solved.outcome, solved.recorded.result);
  solved.source = fmt::format("replanning step {} of {}", solved.step, flight.path);
  const planning::AttemptLog* winner = Winner(solved);
  (*json)["same"] = *solved.same;
  (*json)["stop"] = std::isfinite(solved.pair.t_stop) ? CurveOf(solved.pair.stop) : Json();
  (*json)["t_stop"] = Rounded(solved.pair.t_stop, kMilli);
  (*json)["stops"] = FliesStop(solved);
  (*json)["lost"] = LostWays(solved, winner);
  (*json)["pairs"] = PairsOf(winner, solved);
  (*json)["pad"] = PadOf(solved);
  (*json)["unseen"] = solved.unseen_W ? RoundedPoint(*solved.unseen_W) : Json();
  (*json)["stages"] = StagesOf(solved.times);
  (*json)["words"] = PlanText(solved);
}

}  // namespace

Json StepsDocument(const RecordedFlight& flight, const Registries& registries,
                   const std::function<void(int, int)>& done) {
  std::optional<Replay> replay;
  if (PlannerOf(flight.scenario, registries).solver.empty()) replay.emplace(flight, registries);
  Json steps = Json::array();
  const int all = static_cast<int>(flight.plans.size());
  for (int step = 0; step < all; ++step) {
    const RecordPlan& plan = flight.plans[static_cast<std::size_t>(step)];
    Json& json = steps.emplace_back(RecordedStep(plan));
    if (replay) {
      replay->Seek(step);
      AddAskedAgain(flight, &*replay, &json);
    } else {
      json["words"] = RecordedWords(plan);
    }
    done(step + 1, all);
  }
  return steps;
}

Json MapDocument(const RecordedFlight& flight) {
  Json steps = Json::array();
  for (const RecordPlan& plan : flight.plans) {
    const MapChange& change = plan.map_change;
    Json runs = Json::array();
    for (const MapRun& run : change.runs) {
      const planning::CellIndex from = run.cell - change.origin, left = flight.map_size - from;
      if (from.minCoeff() < 0 || left.minCoeff() <= 0 || left.x() < run.count) {
        throw std::invalid_argument("its table map_change has cells outside of the map's window");
      }
      for (const int x : {run.cell.x(), run.cell.y(), run.cell.z(), run.count}) runs.push_back(x);
      runs.push_back(static_cast<int>(run.state));
    }
    steps.push_back({{"origin", {change.origin.x(), change.origin.y(), change.origin.z()}},
                     {"runs", std::move(runs)}});
  }
  return {{"resolution", flight.map_resolution},
          {"size", {flight.map_size.x(), flight.map_size.y(), flight.map_size.z()}},
          {"steps", std::move(steps)}};
}

}  // namespace touchdown::evaluation
