# SPDX-License-Identifier: BSD-3-Clause
"""Terms that are written in Python."""
from dataclasses import dataclass

import numpy as np

from touchdown._touchdown import SquareLoss


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

    def __init__(self, q, h, t, index):
        self.q, self.h, self.t, self.index = q, h, t, index

    @property
    def position(self):
        """p_WB at the knot in the middle of three control points [m], shape (n, block_size)."""
        return (self.q[:, 0] + 4.0 * self.q[:, 1] + self.q[:, 2]) / 6.0

    @property
    def velocity(self):
        """v_WB there [m/s], shape (n, block_size)."""
        return (self.q[:, 2] - self.q[:, 0]) / (2.0 * self.h)

    @property
    def acceleration(self):
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

    name = ""
    formula = ""
    unit = ""
    source = ""
    convex = False
    window = 1
    outputs = 1
    uses_interval = False
    linear = False
    weight = 1.0
    parameters = {}
    first_block = 0
    windows = None
    can_be_hard = True
    is_limit = False
    is_clearance = False
    context = None
    setup = None

    def __init_subclass__(cls, **kwargs):
        super().__init_subclass__(**kwargs)
        if not cls.__dict__.get("name"):
            cls.name = "".join("_" + c.lower() if c.isupper() else c for c in cls.__name__).lstrip("_")
        for name, parameter in cls.parameters.items():
            setattr(cls, name, parameter.value)

    def __init__(self, **settings):
        """Takes the weight and parameters by name."""
        for name, value in settings.items():
            if name != "weight" and name not in self.parameters:
                known = ", ".join(["weight", *self.parameters])
                raise TypeError(f"term {self.name} has no {name}, it has {known}")
            value = float(value)
            low, high = (0.0, np.inf) if name == "weight" else self._range(name)
            if not low <= value <= high:
                raise ValueError(f"term {self.name}: {name} is {value}, it must be in [{low}, {high}]")
            setattr(self, name, value)

    def _range(self, name):
        return self.parameters[name].lo, self.parameters[name].hi

    def value(self, w):
        """u at the windows `w`: an array of shape (n, outputs), or a tuple with one array of shape (n,) for each output.

        Where a term also has `jacobian(w)`, du by the blocks of shape (n, outputs, window, block_size), that is taken.
        With `jacobian_has_interval = True` it gives (du, du_dh), the second of shape (n, outputs), with what
        t = t0 + k h adds. Else both are found by central differences.
        """
        raise NotImplementedError(f"term {self.name} has no value(self, w)")

    def loss(self):
        """What u costs: a SquareLoss, HingeLoss, RangeLoss or LinearLoss. As rows the interval on which it is 0."""
        return SquareLoss(self.weight)

    def update(self, context):
        """Told before every solve of a landing what it is about; keeps it as `context`."""
        self.context = context
