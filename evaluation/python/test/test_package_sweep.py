# SPDX-License-Identifier: BSD-3-Clause
"""Sweeps from Python: the program's own results, in frames."""
import os
import shlex
import signal
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import numpy as np
import pytest

from the_package import assert_equal, descendants, rows, touchdown, wait_for
from touchdown import _campaigns, _program

SET = {"timeout": 1.5, "start.position_spread": [1, 1, 0]}
VARY = {"controller": ["geometric", "paper"], "gps.sigma": (0.1, 0.5)}
WORDS = ("sweep", "straight_turn", "--trials", "5", "--seed", "3")
WORDS += ("--set", "timeout=1.5", "--set", "start.position_spread=[1, 1, 0]")
WORDS += ("--vary", "controller=geometric,paper", "--vary", "gps.sigma=0.1..0.5")


@pytest.fixture(scope="module")
def own_file(run, tmp_path_factory):
    """The output of the program itself."""
    path = tmp_path_factory.mktemp("own") / "own.db"
    done = run(*WORDS, "--jobs", "1", "--db", str(path))
    assert done.returncode == 0, done.stderr
    return path, done.stdout


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    path = tmp_path_factory.mktemp("flown") / "flown.db"
    return touchdown.sweep(
        "straight_turn", trials=5, seed=3, set=SET, vary=VARY, jobs=2, db=path, progress=False
    )


def test_rows_are_the_programs_to_the_last_bit(flown, own_file):
    assert_equal(flown.trials, *rows(own_file[0], "SELECT * FROM trial ORDER BY trial"))
    planned = rows(own_file[0], "SELECT replay AS command FROM planned ORDER BY trial")
    assert_equal(flown.trials, *planned)
    assert_equal(flown.cells, *rows(own_file[0], "SELECT * FROM cell ORDER BY cell"))
    assert flown.report == own_file[1]
    assert str(flown) == own_file[1]


def test_times_are_those_of_the_file(flown):
    assert_equal(flown.trials, *rows(flown.db, "SELECT * FROM timing ORDER BY trial"))
    assert (flown.trials["wall_s"] > 0).all()


def test_a_varied_key_is_a_column(flown, own_file):
    assert list(flown.trials["controller"]) == ["geometric", "paper", "geometric", "paper", "geometric"]
    drawn = rows(own_file[0], "SELECT value FROM variation WHERE key = 'gps.sigma' ORDER BY trial")[1]
    assert [value.hex() for value in flown.trials["gps.sigma"]] == [float(text).hex() for (text,) in drawn]
    assert list(flown.cells["controller"]) == ["geometric", "paper"] and "gps.sigma" not in flown.cells
    assert list(flown.trials.columns[-3:]) == ["controller", "gps.sigma", "command"]
    assert list(flown.cells.columns[:2]) == ["cell", "controller"]


def test_columns_have_the_types_of_what_they_hold(flown):
    assert flown.trials["landed"].dtype == bool
    assert flown.trials["seed"].dtype == np.int64
    # No trial has them, and they are numbers all the same.
    for column in ("time_to_land_s", "following_mean_error_m", "own_rmse_position_m"):
        assert flown.trials[column].dtype == float and flown.trials[column].isna().all()
    assert flown.trials["outcome"].eq("timeout").all()


def test_cells_have_rates(flown):
    assert list(flown.cells["planned"]) == list(flown.cells["trials"]) == [3, 2]
    assert list(flown.cells["rate"]) == [0.0, 0.0]
    assert flown.cells["rate_hi"].between(0.5, 1.0).all()


def test_what_was_run_flies_the_same(flown, own_file, run, tmp_path):
    program, *arguments = shlex.split(flown.command)
    assert program == "touchdown" and arguments[-2:] == ["--db", str(flown.db)]
    again = run(*arguments)
    assert again.returncode == 0 and again.stdout == own_file[1]
    assert again.stderr == "touchdown: all 5 trials were flown before\n"


def test_the_same_call_goes_on_with_its_file(flown):
    again = touchdown.sweep(
        "straight_turn", trials=5, seed=3, set=SET, vary=VARY, jobs=1, db=flown.db, progress=False
    )
    assert again.trials.equals(flown.trials)  # times too: nothing was flown
    with pytest.raises(touchdown.BadInput, match="its trials is 5, not 6"):
        touchdown.sweep("straight_turn", trials=6, seed=3, set=SET, vary=VARY, db=flown.db, progress=False)


def test_without_a_file_nothing_is_left(monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    done = touchdown.sweep("open", trials=2, set={"timeout": 1}, progress=False)
    assert done.db is None and len(done.trials) == 2 and "--db" not in done.command
    with pytest.raises(touchdown.BadInput):
        touchdown.sweep("open", trials=0)
    assert not list(tmp_path.iterdir())


def test_a_planner_and_a_backend_are_short_for_keys():
    done = touchdown.sweep(
        "open", trials=1, set={"timeout": 1}, planner="landing", backend="lbfgs", progress=False
    )
    assert "--set planner=landing --set solver.backend=lbfgs" in done.trials["command"][0]


def test_values_are_numbers_truths_or_words():
    vary = {"wind.direction_random": [True, False], "planning.latency": [20, 30.5], "pad.motion": ["line", "circle"]}
    done = touchdown.sweep("open", trials=8, set={"timeout": 1}, vary=vary, jobs=2, progress=False)
    assert done.trials["wind.direction_random"].dtype == bool
    assert set(done.trials["planning.latency"]) == {20, 30.5}
    assert list(done.cells.columns[:5]) == ["cell", *vary, "planned"] and len(done.cells) == 8
    assert (done.cells["trials"] == 1).all()


def test_a_trial_that_hangs_is_a_row():
    hung = touchdown.sweep("forest", trials=2, trial_limit=0.1, progress=False)
    assert list(hung.trials["outcome"]) == ["hung", "hung"]
    assert hung.trials["detail"][0] == "It had not ended after 0.1 s."
    assert not hung.trials["landed"].any()


def test_a_trial_that_crashes_is_a_row_and_flies_again_on_request(tmp_path):
    killed = []

    def kill_one():
        # Below this: program, worker, and the flight, which has a process of its own.
        wait_for(lambda: len(descendants(os.getpid())) >= 3)
        killed.append(descendants(os.getpid())[-1])
        os.kill(killed[0], signal.SIGKILL)

    killer = threading.Thread(target=kill_one)
    killer.start()
    sweep = {"trials": 2, "set": {"timeout": 3.0}, "db": tmp_path / "a.db", "progress": False}
    done = touchdown.sweep("forest", **sweep)
    killer.join()
    assert killed and sorted(done.trials["outcome"]) == ["crashed", "timeout"]
    again = touchdown.sweep("forest", **sweep, retry=True)
    assert list(again.trials["outcome"]) == ["timeout", "timeout"]


def test_a_complaint_beside_a_lost_trial_is_raised(tmp_path, monkeypatch):
    """The picture is drawn last, by another program, which is told to fail."""
    monkeypatch.setenv("MPLBACKEND", "none_such")
    hung = {"trials": 1, "trial_limit": 0.1, "vary": {"gps.sigma": [0.1]}, "progress": False}
    with pytest.raises(touchdown.ProgramFailed, match="the picture was not drawn"):
        touchdown.sweep("forest", **hung, picture=tmp_path / "a.png")


def test_a_page_with_flights_and_a_picture_are_written(tmp_path):
    page, picture = tmp_path / "a.html", tmp_path / "a.png"
    touchdown.sweep(
        "open", trials=1, set={"timeout": 1}, vary={"gps.sigma": [0.1]}, html=page, record="failures",
        picture=picture, progress=False,
    )  # fmt: skip
    assert "a_flights/0.html" in page.read_text(encoding="utf-8")
    assert (tmp_path / "a_flights" / "0.html").is_file() and picture.stat().st_size > 0


@pytest.mark.parametrize(
    "wrong, why",
    [
        ({"set": {"gps.sigmo": 1}}, "did you mean gps.sigma"),
        ({"vary": {"gps.sigmo": [1]}}, "gps.sigmo is no key that can be varied"),
        ({"trials": "x"}, "--trials: x is no whole number"),
        ({"record": "all"}, "it needs html"),
        ({"retry": True}, "nothing to fly again without db"),
        ({"planner": "lan"}, "planner must be"),
    ],
)
def test_mistakes_are_a_sentence(wrong, why):
    with pytest.raises(ValueError, match=why):
        touchdown.sweep("open", progress=False, **wrong)


def test_the_file_is_whole_when_the_call_returns(tmp_path):
    """A look at the growing file while the program ends leaves nothing beside it."""
    touchdown.sweep("open", trials=30, set={"timeout": 1}, db=tmp_path / "a.db", progress=True)
    assert [path.name for path in tmp_path.iterdir()] == ["a.db"]


# Progress


def test_a_bar_follows_the_growing_file(bars, monkeypatch):
    monkeypatch.setattr(_program, "_WATCH_S", 0.02)
    touchdown.sweep("straight_turn", trials=6, set={"timeout": 6})
    (bar,) = bars
    assert (bar.total, bar.unit, bar.n, bar.closed) == (6, "trial", 6, True)
    assert bar.shown == sorted(bar.shown) and len(set(bar.shown)) > 2  # it was looked at on the way
    assert bar.text == "0 succeeded"


def test_a_bar_is_full_after_a_sweep_that_was_faster_than_a_look(bars, monkeypatch):
    monkeypatch.setattr(_program, "_WATCH_S", 100.0)
    touchdown.sweep("open", trials=2, set={"timeout": 1})
    assert (bars[0].total, bars[0].shown, bars[0].closed) == (2, [2], True)


def test_no_bar_is_shown_where_none_is_wanted_or_possible(bars, monkeypatch, capfd):
    touchdown.sweep("open", trials=1, set={"timeout": 1}, progress=False)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    touchdown.sweep("open", trials=1, set={"timeout": 1})
    assert bars == [] and capfd.readouterr() == ("", "")


# Parts of Python's


@pytest.fixture
def in_process(monkeypatch, program):
    """Stands for the module: notes what it was given, and has the program fly it."""
    calls = []

    def fly(scenario, overrides, variations, trials, seed, db, registries, progress):
        calls.append((scenario, overrides, variations, trials, seed, db, registries))
        words = [word for text in overrides for word in ("--set", text)]
        words += [word for text in variations for word in ("--vary", text)]
        words = ["sweep", scenario, *words, "--trials", str(trials), "--seed", str(seed), "--db", db]
        for flown in range(trials + 1):
            progress(trials, flown, 0)
        subprocess.run([program, *words], check=True, capture_output=True)

    monkeypatch.setattr(touchdown._touchdown, "_sweep", fly, raising=False)
    return calls


def test_parts_of_python_fly_in_this_process(in_process, bars, flown, tmp_path):
    path, parts = tmp_path / "a.db", object()
    done = touchdown.sweep(
        "straight_turn", trials=5, seed=3, set=SET, vary=VARY, planner="landing", registries=parts, db=path
    )
    overrides = ["timeout=1.5", "start.position_spread=[1, 1, 0]", "planner=landing"]
    variations = ["controller=geometric,paper", "gps.sigma=0.1..0.5"]
    assert in_process == [("straight_turn", overrides, variations, 5, 3, str(path), parts)]
    figures = flown.trials.drop(columns=["command", *rows(path, "SELECT * FROM timing")[0]])
    assert done.trials[figures.columns].equals(figures)
    assert done.command is None and done.db == path
    assert bars[0].shown == [0, 1, 2, 3, 4, 5]


def test_parts_of_python_fly_one_by_one(in_process):
    with pytest.warns(UserWarning, match="jobs is 2: parts written in Python fly in this process") as told:
        done = touchdown.sweep({"timeout": 1}, trials=1, jobs=2, registries=object(), progress=False)
    assert told[0].filename == __file__
    assert len(done.trials) == 1 and Path(in_process[0][0]).name == "scenario.yaml"
    assert not Path(in_process[0][5]).exists()


@pytest.mark.parametrize("registries", [None, touchdown.Registries()])
@pytest.mark.parametrize(
    "wrong, why",
    [
        ({"trials": 0}, r"--trials: 0 is no whole number in \[1, 1000000\]"),
        ({"trials": 1.5}, "--trials: 1.5 is no whole number"),
        ({"trials": True}, "--trials: True is no whole number"),
        ({"trials": 10**12}, "--trials: 1000000000000 is no whole number"),
        ({"seed": -1}, r"--seed: -1 is no whole number in \[0, 9007199254740992\]"),
        ({"jobs": 0}, "--jobs: 0 is no whole number"),
        ({"db": "no_such/a.db"}, "--db no_such/a.db: there is no directory no_such"),
        ({"db": "."}, "--db .: a file must be named, and this is a directory"),
    ],
)
def test_both_ways_refuse_the_same(wrong, why, registries, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(touchdown.BadInput, match=why):
        touchdown.sweep("open", set={"timeout": 1}, registries=registries, progress=False, **wrong)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "command, options",
    [
        (["sweep", "open"], ["trials", "seed", "jobs", "trial_limit"]),
        (["compare"], ["problems", "every", "starts", "repeats", "seed", "gap", "deadline_ms", "backend_seconds", "pin"]),
    ],
)
def test_ranges_are_the_programs(run, command, options):
    for option in options:
        lo, hi = _campaigns._RANGES[option]
        done = run(*command, f"--{option.replace('_', '-')}=-1")
        assert f"-1 is not in [{lo:.16g}, {hi:.16g}]" in done.stderr


@pytest.mark.parametrize(
    "more", [{"html": "a.html"}, {"picture": "a.png"}, {"trial_limit": 3.0}, {"retry": True, "db": "a.db"}]
)
def test_what_does_not_go_with_parts_of_python_is_refused(in_process, more):
    with pytest.raises(ValueError, match="cannot be used with registries"):
        touchdown.sweep("open", registries=object(), **more)
    assert in_process == []
