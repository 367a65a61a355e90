# SPDX-License-Identifier: BSD-3-Clause
"""The program as a user meets it: exit statuses, stdout, stderr, files."""
import json
import sqlite3

import pytest

SHORT = ("--set", "timeout=2")


def one_sentence(text):
    lines = text.strip().splitlines()
    return len(lines) == 1 and lines[0].startswith("touchdown: ")


def test_help_lists_what_is_built(run):
    done = run("--help")
    assert done.returncode == 0
    for command in ("land", "sweep", "list"):
        assert command in done.stdout
    assert "compare" not in done.stdout
    for command in ("land", "sweep", "list"):
        assert run(command, "--help").returncode == 0


@pytest.mark.parametrize(
    "arguments, parts",
    [
        ((), ["subcommand"]),
        (("fly",), ["fly", "land", "sweep", "list"]),
        (("land", "--no-such-option"), ["--no-such-option"]),
        (("land", "no_such_scenario"), ["no_such_scenario", "straight_turn"]),
        (("land", "no/such/file.yaml"), ["no/such/file.yaml"]),
        (("land", "--set", "pad.sped=1"), ["pad.sped", "pad.speed"]),
        (("land", "--set", "pad.speed=fast"), ["pad.speed", "[0, 3] m/s", "fast"]),
        (("land", "--set", "pad.speed=99"), ["pad.speed", "[0, 3] m/s", "99"]),
        (("land", "--set", "pad.speed"), ["KEY=VALUE"]),
        (("land", "--seed", "one"), ["seed", "whole number"]),
        (("land", "--backend", "newton"), ["solver.backend", "ceres"]),
        (("land", "--planner", "rrt"), ["planner", "landing"]),
        (("sweep",), ["SCENARIO"]),
        (("sweep", "open", "--trials", "0"), ["--trials"]),
        (("sweep", "open", "--vary", "pad.sped=1..2"), ["pad.sped"]),
        (("sweep", "open", "--jobs", "2", "--set", "planning.latency=measured"), ["--jobs"]),
        (("list", "bananas"), ["bananas"]),
    ],
)
def test_bad_usage_is_status_2_with_one_sentence(run, tmp_path, arguments, parts):
    extra = ()
    if arguments[:1] == ("land",):
        extra = ("--record", "out.db", "--plot", "out.png")
    if arguments[:1] == ("sweep",):
        extra = ("--db", "out.db")
    done = run(*arguments, *extra, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert one_sentence(done.stderr), done.stderr
    for part in parts:
        assert part in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_an_obstacle_on_the_start_names_file_and_line(run, tmp_path):
    path = tmp_path / "bad.yaml"
    path.write_text("obstacles:\n  boxes:\n    - {centre: [0, 0], size: [1, 1, 4]}\n")
    done = run("land", str(path))
    assert done.returncode == 2
    assert f"{path}:3" in done.stderr and "start" in done.stderr


def test_land_json_is_one_document_with_every_field(run):
    done = run("land", "open", "--json", "--seed", "5", *SHORT)
    assert done.returncode == 1
    document = json.loads(done.stdout)
    assert document["landed"] is False and document["outcome"] == "timeout"
    assert document["time_to_land_s"] is None and document["t_star_s"] is None
    assert document["touchdown"]["error_m"] is None
    assert document["scenario"] == "open" and document["seed"] == 5
    assert document["planner"] == "landing" and document["backend"] == "ceres"
    for key in ("time_ratio", "mean_abs_error_last_5s_m", "min_clearance_m", "replans"):
        assert key in document
    for key in ("replan_latency_ms", "deadline_misses", "realtime_factor"):
        assert key in document["wall_clock"]


def test_the_same_seed_twice_is_the_same_document(run):
    documents = []
    for _ in range(2):
        document = json.loads(run("land", "open", "--json", *SHORT).stdout)
        document.pop("wall_clock")
        documents.append(json.dumps(document))
    assert documents[0] == documents[1]


def test_a_landing_is_status_0_and_drawn(run, tmp_path):
    done = run("land", "open", "--plot", "out/landing.png", cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "landed on open" in done.stdout
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["landing.png"]


def test_a_sweep_writes_its_table_once(run, tmp_path):
    arguments = ("sweep", "open", "--trials", "3", "--db", "t.db", "--vary", "pad.speed=0.2,0.4")
    done = run(*arguments, *SHORT, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "0 of 3 landed" in done.stdout and "Clopper-Pearson" in done.stdout
    with sqlite3.connect(tmp_path / "t.db") as db:
        trials = db.execute("SELECT trial, outcome FROM trial ORDER BY rowid").fetchall()
        assert trials == [(0, "timeout"), (1, "timeout"), (2, "timeout")]
        assert db.execute("SELECT count(*) FROM timing").fetchone() == (3,)
        assert db.execute("SELECT count(*) FROM variation").fetchone() == (3,)
        manifest = dict(db.execute("SELECT key, value FROM manifest"))
        assert {"scenario_yaml", "sweep_seed", "compiler", "cpu"} <= set(manifest)
    again = run(*arguments, *SHORT, cwd=tmp_path)
    assert again.returncode == 2 and "never overwritten" in again.stderr


@pytest.mark.parametrize(
    "what, name",
    [("backends", "ceres"), ("planners", "landing"), ("terms", ""), ("scenarios", "straight_turn")],
)
def test_list(run, what, name):
    entries = json.loads(run("list", what, "--json").stdout)
    names = [entry["name"] for entry in entries]
    assert names and (not name or name in names)
    text = run("list", what).stdout
    assert all(n in text for n in names)
