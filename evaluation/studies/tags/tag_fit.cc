// SPDX-License-Identifier: BSD-3-Clause
// Fits the fast tag camera to rendered views. Detection: the probit's two constants by maximum likelihood over all tags
// in view, on a grid that is refined. (A part of the noise common to all tags of an image is fitted as zero.) Noise:
// the fast camera looks from each view with some noise of the corners. The error is proportional to the noise. So in
// each class of sizes the noise is scaled until the medians of the position errors agree. A second scaling corrects
// nonlinear effects.
#include "evaluation/studies/tags/tag_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace touchdown::evaluation {
namespace {

using Table = std::array<double, sim::TagModel::kKnots>;

constexpr double kTrialSigma = 0.1;  // [pixel]
constexpr int kRounds = 3;
constexpr int kRepeats = 10;
constexpr double kLapse = 0.005;  // of tags, whatever their size: a stray one must not rule the fit
constexpr int kMinRows = 25;      // a class with fewer takes its neighbour's noise

double Probability(double x) { return 0.5 * std::erfc(-x * std::sqrt(0.5)); }

double LogLikelihood(const std::vector<TagStudyRow>& rows, double half_size, double spread) {
  double sum = 0.0;
  for (const TagStudyRow& row : rows) {
    for (const TagRow& tag : row.tags) {
      if (!tag.in_view) continue;
      const double p = Probability((tag.size_px - half_size) / spread);
      sum += std::log(std::max(kLapse, tag.found ? p : 1.0 - p));
    }
  }
  return sum;
}

void FitDetection(const std::vector<TagStudyRow>& rows, sim::TagModel* model) {
  double best = -HUGE_VAL;
  double half_step = 1.0;
  double spread_step = 0.5;
  model->half_size = 10.0;
  model->spread = 2.0;
  for (int level = 0; level < 6; ++level, half_step *= 0.3, spread_step *= 0.3) {
    const double half = model->half_size;
    const double spread = model->spread;
    for (int i = -5; i <= 5; ++i) {
      for (int j = -5; j <= 5; ++j) {
        const double s = spread + j * spread_step;
        if (s < 0.05) continue;
        const double value = LogLikelihood(rows, half + i * half_step, s);
        if (value <= best) continue;
        best = value;
        model->half_size = half + i * half_step;
        model->spread = s;
      }
    }
  }
}

sim::TagSensorConfig FastConfig(const TagStudyOptions& options, const sim::TagModel& model) {
  sim::TagSensorConfig config;
  config.width = options.camera.width;
  config.height = options.camera.height;
  config.fov_y_deg = options.camera.fov_y_deg;
  config.p_BC = options.camera.p_BC;
  config.attitude_sigma_deg = options.attitude_sigma_deg;
  config.model = model;
  return config;
}

double PositionErrorMm(const TagStudyRow& row, const sim::TagSensor::Image& image,
                       const Eigen::Vector3d& p_BC) {
  const Eigen::Matrix3d R_WC = row.vehicle.q_WB.toRotationMatrix() * sim::DownwardCameraAxes();
  const Eigen::Vector3d p_WC = row.vehicle.p_WB + row.vehicle.q_WB * p_BC;
  return 1e3 * (R_WC.transpose() * (row.pad.p_WP - p_WC) - image.pose.p_CP).norm();
}

std::size_t ClassOf(const TagStudyRow& row, const sim::TagModel& model) {
  double largest = 0.0;
  for (const TagRow& tag : row.tags) {
    if (tag.in_view) largest = std::max(largest, tag.size_px);
  }
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < model.size.size(); ++i) {
    if (std::abs(std::log(model.size[i] / largest)) <
        std::abs(std::log(model.size[nearest] / largest))) {
      nearest = i;
    }
  }
  return nearest;
}

// Scales one table, for views that were aligned or for the others.
void FitSigma(const TagStudyOptions& options, const std::vector<TagStudyRow>& rows, bool aligned,
              sim::TagModel* model) {
  sim::TagModel all_found = *model;
  all_found.half_size = -1e6;
  sim::TagSensor sensor(FastConfig(options, all_found), {}, options.seed);
  std::array<std::vector<double>, sim::TagModel::kKnots> rendered, fast;
  for (const TagStudyRow& row : rows) {
    if (!row.InView() || !row.Solved() || row.aligned != aligned) continue;
    const std::size_t at = ClassOf(row, *model);
    rendered[at].push_back(1e3 * row.position_error);
    for (int i = 0; i < kRepeats; ++i) {
      const sim::TagSensor::Image image = sensor.Look(row.vehicle, row.pad, row.vehicle.q_WB);
      if (image.pose.status != estimation::PadPoseStatus::kSolved) continue;
      fast[at].push_back(PositionErrorMm(row, image, options.camera.p_BC));
    }
  }
  Table& table = aligned ? model->sheet_sigma : model->corner_sigma;
  std::array<bool, sim::TagModel::kKnots> known{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    known[i] = rendered[i].size() >= kMinRows && !fast[i].empty();
    if (known[i]) table[i] *= *Quantile(rendered[i], 0.5) / *Quantile(fast[i], 0.5);
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (known[i]) continue;
    std::size_t nearest = table.size();
    for (std::size_t k = 0; k < table.size(); ++k) {
      const auto distance = [i](std::size_t n) { return n > i ? n - i : i - n; };
      if (known[k] && (nearest == table.size() || distance(k) < distance(nearest))) nearest = k;
    }
    if (nearest < table.size()) table[i] = table[nearest];
  }
}

}  // namespace

sim::TagModel FitTagModel(const TagStudyOptions& options, const std::vector<TagStudyRow>& rows) {
  if (std::none_of(rows.begin(), rows.end(), [](const TagStudyRow& r) { return r.Solved(); })) {
    throw std::invalid_argument("tag model: the pad was found in none of the views");
  }
  sim::TagModel model;
  FitDetection(rows, &model);
  model.corner_sigma.fill(kTrialSigma);
  model.sheet_sigma.fill(kTrialSigma);
  for (int round = 0; round < kRounds; ++round) {
    FitSigma(options, rows, false, &model);
    FitSigma(options, rows, true, &model);
  }
  return model;
}

TagAgreement CompareTagCameras(const TagStudyOptions& options, const std::vector<TagStudyRow>& rows,
                               double from, double to, const sim::TagModel& model) {
  constexpr int kLooks = 20;
  sim::TagSensor sensor(FastConfig(options, model), {}, options.seed);
  TagAgreement part;
  part.from = from;
  part.to = to;
  std::vector<double> rendered, fast;
  for (const TagStudyRow& row : rows) {
    if (row.height < from || row.height >= to || !row.InView()) continue;
    ++part.views;
    if (row.Solved()) rendered.push_back(1e3 * row.position_error);
    for (int k = 0; k < kLooks; ++k) {
      const sim::TagSensor::Image image = sensor.Look(row.vehicle, row.pad, row.vehicle.q_WB);
      if (image.pose.status != estimation::PadPoseStatus::kSolved) continue;
      fast.push_back(PositionErrorMm(row, image, options.camera.p_BC));
    }
  }
  const double views = std::max(1, part.views);
  part.rendered_rate = static_cast<double>(rendered.size()) / views;
  part.fast_rate = static_cast<double>(fast.size()) / (views * kLooks);
  part.rendered_mm = QuantilesOf(rendered);
  part.fast_mm = QuantilesOf(fast);
  return part;
}

std::vector<TagAgreement> CompareTagCameras(const TagStudyOptions& options,
                                            const std::vector<TagStudyRow>& rows,
                                            const sim::TagModel& model) {
  constexpr std::array<double, 4> kEdges = {kLowestView, 2.0, 4.0, kHighestView};
  std::vector<TagAgreement> agreement;
  for (std::size_t i = 0; i + 1 < kEdges.size(); ++i) {
    agreement.push_back(CompareTagCameras(options, rows, kEdges[i], kEdges[i + 1], model));
  }
  return agreement;
}

std::string TagFitText(const sim::TagModel& model, const std::vector<TagAgreement>& agreement) {
  std::string text = fmt::format(
      "half_size = {:.2f};  spread = {:.2f};\nsize = {{{:.3g}}};\n"
      "corner_sigma = {{{:.3f}}};\nsheet_sigma = {{{:.4f}}};\n\n",
      model.half_size, model.spread, fmt::join(model.size, ", "),
      fmt::join(model.corner_sigma, ", "), fmt::join(model.sheet_sigma, ", "));
  text += fmt::format("{:<11}{:>7}{:>20}{:>22}{:>22}\n", "height m", "views", "found: rendered",
                      "median mm: rendered", "p95 mm: rendered");
  for (const TagAgreement& part : agreement) {
    const auto value = [](const std::optional<double>& v) { return v.value_or(std::nan("")); };
    text += fmt::format(
        "{:>4.2f}-{:<6.2f}{:>7}{:>10.3f}{:>10.3f}{:>11.2f}{:>11.2f}{:>11.2f}"
        "{:>11.2f}\n",
        part.from, part.to, part.views, part.rendered_rate, part.fast_rate,
        value(part.rendered_mm.median), value(part.fast_mm.median), value(part.rendered_mm.p95),
        value(part.fast_mm.p95));
  }
  return text + "The second of two columns is the fast camera's.\n";
}

nlohmann::ordered_json TagFitJson(const sim::TagModel& model,
                                  const std::vector<TagAgreement>& agreement) {
  using Json = nlohmann::ordered_json;
  Json parts = Json::array();
  const auto value = [](const std::optional<double>& v) { return v ? Json(*v) : Json(); };
  for (const TagAgreement& part : agreement) {
    parts.push_back(
        {{"height_m", {part.from, part.to}},
         {"views", part.views},
         {"found", {{"rendered", part.rendered_rate}, {"fast", part.fast_rate}}},
         {"median_mm",
          {{"rendered", value(part.rendered_mm.median)}, {"fast", value(part.fast_mm.median)}}},
         {"p95_mm",
          {{"rendered", value(part.rendered_mm.p95)}, {"fast", value(part.fast_mm.p95)}}}});
  }
  return {{"model",
           {{"half_size", model.half_size},
            {"spread", model.spread},
            {"size", model.size},
            {"corner_sigma", model.corner_sigma},
            {"sheet_sigma", model.sheet_sigma}}},
          {"agreement", parts}};
}

}  // namespace touchdown::evaluation
