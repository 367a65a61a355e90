# SPDX-License-Identifier: BSD-3-Clause
"""The program as a user meets it: exit statuses, stdout, stderr, files."""
import json
import pathlib
import re
import sqlite3

import pytest

SHORT = ("--set", "timeout=2")


def one_sentence(text):
    lines = text.strip().splitlines()
    return len(lines) == 1 and lines[0].startswith("touchdown: ")


def test_help_lists_what_is_built(run):
    done = run("--help")
    assert done.returncode == 0
    for command in ("land", "plan", "profile", "compare", "sweep", "merge", "list"):
        assert command in done.stdout
    for command in ("land", "plan", "profile", "compare", "sweep", "merge", "list"):
        assert run(command, "--help").returncode == 0


def commands_in(text):
    """The names in the list of commands that ends a help."""
    rows = re.findall(r"^  ([a-z-]+) {2,}", text.partition("Subcommands:")[2], re.M)
    return [(row,) for row in rows]


def test_every_help_ends_with_a_page_that_is_there(run):
    docs = pathlib.Path(__file__).parents[3] / "docs"
    top = run("--help").stdout
    commands = [(), *commands_in(top)]
    commands += [("study", *name) for name in commands_in(run("study", "--help").stdout)]
    assert len(commands) > 15
    for command in commands:
        help_text = run(*command, "--help").stdout
        page = re.fullmatch(r"To read: docs/(\w+\.md)", help_text.strip().splitlines()[-1])
        assert page and (docs / page[1]).is_file(), (command, help_text)


@pytest.mark.parametrize(
    "arguments, parts",
    [
        ((), ["subcommand"]),
        (("flutter",), ["flutter", "fly", "land", "sweep", "list"]),
        (("land", "--no-such-option"), ["--no-such-option"]),
        (("land", "no_such_scenario"), ["no_such_scenario", "straight_turn"]),
        (("land", "no/such/file.yaml"), ["no/such/file.yaml"]),
        (("land", "/"), ["/", "directory"]),
        (("land", "--set", "planning.latency=101"), ["planning.latency", "[0, 100] ms", "101"]),
        (("land", "--set", "planning.clearance=0.05"), ["planning.clearance", "[0.1, 1] m"]),
        (("land", "--set", "planning.ceiling=1"), ["planning.ceiling", "1000] m"]),
        (("land", "--set", "start.position=[7, 6.5, 0.6]"), ["start.position", "1.36 m"]),
        (("land", "--set", "pad.sped=1"), ["pad.sped", "pad.speed"]),
        (("land", "--set", "pad.speed=fast"), ["pad.speed", "[0.01, 10] m/s", "fast"]),
        (("land", "--set", "pad.speed=99"), ["pad.speed", "[0.01, 10] m/s", "99"]),
        (("land", "--set", "pad.speed"), ["KEY=VALUE"]),
        (("land", "--seed", "one"), ["seed", "whole number"]),
        (("land", "--backend", "newton"), ["solver.backend", "ceres"]),
        (("land", "--planner", "rrt"), ["planner", "landing"]),
        (("sweep",), ["SCENARIO"]),
        (("sweep", "open", "--trials", "0"), ["--trials"]),
        (("sweep", "open", "--shard", "3/2"), ["--shard 3/2"]),
        (("sweep", "open", "--trials", "2", "--shard", "3/3"), ["--shard 3/3", "no trials"]),
        (("sweep", "open", "--trial-limit", "0"), ["--trial-limit"]),
        (("merge", "out.db"), ["SHARD"]),
        (("merge", "out.db", "none.db"), ["none.db"]),
        (("sweep", "open", "--seed", "-4"), ["--seed", "9007199254740992"]),
        (("sweep", "open", "--vary", "pad.sped=1..2"), ["pad.sped"]),
        (("sweep", "open", "--vary", "gps.sigma=1..6"), ["--vary gps.sigma=1..6", "[0, 5] m"]),
        (("sweep", "open", "--jobs", "two"), ["--jobs"]),
        (("sweep", "open", "--vary", "gps.sigma=1,1"), ["--vary gps.sigma=1,1", "twice"]),
        (
            ("sweep", "open", "--vary", "gps.sigma=1,2", "--vary", "gps.sigma=0..1"),
            ["--vary gps.sigma=0..1", "twice"],
        ),
        (
            ("sweep", "open", "--vary", "gps.sigma=1,2", "--set", "gps.sigma=3"),
            ["--set gps.sigma=3", "no effect"],
        ),
        (
            ("sweep", "open", "--vary", "solver.backend=banded,lbfgs", "--backend", "banded"),
            ["solver.backend", "no effect"],
        ),
        (("sweep", "open", "--picture", "out.png"), ["out.png", "--vary"]),
        (("sweep", "open", "--vary", "gps.sigma=0,1", "--picture", "out.gif"), ["out.gif", ".png"]),
        (
            ("sweep", "open", "--picture", "out.png", "--vary", "gps.sigma=0,1")
            + ("--vary", "pad.speed=0.2,0.4", "--vary", "controller=geometric,paper"),
            ["out.png", "--vary", "two", "3"],
        ),
        (("list", "bananas"), ["bananas"]),
        (("compare", "--backends", "banded,,lbfgs"), ["--backends", "banded,,lbfgs", "empty"]),
        (("compare", "--from", "none.db"), ["none.db"]),
        (("compare", "--from", "none.db", "--seed", "3"), ["--seed", "--from"]),
        (("profile", "--backends", "all"), ["--backends", "--from"]),
        (("profile", "--from", "none.db", "--gap", "0.01"), ["--gap", "--backends"]),
        (("profile", "--from", "x.db", "--backends", "all", "--db", "y.db"), ["--db", "--backends"]),
        (("study", "pad", "--sigmas", "0.5,0.50"), ["--sigmas", "0.50", "twice"]),
        (("study", "pad", "--scenarios", "open,open"), ["--scenarios", "open", "twice"]),
        (("study", "tags", "--fov", "90,90"), ["--fov", "90", "twice"]),
        (("study", "tags", "--noise", "5,5"), ["--noise", "5", "twice"]),
        (("study", "tags", "--exposure", "8"), ["--exposure", "--speed"]),
        (("study", "tags", "--speed", "2"), ["--speed", "--exposure"]),
        (("study", "tags", "--frames", "/dev/null/frames"), ["--frames", "/dev/null/frames"]),
        (("study", "replan", "--kinds", "A,A"), ["--kinds", "A", "twice"]),
        (("study", "replan", "--parts", "growth,growth"), ["--parts", "growth", "twice"]),
        (
            ("study", "replan", "--parts", "flights", "--planners", "ego", "--guides", "1"),
            ["--guides", "landing"],
        ),
        (
            ("study", "replan", "--parts", "flights", "--planners", "ego", "--backend", "lbfgs"),
            ["--backend", "landing"],
        ),
        (("compare", "--problems", "0"), ["--problems", "0 is not in [1, 100000]"]),
        (("compare", "--problems", "1e3"), ["--problems", "1e3 is no whole number in [1, 100000]"]),
        (("compare", "--gap", "small"), ["--gap", "small is not a number in [1e-09, 1]"]),
        (("compare", "--forest", "B"), ["touchdown compare has no option --forest"]),
        (("study", "replan", "--max-works", "9"), ["touchdown study replan has no option --max-works"]),
        (("list", "terms", "now"), ["touchdown list takes no now"]),
        (("compare", "--set", "terms.speed_limit.weight=heavy"), ["terms.speed_limit.weight", "heavy"]),
        (("compare", "--set", "limits.speed=fast"), ["limits.speed", "fast"]),
        (("compare", "--set", "terms.nothing.weight=3"), ["nothing", "speed_limit"]),
        (("compare", "--set", "terms.speed_limit.colour=3"), ["colour", "weight"]),
        (("compare", "--arrival", "late"), ["--arrival", "fixed"]),
        (("compare", "--backends", "newton"), ["newton", "banded"]),
        (("compare", "--gap", "-1"), ["--gap"]),
        (("compare", "--pin", "1023"), ["--pin 1023"]),
        (("compare", "--picture", "out.gif"), ["out.gif", ".png"]),
    ],
)
def test_bad_usage_is_status_2_with_one_sentence(run, tmp_path, arguments, parts):
    extra = ()
    if arguments[:1] == ("land",):
        extra = ("--record", "out.db", "--plot", "out.png")
    if arguments[:1] in (("sweep",), ("compare",)):
        extra = ("--db", "out.db")
    done = run(*arguments, *extra, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert one_sentence(done.stderr), done.stderr
    for part in parts:
        assert part in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", [("land", "--record"), ("sweep", "--db")])
@pytest.mark.parametrize(
    "text, line, parts",
    [
        ("obstacles:\n  boxes:\n    - {centre: [0, 0], size: [1, 1, 4]}\n", 3, ["the start"]),
        ("seed: 1\npad:\n  sped: 1\n", 3, ["pad.sped", "pad.speed"]),
        ("pad:\n  speed: fast\n", 2, ["pad.speed", "[0.01, 10] m/s", "fast"]),
        ("gps:\n  sigma: -1\n", 2, ["gps.sigma", "[0, 5] m", "-1"]),
        ("planning:\n  rate: 20\n  latency: 60\n", 3, ["planning.latency", "[0, 50] ms", "60"]),
        ("pad: {speed: 0.5\nseed: [\n", 2, []),
        ("", None, ["holds no key"]),
    ],
)
def test_a_bad_file_names_file_line_key_and_range(run, tmp_path, command, text, line, parts):
    (tmp_path / "in").mkdir()
    (tmp_path / "cwd").mkdir()
    path = tmp_path / "in" / "bad.yaml"
    path.write_text(text)
    done = run(command[0], str(path), command[1], "out.db", cwd=tmp_path / "cwd")
    assert done.returncode == 2
    assert done.stdout == "" and one_sentence(done.stderr), done.stderr
    assert (f"{path}:{line}" if line else str(path)) in done.stderr
    assert all(part in done.stderr for part in parts), done.stderr
    assert list((tmp_path / "cwd").iterdir()) == []


@pytest.mark.parametrize(
    "arguments, part",
    [
        (("land", "open", "--record", "no/such/x.db"), "no/such"),
        (("land", "open", "--record", "/proc/x.db"), "cannot be written"),
        (("land", "open", "--record", "."), "directory"),
        (("land", "open", "--record", "/dev/null"), "regular file"),
        (("land", "open", "--record", ""), "--record"),
        (("land", "open", "--plot", "no/such/x.png"), "no/such"),
        (("land", "open", "--plot", "x.bananas"), ".png"),
        (("land", "open", "--record", "x.db", "--plot", "/proc/x.png"), "cannot be written"),
        (("sweep", "open", "--db", "no/such/x.db"), "no/such"),
        (("sweep", "open", "--db", "/proc/x.db"), "cannot be written"),
    ],
)
def test_a_place_that_cannot_be_written_is_refused_before_the_run(run, tmp_path, arguments, part):
    # A run would take far longer than this allows.
    done = run(*arguments, cwd=tmp_path, timeout=5)
    assert done.returncode == 2
    assert done.stdout == "" and one_sentence(done.stderr), done.stderr
    assert part in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_picture_that_fails_leaves_the_result_and_the_record(run, tmp_path):
    # Python looks into the working directory first.
    (tmp_path / "matplotlib.py").write_text("raise ImportError('No module named matplotlib')\n")
    done = run("land", "open", "--json", "--record", "x.db", "--plot", "x.png", cwd=tmp_path)
    assert done.returncode == 1
    assert json.loads(done.stdout)["landed"] is True
    assert one_sentence(done.stderr), done.stderr
    assert "x.png" in done.stderr and "No module named matplotlib" in done.stderr
    assert sorted(p.name for p in tmp_path.iterdir() if p.is_file()) == ["matplotlib.py", "x.db"]


def test_land_json_is_one_document_with_every_field(run):
    done = run("land", "open", "--json", "--seed", "5", *SHORT)
    assert done.returncode == 1
    document = json.loads(done.stdout)
    assert document["landed"] is False and document["outcome"] == "timeout"
    assert document["time_to_land_s"] is None and document["time_ratio"] is None
    assert document["t_star_s"] > 0 and "t_star_upper_s" in document
    assert document["touchdown"]["error_m"] is None
    assert document["scenario"] == "open" and document["seed"] == 5
    assert document["planner"] == "landing" and document["backend"] == "banded"
    for key in ("time_ratio", "mean_abs_error_last_5s_m", "min_clearance_m", "replans"):
        assert key in document
    for key in ("replan_latency_ms", "deadline_misses", "realtime_factor"):
        assert key in document["wall_clock"]


def test_following_is_status_0_and_says_how_well(run):
    follow = ("fly", "open", "--set", "task=follow", "--set", "follow.time=0", "--set", "timeout=25", "--set", "pad.motion=line")
    done = run(*follow, "--json")
    assert done.returncode == 0, done.stdout + done.stderr
    document = json.loads(done.stdout)
    assert document["landed"] is False and document["outcome"] == "followed"
    following = document["following"]
    assert 0.0 < following["mean_error_m"] <= following["max_error_m"] < 0.05
    baseline = json.loads(run(*follow, "--json", "--planner", "ego").stdout)
    assert baseline["following"]["mean_error_m"] > following["mean_error_m"]
    assert "followed the pad of open" in run(*follow).stdout


def test_a_flight_of_the_baseline_cannot_be_asked_again(run, tmp_path):
    run("land", "open", "--planner", "ego", "--record", "x.db", *SHORT, cwd=tmp_path)
    for command in (("plan", "--from", "x.db:0"), ("profile", "--from", "x.db")):
        done = run(*command, cwd=tmp_path)
        assert done.returncode == 2
        assert one_sentence(done.stderr) and "planner ego cannot be asked again" in done.stderr, done.stderr


def test_fidelity_of_the_baseline_is_a_part_of_its_own(run):
    done = run("study", "replan", "--parts", "fidelity", "--kinds", "B", "--scenes", "40", "--json")
    document = json.loads(done.stdout)
    assert done.returncode == (0 if document["met"] else 1)
    assert {row["kind"] for row in document["rows"]} == {"B"}
    for wrong in (("--db", "x.db"), ("--parts", "fidelity,safety")):
        done = run("study", "replan", "--parts", "fidelity", *wrong)
        assert done.returncode == 2 and one_sentence(done.stderr), done.stderr


def test_the_same_seed_twice_is_the_same_document(run):
    documents = []
    for _ in range(2):
        document = json.loads(run("land", "open", "--json", *SHORT).stdout)
        document.pop("wall_clock")
        documents.append(json.dumps(document))
    assert documents[0] == documents[1]


def test_a_landing_is_status_0_and_drawn(run, tmp_path):
    done = run("land", "open", "--plot", "landing.png", cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "landed on open" in done.stdout
    assert [p.name for p in tmp_path.iterdir()] == ["landing.png"]


def test_a_sweep_flies_into_its_file_once(run, tmp_path):
    arguments = ("sweep", "open", "--trials", "3", "--db", "t.db", "--vary", "pad.speed=0.2,0.4")
    done = run(*arguments, *SHORT, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "0 of 3 landed" in done.stdout and "Clopper-Pearson" in done.stdout
    assert done.stdout.endswith(
        "  each command flies that trial alone; with --plot F.png it is drawn, with --record F.db every step is kept\n"
    )
    with sqlite3.connect(tmp_path / "t.db") as db:
        trials = db.execute("SELECT trial, outcome FROM trial ORDER BY rowid").fetchall()
        assert trials == [(0, "timeout"), (1, "timeout"), (2, "timeout")]
        assert db.execute("SELECT count(*) FROM timing").fetchone() == (3,)
        assert db.execute("SELECT count(*) FROM variation").fetchone() == (3,)
        manifest = dict(db.execute("SELECT key, value FROM manifest"))
        assert {"scenario_yaml", "sweep_seed", "compiler", "cpu", "build_hash"} <= set(manifest)
    again = run(*arguments, *SHORT, cwd=tmp_path)
    assert again.returncode == 0 and again.stdout == done.stdout
    assert "all 3 trials were flown before" in again.stderr
    run("land", "open", "--record", "record.db", *SHORT, cwd=tmp_path)
    other = run(*arguments[:-4], "--db", "record.db", *SHORT, cwd=tmp_path)
    assert other.returncode == 2 and "record.db: it is no file of trials" in other.stderr


def rows_of(path):
    """Everything of a study except wall-clock times."""
    with sqlite3.connect(path) as db:
        return {
            table: db.execute(f"SELECT * FROM {table} ORDER BY rowid").fetchall()
            for table in ("manifest", "trial", "variation")
        }


def test_a_sweep_s_page_opens_its_failures(run, tmp_path):
    fly = ("sweep", "open", "--trials", "3", "--jobs", "2", "--vary", "timeout=1,30", "--html", str(tmp_path / "s.html"))
    assert run(*fly).returncode == 0
    page = (tmp_path / "s.html").read_text()
    assert "look at it" not in page and page.count("touchdown land open") >= 3
    assert not (tmp_path / "s_flights").exists()
    assert run(*fly, "--record", "failures").returncode == 0
    page = (tmp_path / "s.html").read_text()
    assert page.count("look at it") == 2
    assert sorted(p.name for p in (tmp_path / "s_flights").iterdir()) == ["0.db", "0.html", "2.db", "2.html"]
    assert "href='s_flights/0.html#t=1.00&amp;view=follow'" in page
    before = (tmp_path / "s_flights" / "0.db").stat().st_mtime_ns
    assert run(*fly, "--record", "all").returncode == 0
    page = (tmp_path / "s.html").read_text()
    assert page.count("look at it") == 3 and "href='s_flights/1.html'" in page
    assert (tmp_path / "s_flights" / "0.db").stat().st_mtime_ns == before
    refused = run("sweep", "open", "--record", "all")
    assert refused.returncode == 2 and "--html" in refused.stderr


def test_replay_refuses_what_is_no_record(run, tmp_path):
    page = tmp_path / "page.html"
    foreign = tmp_path / "foreign.db"
    foreign.write_text("no database")
    record = tmp_path / "flight.db"
    run("land", "open", "--record", str(record), *SHORT)
    for arguments, said in (
        (("land", str(record)), "touchdown replay"),
        (("land", "open", "--record", str(record), "--html", str(record)), "the same file"),
        (("replay", str(record), "--html", str(tmp_path / "." / "flight.db")), "the same file"),
        (("replay", str(foreign), "--html", str(page)), "foreign.db"),
        (("replay", "none.db", "--html", str(page)), "there is no such record"),
        (("replay", str(foreign), "--html", str(tmp_path / "page.pdf")), ".html"),
        (("replay", str(foreign)), "--html"),
        (("replay", str(foreign), "--html", str(tmp_path / "no" / "page.html")), "no directory"),
    ):
        done = run(*arguments)
        assert done.returncode == 2 and one_sentence(done.stderr) and said in done.stderr, done.stderr
        assert not page.exists()


def test_a_sweep_is_repeated_from_its_file(run, tmp_path):
    first = ("sweep", "open", "--trials", "3", "--seed", "9", "--db", "a.db", "--planner", "landing")
    vary = ("--vary", "pad.speed=0.2..0.4", "--vary", "controller=geometric,paper")
    assert run(*first, *vary, *SHORT, "--jobs", "2", cwd=tmp_path).returncode == 0
    rows = rows_of(tmp_path / "a.db")
    manifest = dict(rows["manifest"])
    assert json.loads(manifest["set"]) == ["timeout=2", "planner=landing"]

    (tmp_path / f"{manifest['scenario']}.yaml").write_text(manifest["scenario_yaml"])
    again = ["sweep", "./open.yaml", "--db", "b.db", "--jobs", "1"]
    again += ["--trials", manifest["trials"], "--seed", manifest["sweep_seed"]]
    for variation in json.loads(manifest["vary"]):
        again += ["--vary", variation]
    assert run(*again, cwd=tmp_path).returncode == 0
    repeated = rows_of(tmp_path / "b.db")
    assert dict(repeated.pop("manifest"))["build_hash"] == manifest["build_hash"]
    rows.pop("manifest")
    assert repeated == rows


@pytest.mark.parametrize(
    "what, name",
    [("backends", "ceres"), ("planners", "ego-velocity"), ("terms", ""), ("scenarios", "straight_turn"), ("studies", "paper")],
)
def test_list(run, what, name):
    entries = json.loads(run("list", what, "--json").stdout)
    names = [entry["name"] for entry in entries]
    assert names and (not name or name in names)
    text = run("list", what).stdout
    assert all(n in text for n in names)


@pytest.mark.parametrize(
    "what, word",
    [
        ("backends", "Below each backend: "),
        ("terms", "Each term: "),
        ("planners", "Below each name: "),
        ("motions", "Below each name: "),
        ("controllers", "Below each name: "),
        ("predictors", "Below each name: "),
    ],
)
def test_a_list_ends_with_what_it_shows(run, what, word):
    assert run("list", what).stdout.count("\n" + word) == 1


@pytest.mark.parametrize("what", ["scenarios", "studies"])
def test_files_are_listed_with_their_own_words(run, what):
    *lines, files = run("list", what).stdout.splitlines()
    entries = json.loads(run("list", what, "--json").stdout)
    for line, entry in zip(lines, entries, strict=True):
        name, description = line.split("  ", 1)
        assert (name, description.strip()) == (entry["name"], entry["description"])
        key = "description" if what == "scenarios" else "title"
        file = open(entry["path"], encoding="utf-8").read()
        assert re.search(rf'^{key}: "?{re.escape(entry["description"])}"?$', file, re.M)
        assert files == "The files: " + entry["path"].replace(entry["name"] + ".yaml", "NAME.yaml")
