// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace touchdown::evaluation {

/// A Python that reports may run with.
struct Interpreter {
  std::string path;
  std::string named_by;  ///< a variable of the environment, or "the build's default"
};

/// The interpreters that the user may mean, in order of preference, each once. If TOUCHDOWN_PYTHON is set, it is the
/// only one. Else: the active environment's (VIRTUAL_ENV, CONDA_PREFIX), python3 on PATH, the build's default.
std::vector<Interpreter> InterpretersToAsk();

/// The first that has all packages. Each is asked in turn. @throws std::runtime_error, half a sentence: what each of
/// them lacks, and how to install it. @param patience_s how long one may take to answer [s]
Interpreter FirstWith(const std::vector<std::string>& packages,
                      const std::vector<Interpreter>& interpreters, double patience_s);

/// The path of the first of InterpretersToAsk with these packages. It is kept for the run. If it is not the build's
/// default, it is logged. @throws as FirstWith; the next call asks again
std::string InterpreterWith(const std::vector<std::string>& packages);

}  // namespace touchdown::evaluation
