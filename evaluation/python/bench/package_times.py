#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The overhead of Python: in a solve, by a term, in a sweep. Prints a table (docs/python.md).

    PYTHONPATH=build/release/python python3 evaluation/python/bench/package_times.py
"""
import statistics
import subprocess
import tempfile
import time

import numpy as np
import touchdown as td


class Smooth(td.Term):
    """The library's acceleration_limit, in Python."""

    name = "python_limit"
    window, uses_interval, weight = 3, True, 30.0
    most = 6.0

    def value(self, w):
        return ((w.acceleration**2).sum(axis=1) - self.most**2) / (2.0 * self.most)

    def loss(self):
        return td.HingeLoss(self.weight, 1.0)


class WithSlopes(Smooth):
    name = "python_limit_with_slopes"
    jacobian_has_interval = True

    def jacobian(self, w):
        a = w.acceleration / self.most
        weights = np.array([1.0, -2.0, 1.0]) / w.h**2
        du = np.einsum("k,nd->nkd", weights, a)[:, None]
        return du, -2.0 / w.h * (a * w.acceleration).sum(axis=1)[:, None]


def landing(registries=None, **terms):
    only = {name: {"weight": 0.0} for name in td.Registries().terms if name not in ("smoothness", "arrival_time", *terms)}
    problem = td.LandingProblem(20, arrival="free", registries=registries, terms={**only, **terms})
    problem.set_boundary(td.SplineState(p=[0.0, 0.0, 3.0]), td.GoalAt([9.0, 2.0, 1.0]))
    problem.set_duration(2.0)  # the limit acts
    return problem


def overhead_us(n=5000):
    problem = landing(acceleration_limit={"weight": 30.0})
    solver, start = td.Solver(), problem.guess()
    inside, outside = [], []
    for _ in range(n):
        begin = time.perf_counter()
        solved = solver.solve(problem, start)
        outside.append(time.perf_counter() - begin)
        inside.append(solved.wall_s)
    added = [1e6 * (o - i) for o, i in zip(outside, inside)]
    return statistics.median(added), np.percentile(added, 95), 1e6 * statistics.median(inside)


def evaluation_us(problem, n=2000):
    """Value, gradient and Hessian of all terms at one point."""
    y, times = problem.guess(), []
    for _ in range(n):
        begin = time.perf_counter()
        problem.evaluate(y, hessian=True)
        times.append(1e6 * (time.perf_counter() - begin))
    return statistics.median(times)


def sweep_ratio(pairs=6, trials=60):
    """Both with a result file, in turns, because the order changes the times by some percent."""
    words = [str(td.program_path()), "sweep", "straight_turn", "--trials", str(trials), "--jobs", "2"]

    def by_program(seed):
        with tempfile.TemporaryDirectory() as folder:
            begin = time.perf_counter()
            subprocess.run([*words, "--seed", str(seed), "--db", f"{folder}/t.db"], capture_output=True, check=True)
            return time.perf_counter() - begin

    def by_python(seed):
        begin = time.perf_counter()
        td.sweep("straight_turn", trials=trials, seed=seed, jobs=2, progress=False)
        return time.perf_counter() - begin

    by_python(0)  # imports pandas
    ratios = []
    for seed in range(1, pairs + 1):
        order = (by_program, by_python) if seed % 2 else (by_python, by_program)
        times = {way: way(seed) for way in order}
        ratios.append(times[by_python] / times[by_program])
    return statistics.median(ratios), min(ratios), max(ratios)


def main():
    middle, high, inside = overhead_us()
    print(f"a solve of {inside:.0f} us: {middle:.1f} us more from Python, 95 % under {high:.1f} us")
    parts = td.Registries()
    for term in (Smooth, WithSlopes):
        parts.add(term)
    without = evaluation_us(landing())
    cpp = evaluation_us(landing(acceleration_limit={"weight": 30.0})) - without
    for name in (Smooth.name, WithSlopes.name):
        others = {n: {"weight": 0.0} for n in (Smooth.name, WithSlopes.name) if n != name}
        python = evaluation_us(landing(parts, **{name: {"weight": 30.0}}, **others)) - without
        print(f"{name}: {python:.0f} us an evaluation, {python / cpp:.0f} times the {cpp:.2f} us of C++")
    print("a sweep of 60 flights, two at a time, Python's time over the program's: median %.3f, %.3f to %.3f" % sweep_ratio())


if __name__ == "__main__":
    main()
