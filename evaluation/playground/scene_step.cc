// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/playground/scene_step.h"

#include <chrono>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "control/onboard/pilot.h"
#include "evaluation/flight/field_map.h"
#include "evaluation/playground/scene_setup.h"
#include "evaluation/record/step_json.h"
#include "sim/sensors/depth_camera.h"
#include "touchdown/control/onboard/envelope.h"
#include "touchdown/planning/map/pad_outline.h"
#include "touchdown/solvers/backend_registry.h"

namespace touchdown::evaluation {
namespace {

using AnswerDocument = nlohmann::ordered_json;

constexpr double kPadStep = 0.1;  // of the pad's way that is shown [s]

planning::ReplanInput QuestionOf(const PlaygroundScene& scene,
                                 const estimation::PadPrediction& pad) {
  const control::MissionParameters mission;
  planning::ReplanInput input;
  input.t_start = OnboardOptionsOf(scene).latency.time;
  input.vehicle = StartOf(scene);
  input.pad = &pad;
  input.endpoint =
      control::ContactTarget(PlaygroundVehicle(), mission.touchdown_rate, control::kLevelTime);
  return input;
}

planning::OccupancyMap KnownMap(const PlaygroundScene& scene) {
  planning::OccupancyMap map(OnboardOptionsOf(scene).map);
  LearnScene(scene, &map);
  return map;
}

}  // namespace

void LearnScene(const PlaygroundScene& scene, planning::OccupancyMap* map) {
  map->Recentre(scene.p_WB);
  const sim::ObstacleField field = FieldOf(scene);
  if (scene.all_known) {
    FillMap(field, map);
    return;
  }
  map->MarkFree(scene.p_WB, OnboardOptionsOf(scene).start_free);
  const estimation::PadState pad = sim::PadMotion(scene.pad).At(0.0);
  estimation::DepthFrame frame;
  sim::DepthCamera({}, field, PlaygroundPad(), scene.seed).Capture(StartOf(scene), pad, &frame);
  map->Integrate(frame, planning::OutlineOf(pad, PlaygroundPad().deck_half_size));
}

nlohmann::ordered_json AnswerJson(const planning::ReplanResult& result,
                                  const estimation::PadPrediction& pad, double t_now) {
  AnswerDocument json;
  json["status"] = planning::ToString(result.status);
  json["reason"] = planning::ToString(result.reason);
  json["sentences"] = {planning::Explain(result.status)};
  if (result.reason != planning::ReplanReason::kNone) {
    json["sentences"].push_back(planning::Explain(result.reason));
  }
  if (!result.detail.empty()) json["sentences"].push_back(result.detail);
  json["passed"] = result.certificate.passed();
  const bool stops = std::isfinite(result.t_stop);
  json["pair"] = {{"curve", CurveJson(result.curve)},
                  {"t_stop", stops ? AnswerDocument(result.t_stop) : AnswerDocument()},
                  {"stop", stops ? CurveJson(result.stop) : AnswerDocument()}};
  json["certificate"] = CertificateJson(result.certificate);
  AnswerDocument& guides = json["guide_paths"] = AnswerDocument::array();
  for (const auto& path : result.guide_paths) guides.push_back(PathJson(path));
  json["unseen_W"] = result.unseen_W ? VectorJson(*result.unseen_W) : AnswerDocument();
  AnswerDocument& way = json["pad"] = AnswerDocument::array();
  for (double t = t_now; t <= result.curve.t_end(); t += kPadStep) {
    const estimation::PadState state = pad.At(t);
    way.push_back({{"t", t}, {"p", VectorJson(state.p_WP)}, {"yaw", state.yaw}});
  }
  json["solves"] = result.solves;
  json["rebinds"] = result.rebinds;
  json["work"] = result.work;
  json["pairs"] = result.pairs;
  json["iterations"] = result.solver.iterations;
  json["cost"] = result.solver.cost;
  AnswerDocument& terms = json["terms"] = AnswerDocument::array();
  for (const solvers::TermCost& term : result.solver.cost_by_term) terms.push_back(term.name);
  return json;
}

SceneStep::SceneStep(const PlaygroundScene& scene)
    : map_(KnownMap(scene)),
      pad_(sim::PadMotion(scene.pad)),
      replanner_(PlannerOf(scene), solvers::StandardBackends()),
      input_(QuestionOf(scene, pad_)) {
  replanner_.Prepare(map_);
  replanner_.CommitHover(scene.p_WB, 0.0);
  before_ = replanner_.state();
}

const planning::ReplanResult& SceneStep::Ask() {
  replanner_.Restore(before_);
  return replanner_.Replan(input_, map_);
}

nlohmann::ordered_json SceneStep::Explain() {
  planning::ReplanLog log;
  replanner_.set_log(&log);
  nlohmann::ordered_json json = AnswerJson(Ask(), pad_, input_.t_now);
  replanner_.set_log(nullptr);
  json["attempts"] = AttemptsJson(log);
  return json;
}

double SceneStep::MeanTime(int steps) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  for (int i = 0; i < steps; ++i) Ask();
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count() / steps;
}

}  // namespace touchdown::evaluation
