# SPDX-License-Identifier: BSD-3-Clause
"""Sweeps that are interrupted, killed, split and spread over ranks: the same tables in the end."""
import contextlib
import json
import os
import random
import shlex
import shutil
import signal
import sqlite3
import subprocess

import pytest

SWEEP = ("sweep", "straight_turn", "--seed", "3", "--set", "start.position_spread=[1, 1, 0]")
SHORT = ("--set", "timeout=1.5", "--vary", "controller=geometric,paper", "--vary", "gps.sigma=0.1..0.5")
TABLES = ("planned", "variation", "varied_key", "trial", "cell", "cell_value")


def reading(path):
    """Opens for writing, too, because what a killed writer left must be recovered."""
    return contextlib.closing(sqlite3.connect(f"file:{path}?mode=rw", uri=True))


def tables(path):
    """Everything that does not depend on the clock, in the order in which it is stored."""
    with reading(path) as db:
        assert db.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        return {name: db.execute(f"SELECT * FROM {name} ORDER BY rowid").fetchall() for name in TABLES}


def flown(path):
    """How many trials a reader finds; None before there is a file."""
    if not path.exists():
        return None
    with reading(path) as db:
        db.execute("BEGIN")  # what follows is of one moment
        trials = db.execute("SELECT count(*) FROM trial").fetchone()[0]
        assert db.execute("SELECT count(*) FROM timing").fetchone() == (trials,)
        assert db.execute("SELECT sum(trials) FROM cell").fetchone() == (trials,)
        assert db.execute("SELECT sum(replans) FROM trial").fetchone()[0] == (
            db.execute("SELECT count(*) FROM replan_time").fetchone()[0] if trials else None
        )
        return trials


def begun(program, folder, *arguments):
    return subprocess.Popen(
        [program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=folder
    )


def sweep(trials, db, *more):
    return (*SWEEP, *SHORT, "--trials", str(trials), "--db", db, *more)


def killed_until_it_is_done(program, folder, name, moment):
    """Runs a sweep again and again, killed at random moments; returns how often, and the last run's stdout."""
    kills = seen = 0
    while True:
        process = begun(program, folder, *sweep(12, name, "--jobs", "2"))
        try:
            # Ever later, so that it ends on a slow machine too.
            out, err = process.communicate(timeout=moment.uniform(0.0, 0.4 + 0.1 * kills))
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            kills += 1
            now = flown(folder / name) or 0
            assert now >= seen
            seen = now
            continue
        assert process.returncode == 0, err
        return kills, out


def test_a_sweep_that_is_killed_goes_on_where_it_was(program, run, tmp_path):
    whole = run(*sweep(12, "whole.db", "--jobs", "2"), cwd=tmp_path)
    assert whole.returncode == 0, whole.stderr
    moment = random.Random(7)
    kills = files = 0
    while kills < 20:
        files += 1
        more, out = killed_until_it_is_done(program, tmp_path, f"{files}.db", moment)
        kills += more
        assert out == whole.stdout
        assert tables(tmp_path / f"{files}.db") == tables(tmp_path / "whole.db")
        assert not list(tmp_path.glob(f"{files}.db-*"))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_sweep_says_how_to_go_on(program, run, tmp_path, number):
    path = tmp_path / "a.db"
    process = begun(program, tmp_path, *sweep(100, "a.db", "--jobs", "2"))
    while not flown(path):  # and is read while it grows
        assert process.poll() is None
    process.send_signal(number)
    out, err = process.communicate()
    assert process.returncode == 128 + number and out == ""
    assert "of 100 trials: they are in a.db, and the same command goes on" in err.splitlines()[-1]
    assert [p.name for p in tmp_path.iterdir()] == ["a.db"]
    assert 0 < flown(path) < 100


def test_what_is_resumed_is_told(run, tmp_path):
    done = run(*sweep(3, "a.db", "--shard", "1/2"), cwd=tmp_path)
    assert done.returncode == 0 and "2 of 2 trials, 0 succeeded and 2 failed" in done.stderr
    again = run(*sweep(3, "a.db", "--shard", "1/2"), cwd=tmp_path)
    assert again.returncode == 0 and again.stdout == done.stdout
    assert again.stderr == "touchdown: all 2 trials were flown before\n"
    assert run("merge", "out.db", "a.db", "--partial", cwd=tmp_path).stdout == (
        "out.db: 2 of 3 trials, from 1 files\n"
    )
    rest = run(*sweep(3, "out.db"), cwd=tmp_path)
    assert "2 of 3 trials were flown before" in rest.stderr and rest.returncode == 0
    other = run(*sweep(4, "out.db"), cwd=tmp_path)
    assert other.returncode == 2 and other.stdout == ""
    assert "out.db" in other.stderr and "its trials is 3, not 4" in other.stderr


def test_the_command_beside_a_trial_flies_it_again_bit_for_bit(run, tmp_path):
    done = run(*sweep(2, "a.db", "--json"), cwd=tmp_path)
    results = json.loads(done.stdout)["results"]
    assert len(results) == 2
    for result in results:
        program, *arguments = shlex.split(result.pop("replay"))
        assert program == "touchdown"
        alone = json.loads(run(*arguments, "--json").stdout)
        for of_sweep in ("trial", "varied"):
            result.pop(of_sweep)
        alone.pop("wall_clock")
        assert alone == result


@pytest.mark.skipif(shutil.which("mpirun") is None, reason="there is no mpirun")
def test_two_ranks_give_the_same_tables(program, run, tmp_path):
    assert run(*sweep(5, "one.db", "--jobs", "1"), cwd=tmp_path).returncode == 0
    ranks = in_two_ranks(program, tmp_path, *sweep(5, "two.db"))
    assert ranks.returncode == 0, ranks.stderr
    assert ranks.stdout.count("of 5 landed") == 1
    assert tables(tmp_path / "two.db") == tables(tmp_path / "one.db")


@pytest.mark.skipif(shutil.which("mpirun") is None, reason="there is no mpirun")
def test_what_flies_alone_is_flown_with_two_ranks_too(program, tmp_path):
    latency = ("--vary", "planning.latency=20,measured")
    ranks = in_two_ranks(program, tmp_path, *SWEEP, "--set", "timeout=1.5", *latency, "--trials", "6", "--db", "a.db")
    assert ranks.returncode == 0, ranks.stderr
    with reading(tmp_path / "a.db") as db:
        rows = "SELECT value, count(*) FROM trial JOIN variation USING(trial) GROUP BY value ORDER BY value"
        assert db.execute(rows).fetchall() == [("20", 3), ("measured", 3)]


@pytest.mark.skipif(shutil.which("mpirun") is None, reason="there is no mpirun")
def test_a_study_in_two_ranks_has_its_report(program, tmp_path):
    pytest.importorskip("statsmodels")
    (tmp_path / "s.yaml").write_text(
        "title: s\nreport: plain\nseed: 1\nreference: a\nset: {timeout: 1.5}\n"
        "cells: [{name: c, scenario: open}]\nmethods: [{name: a, trials: 3}]\n"
    )
    ranks = in_two_ranks(program, tmp_path, "study", "run", "s.yaml", "--out", "out")
    assert ranks.returncode == 0, ranks.stderr
    assert ranks.stdout.count("succeeded 0 of 3") == 1
    assert (tmp_path / "out" / "report.html").exists() and "Report: out/report.html" in ranks.stdout


def in_two_ranks(program, folder, *arguments):
    ranks = subprocess.run(
        ["mpirun", "--oversubscribe", "-n", "2", program, *arguments],
        capture_output=True,
        text=True,
        cwd=folder,
        check=False,
        env={**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"},
    )
    if "built without MPI" in ranks.stderr:
        pytest.skip("the program is built without MPI")
    return ranks


# What a stranger, or a broken disk, may have changed in a file of trials.
TAMPERED = {
    "a text for a number": "UPDATE trial SET min_clearance_m = 'x'",
    "counts that are no JSON": "UPDATE trial SET replans_by_status = '{'",
    "counts that are a list": "UPDATE trial SET replans_by_reason = '[1]'",
    "counts that are texts": "UPDATE trial SET replans_by_reason = '{\"a\": \"b\"}'",
    "an outcome that there is not": "UPDATE trial SET outcome = 'x'",
    "no timing": "DELETE FROM timing",
    "a trial that was not planned": "UPDATE trial SET trial = 99; UPDATE timing SET trial = 99; DELETE FROM replan_time",
    "trials beyond all numbers": ";".join(
        f"UPDATE {table} SET trial = trial + 4294967296" for table in ("planned", "trial", "timing", "replan_time")),
    "a cell that there is not": "UPDATE planned SET cell = 99",
    "no cells": "DELETE FROM cell",
    "no shard": "DELETE FROM manifest WHERE key = 'shard'",
    "an index that computes": "CREATE INDEX sqliteX ON trial(hex(zeroblob(100)))",
    "times of no trial": "UPDATE replan_time SET trial = 99",
    "no table": "DROP TABLE cell_value",
    "another column": "ALTER TABLE trial RENAME COLUMN seed TO x",
    "a trigger": "CREATE TRIGGER trap BEFORE INSERT ON cell BEGIN SELECT RAISE(FAIL, 'trap'); END",
    "rows without end": "DROP TABLE cell_value; CREATE VIEW cell_value(cell, key, value) AS "
    "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i, i, i FROM n",
}


@pytest.fixture(scope="module")
def sound_file(program, tmp_path_factory):
    folder = tmp_path_factory.mktemp("tampered")
    subprocess.run([program, *sweep(1, "sound.db")], cwd=folder, check=True, capture_output=True)
    return folder / "sound.db"


@pytest.mark.parametrize("change", TAMPERED.values(), ids=TAMPERED)
def test_a_file_that_was_tampered_with_is_refused_by_name(run, sound_file, tmp_path, change):
    shutil.copy(sound_file, tmp_path / "a.db")
    with contextlib.closing(sqlite3.connect(tmp_path / "a.db")) as db:
        db.executescript(change)
    for command in (sweep(1, "a.db"), ("merge", "b.db", "a.db")):
        done = run(*command, cwd=tmp_path)
        assert done.returncode == 2, done.stderr
        assert done.stderr.startswith("touchdown: a.db: ") and done.stderr.count("\n") == 1, done.stderr
        assert not (tmp_path / "b.db").exists()
