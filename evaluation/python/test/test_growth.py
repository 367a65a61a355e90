# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

from touchdown_report import growth
from touchdown_report.growth import Growth, GrowthError


def test_classes_of_pairs():
    rows = np.array([[0, 1.0], [1, 2.0], [4, 4.0], [5, 8.0], [9, 16.0]])
    classes = growth.by_pairs(rows)
    assert list(classes) == [(0, 0), (1, 4), (5, 8), (9, 16)]
    assert classes[(1, 4)].ravel().tolist() == [2.0, 4.0]


@pytest.fixture(scope="module")
def study(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("growth")
    done = run(
        *("study", "replan", "--parts", "growth", "--scenes", "3", "--repeats", "1"),
        *("--allow-debug", "--db", str(folder / "s.db"), "--picture", str(folder / "s.png")),
    )
    assert done.returncode == 0, done.stderr
    return folder, done.stdout


def test_a_study_of_growth_is_written_and_drawn(study):
    folder, text = study
    for axis in ("horizon_m", "density_per_m2", "resolution_m", "pairs"):
        assert axis in text
    assert "  none " in text and "0 to 0" not in text  # steps with nothing in the way
    read = Growth(str(folder / "s.db"))
    assert list(read.times["resolution_m"]) == [0.05, 0.1, 0.2]
    assert all(len(times) == 3 for times in read.times["horizon_m"].values())
    steps = np.vstack(list(read.times["horizon_m"].values()))
    assert (steps >= 0).all() and (steps[:, -1] >= 0.99 * steps[:, :-1].sum(axis=1)).all()
    assert (folder / "s.png").read_bytes()[:4] == b"\x89PNG"


def test_a_study_without_growth_is_refused(run, tmp_path):
    path = str(tmp_path / "safety.db")
    arguments = ("study", "replan", "--kinds", "B", "--scenes", "2", "--allow-debug", "--db", path)
    assert run(*arguments).returncode == 0
    with pytest.raises(GrowthError, match="no part growth"):
        Growth(path)
    done = run(*arguments[:-2], "--picture", str(tmp_path / "p.png"))
    assert done.returncode == 2 and "growth" in done.stderr
