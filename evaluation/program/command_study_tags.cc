// SPDX-License-Identifier: BSD-3-Clause
// touchdown study tags: how well the pad is found in rendered images.
#include "evaluation/program/command_study_tags.h"

#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "evaluation/base/progress.h"
#include "evaluation/base/rendering_check.h"
#include "evaluation/studies/tags/tag_fit.h"
#include "evaluation/studies/tags/tag_picture.h"
#include "evaluation/studies/tags/tag_report.h"

namespace touchdown::evaluation {
namespace {

constexpr int kFrames = 40;  // saved of each camera

struct TagStudyArguments {
  TagStudyOptions options;
  std::vector<double> fovs = {90.0, 60.0};
  std::vector<double> noises = {0.0, 5.0};
  bool no_align = false;
  bool fit = false;
  std::string db;
  std::string frames;
  bool json = false;
};

void MakeDirectory(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!error && std::filesystem::is_directory(directory)) return;
  throw BadInput(
      fmt::format("--frames {}: the directory cannot be made ({}).", directory, error.message()));
}

/// An exposure blurs what moves; the one changes nothing without the other. @throws BadInput
void CheckBlur(const TagStudyOptions& options) {
  if (options.camera.exposure_ms > 0.0 && options.speed == 0.0) {
    throw BadInput("--exposure needs --speed: only motion blurs an image.");
  }
  if (options.speed > 0.0 && options.camera.exposure_ms == 0.0) {
    throw BadInput("--speed needs --exposure: motion blurs an image during its exposure.");
  }
}

int Run(const TagStudyArguments& arguments) {
  CheckBlur(arguments.options);
  if (!arguments.db.empty()) CheckNewStudy("--db", arguments.db);
  if (arguments.fit && arguments.fovs.size() * arguments.noises.size() != 1) {
    throw BadInput("--fit needs one field of view and one noise: name them by --fov and --noise.");
  }
  RequireRendering("study tags", "");
  if (!arguments.frames.empty()) MakeDirectory(arguments.frames);
  std::vector<TagStudyPart> parts;
  bool fulfilled = true;
  for (const double fov : arguments.fovs) {
    for (const double noise : arguments.noises) {
      TagStudyPart part;
      part.options = arguments.options;
      part.options.camera.fov_y_deg = fov;
      part.options.camera.height = part.options.camera.width * 3 / 4;
      part.options.camera.noise_sigma = noise;
      part.options.finder.align = !arguments.no_align;
      const std::string name = fmt::format("fov{:g}_noise{:g}", fov, noise);
      ViewObserver save;
      if (!arguments.frames.empty()) {
        save = [&](int index, const estimation::GrayImage& image, const estimation::PadView& view,
                   const estimation::CameraIntrinsics& camera) {
          if (index >= kFrames) return;
          const std::string file = fmt::format("{}_{:03}.ppm", name, index);
          WriteTagPicture((std::filesystem::path(arguments.frames) / file).string(), image, view,
                          camera);
        };
      }
      part.rows = RunTagStudy(part.options, Progress({.things = "views", .of = name}), save);
      fulfilled = fulfilled && FulfilsDemand(part.rows);
      parts.push_back(std::move(part));
    }
  }
  nlohmann::ordered_json json = TagStudyJson(parts);
  std::string text = TagStudyText(parts);
  if (arguments.fit) {
    const TagStudyPart& part = parts.front();
    const sim::TagModel model = FitTagModel(part.options, part.rows);
    const auto agreement = CompareTagCameras(part.options, part.rows, model);
    const auto now = CompareTagCameras(part.options, part.rows, sim::TagModel());
    json["fit"] = TagFitJson(model, agreement);
    json["in_use"] = TagFitJson(sim::TagModel(), now);
    text += "Fitted to these views:\n" + TagFitText(model, agreement);
    text += "\nIn use:\n" + TagFitText(sim::TagModel(), now);
  }
  if (arguments.json) {
    std::cout << json.dump(2) << std::endl;
  } else {
    std::cout << text << std::flush;
  }
  if (!arguments.db.empty()) WriteTagStudy(arguments.db, parts);
  return fulfilled ? kDone : kFellShort;
}

}  // namespace

void AddTagStudyCommand(Command study, CommandRun* run) {
  const Command command = study.AddCommand(
      "tags", "How well the pad is found in rendered images of its tags, by height", "tag_pose.md");
  const auto arguments = std::make_shared<TagStudyArguments>();
  TagStudyOptions& options = arguments->options;
  command.Add("--poses", options.poses, "Views for each camera")
      .Check(Range(1, 1000000))
      .ShowDefault();
  command.AddList("--fov", &arguments->fovs, "Vertical fields of view [deg]", "90,60,...",
                  Range(10.0, 100.0));
  command.AddList("--noise", &arguments->noises, "Noise of the images [grey levels]", "0,5,...",
                  Range(0.0, 100.0));
  command.Add("--width", options.camera.width, "Of the images, 4:3 [pixel]")
      .Check(Range(32, 4096))
      .ShowDefault();
  command.Add("--exposure", options.camera.exposure_ms, "Of the images [ms]")
      .Check(Range(0.0, 100.0))
      .ShowDefault();
  command.Add("--speed", options.speed, "Of the vehicle over the pad while exposed [m/s]")
      .Check(Range(0.0, 20.0))
      .ShowDefault();
  command.AddFlag("--no-align", arguments->no_align,
                  "Take poses from the tags' corners alone, without alignment of the sheet");
  command.AddFlag("--fit", arguments->fit,
                  "Fit the constants of the fast tag camera to the views (sim/pad/tag_model.h)");
  command.Add("--seed", options.seed, "Seed of the views")
      .Check(Range(std::uint64_t{0}, std::uint64_t{1} << 53))
      .ShowDefault();
  command.AddFile("--db", &arguments->db, "Write every view, an SQLite file", "F.db");
  command.AddFile(
      "--frames", &arguments->frames,
      fmt::format("Save the first {} images of each camera with what was found in them", kFrames),
      "DIR");
  command.AddFlag("--json", arguments->json, "Print one JSON document on stdout");
  command.OnChosen([arguments, run] { *run = [arguments] { return Run(*arguments); }; });
}

}  // namespace touchdown::evaluation
