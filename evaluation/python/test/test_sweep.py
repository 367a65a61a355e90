# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a sweep. Sweeps are flown for two simulated seconds, too short to land. Pictures of landings are
tested with tables that are changed by hand."""
import shutil
import sqlite3

import matplotlib.pyplot as plt
import numpy as np
import pytest

from touchdown_report import sweep
from touchdown_report.sweep import Sweep, SweepError

SHORT = ("sweep", "open", "--set", "timeout=2", "--jobs", "1", "--seed", "3")


def flown(run, folder, *arguments):
    path = folder / "trials.db"
    done = run(*SHORT, *arguments, "--db", str(path))
    assert done.returncode == 0, done.stderr
    return path


@pytest.fixture(scope="module")
def two_lists(run, tmp_path_factory):
    """Seven trials over two times three values; five of them, by hand, landed."""
    lists = ("--vary", "gps.sigma=0.01,0.5", "--vary", "pad.speed=0.2,0.4,0.6")
    path = flown(run, tmp_path_factory.mktemp("sweep"), "--trials", "7", *lists)
    with sqlite3.connect(path) as db:
        db.execute(
            "UPDATE trial SET outcome = 'landed', landed = 1, time_to_land_s = 5 + trial WHERE trial < 5"
        )
        db.execute("UPDATE cell SET succeeded = 1, time_to_land_median_s = 5 + cell WHERE cell < 5")
    return path


@pytest.fixture
def figure_of():
    figures = []

    def draw(path):
        figures.append(sweep.figure_of(Sweep(str(path))))
        figures[-1].canvas.draw()
        return figures[-1]

    yield draw
    for figure in figures:
        plt.close(figure)


def texts(axes):
    return [text.get_text() for text in axes.texts]


def test_the_cells_of_two_lists_hold_the_counts(two_lists, figure_of):
    rate, time = figure_of(two_lists).axes
    # From the lowest row on; the trial after the sixth is the first combination again.
    counts = [text.splitlines()[0] for text in texts(rate)]
    assert counts == ["1/2", "1/1", "1/1", "1/1", "1/1", "0/1"]
    assert texts(rate)[-1] == "0/1\n[0, 98] %"
    assert np.asarray(rate.images[0].get_array()).tolist() == [[0.5, 1.0], [1.0, 1.0], [1.0, 0.0]]
    assert [label.get_text() for label in rate.get_xticklabels()] == ["0.01", "0.5"]
    assert [label.get_text() for label in rate.get_yticklabels()] == ["0.2", "0.4", "0.6"]
    assert rate.get_xlabel() == "gps.sigma [m]" and rate.get_ylabel() == "pad.speed [m/s]"
    assert texts(time) == ["5.00 s", "6.00 s", "7.00 s", "8.00 s", "9.00 s", "none landed"]


def test_a_combination_that_was_not_flown_stays_empty(run, tmp_path, figure_of):
    lists = ("--vary", "gps.sigma=0.01,0.5", "--vary", "controller=geometric,paper")
    rate, time = figure_of(flown(run, tmp_path, "--trials", "3", *lists)).axes
    assert len(texts(rate)) == 3 and texts(time) == ["none landed"] * 3
    assert np.ma.getmaskarray(np.ma.masked_invalid(rate.images[0].get_array())).sum() == 1


def test_one_list_has_rates_with_intervals_and_a_range_a_cloud(run, tmp_path, figure_of):
    path = flown(
        *(run, tmp_path, "--trials", "4"),
        *("--vary", "controller=geometric,paper", "--vary", "pad.speed=0.2..0.6"),
    )
    with sqlite3.connect(path) as db:
        db.execute("UPDATE trial SET outcome = 'landed', landed = 1, time_to_land_s = 6 WHERE trial = 2")
        drawn = db.execute("SELECT value FROM variation WHERE key = 'pad.speed' ORDER BY trial")
        speeds = [float(value) for value, in drawn]
        db.execute("UPDATE cell SET succeeded = 1, time_to_land_median_s = 6 WHERE cell = 0")
    rate, time, cloud, empty = figure_of(path).axes
    assert [text.splitlines()[0] for text in texts(rate)] == ["1/2", "0/2"]
    assert len(rate.containers) == 2 and rate.get_xlabel() == "controller"
    assert texts(time) == ["6.00 s"]
    landed, failed = cloud.get_lines()
    assert landed.get_xydata().tolist() == [[speeds[2], 6.0]]
    assert failed.get_xdata().tolist() == [speeds[i] for i in (0, 1, 3)]
    assert cloud.get_xlabel() == "pad.speed [m/s]" and not empty.axison


def test_the_program_draws_without_keeping_a_table(run, tmp_path):
    done = run(*SHORT, "--trials", "2", "--vary", "pad.speed=0.2..0.6", "--picture", "out.png", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["out.png"]
    assert (tmp_path / "out.png").read_bytes()[:4] == b"\x89PNG"


def test_what_cannot_be_drawn_is_refused_in_a_sentence(run, two_lists, record_path, tmp_path, capsys):
    with pytest.raises(SweepError, match="not a sweep"):
        Sweep(record_path)
    with pytest.raises(SweepError, match="varied key"):
        Sweep(str(flown(run, tmp_path, "--trials", "1")))
    other = tmp_path / "other.db"
    shutil.copy(two_lists, other)
    with sqlite3.connect(other) as db:
        db.execute("UPDATE manifest SET value = 'touchdown cheese' WHERE key = 'format'")
    assert sweep.main([str(other), str(tmp_path / "out.png")]) == 2
    assert "not a sweep" in capsys.readouterr().err
    assert not (tmp_path / "out.png").exists()
