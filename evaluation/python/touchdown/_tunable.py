# SPDX-License-Identifier: BSD-3-Clause
"""What terms and parts that are written in Python have in common: a name, attributes of a kind, parameters."""
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any, ClassVar, Dict, Tuple

import numpy as np

from touchdown._ranges import Range, number_in, within


def snake(name: str) -> str:
    """The name of a class as scenarios have it."""
    return "".join("_" + c.lower() if c.isupper() else c for c in name).lstrip("_")


@dataclass(frozen=True)
class Parameter:
    """A number that a term or a part can be tuned by: its default, the range in which it may be, and what it means."""

    value: float
    lo: float
    hi: float
    help: str = ""

    @property
    def range(self) -> Range:
        """(lo, hi), of whole numbers and others."""
        return float(self.lo), float(self.hi)


class Tunable:
    """Checks every class that derives from it when the class is made: raises TypeError or ValueError.

    name        the word in a scenario; by default the class's in snake case
    parameters  {name: Parameter}: attributes of an instance. A number of that name in the body of a subclass is its
                default
    """

    name: str = ""
    parameters: ClassVar[Dict[str, Parameter]] = {}
    _ranges: ClassVar[Dict[str, Range]] = {}  # of attributes
    _settings: ClassVar[Tuple[str, ...]] = ()  # attributes that an instance takes by name, as it takes parameters

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if not cls.__dict__.get("name"):
            cls.name = snake(cls.__name__)
        ours = next(base for base in cls.__mro__ if base.__module__.startswith("touchdown."))
        for name, value in vars(cls).items():
            if not name.startswith("_") and not hasattr(value, "__get__"):
                _check_kind(cls, name, value, getattr(ours, name, None))
        taken = {name: _with_default(cls, name, parameter) for name, parameter in cls.parameters.items()}
        for name, parameter in taken.items():
            setattr(cls, name, parameter.value)
        cls.parameters = taken

    def __init__(self, **settings: float) -> None:
        """Takes parameters by name."""
        known = {name: self._ranges[name] for name in self._settings}
        known.update((name, parameter.range) for name, parameter in self.parameters.items())
        for name, value in settings.items():
            if name not in known:
                raise TypeError(f"{type(self).__name__} has no {name}, it has {', '.join(known) or 'none'}")
            _require(type(self), name, value, known[name])
            setattr(self, name, float(value))


def _require(cls: type, name: str, value: Any, allowed: Range) -> None:
    if not within(value, allowed):
        error = ValueError if isinstance(value, Real) else TypeError
        raise error(f"{cls.__name__}.{name} is {value!r}, it must be a {number_in(allowed)}")


def _check_kind(cls: "type[Tunable]", name: str, value: Any, default: Any) -> None:
    """Checks that a library attribute has the type of its default."""
    for kinds, word in (((str,), "text"), ((bool, np.bool_), "truth"), ((dict,), "dictionary")):
        if isinstance(default, kinds) and not isinstance(value, kinds):
            raise TypeError(f"{cls.__name__}.{name} is {value!r}, it must be a {word}")
    if name in cls._ranges and (value is not None or default is not None):
        _require(cls, name, value, cls._ranges[name])


def _with_default(cls: "type[Tunable]", name: str, parameter: Any) -> Parameter:
    """The parameter with the default that it has in this class."""
    if not isinstance(parameter, Parameter):
        raise TypeError(f"{cls.__name__}.parameters has {parameter!r} as {name}, it must be a Parameter")
    if "parameters" not in vars(cls):
        value = getattr(cls, name)
    else:
        value = vars(cls).get(name, parameter.value)
        for base in cls.__mro__[1:]:
            has = {*vars(base), *vars(base).get("__annotations__", ())}
            if name in has and name not in getattr(base, "parameters", ()):
                raise ValueError(f"{cls.__name__}.parameters has {name}, which {base.__name__} has already")
    _require(cls, name, value, parameter.range)
    return replace(parameter, value=value)
