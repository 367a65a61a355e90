// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "evaluation/base/worker_process.h"

namespace touchdown::evaluation {

/// This process as one of the ranks of an MPI program. Once in a process's life. It is made after the workers, because
/// they must not be forked from a process that uses MPI.
class Ranks {
 public:
  /// Starts MPI. @throws BadInput where the build has none
  Ranks();
  // NOLINTNEXTLINE(performance-trivially-destructible): not where there is MPI
  ~Ranks();  ///< of rank 0: lets the others go
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  bool leads() const { return rank_ == 0; }
  int size() const { return size_; }
  /// Whether all ranks give the same text. To be called by all.
  bool Agree(const std::string& text) const;

  /// By rank 0: as ShareWork, but with this rank's worker and those of the others.
  void Lead(WorkerProcess& worker, const std::vector<int>& items,
            const std::function<void(const WorkerReply&)>& take, const std::function<bool()>& stop);
  /// By the other ranks, until rank 0 lets them go.
  void Follow(WorkerProcess& worker);

 private:
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace touchdown::evaluation
