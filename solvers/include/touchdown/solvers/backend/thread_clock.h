// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>

namespace touchdown::solvers {

/// CPU time of the calling thread [s]: the meaningful time on a shared machine.
inline double ThreadCpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Runs `stage` and adds its thread CPU time to `*sum` [s].
template <typename Stage>
void AddThreadCpu(double* sum, Stage&& stage) {
  const double begin = ThreadCpuSeconds();
  stage();
  *sum += ThreadCpuSeconds() - begin;
}

}  // namespace touchdown::solvers
