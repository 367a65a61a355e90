# SPDX-License-Identifier: BSD-3-Clause
"""Touchdown: optimization-centric trajectory planning, from Python (docs/python.md)."""
from touchdown._touchdown import *  # noqa: F401,F403
from touchdown._touchdown import __version__  # noqa: F401
from touchdown._terms import Parameter, Term, Windows  # noqa: F401


def solve(problem, start, backend="banded", *, options=None, **stop):
    return Solver(backend, options or {}).solve(problem, start, **stop)
