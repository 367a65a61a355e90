# SPDX-License-Identifier: BSD-3-Clause
"""For any arguments a function of the package gives a result or an exception with a sentence. A crash would end pytest,
so the calls are made in a process of their own."""
import os
import subprocess
import sys

import pytest

import the_package

td = the_package.touchdown
pytest.importorskip("hypothesis")

CALLS = '''
import inspect, resource, sys
import numpy as np
from hypothesis import HealthCheck, given, settings, strategies as st
from hypothesis.extra import numpy as hnp
import touchdown as td
from touchdown import _touchdown

resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))
ALLOWED = (ValueError, TypeError, RuntimeError, LookupError, OverflowError, AttributeError, OSError, MemoryError,
           NotImplementedError)


class Term(td.Term):
    window = 2
    def value(self, w):
        return w.q[:, 0, :1]


def problem():
    made = td.Problem(4)
    made.add(Term())
    return made


def landing():
    made = td.LandingProblem(8)
    made.set_boundary(td.SplineState(p=[0, 0, 3]), td.GoalAt([3, 0, 1]))
    return made


def planner():
    made = td.Replanner()
    made.commit_hover([0, 0, 2])
    return made


SCENARIO = td.load_scenario("open", set={"timeout": 1})
OPTIONS = td.OccupancyMapOptions(size_log2=[5, 5, 5])
CURVE = td.hermite(td.SplineState(), td.SplineState(p=[1, 0, 0]), 6, 1.0)
# Makes an object with something in it; each is made anew for each call.
MAKERS = {
    "problem": problem, "landing": landing, "planner": planner, "curve": lambda: CURVE,
    "solver": td.Solver, "map": lambda: td.OccupancyMap(OPTIONS), "goal": lambda: td.GoalAt([1, 2, 3]),
    "moving": lambda: td.MovingGoal(lambda t: (t, 0.0, 1.0)), "taylor": lambda: td.Taylor(1.0),
    "registries": td.Registries, "scenario": lambda: SCENARIO,
    "onboard": lambda: td.Onboard(SCENARIO.vehicle_model(), 0.5),
    "loss": lambda: td.HingeLoss(1.0, 1.0), "result": lambda: td.solve(problem(), np.zeros(4)),
    "answer": lambda: planner().replan(td.OccupancyMap(OPTIONS), td.ReplanInput(), td.GoalAt([1, 0, 2])),
    "limits": td.Limits, "state": td.VehicleState, "input": td.ReplanInput, "term": Term, "class": lambda: Term,
}
numbers = st.one_of(st.integers(-3, 40), st.floats(width=32), st.sampled_from([2**31, -2**63, 1e300, float("nan")]))
arrays = hnp.arrays(st.sampled_from([np.float64, np.int32, np.uint8, np.float32, bool]),
                    hnp.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=5))
values = st.one_of(
    st.none(), st.booleans(), numbers, st.text(max_size=8), st.binary(max_size=8), arrays,
    st.lists(numbers, max_size=5), st.dictionaries(st.text(max_size=4), numbers, max_size=2),
    st.sampled_from(["banded", "open", "cost", "rows", "smoothness", "straight_turn"]),
    st.sampled_from(sorted(MAKERS)).map(lambda name: MAKERS[name]()),
    st.just(lambda *a: 1.0), st.just(object()), st.just(iter([1, 2])), st.just(2 + 3j),
)
# What flies, waits or asks for trials is bounded by what it is given; it has tests of its own.
LONG = {"_run", "_sweep", "_explain", "check_term", "_use_share"}
free = [(name, None, value) for name, value in sorted(vars(_touchdown).items())
        if callable(value) and name not in LONG and not (inspect.isclass(value) and issubclass(value, BaseException))]
bound = []
for maker in sorted(MAKERS):
    cls = type(MAKERS[maker]())
    if cls.__module__ != "touchdown._touchdown":
        continue
    for name in sorted(dir(cls)):
        member = inspect.getattr_static(cls, name)
        if name.startswith("__") and name not in ("__init__", "__add__", "__truediv__", "__copy__", "__repr__"):
            continue
        if callable(getattr(cls, name)) or isinstance(member, property):
            bound.append((name, maker, member))
print(len(free), "functions and classes,", len(bound), "members", flush=True)


@settings(max_examples=int(sys.argv[1]), deadline=None, derandomize=sys.argv[2] == "same",
          suppress_health_check=list(HealthCheck))
@given(st.data())
def calls(data):
    name, maker, member = data.draw(st.sampled_from(free + bound * 2))
    given_values = data.draw(st.lists(values, max_size=4))
    print(name, maker, [type(v).__name__ for v in given_values], file=sys.stderr, flush=True)
    try:
        if maker is None:
            kept = member(*given_values)
        else:
            owner = MAKERS[maker]()
            if isinstance(member, property):
                kept = getattr(owner, name)
                if given_values and member.fset:
                    setattr(owner, name, given_values[0])
                    repr(owner)
            else:
                kept = getattr(owner, name)(*given_values)
            del owner
        repr(kept)
    except ALLOWED as error:
        assert str(error) or isinstance(error, (MemoryError, StopIteration)), (name, maker)


calls()
print("done", flush=True)
'''


def test_no_argument_crashes_the_interpreter(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", CALLS, "3000", "same"], capture_output=True, text=True, timeout=600, check=False,
        env={**os.environ, "HYPOTHESIS_STORAGE_DIRECTORY": str(tmp_path)},
    )
    last = "\n".join(done.stderr.splitlines()[-8:])
    assert done.returncode == 0 and done.stdout.endswith("done\n"), f"status {done.returncode} after\n{last}"
    functions, members = (int(word) for word in done.stdout.split() if word.isdigit())
    assert functions > 40 and members > 120


def test_an_object_whose_constructor_was_left_out_is_refused():
    script = """
import touchdown as td
from touchdown import _touchdown
import inspect
for name, cls in vars(_touchdown).items():
    if not inspect.isclass(cls) or issubclass(cls, BaseException):
        continue
    made = type("Half", (cls,), {"__init__": lambda self: None})
    try:
        made = made()
    except TypeError:
        continue
    for member in dir(cls):
        if member.startswith("__") and member != "__repr__":
            continue
        try:
            value = getattr(made, member)
            if callable(value):
                value()
        except (TypeError, ValueError, RuntimeError, AttributeError):
            pass
print("done")
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=False)
    assert done.stdout == "done\n", done.stderr[-2000:]
