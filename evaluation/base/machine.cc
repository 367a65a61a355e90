// SPDX-License-Identifier: BSD-3-Clause
// Linux: getloadavg(3), sched_setaffinity(2).
#include "evaluation/base/machine.h"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <sched.h>
#include <nlohmann/json.hpp>

#include "evaluation/base/bad_input.h"

namespace touchdown::evaluation {

nlohmann::ordered_json MachineJson(const MachineState& machine) {
  using Json = nlohmann::ordered_json;
  const auto or_null = [](double load) { return std::isfinite(load) ? Json(load) : Json(); };
  return {{"pinned_cpu", machine.pinned ? Json(*machine.pinned) : Json()},
          {"load_before", or_null(machine.load_before)},
          {"load_after", or_null(machine.load_after)}};
}

double LoadAverage() {
  double load = 0.0;
  return getloadavg(&load, 1) == 1 ? load : std::numeric_limits<double>::quiet_NaN();
}

void PinToCpu(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(cpu, &set);
  if (sched_setaffinity(0, sizeof(set), &set) != 0) {
    throw BadInput(fmt::format("--pin {}: the thread cannot be bound to this CPU ({}).", cpu,
                               std::strerror(errno)));
  }
}

bool TimingsMeanSomething() {
#if defined(NDEBUG) && defined(__OPTIMIZE__) && !defined(TOUCHDOWN_SANITIZED)
  return true;
#else
  return false;
#endif
}

}  // namespace touchdown::evaluation
