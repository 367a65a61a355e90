# SPDX-License-Identifier: BSD-3-Clause
"""Attributes of a user's class: they are checked when the class is made."""
import numpy as np
import pytest

import the_package

td = the_package.touchdown
BASES = [td.Term, td.Planner, td.Controller, td.PadPredictor]


def made(base, **body):
    return type("Mine", (base,), body)


@pytest.mark.parametrize("base", BASES)
def test_a_number_in_a_subclass_is_its_default(base):
    first = made(base, parameters={"height": td.Parameter(2.5, 0.5, 10.0, "[m]")})
    second = type("Second", (first,), {"height": 1.0})
    third = type("Third", (second,), {})
    assert first.height == first().height == 2.5 == first.parameters["height"].value
    assert second.height == second().height == 1.0 == third().height
    assert second.parameters["height"] == td.Parameter(1.0, 0.5, 10.0, "[m]") == third.parameters["height"]
    fourth = type("Fourth", (second,), {"parameters": {"height": td.Parameter(4.0, 0.5, 10.0)}})
    assert fourth().height == 4.0 and second().height == 1.0
    with pytest.raises(ValueError, match=r"Low.height is 0.1, it must be a number in \[0.5, 10\]"):
        type("Low", (first,), {"height": 0.1})
    with pytest.raises(TypeError, match="Odd.height is <function"):
        type("Odd", (first,), {"height": lambda self: 1.0})


def test_the_default_of_a_subclass_is_the_registrys():
    heights = set()

    class High(td.Term):
        window = 3
        parameters = {"height": td.Parameter(2.5, 0.5, 10.0)}

        def value(self, w):
            heights.add(self.height)
            return w.position[:, 2:] - self.height

    class Low(High):
        height = 1.5

    td.Registries().add(Low)
    assert heights == {1.5}


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize(
    "parameters, error, why",
    [
        ({"a": td.Parameter(3.0, 0.0, 2.0)}, ValueError, r"Mine.a is 3.0, it must be a number in \[0, 2\]"),
        ({"a": td.Parameter(np.nan, 0.0, 2.0)}, ValueError, "Mine.a is nan, it must be a number"),
        ({"a": td.Parameter(np.inf, 0.0, np.inf)}, ValueError, r"Mine.a is inf, it must be a number in \[0, inf\)"),
        ({"a": td.Parameter("1", 0.0, 2.0)}, TypeError, "Mine.a is '1', it must be a number"),
        ({"a": 1.0}, TypeError, "Mine.parameters has 1.0 as a, it must be a Parameter"),
        ({"name": td.Parameter(1.0, 0.0, 2.0)}, ValueError, "Mine.parameters has name, which .* has already"),
        (["a"], TypeError, r"Mine.parameters is \['a'\], it must be a dictionary"),
    ],
)
def test_parameters_are_looked_at(base, parameters, error, why):
    with pytest.raises(error, match=why):
        made(base, parameters=parameters)


@pytest.mark.parametrize(
    "base, name", [(td.Term, "value"), (td.Term, "weight"), (td.Planner, "limits"), (td.PadPredictor, "predict")]
)
def test_no_parameter_takes_the_place_of_what_the_class_has(base, name):
    with pytest.raises(ValueError, match=f"Mine.parameters has {name}, which {base.__name__} has already"):
        made(base, parameters={name: td.Parameter(1.0, 0.0, 2.0)})


@pytest.mark.parametrize(
    "base, body, error, why",
    [
        (td.Planner, {"rate": "x"}, TypeError, r"Mine.rate is 'x', it must be a number in \[0, 100\]"),
        (td.Planner, {"rate": -1.0}, ValueError, "Mine.rate is -1.0"),
        (td.Planner, {"rate": float("nan")}, ValueError, "Mine.rate is nan"),
        (td.Planner, {"lands": "no"}, TypeError, "Mine.lands is 'no', it must be a truth"),
        (td.Controller, {"compensates": 1}, TypeError, "Mine.compensates is 1"),
        (td.PadPredictor, {"name": 3}, TypeError, "Mine.name is 3, it must be a text"),
        (td.PadPredictor, {"summary": 3}, TypeError, "Mine.summary is 3"),
        (td.Term, {"window": 7}, ValueError, r"Mine.window is 7, it must be a whole number in \[1, 6\]"),
        (td.Term, {"window": 2.0}, ValueError, "Mine.window is 2.0"),
        (td.Term, {"outputs": True}, ValueError, "Mine.outputs is True"),
        (td.Term, {"weight": None}, TypeError, "Mine.weight is None"),
        (td.Term, {"scale": 0.0}, ValueError, "Mine.scale is 0.0"),
        (td.Term, {"windows": -1}, ValueError, "Mine.windows is -1"),
        (td.Term, {"linear": None}, TypeError, "Mine.linear is None"),
        (td.Term, {"formula": 1}, TypeError, "Mine.formula is 1"),
    ],
)
def test_attributes_are_of_their_kind(base, body, error, why):
    with pytest.raises(error, match=why):
        made(base, **body)


def test_what_fits_is_taken():
    term = made(td.Term, windows=None, window=np.int64(3), weight=2, linear=np.bool_(True), gain=1, outputs=2)
    assert type("Better", (term,), {"gain": 2.5, "windows": 4}).gain == 2.5
    assert made(td.Term, windows=property(lambda self: 2))().windows == 2
    assert made(td.Planner, rate=10).rate == 10 and made(td.Planner, __doc__=" ").summary == "written in Python"
