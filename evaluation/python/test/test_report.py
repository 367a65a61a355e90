# SPDX-License-Identifier: BSD-3-Clause
import shutil
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


def test_a_mode_that_is_not_known_is_drawn_too(record_path, tmp_path):
    path = tmp_path / "other.db"
    shutil.copy(record_path, path)
    with sqlite3.connect(path) as db:
        assert db.execute("UPDATE mode SET mode = 'gliding' WHERE mode = 'tracking'").rowcount > 0
    assert landing.main([str(path), str(tmp_path / "other.png")]) == 0
    assert landing.look_of("gliding") not in landing.MODE_LOOKS.values()


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
    assert [entry.get_label() for entry in prior.legend_entries(record.prior)] == [
        "prior: occupied",
        "prior: free, seen occupied",
    ]
    assert landing.main([str(path), str(tmp_path / "prior.png")]) == 0
    assert prior.legend_entries(Record(record_path).prior) == []


def test_stretches_of_a_mode_meet():
    assert landing.runs_of(["hold"]) == [("hold", 0, 0)]
    modes = ["hovering", "tracking", "tracking", "hold", "tracking"]
    assert landing.runs_of(modes) == [
        ("hovering", 0, 0),
        ("tracking", 1, 2),
        ("hold", 3, 3),
        ("tracking", 4, 4),
    ]
    figure, axes = landing.plt.subplots()
    landing.mode_path(axes, np.arange(5.0), np.zeros(5), modes)
    assert [list(line.get_xdata()) for line in axes.lines] == [[0, 1], [1, 2, 3], [3, 4], [4]]
    landing.plt.close(figure)


def test_no_two_modes_look_alike_without_their_colours():
    dashes = [str(dashes) for _, dashes in landing.MODE_LOOKS.values()]
    assert len(set(dashes)) == len(dashes)
    hatches = [look[2] for look in prior.LOOKS.values()]
    assert len(set(hatches)) == len(hatches) and None not in hatches
    assert len(plan.MARKERS) == len(set(plan.MARKERS)) == len(plan.TERMS)
    assert plan.SAME_WAY["ls"] != plan.OTHER_WAY["ls"]


def test_an_arrowhead_points_the_way_of_the_flight():
    figure, axes = landing.plt.subplots()
    landing.arrowhead(axes, np.linspace(4.0, 0.0, 41), np.zeros(41), "k")
    (arrow,) = axes.texts
    assert arrow.xy[0] < arrow.xyann[0] and 1.8 < arrow.xy[0] < 2.2
    landing.arrowhead(axes, np.linspace(0.0, 0.1, 41), np.zeros(41), "k")  # it only hovered
    assert len(axes.texts) == 1
    landing.plt.close(figure)


def with_air(record_path, path, *velocity):
    path.write_bytes(open(record_path, "rb").read())
    with sqlite3.connect(path) as db:
        db.execute("UPDATE air SET vx = ?, vy = ?, vz = ?", velocity)
    return Record(str(path))


def test_the_mean_wind_is_an_arrow_with_its_speed(record_path, tmp_path):
    windy = with_air(record_path, tmp_path / "windy.db", -3.0, 4.0, 0.5)
    assert windy.mean_wind().tolist() == [-3.0, 4.0]
    figure, axes = landing.plt.subplots()
    axes.set_xlim(-10.0, 30.0)
    axes.set_ylim(-10.0, 30.0)
    landing.draw_wind(axes, windy)
    arrow, words = axes.texts
    (dx, dy) = axes.transAxes.transform(arrow.xy) - axes.transAxes.transform(arrow.xyann)
    assert np.isclose(dx / dy, -0.75) and dx < 0.0
    assert words.get_text() == "flight's mean wind 5.0 m/s"
    landing.draw_wind(axes, Record(record_path))
    assert len(axes.texts) == 2  # still air: nothing is drawn
    landing.plt.close(figure)


def test_rounds_that_gave_no_plan_are_told_apart():
    def solve(guide, pairs, *first):
        curve = {"control_points": [list(first) or [0.0, 0.0, 0.0]] * 4}
        return {"guide": guide, "pairs": pairs, "curve": curve}

    first, second, third = solve(0, []), solve(1, ["pair"]), solve(0, ["pair"])
    broken = solve(0, ["pair"], None, None, None)
    attempts = [
        {"best": None, "rounds": [first, broken]},
        {"best": 1, "rounds": [third, second]},
    ]
    document = {"attempts": attempts, "result": {"status": "planned"}}
    assert plan.lost_rounds(document) == [(first, False), (third, True)]
    attempts[1]["best"] = 0
    lost = plan.lost_rounds(document)
    assert [other for _, other in lost] == [False, True] and lost[1][0] is second
    document["result"]["status"] = "kept"  # nothing won
    assert len(plan.lost_rounds(document)) == 3
    assert plan.lost_rounds({"attempts": [], "result": {"status": "braking"}}) == []


@pytest.mark.parametrize(
    "outcome, marker", [("landed", "*"), ("followed", "*"), ("arrived", "*"), ("timeout", "X")]
)
def test_both_views_of_the_end_say_whether_it_was_done(record_path, outcome, marker):
    record = Record(record_path)
    record.result["outcome"] = outcome
    figure, (world, close) = landing.plt.subplots(1, 2)
    contact = record.contact_index()
    landing.draw_world(world, record, contact, 0.75, side=False)
    landing.draw_pad_frame(close, record, contact, 0.75)
    for axes in (world, close):
        assert [m for m in (line.get_marker() for line in axes.lines) if m in ("*", "X")] == [marker]
    landing.plt.close(figure)


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
