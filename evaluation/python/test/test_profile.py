# SPDX-License-Identifier: BSD-3-Clause
"""`touchdown profile` and `touchdown plan` as a user meets them."""
import json
import re
import sqlite3

import numpy as np
import pytest

from touchdown_report import bspline, plan
from touchdown_report.plan import PlanError

STAGES = ["look", "predict", "search", "pairs", "solve", "check", "certificate", "other"]
FIGURES = ("median_ms", "p95_ms", "p99_ms", "max_ms")
SHORT = ("--set", "timeout=4")


def one_sentence(text):
    lines = text.strip().splitlines()
    return len(lines) == 1 and lines[0].startswith("touchdown: ")


def events_of(path):
    """Complete events of a trace, and the names of its tracks."""
    trace = json.loads(path.read_text())
    names = {
        event["tid"]: event["args"]["name"]
        for event in trace["traceEvents"]
        if event["ph"] == "M" and event["name"] == "thread_name"
    }
    return [event for event in trace["traceEvents"] if event["ph"] == "X"], names


def assert_nested(events):
    """On each track, spans lie inside each other or apart."""
    for track in {event["tid"] for event in events}:
        open_until = []
        for event in sorted(
            (e for e in events if e["tid"] == track), key=lambda e: (e["ts"], -e["dur"])
        ):
            end = event["ts"] + event["dur"]
            while open_until and open_until[-1] <= event["ts"]:
                open_until.pop()
            assert not open_until or end <= open_until[-1] + 1e-3
            open_until.append(end)


def test_a_flight_is_profiled(run, tmp_path):
    arguments = ("--trace", "trace.json", "--db", "p.db", "--trials", "2", "--json", *SHORT)
    done = run("profile", "straight_turn", "--allow-debug", *arguments, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert list(document["stages"]) == ["sense", "map", *STAGES]
    for stage in (*document["stages"].values(), document["total"]):
        assert all(stage[key] >= 0.0 and stage["wall"][key] >= 0.0 for key in FIGURES)
        assert stage["median_ms"] <= stage["p95_ms"] <= stage["p99_ms"] <= stage["max_ms"]
    assert document["total"]["median_ms"] > 0.0 and document["stages"]["solve"]["median_ms"] > 0.0
    assert document["deadline_ms"] == 20.0 and document["deadline_misses"] >= 0
    assert document["seeds"] == [1, 2] and document["replans"] > 20
    slowest = [step["cpu_ms"] for step in document["slowest"]]
    assert len(slowest) == 3 and slowest[0] == document["total"]["max_ms"]
    assert slowest == sorted(slowest, reverse=True)
    allocations = document["allocations_per_replan"]
    assert allocations is None or allocations <= document["allocations_per_replan_max"]
    assert document["build"]["cpu"] and "load_before" in document["machine"]

    events, names = events_of(tmp_path / "trace.json")
    assert sorted(names.values()) == ["perception", "planning"]
    assert all(event["ts"] >= 0.0 and event["dur"] >= 0.0 for event in events)
    assert_nested(events)
    steps = [event for event in events if event["name"].startswith("replan ")]
    assert len(steps) == document["replans"]
    assert {event["args"]["run"] for event in steps} == {0, 1}
    assert {"sense", "map", "predict", "solve", "check", "certificate"} <= {
        event["name"] for event in events
    }

    with sqlite3.connect(tmp_path / "p.db") as db:
        manifest = dict(db.execute("SELECT key, value FROM manifest"))
        assert {"build_hash", "cpu", "load_before", "scenario_yaml", "deadline_ms"} <= set(manifest)
        assert db.execute("SELECT count(*) FROM replan").fetchone() == (document["replans"],)
        totals = [ms for ms, in db.execute("SELECT cpu_ms FROM stage WHERE stage = 'total'")]
        assert np.isclose(np.median(totals), document["total"]["median_ms"])
        assert np.isclose(np.quantile(totals, 0.95), document["total"]["p95_ms"])
        frames = db.execute("SELECT count(*) FROM frame WHERE stage = 'map'").fetchone()[0]
        assert frames == document["stages"]["map"]["samples"]
    again = run("profile", "open", "--allow-debug", "--db", "p.db", cwd=tmp_path)
    assert again.returncode == 2 and "never overwritten" in again.stderr


def test_a_record_is_replayed_bit_for_bit(run, record_path, tmp_path):
    arguments = ("profile", "--from", record_path, "--repeats", "2", "--allow-debug")
    document = json.loads(run(*arguments, "--json", "--trace", str(tmp_path / "t.json")).stdout)
    with sqlite3.connect(record_path) as db:
        steps = db.execute("SELECT count(*) FROM plan").fetchone()[0]
    assert document["same_as_record"] == {"same": steps, "compared": steps}
    assert document["replans"] == 2 * steps
    assert list(document["stages"]) == STAGES
    assert_nested(events_of(tmp_path / "t.json")[0])
    table = run(*arguments, "--deadline-ms", "0.001").stdout
    assert f"{steps} of {steps} answers are the recorded ones bit for bit" in table
    assert f"{2 * steps} of {2 * steps} replanning steps took longer than 0.001 ms" in table
    slowest = re.search(r"slowest steps: (\d+) \(", table)[1]
    assert f"touchdown plan --from {record_path}:{slowest}" in table
    for word in (*STAGES, "total", "median", "p99", "allocations"):
        assert word in table
    assert "  used in: steps, or images for sense and map" in table


def test_another_backend_plans_on_the_same_inputs(run, record_path):
    done = run(
        *("profile", "--from", record_path, "--repeats", "1", "--allow-debug"),
        *("--backend", "nlopt-lbfgs", "--json"),
    )
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert document["backend"] == "nlopt-lbfgs"
    assert document["same_as_record"]["same"] < document["same_as_record"]["compared"]


def test_a_step_that_flies_a_stop_tells_where_it_ends(run, record_path, tmp_path):
    with sqlite3.connect(record_path) as db:
        (step,) = db.execute("SELECT id FROM plan WHERE earlier ORDER BY id LIMIT 1").fetchone()
    done = run("plan", "--from", f"{record_path}:{step}", "--picture", "p.png", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "then its stored stop until t = " in done.stdout and "committed before: proven then" in done.stdout
    assert "flown from" not in done.stdout and (tmp_path / "p.png").exists()
    document = json.loads(run("plan", "--from", f"{record_path}:{step}", "--json").stdout)
    assert document["result"]["certificate"]["speed_bound_mps"] is None
    before, stop = plan.flown(document)
    assert before[0][-1] <= document["result"]["stop"]["t_stop"] <= stop[0][-1]
    assert stop[2][-1] == pytest.approx(0.0, abs=1e-6), "it ends at rest"


def test_a_recorded_step_is_explained(run, record_path, tmp_path):
    with sqlite3.connect(record_path) as db:
        step, pairs = db.execute(
            "SELECT id, pairs FROM plan WHERE status = 'planned' ORDER BY pairs DESC, id"
        ).fetchone()
    done = run("plan", "--from", f"{record_path}:{step}", "--picture", "p.png", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    for words in ("attempt 1", "round 2", "cost by term", "certificate passed", "bounds: speed", "body rate"):
        assert words in done.stdout
    assert "the recorded answer, bit for bit" in done.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["p.png"]

    document = json.loads(run("plan", "--from", f"{record_path}:{step}", "--json").stdout)
    assert document["same_as_record"] is True and document["result"]["pairs"] == pairs
    attempt = document["attempts"][-1]
    best = attempt["rounds"][attempt["best"]]
    assert len(best["pairs"]) == pairs and best["blocked"] == []
    assert best["curve"] == document["result"]["curve"] and document["result"]["stop"] is None
    assert best["trace"][-1]["cost"] == pytest.approx(best["cost"])
    assert list(best["cost_by_term"]) == document["terms"]
    assert document["wall_clock"]["stages"]["total"]["cpu_ms"] > 0.0
    other = run("plan", "--from", f"{record_path}:{step}", "--backend", "nlopt-lbfgs")
    assert other.returncode == 0 and "not the recorded answer" in other.stdout


def test_a_first_plan_needs_no_record(run, tmp_path):
    done = run("plan", "straight_turn", "--json")
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert document["result"]["status"] == "planned" and document["same_as_record"] is None
    assert document["input"]["prediction"] == "oracle"
    text = run("plan", "open", "--picture", "p.svg", cwd=tmp_path)
    assert text.returncode == 0 and "obstacles and pad known" in text.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["p.svg"]


@pytest.mark.parametrize("command, suffix", [("profile", ""), ("plan", ":0")])
def test_what_is_no_record_is_refused(run, record_path, tmp_path, command, suffix):
    text = tmp_path / "text.db"
    text.write_text("not a database, but longer than the header that SQLite looks at. " * 20)
    old = tmp_path / "old.db"
    with sqlite3.connect(record_path) as db, sqlite3.connect(old) as copy:
        db.backup(copy)
        copy.execute("UPDATE meta SET value = '1' WHERE key = 'version'")
    trials = tmp_path / "trials.db"
    with sqlite3.connect(trials) as db:
        db.execute("CREATE TABLE manifest(key, value)")
        db.execute("INSERT INTO manifest VALUES('format', 'touchdown trials')")
    table = tmp_path / "table.db"
    with sqlite3.connect(table) as db:
        db.execute("CREATE TABLE t(a)")
    for path, words in (
        (tmp_path / "missing.db", "no such record"),
        (text, "not a record"),
        (old, "version 1"),
        (table, "not a record"),
        (trials, "its format is 'touchdown trials'"),
    ):
        done = run(command, "--from", f"{path}{suffix}", *(("--allow-debug",) * (not suffix)))
        assert done.returncode == 2 and done.stdout == ""
        assert one_sentence(done.stderr), done.stderr
        assert str(path) in done.stderr and words in done.stderr


@pytest.mark.parametrize(
    "arguments, words",
    [
        (("plan", "--from", "RECORD:99999"), "0 to "),
        (("plan", "--from", "RECORD:-1"), "RECORD:N"),
        (("plan", "--from", "RECORD"), "RECORD:N"),
        (("plan", "--from", "RECORD:two"), "RECORD:N"),
        (("plan", "--from", "RECORD:0", "--set", "pad.speed=1"), "pad.speed=1"),
        (("plan", "--from", "RECORD:0", "--seed", "2"), "--seed"),
        (("plan", "--from", "RECORD:0", "--backend", "newton"), "solver.backend"),
        (("plan", "--from", "RECORD:0", "--picture", "p.gif"), "p.gif"),
        (("profile", "--from", "RECORD", "--trials", "2"), "--trials"),
        (("profile", "--from", "RECORD", "--set", "pad.speed=1"), "pad.speed=1"),
        (("profile", "--trace", "no/such/t.json"), "no/such"),
        (("profile", "--db", "no/such/t.db"), "no/such"),
        (("profile", "--trace", "x", "--db", "x"), "the same file"),
        (("profile", "--deadline-ms", "nan"), "--deadline-ms"),
        (("profile", "--repeats", "3"), "--from"),
        (("profile", "--trials", "0"), "--trials"),
        (("profile", "no_such_scenario"), "no_such_scenario"),
    ],
)
def test_what_makes_no_sense_is_refused_by_name(run, record_path, tmp_path, arguments, words):
    named = [part.replace("RECORD", record_path) for part in arguments]
    if arguments[0] == "profile":
        named.append("--allow-debug")
    done = run(*named, cwd=tmp_path, timeout=20)
    assert done.returncode == 2 and done.stdout == ""
    assert one_sentence(done.stderr), done.stderr
    assert words in done.stderr, done.stderr
    assert list(tmp_path.iterdir()) == []


def test_the_profile_of_a_curve_by_hand():
    # x = t^2 / 2 on a knot interval of 0.5: unit acceleration, speed t.
    h, k = 0.5, np.arange(-1.0, 8.0)
    q = np.stack([(h * k) ** 2 / 2 - h**2 / 6, np.zeros(9), np.zeros(9)], axis=1)
    t, speed, acceleration = bspline.derivative_norms(q, h)
    assert t[-1] == pytest.approx(6 * h)
    assert np.allclose(speed, t) and np.allclose(acceleration, 1.0)


def test_the_picture_refuses_other_documents(tmp_path, capsys):
    text = tmp_path / "text.json"
    text.write_text("hello")
    empty = tmp_path / "empty.json"
    empty.write_text("{}")
    for path in (text, empty, tmp_path / "missing.json"):
        with pytest.raises(PlanError):
            plan.load(str(path))
        assert plan.main([str(path), str(tmp_path / "x.png")]) == 2
    assert "missing.json" in capsys.readouterr().err
