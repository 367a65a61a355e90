// SPDX-License-Identifier: BSD-3-Clause
// touchdown fly and land: one closed-loop flight, its summary, and on request its record, picture and video.
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "estimation/base/degrees.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/map_file.h"
#include "evaluation/base/output_path.h"
#include "evaluation/base/statistics.h"
#include "evaluation/flight/closed_loop.h"
#include "evaluation/page/replay_page.h"
#include "evaluation/program/commands.h"
#include "evaluation/record/record.h"
#include "evaluation/record/trial_json.h"
#include "evaluation/report/report_program.h"
#include "evaluation/scenario/planner_options.h"
#include "evaluation/scenario/scenario_world.h"
#include "evaluation/video/flight_video.h"
#include "sim/vehicle/vehicle_file.h"

namespace touchdown::evaluation {
namespace {

struct FlyArguments {
  ScenarioArguments scenario;
  std::string record;
  std::string plot;
  std::string html;
  std::string video;
  std::string save_map;
  bool json = false;
};

// 5,031
std::string Grouped(std::int64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t i = digits.size(); i > 3;) digits.insert(i -= 3, ",");
  return digits;
}

std::string PriorSentences(const PriorFigures& prior) {
  std::string text = fmt::format(
      "map.prior: {} of its {} occupied cells were looked at; {} of them are free. {} cells that "
      "it holds free are occupied.\n",
      Grouped(prior.looked_at), Grouped(prior.occupied), Grouped(prior.gone),
      Grouped(prior.appeared));
  if (prior.gone + prior.appeared > 0) {
    text += "warning: what was seen contradicts map.prior; --save-map writes a newer one.\n";
  }
  return text;
}

// As it was drawn for the flight.
std::string WindText(const Scenario& scenario, std::uint64_t seed) {
  const sim::WindConfig wind = WindOf(scenario, DrawTrial(scenario, seed));
  if (wind.max == 0.0 && wind.gust.speed == 0.0) return {};
  std::string text = fmt::format(
      "  wind                   {:g} m/s in the mean, towards {:.0f} deg from x, left positive",
      wind.mean, wind.direction * estimation::kDegPerRad);
  if (wind.max > wind.mean) text += fmt::format("; at most {:g} m/s", wind.max);
  if (wind.gust.speed > 0.0) text += fmt::format("; gusts of {:g} m/s along it", wind.gust.speed);
  return text + "\n";
}

std::string ZonesText(const Scenario& scenario, const estimation::VehicleModel& model,
                      const Registries& registries) {
  if (!PlannerOf(scenario, registries).solver.empty()) return {};  // it has no terms
  std::string text;
  for (const planning::NamedZone& named :
       ZonesOf(PlannerOptions(scenario, model, registries.terms))) {
    const Eigen::Vector3d &centre = named.zone.centre_W, &size = named.zone.size;
    text += fmt::format("  {:<23}{} around [{:g}, {:g}, {:g}] m, {:g} x {:g} x {:g} m\n",
                        "zone of " + named.term, planning::ToString(named.zone.shape), centre.x(),
                        centre.y(), centre.z(), size.x(), size.y(), size.z());
  }
  return text;
}

std::string Summary(const Scenario& scenario, const TrialResult& r, const Registries& registries) {
  std::string text;
  if (r.landed()) {
    const Touchdown& t = *r.touchdown;
    text = fmt::format("landed on {} after {:.2f} s (seed {})\n", scenario.name, t.t, r.seed);
    text += fmt::format("  touchdown error        {:.3f} m\n", t.error_m);
    text += fmt::format("  relative velocity      [{:.3f}, {:.3f}, {:.3f}] m/s\n",
                        t.relative_velocity.x(), t.relative_velocity.y(), t.relative_velocity.z());
    text += fmt::format("  tilt over equilibrium  {:.1f} deg\n",
                        t.tilt_over_equilibrium * estimation::kDegPerRad);
    if (const auto last = LastErrors(scenario, r)) {
      text += fmt::format("  mean |error|, last 5 s {:.3f} m in x, {:.3f} m in y\n", last->x(),
                          last->y());
    }
  } else if (r.outcome == Outcome::kArrived) {
    text = fmt::format("arrived at the goal of {} after {:.2f} s (seed {})\n", scenario.name,
                       r.simulated_s, r.seed);
  } else if (r.succeeded()) {
    text = fmt::format("followed the pad of {}: done after {:.2f} s (seed {})\n", scenario.name,
                       r.simulated_s, r.seed);
  } else {
    const char* missed = scenario.task == TaskKind::kLand     ? "not landed on"
                         : scenario.task == TaskKind::kFollow ? "did not follow the pad of"
                                                              : "not at the goal of";
    text = fmt::format("{}: {} {} within {:.2f} s (seed {}). {}\n", ToString(r.outcome), missed,
                       scenario.name, r.simulated_s, r.seed, r.detail);
  }
  if (r.following) {
    text += fmt::format("  error, last 10 s       {:.3f} m in the mean, {:.3f} m at most\n",
                        r.following->mean_error_m, r.following->max_error_m);
    text += fmt::format("  relative speed         {:.3f} m/s in the mean\n",
                        r.following->relative_speed_mps);
  }
  if (r.min_clearance_m) {
    text += fmt::format("  least true clearance   {:.3f} m\n", *r.min_clearance_m);
  }
  text += WindText(scenario, r.seed);
  const estimation::VehicleModel model = sim::LoadVehicleModel(VehicleMjcf(scenario));
  text += ZonesText(scenario, model, registries);
  if (r.own_state) {
    const OwnStateQuality& own = *r.own_state;
    text += fmt::format("  own state, RMS error   {:.3f} m, {:.3f} m/s, {:.2f} deg\n",
                        own.rmse_position_m, own.rmse_velocity_mps,
                        own.rmse_attitude_rad * estimation::kDegPerRad);
  }
  if (r.safety) {
    const SafetyFigures& safety = *r.safety;
    text += fmt::format(
        "  safety                 uncertified steps {}, narrow steps {}, stops flown {}, "
        "map errors {}, errors beyond a margin {}\n",
        safety.uncertified_steps, safety.narrow_steps, safety.stops_flown, safety.map_errors,
        safety.tracking_events + safety.drift_events);
  }
  if (const double kept = PlanClearance(scenario, model, registries);
      kept > scenario.planning.clearance) {
    text += fmt::format(
        "  planning.clearance     raised from {:g} to {:.3f} m, the hull at every tilt and its "
        "margins\n",
        scenario.planning.clearance, kept);
  }
  if (r.looks > 0) text += fmt::format("  looks                  {}\n", r.looks);
  text += fmt::format("  replans                {}", r.replans);
  for (const auto& [status, count] : r.replans_by_status) {
    text += fmt::format(", {} {}", count, status);
  }
  // Of the steps that made no new plan.
  const char* separator = "; without a plan: ";
  for (const auto& [reason, count] : r.replans_by_reason) {
    text += fmt::format("{}{} {}", std::exchange(separator, ", "), count, reason);
  }
  separator = "; forbidden by: ";
  for (const auto& [name, count] : r.replans_forbidden_by) {
    text += fmt::format("{}{} {}", std::exchange(separator, ", "), count, name);
  }
  if (const auto median = Quantile(r.timing.replan_wall_ms, 0.5)) {
    text += fmt::format(
        "\n  replanning             median {:.2f} ms, p95 {:.2f} ms, largest {:.2f} ms, {} of {} "
        "longer "
        "than their latency",
        *median, *Quantile(r.timing.replan_wall_ms, 0.95), *Quantile(r.timing.replan_wall_ms, 1.0),
        r.timing.deadline_misses, r.timing.replan_wall_ms.size());
    // Those late by their wall time alone waited for a loaded machine.
    if (r.timing.deadline_misses > 0) {
      text += fmt::format(" ({} by CPU time alone, largest {:.2f} ms)",
                          r.timing.deadline_misses_cpu, *Quantile(r.timing.replan_cpu_ms, 1.0));
    }
  }
  text += fmt::format(
      "\n  speed                  {:.1f} x real time (planning {:.0f} %, physics "
      "{:.0f} %, sensing and map {:.0f} % of the CPU time)\n",
      r.timing.simulated_s / r.timing.wall_s, 100.0 * r.timing.planning_cpu_s / r.timing.cpu_s,
      100.0 * r.timing.physics_cpu_s / r.timing.cpu_s,
      100.0 * (r.timing.sensing_cpu_s + r.timing.mapping_cpu_s) / r.timing.cpu_s);
  if (r.prior) text += PriorSentences(*r.prior);
  if (r.prior && !r.succeeded()) {
    text +=
        "Occupied cells of map.prior block plans until the camera sees them free. Check map.prior, "
        "near the start first.\n";
  }
  return text;
}

void CheckFlightOutputs(const FlyArguments& arguments, const Scenario& scenario) {
  CheckApart({{"--record", arguments.record},
              {"--plot", arguments.plot},
              {"--html", arguments.html},
              {"--video", arguments.video},
              {"--save-map", arguments.save_map}});
  if (!arguments.record.empty()) CheckRecordPath("--record", arguments.record);
  if (!arguments.plot.empty()) CheckPicturePath("--plot", arguments.plot);
  if (!arguments.html.empty()) CheckReplayPage("--html", arguments.html);
  if (!arguments.video.empty()) CheckVideo("--video", arguments.video, scenario);
  if (!arguments.save_map.empty()) CheckMapPath("--save-map", arguments.save_map);
}

// The result is printed first, so that a file or picture that fails does not hide it.
int Fly(const FlyArguments& arguments, const Scenario& scenario, const Registries& registries) {
  CheckFlightOutputs(arguments, scenario);
  TrialRecord record;
  const bool recorded = !arguments.record.empty() || !arguments.plot.empty() ||
                        !arguments.html.empty() || !arguments.video.empty();
  std::optional<planning::PersistentMap> map;
  const TrialResult result =
      RunTrial(scenario, scenario.seed, registries, recorded ? &record : nullptr,
               arguments.save_map.empty() ? nullptr : &map);
  if (arguments.json) {
    std::cout << LandJson(scenario, result).dump(2) << std::endl;
  } else {
    std::cout << Summary(scenario, result, registries) << std::flush;
  }
  const auto write = [&](const std::string& path) { WriteRecord(path, scenario, result, record); };
  if (!arguments.record.empty()) write(arguments.record);
  if (map) WriteMapFile(arguments.save_map, &*map);
  if (!arguments.plot.empty()) DrawFrom(arguments.record, arguments.plot, write, DrawLanding);
  if (!arguments.html.empty()) {
    DrawFrom(arguments.record, arguments.html, write,
             [&](const std::string& kept, const std::string& page) {
               const bool stays = !arguments.record.empty();
               WriteReplayPage(page, {{kept, stays ? kept : scenario.name, stays}}, registries,
                               LogReplay());
             });
    if (!arguments.json) PrintPagePath(arguments.html);
  }
  if (!arguments.video.empty()) {
    const VideoProgress tell = TellVideo();
    DrawFrom(arguments.record, arguments.video, write,
             [&](const std::string& table, const std::string& video) {
               WriteVideo(table, video, registries, tell);
             });
  }
  return result.succeeded() ? kDone : kFellShort;
}

// The command of any task, or, with `lands`, of landings alone.
void AddFlight(Command app, const char* name, const char* help, bool lands,
               const Registries& registries, CommandRun* run) {
  const Command command = app.AddCommand(name, help, "scenario.md");
  const auto arguments = std::make_shared<FlyArguments>();
  arguments->scenario.AddTo(command, false);
  command.Add("--seed", arguments->scenario.seed, "Short for --set seed=").TypeName("S");
  command.AddFile("--record", &arguments->record,
                  "Write the record, an SQLite file; an older one is overwritten", "F.db");
  command.AddFile("--plot", &arguments->plot,
                  "Draw plan and side view; an older file is overwritten", "F.png");
  command.AddFile("--html", &arguments->html,
                  "Write a page that shows the flight in three dimensions (`touchdown replay`); an "
                  "older file is overwritten",
                  "F.html");
  command.AddFile("--video", &arguments->video,
                  "Make a video of the flight, by the program ffmpeg; an older file is overwritten",
                  "F.mp4");
  command.AddFile(
      "--save-map", &arguments->save_map,
      "Write what was seen of the world, an OctoMap file; an older file is overwritten; see "
      "map.prior",
      "F.bt|F.ot");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.OnChosen([arguments, lands, &registries, run] {
    *run = [arguments, lands, &registries] {
      const Scenario scenario = arguments->scenario.Load(registries);
      if (lands && scenario.task != TaskKind::kLand) {
        throw BadInput(fmt::format("land is for task: land; `touchdown fly` flies task: {} too.",
                                   ToString(scenario.task)));
      }
      return Fly(*arguments, scenario, registries);
    };
  });
}

}  // namespace

void AddFlyCommands(Command app, const Registries& registries, CommandRun* run) {
  AddFlight(app, "fly", "Fly one scenario in closed loop, whatever its task", false, registries,
            run);
  AddFlight(app, "land", "The same for task: land", true, registries, run);
}

}  // namespace touchdown::evaluation
