# SPDX-License-Identifier: BSD-3-Clause
import sqlite3

import numpy as np
import pytest

from touchdown_report import bspline, landing, plan, prior
from touchdown_report.record import Record, RecordError


def test_a_straight_spline_is_sampled_exactly():
    q = np.stack([np.arange(7.0), 2.0 * np.arange(7.0), np.zeros(7)], axis=1)
    points = bspline.sample(q, per_segment=4)
    assert points.shape == (4 * 4 + 1, 3)
    assert np.allclose(points[0], q[1]) and np.allclose(points[-1], q[-2])
    assert np.allclose(points[:, 1], 2.0 * points[:, 0])


def test_the_curve_is_continuous_over_the_knots():
    q = np.random.default_rng(1).normal(size=(9, 3))
    steps = np.linalg.norm(np.diff(bspline.sample(q, per_segment=200), axis=0), axis=1)
    assert steps.max() < 3.0 * np.median(steps) + 0.05


def test_too_few_points_are_refused():
    with pytest.raises(ValueError):
        bspline.sample(np.zeros((3, 3)))


def test_a_record_is_read(record_path):
    record = Record(record_path)
    assert record.result["scenario"] == "straight_turn"
    assert len(record.vehicle) == len(record.modes) == len(record.pad)
    assert record.plans and all(len(q) >= 4 for q in record.plans.values())
    assert len(record.obstacles) == 7
    assert float(record.scenario_value("pad", "deck_size")) == 1.5
    assert record.scenario_value("pad", "no_such_key") == ""


def test_the_recorded_plans_start_where_the_table_says(record_path):
    with sqlite3.connect(record_path) as db:
        rows = db.execute("SELECT passed, endpoint_position_residual FROM plan WHERE status='planned'")
        for passed, residual in rows:
            assert passed == 1 and residual <= 1e-9


def test_the_picture_is_drawn(record_path, tmp_path):
    out = tmp_path / "landing.png"
    assert landing.main([record_path, str(out)]) == 0
    assert out.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def test_columns_of_cubes_and_the_line_around_them():
    cubes = np.array([[0, 0, 0, 2], [2, 0, 5, 1], [2, 0, 7, 1], [90, 0, 0, 4]])
    low = np.array([-1, -1])
    filled = prior.columns(cubes, 1, low, np.array([4, 4]))
    assert np.argwhere(filled).tolist() == [[1, 1], [1, 2], [2, 1], [2, 2], [3, 1]]
    boxes = [shape.get_bbox().bounds for shape in prior.rectangles(filled, low, 0.5)]
    assert boxes == [(0.0, 0.0, 1.5, 0.5), (0.0, 0.5, 1.0, 0.5)]
    line = prior.outline(filled, low, 0.5)
    assert line.shape == (10, 2, 2)
    assert line.min() == 0.0 and line[:, :, 0].max() == 1.5 and line[:, :, 1].max() == 1.0


def test_a_prior_is_drawn_without_its_file(record_path, tmp_path):
    path = tmp_path / "prior.db"
    path.write_bytes(open(record_path, "rb").read())
    cubes = {"new": [30, 0, 5, 1], "occupied": [20, 0, 0, 8]}
    with sqlite3.connect(path) as db:
        db.executemany(
            "INSERT INTO prior VALUES(?, ?)",
            [(state, np.array(cube, "<i4").tobytes()) for state, cube in cubes.items()],
        )
    record = Record(str(path))
    assert [entry.get_label() for entry in prior.legend_entries(record)] == [
        "prior: occupied",
        "prior: free, seen occupied",
    ]
    assert landing.main([str(path), str(tmp_path / "prior.png")]) == 0
    assert prior.legend_entries(Record(record_path)) == []


def test_the_headline_says_how_it_ended(record_path):
    headline, figures = landing.title_lines(Record(record_path))
    assert "timeout" in headline and "seed 1" in figures


def test_what_is_no_record_is_refused(tmp_path, capsys):
    text = tmp_path / "text.db"
    text.write_text("not a database, but longer than the header that SQLite looks at. " * 20)
    for path in (tmp_path / "missing.db", text):
        with pytest.raises(RecordError):
            Record(str(path))
        assert landing.main([str(path), str(tmp_path / "x.png")]) == 2
    assert landing.main([]) == 2
    assert "missing.db" in capsys.readouterr().err


def test_attempts_without_the_same_terms_share_one_figure_of_costs():
    """A free arrival has a price; a fixed one, tried after it, has none."""
    free = {
        "cost_by_term": {"smoothness": 1.0, "arrival_time": 5.0, "approach_corridor": 2.0},
        "trace": [{"cost_by_term": [3.0, 6.0, 4.0]}, {"cost_by_term": [1.0, 5.0, 2.0]}],
    }
    fixed = {
        "cost_by_term": {"smoothness": 7.0, "approach_corridor": 8.0},
        "trace": [{"cost_by_term": [7.0, 8.0]}],
    }
    costs, names, starts = plan.costs_by_iteration(
        {"attempts": [{"rounds": [free]}, {"rounds": [fixed]}]}
    )
    assert names == ["smoothness", "arrival_time", "approach_corridor"]
    assert starts == [0, 2]
    assert costs.tolist() == [[3.0, 6.0, 4.0], [1.0, 5.0, 2.0], [7.0, 0.0, 8.0]]
