# SPDX-License-Identifier: BSD-3-Clause
import json
import sqlite3

import numpy as np
import pytest

from touchdown_report import problem_set
from touchdown_report.problem_set import ProblemSet, ProblemSetError

INF = float("inf")


@pytest.fixture(scope="module")
def made(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("problem_set")
    done = run(
        *("compare", "--problem-set", "hs", "--starts", "2", "--backends", "banded,nlopt-slsqp,lbfgs"),
        *("--allow-debug", "--json", "--db", "set.db", "--picture", "set.png"),
        cwd=folder,
    )
    assert done.returncode == 0, done.stderr
    return folder, json.loads(done.stdout)


def test_the_table_holds_every_solve_and_refusal(made):
    folder, told = made
    with sqlite3.connect(folder / "set.db") as db:
        problems = db.execute("SELECT COUNT(*) FROM problem").fetchone()[0]
        for name in ("banded", "nlopt-slsqp", "lbfgs"):
            solves = db.execute("SELECT COUNT(*) FROM solve WHERE backend = ?", (name,))
            refusals = db.execute("SELECT COUNT(*) FROM refusal WHERE backend = ?", (name,))
            assert solves.fetchone()[0] + 2 * refusals.fetchone()[0] == 2 * problems
        for cell in told["cells"]:
            right = db.execute(
                "SELECT COUNT(*) FROM solve WHERE problem = ? AND backend = ? AND verdict = 'right'",
                (cell["problem"], cell["backend"]),
            )
            assert right.fetchone()[0] == cell["right"]
        # A right solve was feasible, at the optimum's cost or another known one, and confirmed.
        steps = db.execute("SELECT MAX(max_violation) FROM solve WHERE verdict = 'right'")
        assert steps.fetchone()[0] < 1e-5


def test_times_are_those_of_the_solves_that_were_right(made):
    known = ProblemSet(str(made[0] / "set.db"))
    assert known.backends[0] == "banded" and set(known.backends) == {"banded", "nlopt-slsqp", "lbfgs"}
    assert known.count == 2 * 68
    assert len(known.times["banded"]) == known.count
    assert len(known.times["lbfgs"]) < known.count  # it takes neither rows nor bounds
    right = [ms for ms in known.times["banded"].values() if ms < INF]
    assert len(right) > 0.9 * known.count and np.min(right) > 0.0


def test_the_picture_is_drawn(made, tmp_path):
    folder, _ = made
    assert (folder / "set.png").stat().st_size > 10000
    path = tmp_path / "set.svg"
    assert problem_set.main([str(folder / "set.db"), str(path)]) == 0
    assert path.stat().st_size > 10000


def test_other_files_are_refused_in_a_sentence(tmp_path):
    with pytest.raises(ProblemSetError, match="no such file"):
        ProblemSet(str(tmp_path / "missing.db"))
    text = tmp_path / "text.db"
    text.write_text("hello")
    with pytest.raises(ProblemSetError, match="not a problem set"):
        ProblemSet(str(text))
