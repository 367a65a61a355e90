# SPDX-License-Identifier: BSD-3-Clause
"""Terms that are written in Python."""
from dataclasses import dataclass
from typing import Any, ClassVar, Dict, Optional, Tuple, Union

import numpy as np

from touchdown._touchdown import HingeLoss, LandingContext, LinearLoss, RangeLoss, SquareLoss, TermSetup


def snake(name: str) -> str:
    """The name of a class as scenarios have it."""
    return "".join("_" + c.lower() if c.isupper() else c for c in name).lstrip("_")


@dataclass(frozen=True)
class Parameter:
    """A number that a term can be tuned by: its default, the range in which it may be, and what it means."""

    value: float
    lo: float
    hi: float
    help: str = ""


class Windows:
    """The windows at which a term is asked, n of them at once.

    q      control points, or blocks, of each window: shape (n, window, block_size)
    h      knot interval [s], the same for all
    t      time of the first block of each window [s], shape (n,)
    index  which window of the term each is, from 0: shape (n,)
    """

    __slots__ = ("q", "h", "t", "index")

    def __init__(self, q: np.ndarray, h: float, t: np.ndarray, index: np.ndarray) -> None:
        self.q, self.h, self.t, self.index = q, h, t, index

    @property
    def position(self) -> np.ndarray:
        """p_WB at the knot in the middle of three control points [m], shape (n, block_size)."""
        return (self.q[:, 0] + 4.0 * self.q[:, 1] + self.q[:, 2]) / 6.0

    @property
    def velocity(self) -> np.ndarray:
        """v_WB there [m/s], shape (n, block_size)."""
        return (self.q[:, 2] - self.q[:, 0]) / (2.0 * self.h)

    @property
    def acceleration(self) -> np.ndarray:
        """a_WB there [m/s^2], shape (n, block_size)."""
        return (self.q[:, 0] - 2.0 * self.q[:, 1] + self.q[:, 2]) / self.h**2


class Term:
    """A term of an objective, or rows: the sum over windows of loss(u), where u is what `value` gives.

    A term of one's own derives from this and writes `value`. Everything else has a default:

    name, formula, unit, source   what people want to know; `name` is the word in scenarios
    window, outputs               blocks that it sees at once, 1 to 6; numbers in its u
    uses_interval                 u depends on h or t
    linear                        u is affine in the blocks at a fixed h
    convex                        the cost is convex in the blocks at a fixed h: `check_term` looks
    weight                        of the loss; of a class that is registered the weight in a flight, 0: off
    parameters                    {name: Parameter}: attributes of an instance, and keys terms.NAME.* of a scenario
    first_block, windows          the first block that it sees, and how many windows; None: as many as there are
    can_be_hard, is_limit, is_clearance   what a landing may do with it (docs/adding_a_term.md)
    """

    name: str = ""
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
    parameters: ClassVar[Dict[str, Parameter]] = {}
    first_block: int = 0
    windows: Optional[int] = None
    can_be_hard: bool = True
    is_limit: bool = False
    is_clearance: bool = False
    context: Optional[LandingContext] = None
    setup: Optional[TermSetup] = None

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if not cls.__dict__.get("name"):
            cls.name = snake(cls.__name__)
        for name, parameter in cls.parameters.items():
            setattr(cls, name, parameter.value)

    def __init__(self, **settings: float) -> None:
        """Takes the weight and parameters by name."""
        for name, value in settings.items():
            if name != "weight" and name not in self.parameters:
                known = ", ".join(["weight", *self.parameters])
                raise TypeError(f"term {self.name} has no {name}, it has {known}")
            value = float(value)
            allowed = Parameter(1.0, 0.0, np.inf) if name == "weight" else self.parameters[name]
            if not allowed.lo <= value <= allowed.hi:
                raise ValueError(f"term {self.name}: {name} is {value}, it must be in [{allowed.lo}, {allowed.hi}]")
            setattr(self, name, value)

    def value(self, w: Windows) -> Union[np.ndarray, Tuple[Any, ...]]:
        """u at the windows `w`: an array of shape (n, outputs), or a tuple with one array of shape (n,) for each output.

        Where a term also has `jacobian(w)`, du by the blocks of shape (n, outputs, window, block_size), that is taken.
        With `jacobian_has_interval = True` it gives (du, du_dh), the second of shape (n, outputs), with what
        t = t0 + k h adds. Else both are found by central differences.
        """
        raise NotImplementedError(f"term {self.name} has no value(self, w)")

    def loss(self) -> Union[SquareLoss, HingeLoss, RangeLoss, LinearLoss]:
        """What u costs: a SquareLoss, HingeLoss, RangeLoss or LinearLoss. As rows the interval on which it is 0."""
        return SquareLoss(self.weight)

    def update(self, context: LandingContext) -> None:
        """Told before every solve of a landing what it is about; keeps it as `context`."""
        self.context = context
