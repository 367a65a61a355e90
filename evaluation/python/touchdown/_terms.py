# SPDX-License-Identifier: BSD-3-Clause
"""Terms that are written in Python."""
from math import inf
from typing import Any, ClassVar, Dict, Optional, Tuple, Union

import numpy as np

from touchdown._ranges import Range
from touchdown._touchdown import HingeLoss, LandingContext, LinearLoss, RangeLoss, SquareLoss, TermSetup
from touchdown._tunable import Tunable


class Windows:
    """The windows at which a term is asked, n of them at once.

    q      control points, or blocks, of each window: shape (n, window, block_size)
    h      knot interval [s], the same for all
    t      time of each window [s], shape (n,): the knot at which position, velocity and acceleration are. It is
           t0 + k h for a window that begins with block k
    index  which window of the term each is, from 0: shape (n,)

    The offset from a moving pad: `w.position - self.context.pad.positions(w.t)`, with uses_interval = True.
    """

    __slots__ = ("q", "h", "t", "index")

    def __init__(self, q: np.ndarray, h: float, t: np.ndarray, index: np.ndarray) -> None:
        self.q, self.h, self.t, self.index = q, h, t, index

    def _knots(self, what: str) -> np.ndarray:
        if self.q.shape[1] < 3:
            raise ValueError(f"{what} needs a window of 3 control points, and this has {self.q.shape[1]}")
        return self.q

    @property
    def position(self) -> np.ndarray:
        """p_WB at the knot in the middle of three control points [m], shape (n, block_size)."""
        q = self._knots("position")
        return (q[:, 0] + 4.0 * q[:, 1] + q[:, 2]) / 6.0

    @property
    def velocity(self) -> np.ndarray:
        """v_WB there [m/s], shape (n, block_size)."""
        q = self._knots("velocity")
        return (q[:, 2] - q[:, 0]) / (2.0 * self.h)

    @property
    def acceleration(self) -> np.ndarray:
        """a_WB there [m/s^2], shape (n, block_size)."""
        q = self._knots("acceleration")
        return (q[:, 0] - 2.0 * q[:, 1] + q[:, 2]) / self.h**2


class Term(Tunable):
    """A term of an objective, or rows: the sum over windows of loss(u), where u is what `value` gives.

    A term of one's own derives from this and writes `value`. Everything else has a default:

    name, formula, unit, source   for people; `name` is the word in scenarios
    window, outputs               blocks that it sees at once, 1 to 6; numbers in its u
    uses_interval                 u depends on h or t
    linear                        u is affine in the blocks at a fixed h
    scale                         change of the blocks over which u is smooth, > 0. Steps of the differences are shares
                                  of it. Make it smaller where u changes on a shorter length
    convex                        the cost is convex in the blocks at a fixed h: `check_term` checks it
    weight                        of the loss; for a registered class the weight in a flight, 0: off
    parameters                    {name: Parameter}: attributes of an instance, and keys terms.NAME.* of a scenario. A
                                  number of that name in the body of a subclass is its default
    first_block, windows          the first block that it sees, and how many windows; None: as many as there are
    can_be_hard, is_limit, is_clearance   what a landing may do with it (docs/adding_a_term.md)

    These attributes, also the weight, and the value of loss() are read once, when the term is added. A later change
    has no effect, except for first_block and windows: it counts from the next `update` on. Everything else that `value`
    reads, such as parameters, is live: a change counts at once.
    """

    formula: str = ""
    unit: str = ""
    source: str = ""
    convex: bool = False
    window: int = 1
    outputs: int = 1
    uses_interval: bool = False
    linear: bool = False
    scale: float = 1.0
    weight: float = 1.0
    first_block: int = 0
    windows: Optional[int] = None
    can_be_hard: bool = True
    is_limit: bool = False
    is_clearance: bool = False
    jacobian_has_interval: bool = False
    context: Optional[LandingContext] = None
    setup: Optional[TermSetup] = None
    _ranges: ClassVar[Dict[str, Range]] = {
        "window": (1, 6), "outputs": (1, 65536), "first_block": (0, 2**31 - 1), "windows": (0, 2**31 - 1),
        "weight": (0.0, inf), "scale": (1e-300, 1e300),
    }  # fmt: skip
    _settings = ("weight",)

    def value(self, w: Windows) -> Union[np.ndarray, Tuple[Any, ...]]:
        """u at the windows `w`: an array of shape (n, outputs), or a tuple with one array of shape (n,) for each output.

        Where a term also has `jacobian(w)`, du by the blocks of shape (n, outputs, window, block_size), that is taken.
        With `jacobian_has_interval = True` it gives (du, du_dh), the second of shape (n, outputs), with what
        t = t0 + k h adds. Else both are found by central differences, and from one side where u is not
        finite on the other.
        """
        raise NotImplementedError(f"term {self.name} has no value(self, w)")

    def loss(self) -> Union[SquareLoss, HingeLoss, RangeLoss, LinearLoss]:
        """The cost of u: a SquareLoss, HingeLoss, RangeLoss or LinearLoss. As rows the interval on which it is 0."""
        return SquareLoss(self.weight)

    def update(self, context: LandingContext) -> None:
        """Called before every solve of a landing with its context; keeps it as `context`."""
        self.context = context


def worst_slope(cls: type) -> str:
    """The place where the jacobian of a term is farthest from differences, for a sentence. Empty if it cannot be
    evaluated alone."""
    term = cls()
    n, w = 6, term.window
    q = np.random.default_rng(1).normal(scale=term.scale, size=(n, w, 3))

    def at(moved: np.ndarray) -> Windows:
        return Windows(moved, 0.3, 0.3 * np.arange(n), np.arange(n))

    def value(moved: np.ndarray) -> np.ndarray:
        u = term.value(at(moved))
        return np.stack(np.broadcast_arrays(*u), axis=-1) if isinstance(u, tuple) else np.reshape(u, (n, term.outputs))

    try:
        du = term.jacobian(at(q))  # type: ignore[attr-defined]
        du = np.reshape(du[0] if isinstance(du, tuple) else du, (n, term.outputs, w, 3))
        differences = np.empty_like(du)
        for b, i in np.ndindex(w, 3):
            step = np.zeros_like(q)
            step[:, b, i] = 1e-5 * term.scale
            differences[:, :, b, i] = (value(q + step) - value(q - step)) / (2e-5 * term.scale)
        k, c, b, i = np.unravel_index(np.abs(du - differences).argmax(), du.shape)
    except Exception:  # it needs what a landing tells it
        return ""
    return f"; at a point jacobian gives du[{k}, {c}, {b}, {i}] = {du[k, c, b, i]:.4g}, differences {differences[k, c, b, i]:.4g}"
