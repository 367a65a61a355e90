// SPDX-License-Identifier: BSD-3-Clause
#include "control/tracking/settling.h"

#include <gtest/gtest.h>

#include "control/test/flight_model.h"
#include "touchdown/control/mission/landing_state_machine.h"

namespace touchdown::control {
namespace {

planning::FlatState Sinking() {
  planning::FlatState flat;
  flat.p_WB << 1.0, 2.0, 0.4;
  flat.v_WB << 8.0, 0.0, -0.3;
  flat.j_WB << 0.1, 0.0, 0.0;
  return flat;
}

Disturbance Wind() { return {{3.0, -2.0, 0.5}, {0.01, 0.0, 0.0}}; }

estimation::VehicleState Leaning(double t) {
  estimation::VehicleState state;
  state.t = t;
  state.p_WB << 1.05, 2.0, 0.45;
  state.v_WB << 8.0, 1.0, -0.2;  // on a pad that drives fast
  state.q_WB = Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitY());
  return state;
}

TEST(Settling, WithoutContactNothingChanges) {
  Settling settling;
  settling.Note(1.0, false, true);
  planning::FlatState reference = Sinking();
  Disturbance disturbance = Wind();
  estimation::VehicleState state = Leaning(1.0);
  settling.Apply(&state, &reference, &disturbance);
  EXPECT_EQ(reference.p_WB, Sinking().p_WB);
  EXPECT_EQ(disturbance.force_W, Wind().force_W);
}

TEST(Settling, StandingTheLawWantsItUprightOnItsWeight) {
  const SettlingParameters parameters;
  const double standing_t = 1.0 + 1.1 * parameters.fade_time;
  estimation::VehicleModel model = TestVehicle();
  model.rotor_drag << 0.3, 0.3, 0.0;  // that a fast pad's wind would lean the vehicle against
  for (const char* law : {"geometric", "paper"}) {
    Settling settling;
    settling.Note(1.0, true, true);
    settling.Note(standing_t, true, true);
    estimation::VehicleState state = Leaning(standing_t);
    planning::FlatState reference = Sinking();
    Disturbance disturbance = Wind();
    settling.Apply(&state, &reference, &disturbance);
    EXPECT_EQ(disturbance.moment_B.norm(), 0.0) << "the deck's moments are no disturbance";
    EXPECT_EQ(reference.j_WB.norm(), 0.0);
    const ControlOutput output = MakeController(law, model)->Update(state, reference, disturbance);
    EXPECT_GT(output.R_WB_desired(2, 2), 1.0 - 1e-9) << law;
    EXPECT_GT(output.wrench.moment_B.y(), 0.5) << law;  // levels it
    // A knock of the deck is answered with less than half as much.
    const auto moment_x = [&](double rate) {
      estimation::VehicleState told = Leaning(standing_t);
      told.w_WB_B.x() = rate;
      planning::FlatState asked = Sinking();
      Disturbance taken = Wind();
      settling.Apply(&told, &asked, &taken);
      return MakeController(law, model)->Update(told, asked, taken).wrench.moment_B.x();
    };
    const auto flying_x = [&](double rate) {
      estimation::VehicleState told = Leaning(1.0);
      told.w_WB_B.x() = rate;
      return MakeController(law, model)->Update(told, Sinking(), {}).wrench.moment_B.x();
    };
    const double standing = std::abs(moment_x(1.0) - moment_x(0.0));
    EXPECT_LT(standing, 0.5 * std::abs(flying_x(1.0) - flying_x(0.0))) << law;
    EXPECT_GT(standing, 0.0) << law;
    EXPECT_NEAR(output.wrench.thrust, parameters.thrust_share * model.HoverThrust() * std::cos(0.4),
                1e-9)
        << law;
  }
}

TEST(Settling, FadesWithoutAJump) {
  const estimation::VehicleModel model = TestVehicle();
  const auto law = MakeController("geometric", model);
  Settling settling;
  double last = -1.0;
  for (double t = 0.9; t < 1.4; t += 0.002) {
    settling.Note(t, t >= 1.0, true);
    planning::FlatState reference = Sinking();
    Disturbance disturbance = Wind();
    estimation::VehicleState state = Leaning(t);
    settling.Apply(&state, &reference, &disturbance);
    const double thrust = law->Update(state, reference, disturbance).wrench.thrust;
    if (last >= 0.0) {
      EXPECT_LT(std::abs(thrust - last), 0.02 * model.HoverThrust()) << t;
    }
    last = thrust;
  }
}

TEST(Settling, ABriefLossOfContactDoesNotInterruptAndALongOneEndsIt) {
  const SettlingParameters parameters;
  Settling settling;
  settling.Note(1.0, true, true);
  const double end = 1.0 + parameters.fade_time;
  settling.Note(end, true, true);
  settling.Note(end + 0.9 * parameters.contact_gap, false, true);
  EXPECT_EQ(settling.Share(end + 0.9 * parameters.contact_gap), 1.0);
  const double off = end + 1.1 * parameters.contact_gap;
  settling.Note(off, false, true);
  EXPECT_EQ(settling.Share(off), 1.0) << "a return is no jump";
  EXPECT_NEAR(settling.Share(off + 0.5 * parameters.return_time), 0.5, 1e-9);
  EXPECT_EQ(settling.Share(off + 1.1 * parameters.return_time), 0.0);
}

TEST(Settling, WhoDoesNotLandAnyMoreFliesAgainAtOnce) {
  const SettlingParameters parameters;
  Settling settling;
  settling.Note(1.0, true, true);
  const double abort = 1.0 + 0.6 * parameters.fade_time;
  settling.Note(abort, true, false);  // the feet still touch
  EXPECT_NEAR(settling.Share(abort), 0.6, 1e-9);
  EXPECT_LT(settling.Share(abort + 0.5 * parameters.return_time), 0.2);
  settling.Note(abort + parameters.return_time, true, false);
  EXPECT_EQ(settling.Share(abort + parameters.return_time), 0.0);
}

TEST(Settling, IsOverBeforeContactIsConfirmed) {
  EXPECT_LT(SettlingParameters{}.fade_time, MissionParameters{}.contact_time);
}

TEST(Settling, RefusesParametersOutOfRange) {
  for (const auto& [spoil, name] :
       {std::pair<void (*)(SettlingParameters&), const char*>{
            [](SettlingParameters& p) { p.fade_time = 0.0; }, "fade_time"},
        {[](SettlingParameters& p) { p.return_time = -1.0; }, "return_time"},
        {[](SettlingParameters& p) { p.thrust_share = 1.0; }, "thrust_share"},
        {[](SettlingParameters& p) { p.contact_gap = -0.1; }, "contact_gap"}}) {
    SettlingParameters parameters;
    spoil(parameters);
    try {
      const Settling settling(parameters);
      FAIL() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace touchdown::control
