# SPDX-License-Identifier: BSD-3-Clause
import sqlite3

import numpy as np
import pytest

from touchdown_report import compare
from touchdown_report.compare import CompareError, Comparison

INF = float("inf")


def test_a_profile_by_hand():
    times = {
        "a": {0: 1.0, 1: 4.0, 2: INF},
        "b": {0: 2.0, 1: 2.0, 2: INF},
        "c": {0: 8.0},  # not run on the others
    }
    curves = compare.profile(times, 3)
    assert curves["a"][0].tolist() == [1.0, 2.0]
    assert np.allclose(curves["a"][1], [1 / 3, 2 / 3])  # one problem without a solution
    assert curves["b"][0].tolist() == [1.0, 2.0]
    assert curves["c"][0].tolist() == [8.0] and np.allclose(curves["c"][1], [1 / 3])
    assert compare.label_of("c", 1, 1, 3) == "c (1 of 3; 1 of 3 run)"
    assert compare.label_of("a", 2, 3, 3) == "a (2 of 3)"


def test_failures_keep_a_distribution_below_one():
    milliseconds, fractions = compare.ecdf({"a": {0: 3.0, 1: INF, 2: 1.0, 3: INF}}, 4)["a"]
    assert milliseconds.tolist() == [1.0, 3.0]
    assert fractions.tolist() == [0.25, 0.5]


def test_the_median_of_repeats_with_failures():
    assert compare.middle([1.0, INF, 3.0]) == 3.0
    assert compare.middle([1.0, INF]) == INF
    assert compare.middle([INF, INF, 2.0]) == INF
    assert compare.middle([1.0, 3.0]) == 2.0


@pytest.fixture(scope="module")
def table_path(run, tmp_path_factory):
    path = tmp_path_factory.mktemp("compare") / "compare.db"
    done = run(
        *("compare", "--problems", "3", "--every", "9", "--repeats", "2", "--allow-debug"),
        *("--backends", "banded,ceres,nlopt-lbfgs", "--db", str(path)),
    )
    assert done.returncode == 0, done.stderr
    return str(path)


def test_a_table_is_read_and_tells_what_it_was_made_with(table_path):
    comparison = Comparison(table_path)
    assert comparison.backends[0] == "banded" and "ceres" in comparison.backends
    for key in ("cpu", "build_type", "revision", "load_before", "pinned_cpu", "ceres", "seed"):
        assert key in comparison.manifest
    assert comparison.problems == 3 and comparison.flights == 1 and comparison.timed >= 1
    times = comparison.times()
    assert all(len(times[backend]) == comparison.timed for backend in times)
    assert all(ms > 0 for ms in times["banded"].values())
    with sqlite3.connect(table_path) as db:
        (command,) = db.execute("SELECT command FROM flight").fetchone()
        assert command.startswith("touchdown land forest --seed ")
        assert db.execute("SELECT solve FROM problem ORDER BY problem").fetchall() == [(0,), (9,), (18,)]
        solves = "SELECT COUNT(*) FROM solve WHERE backend = 'banded' AND phase = "
        assert db.execute(solves + "'tight'").fetchone() == (3,)
        assert db.execute(solves + "'gap'").fetchone() == (2 * comparison.timed,)
        assert db.execute(solves + "'shares'").fetchone() == (comparison.timed,)


@pytest.mark.parametrize("kind", ["png", "svg"])
def test_the_picture_is_drawn(table_path, tmp_path, kind):
    path = tmp_path / f"compare.{kind}"
    assert compare.main([table_path, str(path)]) == 0
    assert path.stat().st_size > 10000


def test_the_program_draws_without_keeping_a_table(run, tmp_path):
    done = run(
        *("compare", "--problems", "1", "--repeats", "1", "--allow-debug"),
        *("--backends", "banded", "--picture", "out.png"),
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["out.png"]


@pytest.mark.parametrize(
    "option, value",
    [
        *((name, "nan") for name in ("--gap", "--deadline-ms")),
        ("--every", "0"),
        ("--backend-seconds", "nan"),
        ("--backends", "banded,banded"),
        ("--backends", "banded,,ceres"),
    ],
)
def test_what_makes_no_sense_is_refused_by_name(run, option, value):
    done = run("compare", "--problems", "1", "--allow-debug", option, value)
    assert done.returncode == 2
    assert option in done.stderr and done.stdout == ""


def test_table_and_picture_need_two_files(run, tmp_path):
    one = str(tmp_path / "one.png")
    done = run("compare", "--problems", "1", "--allow-debug", "--db", one, "--picture", one)
    assert done.returncode == 2
    assert "same file" in done.stderr and not (tmp_path / "one.png").exists()


def test_other_files_are_refused_in_a_sentence(tmp_path, capsys):
    with pytest.raises(CompareError, match="no such file"):
        Comparison(str(tmp_path / "missing.db"))
    text = tmp_path / "text.db"
    text.write_text("hello")
    with pytest.raises(CompareError, match="not a comparison"):
        Comparison(str(text))
    assert compare.main([str(text), str(tmp_path / "out.png")]) == 2
    assert "not a comparison" in capsys.readouterr().err
    assert compare.main([]) == 2
