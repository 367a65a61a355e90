// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <nlohmann/json_fwd.hpp>

namespace touchdown::evaluation {

/// What a timing depends on besides build and CPU: the place and the load.
struct MachineState {
  std::optional<int> pinned;  ///< the CPU that the thread was bound to
  double load_before = 0.0;   ///< load average over one minute
  double load_after = 0.0;
};

/// Document `machine` of --json: `pinned_cpu`, `load_before`, `load_after`.
nlohmann::ordered_json MachineJson(const MachineState& machine);

/// Load average over the last minute; NaN where the system does not tell.
double LoadAverage();

/// Binds the calling thread to one CPU. @throws BadInput naming --pin if there is no such CPU or it
/// may not be used.
void PinToCpu(int cpu);

/// Whether this build is optimised and no assertion or sanitizer slows it: only then its timings
/// are meaningful.
bool TimingsMeanSomething();

}  // namespace touchdown::evaluation
