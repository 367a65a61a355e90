// SPDX-License-Identifier: BSD-3-Clause
// The columns of a trial are listed here once, in two lists. Three functions walk the lists: they declare the columns,
// take their values from a result, and put the values back into a result.
#include "evaluation/campaign/trial_columns.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/statistics.h"

namespace touchdown::evaluation {
namespace {

// The declarations.
class Declare {
 public:
  void operator()(const char* name, bool&) { Add(name, "INTEGER"); }
  void operator()(const char* name, int&) { Add(name, "INTEGER"); }
  void operator()(const char* name, std::int64_t&) { Add(name, "INTEGER"); }
  void operator()(const char* name, std::uint64_t&) { Add(name, "INTEGER"); }
  void operator()(const char* name, double&) { Add(name, "REAL"); }
  void operator()(const char* name, std::optional<double>&) { Add(name, "REAL"); }
  void operator()(const char* name, std::string&) { Add(name, "TEXT"); }
  void operator()(const char* name, Outcome&) { Add(name, "TEXT"); }
  void operator()(const char* name, StepCounts&) { Add(name, "TEXT"); }
  void Derived(const char* name, bool) { Add(name, "INTEGER"); }
  void Derived(const char* name, int) { Add(name, "INTEGER"); }
  void Derived(const char* name, const std::optional<double>&) { Add(name, "REAL"); }
  template <typename Part, typename Columns>
  void Group(std::optional<Part>&, const Columns& columns) {
    Part part;
    columns(part);
  }
  const std::string& text() const { return text_; }

 private:
  void Add(const char* name, const char* type) {
    text_ += fmt::format("{}{} {}", text_.empty() ? "" : ", ", name, type);
  }
  std::string text_;
};

// From a result.
class Take {
 public:
  void operator()(const char*, bool& value) { Add(std::int64_t{value}); }
  void operator()(const char*, int& value) { Add(std::int64_t{value}); }
  void operator()(const char*, std::int64_t& value) { Add(value); }
  void operator()(const char*, std::uint64_t& value) { Add(static_cast<std::int64_t>(value)); }
  void operator()(const char*, double& value) { AddNumber(value); }
  void operator()(const char*, std::optional<double>& value) { AddNumber(value); }
  void operator()(const char*, std::string& value) { Add(value); }
  void operator()(const char*, Outcome& value) { Add(std::string(ToString(value))); }
  void operator()(const char*, StepCounts& value) { Add(nlohmann::json(value).dump()); }
  void Derived(const char*, bool value) { Add(std::int64_t{value}); }
  void Derived(const char*, int value) { Add(std::int64_t{value}); }
  void Derived(const char*, const std::optional<double>& value) { AddNumber(value); }
  template <typename Part, typename Columns>
  void Group(std::optional<Part>& part, const Columns& columns) {
    Part none;
    absent_ = !part;
    columns(part ? *part : none);
    absent_ = false;
  }
  std::vector<SqlValue> Values() { return std::move(values_); }

 private:
  void Add(SqlValue value) { values_.push_back(absent_ ? SqlValue() : std::move(value)); }
  void AddNumber(std::optional<double> value) {
    Add(value && std::isfinite(*value) ? SqlValue(*value) : SqlValue());
  }
  std::vector<SqlValue> values_;
  bool absent_ = false;
};

// Into a result.
class Put {
 public:
  explicit Put(const std::vector<SqlValue>& values) : values_(values) {}
  void operator()(const char* name, bool& value) { value = Whole(name) != 0; }
  void operator()(const char* name, int& value) { value = static_cast<int>(Whole(name)); }
  void operator()(const char* name, std::int64_t& value) { value = Whole(name); }
  void operator()(const char* name, std::uint64_t& value) {
    value = static_cast<std::uint64_t>(Whole(name));
  }
  void operator()(const char* name, double& value) {
    value = Number(name).value_or(std::numeric_limits<double>::quiet_NaN());
  }
  void operator()(const char* name, std::optional<double>& value) { value = Number(name); }
  void operator()(const char* name, std::string& value) { value = Text(name); }
  void operator()(const char* name, Outcome& value) {
    const std::string word = Text(name);
    const std::optional<Outcome> outcome = OutcomeNamed(word);
    if (!outcome) Refuse(name, "an outcome");
    value = *outcome;
  }
  void operator()(const char* name, StepCounts& value) {
    const nlohmann::json json = nlohmann::json::parse(Text(name), nullptr, false);
    if (!json.is_object()) Refuse(name, "an object of counts");
    value.clear();
    for (const auto& [word, count] : json.items()) {
      if (!count.is_number_integer()) Refuse(name, "an object of counts");
      value[word] = count;
    }
  }
  template <typename Value>
  void Derived(const char* name, const Value&) {
    Next(name);
  }
  template <typename Part, typename Columns>
  void Group(std::optional<Part>& part, const Columns& columns) {
    present_ = false;
    Part all;
    columns(all);
    part = present_ ? std::optional<Part>(all) : std::nullopt;
  }

 private:
  const SqlValue& Next(const char* name) {
    if (next_ == values_.size()) Refuse(name, "there");
    const SqlValue& value = values_[next_++];
    present_ |= value.index() != 0;
    return value;
  }
  std::int64_t Whole(const char* name) {
    const SqlValue& value = Next(name);
    if (value.index() == 0) return 0;  // of a group that is absent
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return *whole;
    Refuse(name, "a whole number");
  }
  std::optional<double> Number(const char* name) {
    const SqlValue& value = Next(name);
    if (value.index() == 0) return std::nullopt;
    if (const auto* number = std::get_if<double>(&value)) return *number;
    Refuse(name, "a number");
  }
  const std::string& Text(const char* name) {
    const SqlValue& value = Next(name);
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    Refuse(name, "a text");
  }
  [[noreturn]] static void Refuse(const char* name, const char* what) {
    throw std::invalid_argument(fmt::format("a trial's {} is not {}", name, what));
  }
  const std::vector<SqlValue>& values_;
  std::size_t next_ = 0;
  bool present_ = false;
};

int Planned(const TrialResult& r) {
  const auto planned = r.replans_by_status.find("planned");
  return planned == r.replans_by_status.end() ? 0 : planned->second;
}

template <typename Walk>
void WalkTrial(Walk& walk, TrialResult& r) {
  walk("seed", r.seed);
  walk.Derived("landed", r.landed());
  walk("outcome", r.outcome);
  walk("detail", r.detail);
  walk("cause", r.cause);
  walk.Group(r.touchdown, [&](Touchdown& t) {
    walk("time_to_land_s", t.t);
    walk("touchdown_error_m", t.error_m);
    walk("relative_vx_mps", t.relative_velocity[0]);
    walk("relative_vy_mps", t.relative_velocity[1]);
    walk("relative_vz_mps", t.relative_velocity[2]);
    walk("tilt_rad", t.tilt);
    walk("tilt_over_equilibrium_rad", t.tilt_over_equilibrium);
  });
  walk("mean_abs_error_x_m", r.mean_abs_error_x_m);
  walk("mean_abs_error_y_m", r.mean_abs_error_y_m);
  walk("min_clearance_m", r.min_clearance_m);
  walk("simulated_s", r.simulated_s);
  walk("effort_n2s", r.effort_n2s);
  walk("saturation_share", r.saturation_share);
  walk("max_speed_mps", r.max_speed_mps);
  walk("max_acceleration_mps2", r.max_acceleration_mps2);
  walk("replans", r.replans);
  walk.Derived("replans_planned", Planned(r));
  walk("replans_by_status", r.replans_by_status);
  walk("replans_by_reason", r.replans_by_reason);
  walk("replans_forbidden_by", r.replans_forbidden_by);
  walk("gate_steps", r.gate_steps);
  walk("first_tag_s", r.first_tag_s);
  walk.Group(r.estimator, [&](EstimatorQuality& e) {
    walk("estimator_rmse_position_m", e.rmse_position_m);
    walk("estimator_rmse_velocity_mps", e.rmse_velocity_mps);
    walk("estimator_nees_position", e.nees_position_mean);
    walk("estimator_samples", e.samples);
  });
  walk.Group(r.following, [&](Following& f) {
    walk("following_mean_error_m", f.mean_error_m);
    walk("following_max_error_m", f.max_error_m);
    walk("following_relative_speed_mps", f.relative_speed_mps);
  });
  walk.Group(r.own_state, [&](OwnStateQuality& o) {
    walk("own_rmse_position_m", o.rmse_position_m);
    walk("own_max_position_m", o.max_position_m);
    walk("own_rmse_velocity_mps", o.rmse_velocity_mps);
    walk("own_max_velocity_mps", o.max_velocity_mps);
    walk("own_rmse_attitude_rad", o.rmse_attitude_rad);
    walk("own_max_attitude_rad", o.max_attitude_rad);
  });
  walk.Group(r.safety, [&](SafetyFigures& s) {
    walk("safety_uncertified_steps", s.uncertified_steps);
    walk("safety_escaping_steps", s.escaping_steps);
    walk("safety_escaping_hit_steps", s.escaping_hit_steps);
    walk("safety_escaping_unknown_steps", s.escaping_unknown_steps);
    walk("safety_narrow_steps", s.narrow_steps);
    walk("safety_stops_flown", s.stops_flown);
    walk("safety_map_errors", s.map_errors);
    walk("safety_margin_mean_m", s.margin_mean_m);
    walk("safety_margin_max_m", s.margin_max_m);
    walk("safety_tracking_events", s.tracking_events);
    walk("safety_tracking_max_m", s.tracking_max_m);
    walk("safety_drift_events", s.drift_events);
    walk("safety_drift_max_m", s.drift_max_m);
    walk("safety_free_cells", s.free_cells);
    walk("safety_falsely_free_cells", s.falsely_free_cells);
  });
  walk("t_star_s", r.t_star_s);
  walk("t_star_upper_s", r.t_star_upper_s);
  walk.Derived("time_ratio", r.time_ratio());
  walk("within_limits", r.within_limits);
}

template <typename Walk>
void WalkTiming(Walk& walk, TrialTiming& t) {
  walk("wall_s", t.wall_s);
  walk("cpu_s", t.cpu_s);
  walk("physics_cpu_s", t.physics_cpu_s);
  walk("sensing_cpu_s", t.sensing_cpu_s);
  walk("mapping_cpu_s", t.mapping_cpu_s);
  walk("planning_cpu_s", t.planning_cpu_s);
  walk("control_cpu_s", t.control_cpu_s);
  walk("judging_cpu_s", t.judging_cpu_s);
  walk.Derived("replan_median_ms", Quantile(t.replan_wall_ms, 0.5));
  walk.Derived("replan_p95_ms", Quantile(t.replan_wall_ms, 0.95));
  walk.Derived("replan_max_ms", Quantile(t.replan_wall_ms, 1.0));
  walk("deadline_misses", t.deadline_misses);
  walk("deadline_misses_cpu", t.deadline_misses_cpu);
  walk("depth_image_cpu_s", t.sensing_stages.depth_image);
  walk("pad_image_cpu_s", t.sensing_stages.pad_image);
  walk("pad_finding_cpu_s", t.sensing_stages.pad_finding);
  walk("pad_filter_cpu_s", t.sensing_stages.pad_filter);
  walk("own_state_cpu_s", t.sensing_stages.own_state);
}

}  // namespace

TrialValues ValuesOf(const TrialResult& result) {
  TrialResult r = result;
  if (!r.landed()) {
    r.touchdown.reset();
    r.mean_abs_error_x_m.reset();
    r.mean_abs_error_y_m.reset();
  }
  Take trial, timing;
  WalkTrial(trial, r);
  WalkTiming(timing, r.timing);
  return {trial.Values(), timing.Values()};
}

TrialResult ResultOf(const TrialValues& values) {
  TrialResult result;
  Put trial(values.trial), timing(values.timing);
  WalkTrial(trial, result);
  WalkTiming(timing, result.timing);
  result.timing.simulated_s = result.simulated_s;
  return result;
}

std::string TrialSchema() {
  Declare trial, timing;
  TrialResult any;
  WalkTrial(trial, any);
  WalkTiming(timing, any.timing);
  return fmt::format(R"sql(
CREATE TABLE planned(trial INTEGER PRIMARY KEY, cell INTEGER, seed INTEGER, replay TEXT);
CREATE TABLE variation(trial INTEGER, key TEXT, value TEXT, PRIMARY KEY(trial, key));
CREATE TABLE varied_key(key TEXT PRIMARY KEY, unit TEXT, kind TEXT);
CREATE TABLE trial(trial INTEGER PRIMARY KEY, {});
CREATE TABLE cell(cell INTEGER PRIMARY KEY, planned INTEGER, trials INTEGER, succeeded INTEGER,
  rate_lo REAL, rate_hi REAL, time_to_land_median_s REAL, touchdown_error_median_m REAL);
CREATE TABLE cell_value(cell INTEGER, key TEXT, value TEXT, PRIMARY KEY(cell, key));
CREATE TABLE timing(trial INTEGER PRIMARY KEY, {});
CREATE TABLE replan_time(trial INTEGER, replan INTEGER, wall_ms REAL, cpu_ms REAL,
  PRIMARY KEY(trial, replan)) WITHOUT ROWID;
)sql",
                     trial.text(), timing.text());
}

namespace {

using Cbor = nlohmann::json;

Cbor Packed(const std::vector<SqlValue>& values) {
  Cbor list = Cbor::array();
  for (const SqlValue& value : values) {
    std::visit(
        [&](const auto& v) {
          if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>) {
            list.push_back(nullptr);
          } else {
            list.push_back(v);
          }
        },
        value);
  }
  return list;
}

std::vector<SqlValue> Unpacked(const Cbor& list) {
  std::vector<SqlValue> values;
  for (const Cbor& value : list) {
    if (value.is_null()) {
      values.emplace_back();
    } else if (value.is_string()) {
      values.emplace_back(value.get<std::string>());
    } else if (value.is_number_integer()) {
      values.emplace_back(value.get<std::int64_t>());
    } else {
      values.emplace_back(value.get<double>());
    }
  }
  return values;
}

}  // namespace

std::string PackResult(const TrialResult& result) {
  const TrialValues values = ValuesOf(result);
  const std::vector<std::uint8_t> bytes =
      Cbor::to_cbor(Cbor::array({Packed(values.trial), Packed(values.timing),
                                 result.timing.replan_wall_ms, result.timing.replan_cpu_ms}));
  return {bytes.begin(), bytes.end()};
}

TrialResult UnpackResult(const std::string& bytes) {
  const Cbor json = Cbor::from_cbor(bytes);
  TrialResult result = ResultOf({Unpacked(json.at(0)), Unpacked(json.at(1))});
  json.at(2).get_to(result.timing.replan_wall_ms);
  json.at(3).get_to(result.timing.replan_cpu_ms);
  return result;
}

}  // namespace touchdown::evaluation
