// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace touchdown::evaluation {

/// Calls run(i) once for every i in [0, count) on `jobs` threads, the caller's among them, in no set
/// order. `progress` is called after each with the number done and `count`, never from two threads at a time.
/// What `run` or `progress` throws is thrown again, the first of it, once the calls under way have ended.
/// @throws std::system_error likewise, if a thread cannot be started.
void RunOnThreads(int count, int jobs, const std::function<void(int)>& run,
                  const std::function<void(int done, int all)>& progress);

}  // namespace touchdown::evaluation
