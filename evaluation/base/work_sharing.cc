// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/base/work_sharing.h"

#include <algorithm>
#include <numeric>

#include <poll.h>

namespace touchdown::evaluation {

void ShareWork(std::vector<WorkerProcess>& workers, int at_a_time, const std::vector<int>& items,
               const std::function<void(const WorkerReply&)>& take,
               const std::function<bool()>& stop) {
  constexpr int kPollMs = 200;
  const std::size_t most = std::min(workers.size(), static_cast<std::size_t>(at_a_time));
  std::size_t next = 0;
  while (!stop()) {
    std::vector<pollfd> waits;
    std::vector<WorkerProcess*> busy;
    for (std::size_t w = 0; w < most; ++w) {
      WorkerProcess& worker = workers[w];
      if (!worker.busy() && next < items.size()) worker.Start(items[next++]);
      if (!worker.busy()) continue;
      waits.push_back({worker.descriptor(), POLLIN, 0});
      busy.push_back(&worker);
    }
    if (busy.empty()) return;
    if (poll(waits.data(), waits.size(), kPollMs) <= 0) continue;
    for (std::size_t i = 0; i < busy.size(); ++i) {
      if (waits[i].revents != 0) take(busy[i]->Receive());
    }
  }
}

void ShareAll(int count, int jobs, const WorkerProcess::Work& work, double limit_s,
              const std::function<void(const WorkerReply&)>& take) {
  std::vector<WorkerProcess> workers;
  for (int job = 0; job < std::min(jobs, count); ++job) workers.emplace_back(work, limit_s);
  std::vector<int> items(static_cast<std::size_t>(count));
  std::iota(items.begin(), items.end(), 0);
  ShareWork(workers, jobs, items, take, [] { return false; });
}

}  // namespace touchdown::evaluation
