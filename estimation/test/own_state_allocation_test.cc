// SPDX-License-Identifier: BSD-3-Clause
// OwnStateFilter allocates in its construction only.
#include <gtest/gtest.h>

#include "estimation/test/own_flight.h"
#include "touchdown/solvers/allocation_count.h"

namespace touchdown::estimation {
namespace {

TEST(OwnStateAllocation, NoneAfterConstruction) {
  if (solvers::AllocationCount() < 0) GTEST_SKIP() << "a sanitizer owns the heap";
  OwnRig rig;
  rig.delay = 20;
  rig.velocity_every = 9;
  rig.outlier_share = 0.2;
  OwnRun flight(5, 1.0, rig);
  OwnRun hover(6, 0.0, rig);
  const long before = solvers::AllocationCount();
  flight.StartFromPrior();
  flight.FlyTo(3.0);
  hover.FlyTo(3.0);
  double sum = 0.0;
  for (double t = 3.0; t < 3.1; t += 0.01) {
    sum += flight.filter.Estimate(t).p_WB.x() + flight.filter.PositionSigma();
    sum += static_cast<double>(flight.filter.Status(t));
    sum += flight.filter.diagnostics().late_accepted;
  }
  const long during = solvers::AllocationCount() - before;
  EXPECT_EQ(during, 0);
  EXPECT_GT(sum, 0.0);
  EXPECT_TRUE(hover.filter.started());
  EXPECT_GT(flight.filter.diagnostics().of(OwnSensor::kPosition).gated, 0);
  EXPECT_GT(flight.filter.diagnostics().late_accepted, 0);
}

}  // namespace
}  // namespace touchdown::estimation
