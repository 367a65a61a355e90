// SPDX-License-Identifier: BSD-3-Clause
// All headers for a problem of one's own (docs/library.md).
#pragma once

#include "touchdown/solvers/backend_registry.h"
#include "touchdown/solvers/problem/function_term.h"
#include "touchdown/solvers/problem/problem.h"
#include "touchdown/solvers/problem/window_term.h"
#include "touchdown/solvers/solve.h"
