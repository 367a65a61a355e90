# SPDX-License-Identifier: BSD-3-Clause
"""Ranges of numbers: (lo, hi), of whole numbers where lo is one."""
from math import inf
from numbers import Integral, Real
from typing import Any, Tuple

Range = Tuple[float, float]


def within(value: Any, allowed: Range) -> bool:
    """A finite number, and in the range."""
    lo, hi = allowed
    kind: Any = Integral if isinstance(lo, int) else Real
    return isinstance(value, kind) and not isinstance(value, bool) and lo <= value <= hi and abs(value) < inf


def number_in(allowed: Range) -> str:
    """What a number must be: `number in [0.1, 20]`."""
    lo, hi = allowed
    ends = "(" if lo == -inf else "[", ")" if hi == inf else "]"
    return f"{'whole ' if isinstance(lo, int) else ''}number in {ends[0]}{lo:.16g}, {hi:.16g}{ends[1]}"
