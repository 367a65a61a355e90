// SPDX-License-Identifier: BSD-3-Clause
// The factorisation and the solves behind every step of `banded`, by number of blocks: both must
// grow linearly.

#include <benchmark/benchmark.h>

#include <vector>

#include "touchdown/solvers/linear/bordered_cholesky.h"

namespace touchdown::solvers {
namespace {

/// A definite matrix of the landing problem's shape: third differences of blocks of three.
BorderedBandMatrix ThirdDifferences(int blocks, bool bordered) {
  BorderedBandMatrix A;
  A.Resize(blocks, 3, 3, bordered);
  const double row[4] = {-1.0, 3.0, -3.0, 1.0};
  for (int k = 0; k + 3 < blocks; ++k) {
    for (int a = 0; a < 4; ++a) {
      for (int b = a; b < 4; ++b) {
        for (int c = 0; c < 3; ++c) A.block(k + a, b - a)[4 * c] += row[a] * row[b];
      }
    }
  }
  for (int i = 0; i < blocks; ++i) {
    for (int c = 0; c < 3; ++c) A.block(i, 0)[4 * c] += 0.1;
  }
  if (bordered) A.corner() = 1.0;
  return A;
}

void Factor(benchmark::State& state) {
  const BorderedBandMatrix A = ThirdDifferences(static_cast<int>(state.range(0)), state.range(1));
  BorderedCholesky factor;
  factor.Prepare(A);
  for (auto _ : state) benchmark::DoNotOptimize(factor.Factor(A));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(Factor)->ArgsProduct({{10, 20, 40, 80, 160}, {0, 1}})->ArgNames({"blocks", "border"});

void Solve(benchmark::State& state) {
  const BorderedBandMatrix A = ThirdDifferences(static_cast<int>(state.range(0)), state.range(1));
  BorderedCholesky factor;
  factor.Prepare(A);
  factor.Factor(A);
  std::vector<double> x(static_cast<std::size_t>(A.size()), 1.0);
  for (auto _ : state) {
    std::fill(x.begin(), x.end(), 1.0);
    factor.Solve(x.data());
    benchmark::DoNotOptimize(x.data());
  }
}
BENCHMARK(Solve)->ArgsProduct({{10, 20, 40, 80, 160}, {0, 1}})->ArgNames({"blocks", "border"});

}  // namespace
}  // namespace touchdown::solvers
