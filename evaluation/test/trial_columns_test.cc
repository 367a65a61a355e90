// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/campaign/trial_columns.h"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/record/trial_json.h"

namespace touchdown::evaluation {
namespace {

// Every figure another one, so that one in another's place shows.
TrialResult Landing() {
  TrialResult r;
  r.seed = (std::uint64_t{1} << 53) - 1;
  r.outcome = Outcome::kLanded;
  double next = 0.1;
  const auto set = [&](auto&... values) { ((values = next += 1.0), ...); };
  Touchdown& t = r.touchdown.emplace();
  set(t.t, t.error_m, t.relative_velocity[0], t.relative_velocity[1], t.relative_velocity[2],
      t.tilt, t.tilt_over_equilibrium);
  set(r.mean_abs_error_x_m, r.mean_abs_error_y_m, r.min_clearance_m, r.simulated_s, r.effort_n2s,
      r.saturation_share, r.max_speed_mps, r.max_acceleration_mps2);
  r.replans = 5;
  r.replans_by_status = {{"planned", 3}, {"holding", 2}};
  r.replans_by_reason = {{"search_failed", 2}};
  r.replans_forbidden_by = {{"tilt_limit", 1}};
  r.gate_steps = {{"open", 6}, {"no_pad", 4}};
  set(r.first_tag_s);
  EstimatorQuality& e = r.estimator.emplace();
  set(e.rmse_position_m, e.rmse_velocity_mps, e.nees_position_mean);
  e.samples = 77;
  OwnStateQuality& o = r.own_state.emplace();
  set(o.rmse_position_m, o.max_position_m, o.rmse_velocity_mps, o.max_velocity_mps,
      o.rmse_attitude_rad, o.max_attitude_rad);
  Following& f = r.following.emplace();
  set(f.mean_error_m, f.max_error_m, f.relative_speed_mps);
  set(r.t_star_s, r.t_star_upper_s);
  r.within_limits = true;
  TrialTiming& c = r.timing;
  set(c.wall_s, c.cpu_s, c.physics_cpu_s, c.sensing_cpu_s, c.mapping_cpu_s, c.planning_cpu_s,
      c.control_cpu_s, c.judging_cpu_s, c.sensing_stages.depth_image, c.sensing_stages.pad_image,
      c.sensing_stages.pad_finding, c.sensing_stages.pad_filter, c.sensing_stages.own_state);
  c.simulated_s = r.simulated_s;
  c.replan_wall_ms = {1.0 / 3.0, 2.0, 5e-324};
  c.replan_cpu_ms = {0.3, 0.25, 1e300};
  c.deadline_misses = 9;
  c.deadline_misses_cpu = 8;
  return r;
}

std::string Text(const TrialResult& result) { return LandJson(Scenario(), result).dump(); }

TEST(TrialColumns, EveryFigureComesBack) {
  const TrialResult there = Landing();
  const TrialResult back = UnpackResult(PackResult(there));
  EXPECT_EQ(Text(back), Text(there));
  EXPECT_EQ(back.timing.replan_wall_ms, there.timing.replan_wall_ms);
  EXPECT_EQ(back.timing.replan_cpu_ms, there.timing.replan_cpu_ms);
  EXPECT_EQ(PackResult(back), PackResult(there));
}

TEST(TrialColumns, WhatIsNotThereStaysAway) {
  TrialResult there;
  there.outcome = Outcome::kCrashed;
  there.detail = "Its process ended by signal 11.";
  const TrialResult back = UnpackResult(PackResult(there));
  EXPECT_EQ(Text(back), Text(there));
  EXPECT_FALSE(back.touchdown || back.estimator || back.own_state || back.following ||
               back.min_clearance_m);
}

TEST(TrialColumns, FiguresAtTouchdownAreOfLandings) {
  TrialResult there = Landing();
  there.outcome = Outcome::kTipOver;
  const TrialResult back = UnpackResult(PackResult(there));
  EXPECT_FALSE(back.touchdown || back.mean_abs_error_x_m);
  EXPECT_EQ(Text(back), Text(there));
}

TEST(TrialColumns, WhatIsNotFiniteIsNoNumber) {
  TrialResult there = Landing();
  there.max_speed_mps = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(UnpackResult(PackResult(there)).max_speed_mps));
}

TEST(TrialColumns, RefusesValuesOfAnotherKind) {
  TrialValues values = ValuesOf(Landing());
  values.trial[2] = std::string("sunk");  // the outcome
  EXPECT_THROW(ResultOf(values), std::invalid_argument);
  values = ValuesOf(Landing());
  values.timing.pop_back();
  EXPECT_THROW(ResultOf(values), std::invalid_argument);
}

}  // namespace
}  // namespace touchdown::evaluation
