// SPDX-License-Identifier: BSD-3-Clause
// Variables that launchers set for the processes that they start. Open MPI's mpirun sets its own variables. MPICH's and
// Slurm's srun set those of PMI. Newer ones have those of PMIx, which say the rank but not the number of processes.
// Slurm says the number in a variable of its own. That one alone means nothing, because srun starts other programs too.
#include "evaluation/base/launch.h"

#include <cstdlib>
#include <initializer_list>

namespace touchdown::evaluation {

bool LaunchedAsOneOfSeveral() {
  for (const char* size : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    if (const char* text = std::getenv(size)) return std::atoi(text) > 1;
  }
  if (std::getenv("PMIX_RANK") == nullptr) return false;
  const char* tasks = std::getenv("SLURM_STEP_NUM_TASKS");
  return tasks == nullptr || std::atoi(tasks) > 1;
}

}  // namespace touchdown::evaluation
