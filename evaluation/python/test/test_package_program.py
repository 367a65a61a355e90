# SPDX-License-Identifier: BSD-3-Clause
"""Where the package finds the program, and how it runs and ends it."""
import json
import os
import signal
import subprocess
import sys
import time

import pytest

from the_package import alive, descendants, touchdown, wait_for
from touchdown import _program


@pytest.fixture
def place(monkeypatch, tmp_path):
    """The package is in this folder below tmp_path, and no other program is known."""

    def put(folder):
        package = tmp_path / folder
        package.mkdir(parents=True)
        monkeypatch.setattr(_program, "PACKAGE", package)
        return package

    monkeypatch.delenv("TOUCHDOWN_PROGRAM", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path / "on_path"))
    return put


def executable(path, text="\x7fELF"):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)
    return path


def script(path, *lines):
    return executable(path, "\n".join(["#!/bin/sh", *lines, ""]))


def test_a_program_inside_of_the_package_comes_first(place, tmp_path):
    package = place("p/lib/python3.11/site-packages/touchdown")
    in_prefix, in_package = executable(tmp_path / "p/bin/touchdown"), executable(package / "bin/touchdown")
    assert touchdown.program_path() == in_package
    in_package.unlink()
    assert touchdown.program_path() == in_prefix


@pytest.mark.parametrize("folder", ["python3.11/dist-packages", "python3.12/site-packages"])
def test_the_prefix_comes_before_path(place, tmp_path, folder):
    place(f"p/lib/{folder}/touchdown")
    on_path = executable(tmp_path / "on_path/touchdown")
    assert touchdown.program_path() == on_path
    in_prefix = executable(tmp_path / "p/bin/touchdown")
    assert touchdown.program_path() == in_prefix


def test_a_build_tree_has_it_beside_the_package(place, tmp_path):
    place("build/release/python/touchdown")
    executable(tmp_path / "on_path/touchdown")
    built = executable(tmp_path / "build/release/bin/touchdown")
    assert touchdown.program_path() == built
    assert _program.share_path() is None


def test_the_variable_counts_alone(place, tmp_path, monkeypatch):
    package = place("p")
    executable(package / "bin/touchdown")
    named = script(tmp_path / "mine")
    monkeypatch.setenv("TOUCHDOWN_PROGRAM", str(named))
    assert touchdown.program_path() == named
    named.chmod(0o644)
    with pytest.raises(FileNotFoundError, match="mine, the value of TOUCHDOWN_PROGRAM, is no program"):
        touchdown.program_path()


def test_the_command_of_a_package_is_not_taken_for_the_program(place, tmp_path):
    place("p")
    script(tmp_path / "on_path/touchdown")
    with pytest.raises(FileNotFoundError, match="There is no program `touchdown`"):
        touchdown.program_path()


def test_what_is_shipped_is_told_to_the_module(place, tmp_path, monkeypatch):
    package = place("p/lib/python3.11/dist-packages/touchdown")
    told = []
    monkeypatch.setattr(_program._touchdown, "_use_share", told.append, raising=False)
    (tmp_path / "p/share/touchdown").mkdir(parents=True)
    _program.use_share()
    (package / "share/touchdown").mkdir(parents=True)
    _program.use_share()
    (place("build/python/touchdown").parents[1] / "share/touchdown").mkdir(parents=True)
    _program.use_share()
    places = (tmp_path / "p", package, tmp_path / "build")
    assert told == [str(folder / "share/touchdown") for folder in places]


def test_what_it_prints_is_returned(run):
    assert touchdown.run_program("list", "scenarios") == run("list", "scenarios").stdout
    assert touchdown.run_program("list", "terms", json=True) == json.loads(run("list", "terms", "--json").stdout)


def test_a_refusal_is_bad_input_with_the_programs_sentence(run):
    with pytest.raises(touchdown.BadInput) as refused:
        touchdown.run_program("land", "opn")
    assert f"touchdown: {refused.value}\n" == run("land", "opn").stderr
    assert isinstance(refused.value, ValueError)


def test_a_flight_that_does_not_land_is_told_by_its_own_line(run):
    land = ("land", "open", "--set", "timeout=1")
    with pytest.raises(touchdown.ProgramFailed) as failed:
        touchdown.run_program(*land)
    assert failed.value.status == 1
    assert str(failed.value) == failed.value.output.splitlines()[0]
    assert str(failed.value).startswith("timeout: not landed on open within 1.00 s")
    with pytest.raises(touchdown.ProgramFailed, match="status 1") as failed:
        touchdown.run_program(*land, json=True)
    assert json.loads(failed.value.output)["outcome"] == "timeout"


@pytest.mark.parametrize(
    "does, sentence, status",
    [
        ("echo 'touchdown: F.db: the disk is full.' >&2; exit 1", "F.db: the disk is full.", 1),
        ("kill -9 $$", "The program was ended by SIGKILL.", -9),
        ("echo 'touchdown: 3 of 20 trials, 2 succeeded and 1 failed, 5 s left' >&2; exit 3", "status 3", 3),
    ],
)
def test_other_ends_are_told(monkeypatch, tmp_path, does, sentence, status):
    monkeypatch.setenv("TOUCHDOWN_PROGRAM", str(script(tmp_path / "fake", does)))
    with pytest.raises(touchdown.ProgramFailed, match=sentence) as failed:
        touchdown.run_program()
    assert failed.value.status == status


def test_what_else_it_says_is_a_warning(monkeypatch, tmp_path):
    says = "echo 'touchdown: warning: vehicle v.xml: heavy; eat less.' >&2; echo 'touchdown: 1 of 1 steps, 0 s left' >&2"
    monkeypatch.setenv("TOUCHDOWN_PROGRAM", str(script(tmp_path / "fake", says, "echo done")))
    with pytest.warns(UserWarning) as told:
        assert touchdown.run_program() == "done\n"
    assert [str(one.message) for one in told] == ["warning: vehicle v.xml: heavy; eat less."]
    assert told[0].filename == __file__


@pytest.mark.parametrize(
    "line, progress",
    [
        ("3 of 20 trials, 2 succeeded and 1 failed, 1.50 a second, 11 s left", True),
        ("kind C: 3 of 20 flights, 12 s left", True),
        ("7 scenes", True),
        ("all 2 trials were flown before", True),
        ("2 of 3 trials were flown before: going on with the others", True),
        ("interrupted after 3 of 20 trials: nothing is kept without --db", False),
        ("--jobs: 0 is no whole number in [1, 1024] (try --help)", False),
        ("out/2.db: 2: no such directory.", False),
    ],
)
def test_lines_of_progress_are_known(line, progress):
    assert _program.is_progress(line) == progress


@pytest.mark.parametrize("call", ["sweep('open', trials=500, jobs=2, progress=False)", "compare(progress=False)"])
def test_an_interrupt_that_reaches_python_alone_ends_all(call):
    code = f"import touchdown\ntouchdown.{call}"
    with subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True) as process:
        # The program; of a sweep its two workers and their flights, too.
        wait_for(lambda: len(descendants(process.pid)) >= (5 if "sweep" in call else 1))
        below = descendants(process.pid)
        begun = time.monotonic()
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=30)
        took_s = time.monotonic() - begun
    assert said.splitlines()[-1] == "KeyboardInterrupt"
    assert took_s < 3.0
    wait_for(lambda: not any(map(alive, below)), 2.0)


def test_a_program_that_does_not_end_is_killed_with_its_children(monkeypatch, tmp_path):
    noted = tmp_path / "child"
    stays = script(tmp_path / "fake", "trap '' TERM", f"sleep 100 & echo $! > {noted}", "wait; sleep 100")
    monkeypatch.setenv("TOUCHDOWN_PROGRAM", str(stays))
    monkeypatch.setattr(_program, "_END_S", 0.2)
    monkeypatch.setattr(_program, "_WATCH_S", 0.2)

    def interrupted(_):
        if noted.exists() and noted.read_text():
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        _program.run_words([], interrupted)
    wait_for(lambda: not alive(int(noted.read_text())), 2.0)


def test_the_command_becomes_the_program(program, run):
    code = "from touchdown._program import main; main()"

    def command(*arguments):
        return subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=False)

    done = command("list", "scenarios")
    assert (done.returncode, done.stdout) == (0, run("list", "scenarios").stdout)
    refused = command("land", "opn")
    assert (refused.returncode, refused.stderr) == (2, run("land", "opn").stderr)
