# SPDX-License-Identifier: BSD-3-Clause
"""Comparisons, studies and result files in frames."""
import json
import shutil
import sqlite3
import subprocess
from contextlib import closing
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from the_package import assert_equal, rows, touchdown
from touchdown import _results

COMPARE = {"problems": 3, "backends": ["banded", "ipopt"], "repeats": 1, "seed": 5}


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    return touchdown.compare(**COMPARE, db=tmp_path_factory.mktemp("compare") / "a.db", progress=False)


@pytest.fixture(scope="module")
def own_comparison(run, tmp_path_factory):
    path = tmp_path_factory.mktemp("own") / "own.db"
    done = run(*"compare --problems 3 --backends banded,ipopt --repeats 1 --seed 5 --db".split(), str(path))
    assert done.returncode == 0, done.stderr
    return path


def test_a_comparison_is_its_file(compared):
    for frame, table in (("summary", "summary"), ("solves", "solve"), ("problems", "problem")):
        assert_equal(getattr(compared, frame), *rows(compared.db, f"SELECT * FROM {table} ORDER BY rowid"))
    assert compared.manifest["format"] == "touchdown comparison"
    assert compared.refusals.empty and list(compared.refusals.columns) == ["backend", "reason"]


def test_a_comparison_is_the_programs_to_the_last_bit(compared, own_comparison):
    assert_equal(compared.problems, *rows(own_comparison, "SELECT * FROM problem ORDER BY problem"))
    counted = "problem, backend, phase, repeat, status, reached, iterations, evaluations, cost, gap, max_violation"
    order = "ORDER BY problem, backend, phase, repeat"
    frame = compared.solves.sort_values(["problem", "backend", "phase", "repeat"])
    assert_equal(frame, *rows(own_comparison, f"SELECT {counted} FROM solve {order}"))
    judged = "backend, problems, solved, ran_all, solved_lo, solved_hi, agreeing, tight_gap_p95, max_violation"
    assert_equal(compared.summary, *rows(own_comparison, f"SELECT {judged} FROM summary ORDER BY rowid"))


def test_what_was_compared_is_told(compared):
    assert compared.command == (
        "touchdown compare --problem-set landing --problems 3 --backends banded,ipopt --seed 5 --repeats 1 "
        f"--db {compared.db}"
    )
    with pytest.raises(touchdown.BadInput, match="the file exists"):
        touchdown.compare(**COMPARE, db=compared.db)


@pytest.mark.parametrize("registries", [None, touchdown.Registries()])
@pytest.mark.parametrize(
    "wrong, why",
    [
        ({"gap": float("nan")}, r"--gap: nan is no number in \[1e-09, 1\]"),
        ({"repeats": 0}, r"--repeats: 0 is no whole number in \[1, 1000\]"),
        ({"problems": 2.5}, "--problems: 2.5 is no whole number"),
        ({"deadline_ms": -1}, r"--deadline-ms: -1 is no number in \[0.001, 100000\]"),
        ({"backends": []}, "--backends: none is named"),
        ({"backends": "banded,no_such"}, "--backends:? no_such"),
        ({"db": "no_such/a.db"}, "--db no_such/a.db: there is no directory no_such"),
    ],
)
def test_both_ways_refuse_the_same(wrong, why, registries, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(touchdown.BadInput, match=why):
        touchdown.compare(**{**COMPARE, **wrong}, registries=registries, progress=False)
    assert not list(tmp_path.iterdir())


def test_a_file_that_is_there_is_kept(tmp_path):
    kept = tmp_path / "notes.txt"
    kept.write_text("mine")
    for registries in (None, touchdown.Registries()):
        with pytest.raises(touchdown.BadInput, match="the file exists"):
            touchdown.compare(**COMPARE, db=kept, registries=registries, progress=False)
    assert kept.read_text() == "mine"


def test_the_problems_of_a_file_are_compared(record_path):
    done = touchdown.compare(
        source=record_path, problems=2, every=20, backends=["banded"], repeats=1, progress=False
    )
    assert json.loads(done.manifest["from"]) == record_path and len(done.problems) == 2 and done.db is None
    assert done.manifest["every"] == "20"


def test_a_set_of_known_problems_has_a_row_for_each_problem_and_backend():
    done = touchdown.compare(problem_set="mgh", starts=1, backends=["banded", "lbfgs"], progress=False)
    assert len(done.summary) == 30 == len(done.solves) and set(done.summary["right"]) <= {0, 1}
    right = done.solves["verdict"].eq("right").groupby([done.solves["problem"], done.solves["backend"]]).sum()
    assert right.sum() == done.summary["right"].sum() > 20
    with pytest.raises(touchdown.BadInput, match="--gap cannot be used with --problem-set mgh"):
        touchdown.compare(problem_set="mgh", gap=0.1)


def test_a_bar_follows_the_lines_of_a_comparison(bars, monkeypatch, tmp_path):
    """A stand-in for the program, which says how far it is at the pace of a log."""
    fake = tmp_path / "fake"
    fake.write_text(
        "#!/bin/sh\necho 'touchdown: 1 of 4 problems, 9 s left' >&2; sleep 0.6; "
        "echo 'touchdown: 4 of 4 problems, 0 s left' >&2; echo 'touchdown: the disk is full.' >&2; exit 1\n"
    )
    fake.chmod(0o755)
    monkeypatch.setenv("TOUCHDOWN_PROGRAM", str(fake))
    with pytest.raises(touchdown.ProgramFailed, match="the disk is full"):
        touchdown.compare()
    (bar,) = bars
    assert (bar.total, bar.shown, bar.unit, bar.closed) == (4, [1], "problem", True)


# Studies

STUDY = """
title: s
report: plain
seed: 1
reference: a
set: {timeout: 1.5}
cells: [{name: c, title: C, scenario: open, labels: {speed_mps: 0.5}}]
methods: [{name: a, title: A, trials: 3}, {name: b, title: B, set: {controller: paper}, trials: 3}]
"""


@pytest.fixture(scope="module")
def study_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("study") / "s.yaml"
    path.write_text(STUDY, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def studied(study_file):
    pytest.importorskip("statsmodels")
    return touchdown.study(study_file, out=study_file.parent / "out", jobs=2, progress=False)


def test_a_study_is_its_folder(studied):
    db = studied.folder / "study.db"
    assert_equal(studied.trials, *rows(db, "SELECT * FROM trial ORDER BY trial"))
    assert_equal(studied.replans, *rows(db, "SELECT * FROM replan_time ORDER BY trial, replan"))
    assert sorted(studied.trials["method"]) == ["a", "a", "a", "b", "b", "b"]
    assert studied.plan["study"] == "s" and studied.report == studied.folder / "report.html"
    assert studied.report.is_file()


def test_a_study_has_the_programs_rows_and_rates(studied, study_file, run, tmp_path):
    own = run("study", "run", str(study_file), "--out", str(tmp_path / "own"), "--json")
    assert own.returncode == 0, own.stderr
    assert studied.rates.to_dict("records") == json.loads(own.stdout)["parts"]
    assert_equal(studied.trials, *rows(tmp_path / "own" / "study.db", "SELECT * FROM trial ORDER BY trial"))
    assert studied.command == f"touchdown study run {study_file} --out {studied.folder} --jobs 2"


def test_a_part_of_a_study(study_file, tmp_path, bars):
    part = touchdown.study(study_file, out=tmp_path / "part", methods=["b"], trials=1, seed=4)
    assert list(part.trials["method"]) == ["b"] and list(part.rates["method"]) == ["b"]
    assert bars[0].total == bars[0].n == 1
    with pytest.raises(touchdown.BadInput, match="no_such"):
        touchdown.study("no_such", out=tmp_path / "none")


# Result files


def test_every_table_of_a_record_is_a_frame(record_path):
    frames = touchdown.read(record_path)
    names = [name for (name,) in rows(record_path, "SELECT name FROM sqlite_master WHERE type = 'table'")[1]]
    assert sorted(frames) == sorted(names) and {"vehicle", "plan", "control_point", "obstacle"} <= set(frames)
    for name in ("vehicle", "plan", "replanner_state"):
        assert_equal(frames[name], *rows(record_path, f"SELECT * FROM {name} ORDER BY rowid"))
    assert dict(frames["meta"].to_numpy())["format"] == "touchdown record"
    assert frames["vehicle"]["px"].dtype == float


def test_columns_without_a_number_are_numbers(tmp_path):
    path = tmp_path / "a.db"
    with sqlite3.connect(path) as db:
        db.execute("CREATE TABLE manifest(key TEXT, value TEXT)")
        db.execute("INSERT INTO manifest VALUES('format', 'touchdown trials')")
        db.execute("CREATE TABLE part(a REAL, b INTEGER, c TEXT, d BLOB)")
        db.execute("INSERT INTO part VALUES(NULL, NULL, NULL, x'0102')")
    part = touchdown.read(path)["part"]
    assert [part[name].dtype for name in "abc"] == [float, float, object]
    assert part["d"][0] == b"\x01\x02"


def test_what_a_killed_writer_left_is_taken_in(tmp_path):
    path, left = tmp_path / "a.db", tmp_path / "left"
    left.mkdir()
    with closing(sqlite3.connect(path)) as db:
        db.execute("PRAGMA journal_mode=WAL")
        db.execute("CREATE TABLE manifest(key TEXT, value TEXT)")
        db.execute("INSERT INTO manifest VALUES('format', 'touchdown trials')")
        db.commit()
        for file in (path, tmp_path / "a.db-wal"):
            shutil.copy(file, left)
    assert list(touchdown.read(left / "a.db")["manifest"]["value"]) == ["touchdown trials"]
    assert [file.name for file in left.iterdir()] == ["a.db"]


def test_a_file_that_grows_can_be_read(program, tmp_path):
    path = tmp_path / "a b?.db"
    sweep = [program, *"sweep open --set timeout=2 --trials 500 --jobs 1 --db".split(), str(path)]
    with subprocess.Popen(sweep, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        try:
            seen = 0
            while seen < 3:
                assert process.poll() is None
                frames = touchdown.read(path) if path.exists() else {"trial": ()}
                seen = len(frames["trial"])
            assert len(frames["planned"]) == 500 and len(frames["timing"]) == seen
        finally:
            process.terminate()


def test_what_is_no_result_file_is_told(tmp_path):
    with pytest.raises(FileNotFoundError, match="a.db: there is no such file"):
        touchdown.read(tmp_path / "a.db")
    (tmp_path / "text.db").write_text("no database, but longer than a header of one hundred bytes" * 3)
    other = tmp_path / "other.db"
    with sqlite3.connect(other) as db:
        db.execute("CREATE TABLE manifest(key TEXT, value TEXT)")
    for path in (tmp_path / "text.db", other):
        with pytest.raises(touchdown.BadInput, match="it is no result file of touchdown"):
            touchdown.read(path)


@pytest.mark.parametrize(
    "texts, kind",
    [(["1", "0.5"], float), (["1", "2"], np.int64), (["true", "false"], bool), (["1", "measured"], object),
     (["[1, 2]", "3"], object), ([], object)],
)  # fmt: skip
def test_values_of_keys_have_the_type_that_all_of_them_have(texts, kind):
    typed = _results.typed(pd.Series(texts, dtype=object))
    assert typed.dtype == kind
    assert [str(value).lower() for value in typed] == [str(float(t)) if kind is float else t for t in texts]


TYPED = ("program", "scenarios", "results", "progress", "ranges", "tunable", "campaigns")


@pytest.mark.skipif(shutil.which("mypy") is None, reason="there is no mypy")
def test_the_package_is_typed():
    """What is written by hand here, by mypy."""
    package = Path(_results.__file__).parent
    files = [str(package / f"_{name}.py") for name in TYPED]
    options = ["--strict", "--allow-untyped-calls", "--ignore-missing-imports", "--follow-imports=silent"]
    options += ["--cache-dir=/dev/null"]
    done = subprocess.run(
        ["mypy", *options, *files], capture_output=True, text=True, check=False, cwd=package.parent
    )
    assert done.returncode == 0, done.stdout
