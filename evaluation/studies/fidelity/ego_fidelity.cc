// SPDX-License-Identifier: BSD-3-Clause
// The comparison resamples our scenes; the measured median is a given number, since its scenes are
// not known one by one.
#include "evaluation/studies/fidelity/ego_fidelity.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"
#include "sim/base/random_stream.h"
#include "touchdown/evaluation/base/shipped_files.h"

namespace touchdown::evaluation {
namespace {

using planning::EgoStatus;

constexpr int kResamples = 2000;
constexpr double kRatioLow = 0.85, kRatioHigh = 1.15, kShareSlack = 0.03;
constexpr const char* kSuccess = "first_attempt_success";

/// Median over values drawn with replacement, 2.5 % and 97.5 % quantiles of it.
Interval BootstrapMedian(const std::vector<double>& values) {
  sim::RandomStream draw(1, "ego bootstrap");
  std::vector<double> medians, sample(values.size());
  for (int i = 0; i < kResamples; ++i) {
    for (double& value : sample) {
      value = values[static_cast<std::size_t>(draw.Uniform(0.0, 1.0) * values.size())];
    }
    medians.push_back(*Quantile(sample, 0.5));
  }
  return {*Quantile(medians, 0.025), *Quantile(medians, 0.975)};
}

struct Quantity {
  const char* name;
  bool judged;
  bool of_plans;  // over successful calls only
  std::function<double(const EgoSceneResult&)> value;
};

const std::vector<Quantity>& Quantities() {
  static const std::vector<Quantity> list = {
      {"lb_iters", true, false, [](const auto& r) { return r.iterations; }},
      {"lb_evals", false, false, [](const auto& r) { return r.evaluations; }},
      {"lb_runs", false, false, [](const auto& r) { return r.runs; }},
      {"n_astar", false, false, [](const auto& r) { return r.searches; }},
      {"length_m", true, true, [](const auto& r) { return r.length; }},
      {"dur_s", true, true, [](const auto& r) { return r.duration; }},
      {"jerk_int", true, true, [](const auto& r) { return r.jerk; }},
      {"max_v", true, true, [](const auto& r) { return r.max_speed; }},
      {"max_a", false, true, [](const auto& r) { return r.max_acceleration; }},
  };
  return list;
}

/// The measured medians and shares. Rows are: set, whose first letter is the kind, quantity, count,
/// then the share, or quantiles with the median as the third.
class UpstreamTable {
 public:
  explicit UpstreamTable(const std::string& path) : path_(path) {
    std::ifstream file(path);
    if (!file) throw BadInput(fmt::format("{}: cannot be read.", path));
    int number = 0;
    for (std::string line; std::getline(file, line);) {
      ++number;
      std::vector<std::string> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      if (cells.size() < 2 || cells[0].size() < 2 || cells[0][1] != '_') continue;
      const std::size_t column = cells[1] == kSuccess ? 3 : 5;
      std::size_t used = 0;
      double value = 0.0;
      try {
        value = std::stod(cells.at(column), &used);
      } catch (const std::logic_error&) {
      }
      if (used == 0) {
        throw BadInput(fmt::format("{}:{}: column {} must be a number.", path, number, column + 1));
      }
      values_[{cells[0].substr(0, 1), cells[1]}] = value;
    }
  }

  double Value(const std::string& kind, const std::string& quantity) const {
    const auto found = values_.find({kind, quantity});
    if (found != values_.end()) return found->second;
    throw BadInput(fmt::format("{}: has no {} of kind {}.", path_, quantity, kind));
  }

 private:
  std::string path_;
  std::map<std::pair<std::string, std::string>, double> values_;
};

}  // namespace

std::string EgoQuantilesPath() { return DataPath("ego_upstream_quantiles.csv"); }

std::vector<EgoFidelityRow> CompareWithUpstream(const SceneKind& kind,
                                                const std::vector<EgoSceneResult>& results,
                                                const std::string& path) {
  const UpstreamTable file(path);
  std::vector<EgoFidelityRow> rows;
  EgoFidelityRow success;
  success.kind = kind.name;
  success.quantity = kSuccess;
  success.scenes = static_cast<int>(results.size());
  const auto planned = std::count_if(results.begin(), results.end(),
                                     [](const auto& r) { return r.status == EgoStatus::kPlanned; });
  success.upstream = file.Value(kind.name, kSuccess);
  success.ours = static_cast<double>(planned) / static_cast<double>(results.size());
  success.interval = ClopperPearson(static_cast<int>(planned), success.scenes);
  success.met = std::abs(success.ours - success.upstream) <= kShareSlack;
  rows.push_back(success);
  for (const Quantity& quantity : Quantities()) {
    std::vector<double> values;
    for (const EgoSceneResult& r : results) {
      if (!quantity.of_plans || r.status == EgoStatus::kPlanned)
        values.push_back(quantity.value(r));
    }
    EgoFidelityRow row;
    row.kind = kind.name;
    row.quantity = quantity.name;
    row.scenes = static_cast<int>(values.size());
    row.upstream = file.Value(kind.name, quantity.name);
    row.judged = quantity.judged;
    if (values.empty()) {  // nothing to compare with is no agreement
      row.ours = std::numeric_limits<double>::quiet_NaN();
      rows.push_back(row);
      continue;
    }
    row.ours = *Quantile(values, 0.5);
    row.interval = BootstrapMedian(values);
    if (row.upstream != 0.0) {
      row.interval = {row.interval.lo / row.upstream, row.interval.hi / row.upstream};
      row.met = row.interval.lo <= kRatioHigh && row.interval.hi >= kRatioLow;
    } else {
      row.interval = {1.0, 1.0};
      row.met = row.ours == 0.0;
    }
    rows.push_back(row);
  }
  return rows;
}

bool Faithful(const std::vector<EgoFidelityRow>& rows) {
  return std::all_of(rows.begin(), rows.end(),
                     [](const EgoFidelityRow& row) { return row.met || !row.judged; });
}

std::string EgoFidelityText(const std::vector<EgoFidelityRow>& rows) {
  std::string text = fmt::format("{:<6}{:<24}{:>8}{:>10}{:>10}  {:<10}{:<18}{}\n", "kind",
                                 "quantity", "scenes", "released", "here", "ratio", "95 %", "rule");
  for (const EgoFidelityRow& row : rows) {
    const bool share = row.quantity == kSuccess;
    const std::string ratio =
        share || row.upstream == 0.0 ? "" : fmt::format("{:.2f}", row.ours / row.upstream);
    const std::string rule = !row.judged ? "" : row.met ? "met" : "not met";
    text += fmt::format("{:<6}{:<24}{:>8}{:>10.4g}{:>10.4g}  {:<10}{:<18}{}\n", row.kind,
                        row.quantity, row.scenes, row.upstream, row.ours, ratio,
                        fmt::format("[{:.3f}, {:.3f}]", row.interval.lo, row.interval.hi), rule);
  }
  text += fmt::format(
      "Medians, and the share of first calls that succeed. 95 %: of the ratio of medians "
      "(bootstrap over our scenes), or of the share.\n"
      "The rule: the ratio's interval meets [{}, {}]; shares differ by at most {:.0f} points.\n",
      kRatioLow, kRatioHigh, 100.0 * kShareSlack);
  return text;
}

nlohmann::ordered_json EgoFidelityJson(const std::vector<EgoFidelityRow>& rows,
                                       std::uint64_t seed) {
  nlohmann::ordered_json json;
  json["study"] = "replan";
  json["part"] = "fidelity";
  json["seed"] = seed;
  json["met"] = Faithful(rows);
  json["rows"] = nlohmann::ordered_json::array();
  for (const EgoFidelityRow& row : rows) {
    json["rows"].push_back({{"kind", row.kind},
                            {"quantity", row.quantity},
                            {"scenes", row.scenes},
                            {"released", row.upstream},
                            {"here", row.ours},
                            {"interval_95", {row.interval.lo, row.interval.hi}},
                            {"judged", row.judged},
                            {"met", row.met}});
  }
  return json;
}

}  // namespace touchdown::evaluation
