# SPDX-License-Identifier: BSD-3-Clause
"""Stubs, docstrings and the page docs/python.md against the package itself."""
import inspect
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Literal, get_origin

import pytest

import the_package

td = the_package.touchdown

ROOT = Path(__file__).resolve().parents[3]
PACKAGE = Path(td.__file__).parent


def public():
    return {name: value for name, value in vars(td).items() if not name.startswith("_") and not inspect.ismodule(value)}


def test_all_that_is_public_is_named():
    assert sorted(td.__all__) == sorted(public()), "the list in __init__.py is to be made longer"


def test_the_stub_is_the_modules():
    made = subprocess.run(
        [sys.executable, str(ROOT / "evaluation" / "binding" / "stubs.py")],
        capture_output=True, text=True, check=True,
        env={**os.environ, "PYTHONPATH": str(PACKAGE.parent)},
    ).stdout
    kept = (ROOT / "evaluation" / "python" / "touchdown" / "_touchdown.pyi").read_text(encoding="utf-8")
    assert made == kept, "evaluation/binding/stubs.py makes another one"


def test_the_types_hold(tmp_path):
    pytest.importorskip("mypy")
    user = tmp_path / "user.py"
    user.write_text(
        """
import numpy as np
from numpy.typing import NDArray
import touchdown as td


class Low(td.Term):
    window = 3

    def value(self, w: td.Windows) -> NDArray[np.float64]:
        return w.position[:, 2:] - 1.0

    def loss(self) -> td.HingeLoss:
        return td.HingeLoss(self.weight, width=0.3)


parts = td.Registries()
parts.add(Low)
result: td.TrialResult = td.run_trial("open", registries=parts, record=True)
height: float = result.max_speed_mps
problem = td.Problem(blocks=3)


def stops(y: NDArray[np.float64], cost: float, max_violation: float, evaluations: int) -> bool:
    return evaluations > 3


solved: td.SolverResult = td.solve(problem, [0.0, 1.0, 2.0], max_iterations=3, callback=stops)
again = td.solve(problem, solved.x, "ipopt", multipliers=solved.multipliers, gap=0.1, trace=True)
word: str = solved.status
limits = td.Limits(speed=2.0)
"""
    )
    environment = {**os.environ, "MYPYPATH": str(PACKAGE.parent), "PYTHONPATH": str(PACKAGE.parent)}
    mypy = [sys.executable, "-m", "mypy", "--cache-dir", str(tmp_path / "cache"), "--ignore-missing-imports"]
    mypy += ["--strict", "--follow-imports=silent"]
    good = subprocess.run([*mypy, str(user)], capture_output=True, text=True, env=environment, check=False)
    assert good.returncode == 0, good.stdout
    user.write_text(user.read_text() + "wrong: int = solved.status\nlimits.sped = 3.0\ntd.Problem('three')\n"
                    "td.solve(problem, max_iteration=3)\ntd.solve(problem, gap='x')\ntd.solve(problem, callback=3)\n")
    bad = subprocess.run([*mypy, str(user)], capture_output=True, text=True, env=environment, check=False)
    assert bad.stdout.count("error:") == 6, bad.stdout


def test_the_stub_holds_against_the_module(tmp_path):
    pytest.importorskip("mypy")
    # Classes have pybind11's metaclass. A constructor checks arguments by name itself.
    allowed = tmp_path / "allowed"
    allowed.write_text("touchdown\\._touchdown\\.[A-Z]\\w+(\\.__init__)?\n", encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "touchdown._touchdown", "--ignore-positional-only",
         "--allowlist", str(allowed), "--ignore-unused-allowlist"],
        capture_output=True, text=True, cwd=tmp_path, check=False,
        env={**os.environ, "MYPYPATH": str(PACKAGE.parent), "PYTHONPATH": str(PACKAGE.parent)},
    )
    assert done.returncode == 0, done.stdout[-3000:]


@pytest.mark.parametrize("name", sorted(public()))
def test_everything_public_is_told(name):
    thing = public()[name]
    if not callable(thing) or get_origin(thing) is Literal:
        return
    text = re.sub(r"^\w+\(.*\) -> .*$", "", inspect.getdoc(thing) or "", flags=re.M).strip()
    assert text, f"{name} has no docstring"
    if inspect.isclass(thing) and thing.__module__ == "touchdown._touchdown":
        for member, value in vars(thing).items():
            if member.startswith("_") or member in getattr(thing, "_fields", ()) or isinstance(value, staticmethod):
                continue
            told = re.sub(r"^\w*\(.*\) -> .*$", "", value.__doc__ or "", flags=re.M).strip()
            assert told or thing.__name__ == "Taylor", f"{name}.{member} has no docstring"


def test_version_is_the_projects():
    project = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    assert td.__version__ == re.search(r"project\(touchdown VERSION ([\d.]+)", project)[1]


def test_every_block_of_the_page_runs(tmp_path, monkeypatch, capsys):
    page = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", page, re.M | re.S)
    assert len(blocks) >= 8
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)
    said = capsys.readouterr().out
    assert "landed" in said and "planned" in said and "banded converged" in said
    assert not list(tmp_path.iterdir()), "nothing is left behind"
