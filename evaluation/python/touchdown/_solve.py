# SPDX-License-Identifier: BSD-3-Clause
"""One solve."""
from typing import Any, Mapping, Optional

from numpy.typing import ArrayLike

from touchdown import _touchdown


def solve(
    problem: _touchdown.Solvable,
    start: Optional[ArrayLike] = None,
    backend: str = "banded",
    *,
    options: Optional[Mapping[str, float]] = None,
    **stop: Any,
) -> _touchdown.SolverResult:
    """Solves a Problem or a LandingProblem with one of `backends()`.

    start    where it begins, shape (num_variables,); None: the guess of a landing problem
    options  of the backend, {name: value}
    stop     as in Solver.solve: max_iterations, wall_limit_s, gap, trace, callback, multipliers, ...

    Gives a SolverResult, however the solve ends. Raises ValueError where the backend is unknown or refuses the problem, and
    what a term raises. Who solves many problems of one structure keeps a Solver.
    """
    if start is None:
        if not isinstance(problem, _touchdown.LandingProblem):
            raise TypeError("solve needs a start: only a LandingProblem has a guess")
        start = problem.guess()
    return _touchdown.Solver(backend, dict(options or {})).solve(problem, start, **stop)
