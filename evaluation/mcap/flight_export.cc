// SPDX-License-Identifier: BSD-3-Clause
// What each topic holds, and when: docs/mcap.md. A message is made at its time. So memory holds the record, but only a
// part of the file.
#include "evaluation/mcap/flight_export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/atomic_file.h"
#include "evaluation/base/bad_input.h"
#include "evaluation/base/output_path.h"
#include "evaluation/base/rendering_check.h"
#include "evaluation/flight/pad_sensor.h"
#include "evaluation/judge/landing_judge.h"
#include "evaluation/mcap/flight_camera.h"
#include "evaluation/mcap/flight_figures.h"
#include "evaluation/mcap/flight_paths.h"
#include "evaluation/mcap/flight_scene.h"
#include "evaluation/mcap/mcap_writer.h"
#include "evaluation/mcap/messages.h"
#include "evaluation/mcap/occupied_cells.h"
#include "evaluation/page/flight_tables.h"
#include "evaluation/record/record_reader.h"
#include "evaluation/scenario/scenario_world.h"
#include "evaluation/video/flight_track.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr Color kFlownColor = {0.90, 0.62, 0.0, 1.0};
constexpr Color kPlanColor = {0.0, 0.45, 0.70, 1.0};
constexpr Color kBeliefColor = {0.80, 0.47, 0.65, 1.0};
constexpr double kMapPeriod = 0.5;       // between messages of the map at least [s]
constexpr double kMostMapBytes = 0.5e6;  // a second, of whole maps: large ones come less often
constexpr double kTrailPeriod = 0.5, kBeliefPeriod = 0.1;  // [s]

constexpr char kSchemaFrameTransforms[] = "foxglove.FrameTransforms";
constexpr char kSchemaSceneUpdate[] = "foxglove.SceneUpdate";
constexpr char kSchemaPointCloud[] = "foxglove.PointCloud";
constexpr char kSchemaPoseInFrame[] = "foxglove.PoseInFrame";
constexpr char kSchemaPosesInFrame[] = "foxglove.PosesInFrame";
constexpr char kSchemaCompressedImage[] = "foxglove.CompressedImage";
constexpr char kSchemaRawImage[] = "foxglove.RawImage";
constexpr char kSchemaCameraCalibration[] = "foxglove.CameraCalibration";
constexpr char kSchemaLog[] = "foxglove.Log";
constexpr char kSchemaState[] = "touchdown.State";
constexpr char kSchemaStep[] = "touchdown.Step";

// Every schema that a file can have.
constexpr const char* kSchemas[] = {kSchemaFrameTransforms,
                                    kSchemaSceneUpdate,
                                    kSchemaPointCloud,
                                    kSchemaPoseInFrame,
                                    kSchemaPosesInFrame,
                                    kSchemaCompressedImage,
                                    kSchemaRawImage,
                                    kSchemaCameraCalibration,
                                    kSchemaLog,
                                    kSchemaState,
                                    kSchemaStep};

std::string DescriptorsOf(const std::string& schema) {
  const std::string path = DataPath(fmt::format("mcap/{}.binpb", schema));
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file || bytes.empty()) throw std::runtime_error(fmt::format("{}: cannot be read", path));
  return bytes;
}

Eigen::Isometry3d PadPose(const Eigen::Vector3d& p_WP, double yaw) {
  return PoseOf(p_WP, Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())));
}

// Brown, light where it is high.
Color ColorAt(double height) {
  constexpr double kLow = 0.0, kHigh = 4.0;  // [m]
  const double s = std::clamp((height - kLow) / (kHigh - kLow), 0.0, 1.0);
  return {0.45 + 0.50 * s, 0.22 + 0.62 * s, 0.10 + 0.35 * s, 1.0};
}

class FlightExport {
 public:
  FlightExport(const std::string& record_path, const Registries& registries)
      : registries_(registries),
        flight_(ReadRecord(record_path, {}, registries)),
        track_(record_path),
        tables_(TablesOf(record_path)),
        figures_(flight_, track_),
        map_(flight_.map_size) {
    if (flight_.scenario.sensing == SensingKind::kRendered) {
      RequireRendering(fmt::format("{}, whose images are rendered,", record_path), "");
    }
  }

  void Write(std::ostream* out, const ExportProgress& progress) {
    McapWriter writer(out, fmt::format("touchdown {}", TOUCHDOWN_VERSION));
    writer_ = &writer;
    writer.AddMetadata("touchdown", Facts());
    AddFrames();
    AddScene();
    AddMap();
    AddPlans();
    AddFlown();
    AddPadBelief();
    AddCameras();
    AddStates();
    AddLog();
    std::stable_sort(due_.begin(), due_.end(),
                     [](const Message& a, const Message& b) { return a.t < b.t; });
    const int all = static_cast<int>(due_.size());
    for (int i = 0; i < all; ++i) {
      const Message& message = due_[static_cast<std::size_t>(i)];
      writer.Write(message.channel, Nanoseconds(message.t), message.make());
      if (progress) progress(i + 1, all);
    }
    writer.Finish();
  }

 private:
  struct Message {
    double t;
    std::uint16_t channel;
    std::function<std::string()> make;
  };

  static Json TablesOf(const std::string& record_path) {
    SqliteDb db(record_path, SqliteDb::Mode::kReadOnly);
    Json tables = FlightTables(db);
    // Samples are rounded for pages: here the track tells them. Of the modes the words are looked at.
    tables["samples"] = std::move(tables["samples"]["mode"]["names"]);
    try {
      tables.dump();  // which looks at all text
    } catch (const Json::type_error&) {
      throw std::invalid_argument("it holds text that is not UTF-8");
    }
    tables.erase("samples");
    return tables;
  }

  std::uint16_t Topic(const std::string& topic, const std::string& schema,
                      const std::string& about) {
    return writer_->AddTopic(topic, schema, DescriptorsOf(schema), {{"about", about}});
  }

  void Add(std::uint16_t channel, double t, std::function<std::string()> make) {
    due_.push_back({t, channel, std::move(make)});
  }

  // Calls for the first sample, and then for each that is at least `period` after the last it was called for.
  template <typename Call>
  void EachSample(double period, const Call& call) {
    double next = 0.0;
    for (int i = 0; i < figures_.count(); ++i) {
      if (figures_.TimeOf(i) < next - 1e-6) continue;
      next = figures_.TimeOf(i) + period;
      call(i);
    }
  }

  McapWriter::Words Facts() const {
    const Scenario& scenario = flight_.scenario;
    const Json& result = tables_.at("result");
    const Json& build = tables_.at("build");
    const auto words = [](const Json& json) { return json.get<std::string>(); };
    return {{"scenario", scenario.name},
            {"scenario_yaml", words(tables_.at("scenario_yaml"))},
            {"seed", std::to_string(scenario.seed)},
            {"planner", scenario.planner},
            {"solver", scenario.solver_name()},
            {"outcome", words(result.at("outcome"))},
            {"revision", words(build.at("revision"))},
            {"touchdown_version", words(build.at("touchdown_version"))}};
  }

  bool has_pad() const { return !figures_.goal(); }

  void AddFrames() {
    const std::uint16_t still =
        Topic("/tf_static", kSchemaFrameTransforms, "Where the cameras are on the vehicle");
    Add(still, 0.0, [this] {
      return FrameTransforms(0.0,
                             {{kVehicleFrame, kDownFrame, DownCameraPose(flight_.scenario)},
                              {kVehicleFrame, kDepthFrame, DepthCameraPose(flight_.scenario)}});
    });
    const std::uint16_t moving =
        Topic("/tf", kSchemaFrameTransforms,
              "Vehicle and pad as they truly are, the pad as it is believed to be");
    EachSample(0.0, [&](int i) {
      Add(moving, figures_.TimeOf(i),
          [this, i] { return FrameTransforms(figures_.TimeOf(i), FramesAt(i)); });
    });
  }

  std::vector<FramePose> FramesAt(int i) const {
    const TrackSample now = figures_.At(i);
    std::vector<FramePose> frames = {
        {kWorldFrame, kVehicleFrame, PoseOf(now.vehicle.p_WB, now.vehicle.q_WB)}};
    if (figures_.goal()) {
      frames.push_back(
          {kWorldFrame, kGoalFrame, PadPose(figures_.goal()->At(figures_.TimeOf(i)).p_WP, 0.0)});
    } else {
      frames.push_back({kWorldFrame, kPadFrame, PadPose(now.pad.p_WP, now.pad.yaw)});
    }
    if (const TrackBelief* belief = figures_.PadBelief(i)) {
      frames.push_back({kWorldFrame, kPadBeliefFrame, PadPose(belief->pad.p_WP, belief->pad.yaw)});
    }
    return frames;
  }

  void AddScene() {
    constexpr double kSpacing = 0.25, kFineSpacing = 0.03, kPadSpacing = 0.1;  // [m]
    constexpr std::size_t kMostPoints = 40000, kMostMovingPoints = 1000;
    constexpr double kMovingPeriod = 0.1;  // [s]
    const Scenario& scenario = flight_.scenario;
    std::vector<Eigen::Vector3d> places;
    EachSample(kTrailPeriod, [&](int i) {
      places.push_back(figures_.At(i).vehicle.p_WB);
      if (has_pad()) places.push_back(figures_.At(i).pad.p_WP);
    });
    std::vector<NamedSolids> obstacles = ObstacleSolids(scenario);
    const NamedSolids vehicle = VehicleSolids(scenario);
    const NamedSolids target = has_pad() ? PadSolids(scenario) : GoalSolids();
    std::vector<NamedSolids> all = {GroundSolids(obstacles, places), vehicle, target};
    all.insert(all.end(), obstacles.begin(), obstacles.end());
    for (NamedSolids& zone : ZoneSolids(tables_.at("zones"))) all.push_back(std::move(zone));
    Add(Topic("/scene", kSchemaSceneUpdate, "The world as it truly is, the vehicle and the pad"),
        0.0, [all] { return SceneUpdate(EntitiesOf(all)); });

    const auto cloud = [&](const std::string& topic, const std::vector<NamedSolids>& things,
                           double spacing, const std::string& about) {
      if (things.empty()) return;
      Add(Topic(topic, kSchemaPointCloud, about), 0.0, [things, spacing] {
        return PointCloud(0.0, things.front().frame, PointsOf(things, spacing, kMostPoints));
      });
    };
    cloud("/points/obstacles", obstacles, kSpacing, "Surfaces of the obstacles as they truly are");
    // Foxglove leaves a cloud where its frame was at the message's time. So moving clouds are sent again.
    const auto moving_cloud = [&](const std::string& topic, const NamedSolids& thing,
                                  double spacing, const std::string& about) {
      const std::uint16_t channel = Topic(topic, kSchemaPointCloud, about);
      const auto points =
          std::make_shared<const CloudPoints>(PointsOf({thing}, spacing, kMostMovingPoints));
      EachSample(kMovingPeriod, [&](int i) {
        const double t = figures_.TimeOf(i);
        Add(channel, t, [t, frame = thing.frame, points] { return PointCloud(t, frame, *points); });
      });
    };
    moving_cloud("/points/vehicle", vehicle, kFineSpacing, "Surface of the vehicle");
    moving_cloud(has_pad() ? "/points/pad" : "/points/goal", target, kPadSpacing,
                 has_pad() ? "Surface of the pad" : "Surface of the goal");
  }

  void AddMap() {
    const std::uint16_t occupied = Topic("/map/occupied", kSchemaPointCloud,
                                         "Middles of all cells that the vehicle holds occupied");
    const std::uint16_t changes =
        Topic("/map/changes", kSchemaPointCloud,
              "Middles of the cells that became occupied since the last message");
    OccupiedCells ahead(flight_.map_size);
    double next = 0.0, next_whole = 0.0;
    int applied = 0;
    for (int i = 0; i < static_cast<int>(flight_.plans.size()); ++i) {
      const double t = flight_.plans[static_cast<std::size_t>(i)].request.input.t_now;
      ahead.Apply(ChangeAt(i));
      if (t < next - 1e-6) continue;
      next = t + kMapPeriod;
      const int from = std::exchange(applied, i + 1);
      // The first one brings the map to this step, for both.
      Add(changes, t, [this, t, from, i] {
        for (int step = from; step <= i; ++step) map_.Apply(ChangeAt(step));
        return Cells(t, map_.TakeNew());
      });
      if (t < next_whole - 1e-6) continue;
      const double bytes = static_cast<double>(kPointBytes * ahead.all().size());
      next_whole = t + std::max(kMapPeriod, bytes / kMostMapBytes);
      Add(occupied, t, [this, t] { return Cells(t, map_.all()); });
    }
  }

  const MapChange& ChangeAt(int step) const {
    return flight_.plans[static_cast<std::size_t>(step)].map_change;
  }

  template <typename Range>
  std::string Cells(double t, const Range& cells) const {
    CloudPoints points;
    for (const OccupiedCells::Cell& cell : cells) {
      const Eigen::Vector3d p = flight_.map_resolution *
                                (Eigen::Vector3d(cell[2], cell[1], cell[0]).array() + 0.5).matrix();
      points.push_back({p, ColorAt(p.z())});
    }
    return PointCloud(t, kWorldFrame, points);
  }

  void AddPlans() {
    const std::uint16_t poses =
        Topic("/plan", kSchemaPosesInFrame, "The committed curve from now to its end");
    const std::uint16_t line = Topic("/scene/plan", kSchemaSceneUpdate, "The same as a line");
    const std::uint16_t points = Topic("/points/plan", kSchemaPointCloud, "The same as points");
    const std::uint16_t figures =
        Topic("/step", kSchemaStep, "How each replanning step went, and what it took");
    for (std::size_t i = 0; i < flight_.plans.size(); ++i) {
      const RecordPlan& plan = flight_.plans[i];
      const double t = plan.request.input.t_now;
      // The first one makes the curve, for all three.
      Add(poses, t, [this, &plan, t] {
        plan_poses_ = PlanPoses(plan);
        return PosesInFrame(t, kWorldFrame, plan_poses_);
      });
      Add(line, t,
          [this, t] { return LineUpdate(t, "plan", PlacesOf(plan_poses_), kPlanColor, false); });
      Add(points, t, [this, t] { return PointUpdate(t, PlacesOf(plan_poses_), kPlanColor); });
      Add(figures, t, [&plan, i] { return StepMessage(static_cast<int>(i), plan); });
    }
  }

  void AddFlown() {
    const std::uint16_t poses =
        Topic("/flown", kSchemaPosesInFrame, "Where the vehicle truly was in the last minute");
    const std::uint16_t line = Topic("/scene/flown", kSchemaSceneUpdate, "The same as a line");
    const std::uint16_t points = Topic("/points/flown", kSchemaPointCloud, "The same as points");
    EachSample(kTrailPeriod, [&](int i) {
      const double t = figures_.TimeOf(i);
      Add(poses, t, [this, t] {
        flown_poses_ = FlownPoses(track_, t);
        return PosesInFrame(t, kWorldFrame, flown_poses_);
      });
      Add(points, t, [this, t] { return PointUpdate(t, PlacesOf(flown_poses_), kFlownColor); });
      if (i == 0) return;  // a line has two ends
      Add(line, t,
          [this, t] { return LineUpdate(t, "flown", PlacesOf(flown_poses_), kFlownColor, false); });
    });
  }

  void AddPadBelief() {
    if (!has_pad()) return;
    const std::uint16_t pose =
        Topic("/pad/belief", kSchemaPoseInFrame, "The pad as it is believed to be");
    const std::uint16_t line =
        Topic("/scene/pad_belief", kSchemaSceneUpdate, "Three standard deviations of its place");
    const std::uint16_t points =
        Topic("/points/pad_belief", kSchemaPointCloud, "The same as points");
    EachSample(0.0, [&](int i) {
      const TrackBelief* const belief = figures_.PadBelief(i);
      if (belief == nullptr) return;
      Add(pose, belief->t, [belief] {
        return PoseInFrame(belief->t, kWorldFrame, PadPose(belief->pad.p_WP, belief->pad.yaw));
      });
    });
    EachSample(kBeliefPeriod, [&](int i) {
      const TrackBelief* const belief = figures_.PadBelief(i);
      if (belief == nullptr) return;
      Add(line, belief->t, [belief] {
        return LineUpdate(belief->t, "pad belief", BeliefEllipse(belief->pad), kBeliefColor, true);
      });
      Add(points, belief->t,
          [belief] { return PointUpdate(belief->t, BeliefEllipse(belief->pad), kBeliefColor); });
    });
  }

  void AddCameras() {
    const Scenario& scenario = flight_.scenario;
    if (scenario.sensing != SensingKind::kRendered) return;
    const sim::WorldConfig world =
        WorldOf(scenario, DrawTrial(scenario, scenario.seed), registries_);
    cameras_ = std::make_unique<FlightCameras>(scenario, VisualSceneOf(scenario, world));
    const auto camera = [&](const std::string& name, const std::string& schema, double rate,
                            std::string (FlightCameras::*image)(const TrackSample&),
                            std::string (FlightCameras::*calibration)(double) const) {
      const std::uint16_t images =
          Topic("/camera/" + name + "/image", schema, "Rendered again from the true states");
      const std::uint16_t calibrations =
          Topic("/camera/" + name + "/calibration", kSchemaCameraCalibration,
                "Of these images, which have no distortion");
      for (int i = 0; i / rate <= track_.t_end() + 1e-9; ++i) {
        const double t = i / rate;
        Add(calibrations, t, [this, t, calibration] { return (*cameras_.*calibration)(t); });
        Add(images, t, [this, t, image] { return (*cameras_.*image)(track_.At(t)); });
      }
    };
    if (has_pad()) {
      camera("down", kSchemaCompressedImage, cameras_->down_rate(), &FlightCameras::DownImage,
             &FlightCameras::DownCalibration);
    }
    camera("depth", kSchemaRawImage, cameras_->depth_rate(), &FlightCameras::DepthImage,
           &FlightCameras::DepthCalibration);
  }

  void AddStates() {
    const std::uint16_t states =
        Topic("/state", kSchemaState, "Mode, speeds, distances and errors");
    EachSample(0.0, [&](int i) {
      Add(states, figures_.TimeOf(i), [this, i] { return figures_.StateMessage(i); });
    });
  }

  void AddLog() {
    const std::uint16_t log =
        Topic("/log", kSchemaLog, "Modes, events, steps without a new plan, the outcome");
    for (const TrackEvent& event : track_.events()) {
      Add(log, event.t,
          [this, &event] { return Log(event.t, LevelOf(event), event.kind, WordsOf(event)); });
    }
    for (std::size_t i = 0; i < flight_.plans.size(); ++i) {
      const RecordPlan& plan = flight_.plans[i];
      if (plan.result.reason == planning::ReplanReason::kNone) continue;
      Add(log, plan.request.input.t_now, [i, &plan] {
        return Log(plan.request.input.t_now, LogLevel::kWarning, "plan",
                   fmt::format("plan: none new at step {}: {}, {}", i,
                               planning::ToString(plan.result.reason),
                               planning::ToString(plan.result.status)));
      });
    }
  }

  static LogLevel LevelOf(const TrackEvent& event) {
    if (event.kind == "outcome") {
      const bool succeeded = event.text == ToString(Outcome::kLanded) ||
                             event.text == ToString(Outcome::kFollowed) ||
                             event.text == ToString(Outcome::kArrived);
      return succeeded ? LogLevel::kInfo : LogLevel::kError;
    }
    const bool trouble = event.kind == "mode" && (event.text.starts_with("go_around") ||
                                                  event.text.starts_with("emergency_stop"));
    return trouble ? LogLevel::kWarning : LogLevel::kInfo;
  }

  // With its kind before it: not every viewer shows a name.
  std::string WordsOf(const TrackEvent& event) const {
    std::string words = fmt::format("{}: {}", event.kind, event.text);
    const std::string detail = tables_.at("result").at("detail").get<std::string>();
    if (event.kind == "outcome" && !detail.empty()) words.append(", ").append(detail);
    return words;
  }

  const Registries& registries_;
  RecordedFlight flight_;
  FlightTrack track_;
  Json tables_;
  FlightFigures figures_;
  OccupiedCells map_;
  std::unique_ptr<FlightCameras> cameras_;
  McapWriter* writer_ = nullptr;
  std::vector<Message> due_;
  Poses plan_poses_, flown_poses_;  // of the last messages
};

}  // namespace

void CheckMcap(const std::string& option, const std::string& path) {
  if (std::filesystem::path(path).filename() == ".mcap") {
    throw BadInput(fmt::format("{} {}: a name must stand before .mcap.", option, path));
  }
  if (std::filesystem::path(path).extension() != ".mcap") {
    throw BadInput(fmt::format("{} {}: the name must end in .mcap.", option, path));
  }
  CheckOutputPath(option, path);
  for (const char* schema : kSchemas) DescriptorsOf(schema);
}

void WriteMcap(const std::string& record_path, const std::string& mcap_path,
               const Registries& registries, const ExportProgress& progress) {
  try {
    FlightExport flight(record_path, registries);
    AtomicFile file(mcap_path);
    std::ofstream out(file.working_path(), std::ios::binary);
    try {
      flight.Write(&out, progress);
      out.close();
    } catch (const std::runtime_error&) {
      if (out) throw;  // nothing is wrong with the file
    }
    if (!out) throw std::runtime_error(fmt::format("{}: cannot be written", mcap_path));
    file.Commit();
  } catch (...) {
    RethrowNaming(record_path, "record");
  }
}

}  // namespace touchdown::evaluation
