// SPDX-License-Identifier: BSD-3-Clause
// OwnStateFilter allocates in its construction only: operator new is counted.
#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "touchdown/estimation/test/own_flight.h"

namespace {

std::atomic<long> allocations = 0;

void* CountedAllocation(std::size_t size) {
  ++allocations;
  void* const memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return CountedAllocation(size); }
void* operator new[](std::size_t size) { return CountedAllocation(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace touchdown::estimation {
namespace {

TEST(OwnStateAllocation, NoneAfterConstruction) {
  OwnRig rig;
  rig.delay = 20;
  rig.velocity_every = 9;
  rig.outlier_share = 0.2;
  OwnRun flight(5, 1.0, rig);
  OwnRun hover(6, 0.0, rig);
  const long before = allocations;
  flight.StartFromPrior();
  flight.FlyTo(3.0);
  hover.FlyTo(3.0);
  double sum = 0.0;
  for (double t = 3.0; t < 3.1; t += 0.01) {
    sum += flight.filter.Estimate(t).p_WB.x() + flight.filter.PositionSigma();
    sum += static_cast<double>(flight.filter.Status(t));
    sum += flight.filter.diagnostics().late_accepted;
  }
  const long during = allocations - before;
  EXPECT_EQ(during, 0);
  EXPECT_GT(sum, 0.0);
  EXPECT_TRUE(hover.filter.started());
  EXPECT_GT(flight.filter.diagnostics().of(OwnSensor::kPosition).gated, 0);
  EXPECT_GT(flight.filter.diagnostics().late_accepted, 0);
}

}  // namespace
}  // namespace touchdown::estimation
