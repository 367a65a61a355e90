# SPDX-License-Identifier: BSD-3-Clause
"""One solve."""
from math import inf
from typing import Any, Callable, Mapping, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from touchdown import _touchdown


def solve(
    problem: _touchdown.Solvable,
    start: Optional[ArrayLike] = None,
    backend: str = "banded",
    *,
    options: Optional[Mapping[str, float]] = None,
    max_iterations: int = 100,
    max_evaluations: int = 2**31 - 1,
    wall_limit_s: float = inf,
    gap: float = 0.0,
    confirm: bool = True,
    trace: bool = False,
    shares: bool = False,
    callback: Optional[Callable[[NDArray[np.float64], float, float, int], Any]] = None,
    multipliers: Sequence[Sequence[float]] = (),
) -> _touchdown.SolverResult:
    """Solves a Problem or a LandingProblem with one of `backends()`.

    start        where it begins, shape (num_variables,); None: the guess of a landing problem
    options      of the backend, {name: value}
    max_iterations, max_evaluations, wall_limit_s   end the solve
    gap          ends the solve where the cost is above the optimum by at most this share; 0: it does not
    confirm      checks the point of a backend that reports convergence
    trace        keeps every iteration in the result; shares: the times of its parts
    callback     called with y, cost, max_violation, evaluations; a true return value ends the solve
    multipliers  of the rows, from an earlier result: the solve begins there

    Returns a SolverResult, however the solve ends. Raises ValueError where the backend is unknown or refuses the
    problem, and what a term raises. A caller that solves many problems of one structure keeps a Solver.
    """
    if start is None:
        if not isinstance(problem, _touchdown.LandingProblem):
            raise TypeError("solve needs a start: only a LandingProblem has a guess")
        start = problem.guess()
    return _touchdown.Solver(backend, dict(options or {})).solve(
        problem, start, multipliers=list(map(list, multipliers)), callback=callback, max_iterations=max_iterations,
        max_evaluations=max_evaluations, wall_limit_s=wall_limit_s, gap=gap, confirm=confirm, trace=trace,
        shares=shares,
    )  # fmt: skip
