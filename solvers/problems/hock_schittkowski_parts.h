// SPDX-License-Identifier: BSD-3-Clause
// The set is compiled in three parts.
#pragma once

#include "touchdown/solvers/problems/hock_schittkowski.h"

namespace touchdown::solvers {

template <class T>
T Square(const T& x) {
  return x * x;
}

void AddHockSchittkowskiFirst(EqualityForm form, std::vector<ReferenceProblem>* all);
void AddHockSchittkowskiSecond(EqualityForm form, std::vector<ReferenceProblem>* all);
void AddHockSchittkowskiThird(EqualityForm form, std::vector<ReferenceProblem>* all);

}  // namespace touchdown::solvers
