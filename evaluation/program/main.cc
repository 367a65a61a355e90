// SPDX-License-Identifier: BSD-3-Clause
#include "touchdown/evaluation/program/program.h"

int main(int argc, char** argv) {
  return touchdown::evaluation::RunProgram(argc, argv, touchdown::evaluation::StandardRegistries());
}
