// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/work_sharing.h"

#include <poll.h>

namespace touchdown::evaluation {

void ShareWork(std::vector<WorkerProcess>& workers, const std::vector<int>& items,
               const std::function<void(const WorkerReply&)>& take,
               const std::function<bool()>& stop) {
  constexpr int kPatienceMs = 200;
  std::size_t next = 0;
  while (!stop()) {
    std::vector<pollfd> waits;
    std::vector<WorkerProcess*> busy;
    for (WorkerProcess& worker : workers) {
      if (!worker.busy() && next < items.size()) worker.Start(items[next++]);
      if (!worker.busy()) continue;
      waits.push_back({worker.descriptor(), POLLIN, 0});
      busy.push_back(&worker);
    }
    if (busy.empty()) return;
    if (poll(waits.data(), waits.size(), kPatienceMs) <= 0) continue;
    for (std::size_t i = 0; i < busy.size(); ++i) {
      if (waits[i].revents != 0) take(busy[i]->Receive());
    }
  }
}

}  // namespace touchdown::evaluation
