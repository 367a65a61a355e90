// SPDX-License-Identifier: BSD-3-Clause
// Stands in for ranks.cc where the build has no MPI.
#include "evaluation/base/bad_input.h"
#include "evaluation/campaign/ranks.h"

namespace touchdown::evaluation {

Ranks::Ranks() {
  throw BadInput(
      "An MPI launcher started this program, which was built without MPI (TOUCHDOWN_WITH_MPI): "
      "start it "
      "by itself with --jobs, or as several with --shard.");
}
Ranks::~Ranks() = default;
bool Ranks::Agree(const std::string&) const { return true; }
void Ranks::Lead(WorkerProcess&, const std::vector<int>&,
                 const std::function<void(const WorkerReply&)>&, const std::function<bool()>&) {}
void Ranks::Follow(WorkerProcess&) {}

}  // namespace touchdown::evaluation
