// SPDX-License-Identifier: BSD-3-Clause

#include "touchdown/solvers/problems/hock_schittkowski.h"

#include "solvers/problems/hock_schittkowski_parts.h"

namespace touchdown::solvers {

std::vector<ReferenceProblem> HockSchittkowski(EqualityForm form) {
  std::vector<ReferenceProblem> all;
  AddHockSchittkowskiFirst(form, &all);
  AddHockSchittkowskiSecond(form, &all);
  AddHockSchittkowskiThird(form, &all);
  return all;
}

}  // namespace touchdown::solvers
