# SPDX-License-Identifier: BSD-3-Clause
"""Fixtures: the built program (environment TOUCHDOWN_PROGRAM) and a record that it wrote."""
import os
import signal
import subprocess
import sys
import time
import types

import pytest

# The Python of these tests makes the program's reports, too, whatever environment is active.
os.environ["TOUCHDOWN_PYTHON"] = sys.executable


@pytest.fixture(scope="session")
def program():
    path = os.environ.get("TOUCHDOWN_PROGRAM")
    if not path:
        pytest.skip("TOUCHDOWN_PROGRAM is not set; CTest sets it")
    return path


@pytest.fixture(scope="session")
def run(program):
    """Runs the program; returns the finished process with its text."""

    def call(*arguments, cwd=None, timeout=None):
        return subprocess.run(
            [program, *arguments],
            capture_output=True,
            text=True,
            cwd=cwd,
            check=False,
            timeout=timeout,
        )

    return call


@pytest.fixture(scope="session")
def record_path(run, tmp_path_factory):
    path = tmp_path_factory.mktemp("record") / "landing.db"
    done = run("land", "straight_turn", "--record", str(path), "--set", "timeout=6")
    assert done.returncode == 1, done.stderr
    return str(path)


class FakeBar:
    made = []

    def __init__(self, total, unit):
        self.total, self.unit, self.n, self.closed, self.shown = total, unit, 0, False, []
        FakeBar.made.append(self)

    def update(self, more):
        self.n += more
        self.shown.append(self.n)

    def set_postfix_str(self, text, refresh):
        self.text = text

    def close(self):
        self.closed = True


@pytest.fixture
def bars(monkeypatch):
    FakeBar.made = []
    monkeypatch.setitem(sys.modules, "tqdm.auto", types.SimpleNamespace(tqdm=FakeBar))
    return FakeBar.made


@pytest.fixture
def interrupted(program, tmp_path):
    """Runs the program in `tmp_path` until a file of this pattern is there, and interrupts it: it says so, and leaves nothing."""

    def call(*arguments, begun):
        command = [program, *arguments]
        with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
            for _ in range(6000):
                if list(tmp_path.glob(begun)):
                    break
                time.sleep(0.01)
            process.send_signal(signal.SIGTERM)
            said = process.stderr.read()
        assert process.returncode == 128 + signal.SIGTERM
        assert said.splitlines()[-1] == "touchdown: interrupted"
        assert not list(tmp_path.iterdir())

    return call
