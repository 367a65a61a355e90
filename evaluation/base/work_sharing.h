// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "evaluation/base/worker_process.h"

namespace touchdown::evaluation {

/// Has every item done by the first free one of `at_a_time` workers, in no set order; `take` gets each reply. Ends
/// early when `stop` says so, which is asked at least every 0.2 s. The workers then still have their current work.
/// @throws what `take` and WorkerProcess::Receive throw
void ShareWork(std::vector<WorkerProcess>& workers, int at_a_time, const std::vector<int>& items,
               const std::function<void(const WorkerReply&)>& take,
               const std::function<bool()>& stop);

/// Lets up to `jobs` workers do the items 0, 1, ... count - 1. Each item takes at most `limit_s` of wall time [s].
/// `take` gets each reply. @throws what `take` and WorkerProcess throw
void ShareAll(int count, int jobs, const WorkerProcess::Work& work, double limit_s,
              const std::function<void(const WorkerReply&)>& take);

}  // namespace touchdown::evaluation
