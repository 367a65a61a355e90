// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "touchdown/evaluation/worker_process.h"

namespace touchdown::evaluation {

/// Has every item done by whichever worker is free, in no set order; `take` gets each reply. Ends early when
/// `stop` says so, which is asked at least every 0.2 s: what is under way is then left to the workers.
/// @throws what `take` and WorkerProcess::Receive throw
void ShareWork(std::vector<WorkerProcess>& workers, const std::vector<int>& items,
               const std::function<void(const WorkerReply&)>& take,
               const std::function<bool()>& stop);

}  // namespace touchdown::evaluation
