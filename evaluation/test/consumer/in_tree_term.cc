// SPDX-License-Identifier: BSD-3-Clause
// The program `touchdown` as it is with the term of docs/examples/in_tree_term in its tree.
#include "touchdown/evaluation/program/program.h"

namespace touchdown::planning {
TermEntry LowestHeightTerm();
}  // namespace touchdown::planning

int main(int argc, char** argv) {
  touchdown::evaluation::Registries registries = touchdown::evaluation::StandardRegistries();
  registries.terms.push_back(touchdown::planning::LowestHeightTerm());
  return touchdown::evaluation::RunProgram(argc, argv, registries);
}
