// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace touchdown::evaluation {

/// Whether a launcher (mpirun, srun) has started this process as one of several that are to work together.
/// Found out from the environment, without MPI.
bool LaunchedAsOneOfSeveral();

}  // namespace touchdown::evaluation
