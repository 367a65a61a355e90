// SPDX-License-Identifier: BSD-3-Clause
// The last stretch before contact: a proven landing is not postponed, unless the deck is gone.
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "planning/test/replanner_fixtures.h"
#include "touchdown/planning/map/cell_box.h"
#include "touchdown/planning/replan/replanner.h"

namespace touchdown::planning {
namespace {

constexpr double kDeck = 0.45;  // its height [m]

/// A request to contact from where the replanner's reference is.
ReplanInput ToContact(const Replanner& replanner, const estimation::PadPrediction& pad, double t,
                      double height = 0.165, double sink = 0.3) {
  const FlatState at = replanner.Reference(t);
  ReplanInput input = Input(at.p_WB, pad, t);
  input.vehicle.v_WB = at.v_WB;
  input.endpoint = {.t_reference = t, .height = height, .height_floor = height};
  input.endpoint.arrival_sink = sink;
  return input;
}

/// Over a deck that drives along x, planning to contact until shortly before it.
class LastStretch : public ::testing::Test {
 protected:
  LastStretch() : map_(ObservedMap()), pad_({0.0, 0.0, kDeck}, 0.5, 0.0, 0.0) {
    ReplannerOptions options = Options(ArrivalMode::kFixed);
    options.deck_half_size = 0.5;
    replanner_ = std::make_unique<Replanner>(options, solvers::StandardBackends());
    FlyAlong({-0.6, 0.0, kDeck + 1.2}, {0.5, 0.0, 0.0}, replanner_.get());
    while (left() > 0.7 || t_ == 0.0) {
      EXPECT_EQ(Ask(pad_).status, ReplanStatus::kPlanned) << t_;
      t_ += 0.1;
      if (t_ > 5.0) break;
    }
    landing_ = replanner_->state().next;
  }

  double left() const { return replanner_->state().next.curve.t_end() - t_; }

  const ReplanResult& Ask(const estimation::PadPrediction& pad) {
    return replanner_->Replan(ToContact(*replanner_, pad, t_), map_);
  }

  OccupancyMap map_;
  ArcPad pad_;
  std::unique_ptr<Replanner> replanner_;
  FlightPair landing_;
  double t_ = 0.0;
};

// Pairs bound before would push the vehicle towards the deck.
TEST(ReplannerLanding, NothingIsKeptShortlyBeforeContact) {
  const OccupancyMap map = ObservedMap();
  const ArcPad pad({4.5, 0.0, kDeck}, 0.3, 0.0, 0.0);
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  options.deck_half_size = 0.5;
  Replanner replanner(options, solvers::StandardBackends());
  FlyAlong({-4.0, 0.0, kDeck + 1.2}, {0.5, 0.0, 0.0}, &replanner);
  int kept = 0, anew = 0;
  for (double t = 0.0; t == 0.0 || replanner.state().next.curve.t_end() - t > 1.0; t += 0.1) {
    const ReplanInput input = ToContact(replanner, pad, t);
    const double left = replanner.state().next.curve.t_end() - input.t_start;
    const double looked = replanner.state().looked_t;
    ASSERT_EQ(replanner.Replan(input, map).status, ReplanStatus::kPlanned) << t;
    const bool looks = replanner.state().looked_t != looked;
    if (t == 0.0) continue;
    EXPECT_TRUE(looks || left >= options.constants.near_contact) << left;
    kept += !looks;
    anew += looks && left < options.constants.near_contact;
  }
  EXPECT_GT(kept, 8);
  EXPECT_GT(anew, 15);
}

// With little acceleration no plan as short as what is left meets a pad that is elsewhere by centimetres. A longer one
// would, and so would the next: the vehicle hovered over the deck for ever.
TEST(ReplannerLanding, AContactThatIsNearIsNotPutOff) {
  const OccupancyMap map = ObservedMap();
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  options.deck_half_size = 0.5;
  options.limits.acceleration = 1.0;
  Replanner replanner(options, solvers::StandardBackends());
  FlyAlong({-0.6, 0.0, kDeck + 1.2}, {0.5, 0.0, 0.0}, &replanner);
  const auto ask = [&](double t, double off) {
    const ArcPad pad({0.0, off, kDeck}, 0.5, 0.0, 0.0);
    return replanner.Replan(ToContact(replanner, pad, t, 0.28, 0.13), map);
  };
  double t = 0.0;
  for (; t == 0.0 || replanner.state().next.curve.t_end() - t > 0.6; t += 0.1) {
    ASSERT_EQ(ask(t, 0.0).status, ReplanStatus::kPlanned) << t;
    ASSERT_LT(t, 10.0);
  }
  const double t_end = replanner.state().next.curve.t_end();
  ASSERT_FALSE(replanner.state().next.Lands()) << "it touches the deck too long after its end";
  const ReplanResult kept = ask(t, 0.06);
  EXPECT_EQ(kept.status, ReplanStatus::kKept);
  EXPECT_EQ(kept.reason, ReplanReason::kLimitsExceeded);
  EXPECT_EQ(replanner.state().next.curve.t_end(), t_end);
  EXPECT_EQ(ask(t + 0.1, 0.3).status, ReplanStatus::kPlanned) << "it would miss the deck's middle";
}

// With little acceleration no plan meets a pad that brakes. The old one would meet it softly as it drives now, but not
// as it will by then.
TEST(ReplannerLanding, ADeckThatGoesOnTurningAwayIsLeftInTime) {
  const OccupancyMap map = ObservedMap();
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  options.deck_half_size = 0.5;
  options.limits.acceleration = 1.0;
  for (const double slower : {0.1, 0.3}) {
    Replanner replanner(options, solvers::StandardBackends());
    FlyAlong({-0.6, 0.0, kDeck + 1.2}, {0.5, 0.0, 0.0}, &replanner);
    const auto ask = [&](double t, double by) {
      const ArcPad pad({by * t, 0.0, kDeck}, 0.5 - by, 0.0, 0.0);
      return replanner.Replan(ToContact(replanner, pad, t), map);
    };
    double t = 0.0;
    for (; t == 0.0 || replanner.state().next.curve.t_end() - t > 0.5; t += 0.1) {
      ASSERT_EQ(ask(t, 0.0).status, ReplanStatus::kPlanned) << t;
      ASSERT_LT(t, 10.0);
    }
    ASSERT_TRUE(replanner.state().next.Lands());
    const ReplanResult result = ask(t, slower);
    EXPECT_EQ(result.Lands(), slower < 0.2) << Explain(result.reason);
    EXPECT_EQ(result.status == ReplanStatus::kBraking, slower > 0.2);
    EXPECT_TRUE(result.proven);
  }
}

TEST_F(LastStretch, ItsPairLands) {
  EXPECT_TRUE(landing_.Lands());
  EXPECT_GT(left(), 0.4);
}

TEST_F(LastStretch, WithoutANewPlanTheLandingIsKept) {
  // In the next step's map nothing around was ever seen.
  map_ = OccupancyMap(map_.options());
  const ReplanResult& result = Ask(pad_);
  EXPECT_EQ(result.status, ReplanStatus::kKept);
  EXPECT_EQ(result.reason, ReplanReason::kUnobserved);
  EXPECT_TRUE(result.Lands());
  EXPECT_TRUE(result.certificate.stops_in_observed_space) << "it was proven when it was made";
  EXPECT_TRUE(result.map_error) << "and what it was proven in is not there any more";
  EXPECT_EQ(replanner_->state().next.curve.control_points(), landing_.curve.control_points());
}

TEST_F(LastStretch, AnObstacleBesideTheWayIsNotFlownAround) {
  const Eigen::Vector3d end = landing_.curve.Position(landing_.curve.t_end());
  map_.SetOccupied(end + Eigen::Vector3d(0.1, 0.55, 0.4));  // within the clearance of plans
  const ReplanResult& result = Ask(pad_);
  EXPECT_TRUE(result.Lands());
  EXPECT_EQ(result.rebinds, 0);
}

TEST_F(LastStretch, WhatIsSeenToBlockTheWayEndsIt) {
  const Eigen::Vector3d end = landing_.curve.Position(landing_.curve.t_end());
  map_.SetOccupied(end + Eigen::Vector3d(0.15, 0.0, 0.2));
  const ReplanResult& result = Ask(pad_);
  EXPECT_FALSE(result.Lands());
  EXPECT_TRUE(result.certificate.stops_in_observed_space);
}

TEST_F(LastStretch, ALandingThatIsNotWantedAnyMoreIsLeft) {
  const FlatState at = replanner_->Reference(t_);
  ReplanInput input = Input(at.p_WB, pad_, t_);
  input.vehicle.v_WB = at.v_WB;
  EXPECT_FALSE(replanner_->Replan(input, map_).Lands()) << "a plan to hover above the pad";
  EXPECT_FALSE(replanner_->Rest(input, 1.0, map_).Lands()) << "a climb";
}

TEST_F(LastStretch, MarginsThatAreNoNumbersProveNothing) {
  const FlatState at = replanner_->Reference(t_);
  ReplanInput input = Input(at.p_WB, pad_, t_);
  input.vehicle.v_WB = at.v_WB;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), -0.1}) {
    input.margins.own_state = bad;
    EXPECT_EQ(replanner_->Replan(input, map_).reason, ReplanReason::kInvalidInput);
    EXPECT_EQ(replanner_->state().next.curve.control_points(), landing_.curve.control_points());
  }
}

TEST_F(LastStretch, ADeckThatIsGoneIsNotLandedOn) {
  const ArcPad gone({4.0, 3.0, kDeck}, 0.5, 0.0, 0.0);
  const ReplanResult& result = Ask(gone);
  EXPECT_FALSE(result.Lands());
  EXPECT_TRUE(result.certificate.stops_in_observed_space);
  // And no trajectory goes on below where the deck was.
  for (double t = t_; t < t_ + 5.0; t += 0.02) {
    EXPECT_GT(replanner_->Reference(t).p_WB.z(), 0.44) << t;
  }
}

/// A deck that is below where contact is due, and drives back by then.
class TurnedBack : public ArcPad {
 public:
  TurnedBack(const FlightPair& landing, double speed)
      : ArcPad({landing.curve.Position(landing.curve.t_end()).x() + speed * landing.curve.t_end(),
                0.0, kDeck},
               -speed, 0.0, 0.0) {}
};

TEST_F(LastStretch, ADeckThatHasTurnedBackIsNotTouched) {
  // A new landing on to it takes longer than the last stretch: the old one is left.
  const TurnedBack back(landing_, 0.4);
  const double t_contact = landing_.curve.t_end();
  ASSERT_LT((back.At(t_contact).p_WP - landing_.curve.Position(t_contact)).head<2>().norm(), 0.1);
  const ReplanResult& result = Ask(back);
  EXPECT_NE(result.curve.control_points(), landing_.curve.control_points());
  EXPECT_TRUE(result.proven);
  EXPECT_TRUE(result.certificate.stops_in_observed_space);
}

// Nothing else is proven: a hard touchdown is better than a rise into what was not seen.
TEST_F(LastStretch, WhereNothingElseIsProvenAHardLandingIsKept) {
  map_ = OccupancyMap(map_.options());
  const TurnedBack back(landing_, 0.4);
  const ReplanResult& result = Ask(back);
  EXPECT_EQ(result.status, ReplanStatus::kKept);
  EXPECT_TRUE(result.Lands());
  EXPECT_TRUE(result.proven);
}

// Unknown cells in front do not hide it.
TEST_F(LastStretch, AnObstacleBehindUnknownCellsEndsIt) {
  const Eigen::Vector3d end = landing_.curve.Position(landing_.curve.t_end());
  map_ = OccupancyMap(map_.options());
  map_.SetOccupied(end + Eigen::Vector3d(0.15, 0.0, 0.2));
  const ReplanResult& result = Ask(pad_);
  EXPECT_FALSE(result.Lands());
  EXPECT_FALSE(result.certificate.stops_in_observed_space) << "nothing else is proven";
}

// Without a proof it rises, and does not go on to where the deck was. The pair says that it is not proven.
TEST_F(LastStretch, AMissedLandingInTheUnseenRisesAndIsNotCalledProven) {
  map_ = OccupancyMap(map_.options());
  const ArcPad gone({4.0, 3.0, kDeck}, 0.5, 0.0, 0.0);
  const ReplanResult& result = Ask(gone);
  EXPECT_EQ(result.status, ReplanStatus::kBraking);
  EXPECT_FALSE(result.Lands());
  EXPECT_FALSE(result.proven);
  EXPECT_FALSE(result.certificate.stops_in_observed_space);
  EXPECT_GT(replanner_->Reference(t_ + 5.0).p_WB.z(), kDeck + 0.5);
  // Going on without a new pair does not make the old one proven.
  t_ += 0.1;
  EXPECT_FALSE(Ask(gone).certificate.stops_in_observed_space);
  // A hover elsewhere is a new pair.
  map_ = ObservedMap();
  t_ += 3.0;
  EXPECT_TRUE(Ask(gone).proven);
}

// Above the deck the hull is among cells that are not seen free, as the deck is: no escape from there.
TEST_F(LastStretch, WhoComesToRestKnowsTheDeckBelow) {
  t_ = landing_.curve.t_end() - 0.2;
  map_ = ObservedMap();
  const Eigen::Vector3d deck = pad_.At(t_).p_WP;
  ForEachCell({map_.CellOf(deck - Eigen::Vector3d(0.4, 0.4, 0.4)),
               map_.CellOf(deck + Eigen::Vector3d(0.4, 0.4, -0.04))},
              [&](const CellIndex& cell) { map_.SetState(cell, CellState::kUnknown); });
  const FlatState at = replanner_->Reference(t_);
  ReplanInput input = Input(at.p_WB, pad_, t_);
  input.vehicle.v_WB = at.v_WB;
  const ReplannerState before = replanner_->state();
  const ReplanResult& result = replanner_->Rest(input, 1.0, map_);
  EXPECT_EQ(result.status, ReplanStatus::kClimbing);
  EXPECT_FALSE(result.certificate.start_cells.leaves());
  replanner_->Restore(before);
  input.pad = nullptr;
  EXPECT_EQ(replanner_->Rest(input, 1.0, map_).status, ReplanStatus::kKept) << "it cannot leave";
}

// A climb would begin with feet on the deck, and bounce off.
TEST_F(LastStretch, WhoWillTouchAnywayDoesNotClimb) {
  t_ = landing_.curve.t_end();
  const FlatState at = replanner_->Reference(t_);
  ReplanInput input = Input(at.p_WB, pad_, t_);
  input.vehicle.v_WB = at.v_WB;
  const ReplannerState before = replanner_->state();
  EXPECT_EQ(replanner_->Rest(input, 1.0, map_).status, ReplanStatus::kKept);
  EXPECT_TRUE(replanner_->state().next.Lands());
  // In a gust it would touch the deck too fast.
  input.vehicle.v_WB = pad_.At(t_).v_WP + Eigen::Vector3d(0.7, 0.0, -0.2);
  replanner_->Restore(before);
  EXPECT_EQ(replanner_->Rest(input, 1.0, map_).status, ReplanStatus::kClimbing);
}

TEST_F(LastStretch, ContactThatNeverComesEndsIt) {
  // The deck is lower than estimated: the pair is flown to its end, and past it for a limited time.
  // Nothing else is proven meanwhile.
  map_ = OccupancyMap(map_.options());
  const double t_end = landing_.curve.t_end();
  ReplanStatus status = ReplanStatus::kKept;
  for (t_ = t_end; t_ < t_end + 3.0; t_ += 0.1) {
    const FlatState at = replanner_->Reference(t_);
    ReplanInput input = Input(at.p_WB, pad_, t_);
    input.vehicle.v_WB = at.v_WB;
    status = replanner_->Rest(input, 0.0, map_).status;
    if (status != ReplanStatus::kKept) break;
  }
  EXPECT_NE(status, ReplanStatus::kKept);
  EXPECT_NEAR(t_, t_end + kLatestContact, 0.11);
}

// A vehicle that waits above the deck waits lower there.
TEST(ReplannerLanding, UnderARoofTheEndComesDown) {
  OccupancyMap map = ObservedMap();
  for (double x = 1.0; x < 5.0; x += 0.1) {
    for (double y = -2.0; y < 2.0; y += 0.1) map.SetOccupied({x, y, 2.05});
  }
  const ArcPad pad({3.0, 0.0, kDeck}, 0.0, 0.0, 0.0);
  ReplannerOptions options = Options(ArrivalMode::kFixed);
  options.deck_half_size = 0.5;
  for (const double height : {1.0, 1.62}) {
    Replanner replanner(options, solvers::StandardBackends());
    const Eigen::Vector3d start(-3.0, 0.0, 1.2);
    replanner.CommitHover(start, 0.0);
    ReplanInput input = Input(start, pad, 0.0);
    input.endpoint.height = input.endpoint.height_floor = height;
    const ReplanResult& result = replanner.Replan(input, map);
    ASSERT_EQ(result.status, ReplanStatus::kPlanned) << height;
    const double end = result.curve.Position(result.curve.t_end()).z();
    EXPECT_LE(end, 1.67) << "the roof's zone begins";
    EXPECT_GE(end, height == 1.0 ? kDeck + 1.0 - 1e-9 : 1.5) << "no lower than it must";
  }
}

}  // namespace
}  // namespace touchdown::planning
