// SPDX-License-Identifier: BSD-3-Clause
// The study of tags in words, in JSON and as a table of all its views.
#include "evaluation/studies/tags/tag_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/result_file.h"
#include "evaluation/base/sqlite_db.h"

namespace touchdown::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr ResultFormat kFormat{"touchdown tag study", 1};

constexpr char kSchema[] = R"sql(
CREATE TABLE part(part INTEGER PRIMARY KEY, seed INTEGER, width_px INTEGER, height_px INTEGER,
  fov_y_deg REAL, noise_gray REAL, exposure_ms REAL, speed_mps REAL, align INTEGER, enlarge INTEGER,
  attitude_sigma_deg REAL);
CREATE TABLE view(part INTEGER, view INTEGER, height_m REAL, distance_m REAL, tilt_deg REAL,
  in_view INTEGER, status TEXT, aligned INTEGER, position_error_m REAL, rotation_error_deg REAL,
  nees_per_dof REAL, claimed_sigma_m REAL, render_ms REAL, find_ms REAL, PRIMARY KEY(part, view));
CREATE TABLE tag(part INTEGER, view INTEGER, id INTEGER, in_view INTEGER, found INTEGER,
  size_px REAL, view_angle_deg REAL, corner_rms_px REAL, PRIMARY KEY(part, view, id));
)sql";

std::string Rate(int found, int all) {
  return all > 0 ? fmt::format("{}/{}", found, all) : std::string("-");
}

std::string Number(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : std::string("-");
}

std::string Line(const TagStudyBin& bin) {
  return fmt::format(
      "{:>4.2f}-{:<4.2f}{:>7}{:>9}{:>9}{:>10}{:>10}{:>9}{:>8}{:>8}{:>8}{:>7}{:>7}"
      "{:>8}\n",
      bin.from, bin.to, bin.views, bin.not_in_view, Rate(bin.found, bin.views - bin.not_in_view),
      Rate(bin.center_found, bin.center_in_view), Rate(bin.outer_found, bin.outer_in_view),
      Rate(bin.aligned, bin.found), Number(bin.position_mm.median, 1),
      Number(bin.position_mm.p95, 1), Number(bin.position_mm.max, 1),
      Number(bin.rotation_deg.median, 2), Number(bin.rotation_deg.p95, 2), Number(bin.nees, 2));
}

double MeanOf(const std::vector<TagStudyRow>& rows, double TagStudyRow::*value) {
  double sum = 0.0;
  for (const TagStudyRow& row : rows) sum += row.*value / static_cast<double>(rows.size());
  return sum;
}

Json QuantilesJson(const Quantiles& q) {
  const auto value = [](const std::optional<double>& v) { return v ? Json(*v) : Json(); };
  return {{"median", value(q.median)}, {"p95", value(q.p95)}, {"max", value(q.max)}};
}

Json RateJson(int found, int all) {
  Json json = {{"found", found}, {"in_view", all}};
  if (all > 0) {
    const Interval interval = ClopperPearson(found, all);
    json["interval_95"] = {interval.lo, interval.hi};
  }
  return json;
}

Json BinJson(const TagStudyBin& bin) {
  return {{"height_m", {bin.from, bin.to}},
          {"views", bin.views},
          {"not_in_view", bin.not_in_view},
          {"pose", RateJson(bin.found, bin.views - bin.not_in_view)},
          {"center_tag", RateJson(bin.center_found, bin.center_in_view)},
          {"outer_tags", RateJson(bin.outer_found, bin.outer_in_view)},
          {"aligned", bin.aligned},
          {"position_error_mm", QuantilesJson(bin.position_mm)},
          {"rotation_error_deg", QuantilesJson(bin.rotation_deg)},
          {"nees_per_dof", bin.nees ? Json(*bin.nees) : Json()}};
}

const char* StatusName(estimation::PadPoseStatus status) {
  switch (status) {
    case estimation::PadPoseStatus::kSolved:
      return "solved";
    case estimation::PadPoseStatus::kNoTag:
      return "no_tag";
    case estimation::PadPoseStatus::kDegenerate:
      return "degenerate";
    case estimation::PadPoseStatus::kNotConverged:
      return "not_converged";
    case estimation::PadPoseStatus::kInconsistent:
      return "inconsistent";
  }
  return "unknown";
}

}  // namespace

bool FulfilsDemand(const std::vector<TagStudyRow>& rows) {
  const auto near = Summarise(rows, kLowestView, kNearHeight).position_mm.median;
  const auto far = Summarise(rows, kNearHeight, kHighestView).position_mm.median;
  return near && far && *near <= kNearErrorMm && *far <= kFarErrorMm;
}

std::string TagStudyText(const std::vector<TagStudyPart>& parts) {
  std::string text;
  for (const TagStudyPart& part : parts) {
    const sim::PadCameraConfig& camera = part.options.camera;
    text += fmt::format(
        "{}x{}, fov {:.4g} deg, noise {:.4g} grey levels, exposure {:.4g} ms at "
        "{:.4g} m/s, sheet {}\n",
        camera.width, camera.height, camera.fov_y_deg, camera.noise_sigma, camera.exposure_ms,
        part.options.speed, part.options.finder.align ? "aligned" : "not aligned");
    text += fmt::format("{:<9}{:>7}{:>9}{:>9}{:>10}{:>10}{:>9}{:>24}{:>14}{:>8}\n", "height m",
                        "views", "no tag", "pose", "centre", "outer", "aligned", "position mm",
                        "rotation deg", "NEES");
    text += fmt::format("{:<9}{:>7}{:>9}{:>9}{:>10}{:>10}{:>9}{:>8}{:>8}{:>8}{:>7}{:>7}{:>8}\n", "",
                        "", "in view", "found", "found", "found", "", "median", "p95", "max",
                        "median", "p95", "/dof");
    for (const TagStudyBin& bin : TagStudyBins(part.rows)) text += Line(bin);
    text += fmt::format("{:.1f} ms to render, {:.1f} ms to find, CPU, mean\n",
                        MeanOf(part.rows, &TagStudyRow::render_ms),
                        MeanOf(part.rows, &TagStudyRow::find_ms));
    text += fmt::format(
        "Median position error at most {:.4g} mm below {:.4g} m and {:.4g} mm to "
        "{:.4g} m: {}\n\n",
        kNearErrorMm, kNearHeight, kFarErrorMm, kHighestView,
        FulfilsDemand(part.rows) ? "yes" : "no");
  }
  return text;
}

Json TagStudyJson(const std::vector<TagStudyPart>& parts) {
  Json json;
  json["parts"] = Json::array();
  for (const TagStudyPart& part : parts) {
    const TagStudyOptions& o = part.options;
    Json bins = Json::array();
    for (const TagStudyBin& bin : TagStudyBins(part.rows)) bins.push_back(BinJson(bin));
    json["parts"].push_back({{"poses", o.poses},
                             {"seed", o.seed},
                             {"width_px", o.camera.width},
                             {"height_px", o.camera.height},
                             {"fov_y_deg", o.camera.fov_y_deg},
                             {"noise_gray", o.camera.noise_sigma},
                             {"exposure_ms", o.camera.exposure_ms},
                             {"speed_mps", o.speed},
                             {"align", o.finder.align},
                             {"attitude_sigma_deg", o.attitude_sigma_deg},
                             {"fulfils_demand", FulfilsDemand(part.rows)},
                             {"heights", bins},
                             {"wall_clock",
                              {{"render_ms_mean", MeanOf(part.rows, &TagStudyRow::render_ms)},
                               {"find_ms_mean", MeanOf(part.rows, &TagStudyRow::find_ms)}}}});
  }
  return json;
}

void WriteTagStudy(const std::string& path, const std::vector<TagStudyPart>& parts) {
  WriteResultFile(path, kFormat, kSchema, {}, [&](SqliteDb& db) {
    SqliteStatement insert_part =
        db.Prepare("INSERT INTO part VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    SqliteStatement insert_view =
        db.Prepare("INSERT INTO view VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    SqliteStatement insert_tag = db.Prepare("INSERT INTO tag VALUES(?, ?, ?, ?, ?, ?, ?, ?)");
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const int number = static_cast<int>(i);
      const TagStudyOptions& o = parts[i].options;
      insert_part.Run(number, static_cast<std::int64_t>(o.seed), o.camera.width, o.camera.height,
                      o.camera.fov_y_deg, o.camera.noise_sigma, o.camera.exposure_ms, o.speed,
                      o.finder.align, o.finder.enlarge, o.attitude_sigma_deg);
      for (std::size_t k = 0; k < parts[i].rows.size(); ++k) {
        const TagStudyRow& row = parts[i].rows[k];
        const int view = static_cast<int>(k);
        const auto solved = [&row](double value) {
          return row.Solved() ? std::optional<double>(value) : std::nullopt;
        };
        insert_view.Run(number, view, row.height, row.distance, row.tilt_deg, row.InView(),
                        StatusName(row.status), row.aligned, solved(row.position_error),
                        solved(row.rotation_error_deg), solved(row.nees), solved(row.sigma),
                        row.render_ms, row.find_ms);
        for (std::size_t id = 0; id < row.tags.size(); ++id) {
          const TagRow& tag = row.tags[id];
          insert_tag.Run(number, view, static_cast<int>(id), tag.in_view, tag.found, tag.size_px,
                         tag.view_angle_deg,
                         tag.found ? std::optional<double>(tag.corner_rms_px) : std::nullopt);
        }
      }
    }
  });
}

}  // namespace touchdown::evaluation
