# SPDX-License-Identifier: BSD-3-Clause
"""Flights from Python: the program's to the last bit, and with parts of one's own."""
import json
import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import the_package

td = the_package.touchdown


def without_times(document):
    return {key: value for key, value in document.items() if key != "wall_clock"}


@pytest.mark.parametrize(
    "scenario, seed, changes",
    [
        ("straight_turn", 1, {}),
        ("open", 3, {"wind.mean": 4.0}),
        ("forest", 2, {"planner": "ego"}),
        ("circle", 5, {"descent": "vertical", "timeout": 12}),
        ("open", 4, {"own_state": "estimated"}),
    ],
)
def test_a_flight_is_the_programs_to_the_last_bit(run, scenario, seed, changes):
    words = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
    command = run("land", scenario, "--seed", str(seed), "--json", *words)
    result = td.run_trial(scenario, seed=seed, set=changes)
    assert without_times(result.document) == without_times(json.loads(command.stdout))
    assert result.outcome == result.document["outcome"] and result.seed == seed
    assert set(result.document) <= set(vars(result)), "each is an attribute"


def test_a_record_is_the_programs(run, tmp_path):
    run("land", "open", "--seed", "3", "--record", str(tmp_path / "program.db"))
    mine = td.run_trial("open", seed=3, record=True).record
    its = td.Record(tmp_path / "program.db")
    assert mine.tables == its.tables
    for table in mine.tables:
        if table in ("meta", "timing", "plan_timing"):
            continue
        for name, column in mine[table].items():
            np.testing.assert_array_equal(column, its[table][name], err_msg=f"{table}.{name}")
    same = set(mine.meta) - {"result_json", "build_hash", "revision"}
    assert {key: mine.meta[key] for key in same} == {key: its.meta[key] for key in same}


def test_the_record_has_arrays_and_frames(tmp_path):
    result = td.run_trial("open", seed=3, record=tmp_path / "kept.db")
    assert (tmp_path / "kept.db").is_file()
    true = result.record.states("vehicle")
    assert true["t"].ndim == 1 and np.all(np.diff(true["t"]) > 0)
    frame = result.record.frame("plan")
    assert len(frame) == result.replans and (frame.status == "planned").any()
    with pytest.raises(KeyError, match="no table plans, it has air"):
        result.record["plans"]
    with pytest.raises(FileNotFoundError):
        td.Record(tmp_path / "nowhere.db")


def test_a_record_takes_no_other_files_place(tmp_path):
    text, trials, kept = tmp_path / "notes.txt", tmp_path / "trials.db", tmp_path / "kept.db"
    text.write_text("mine " * 100)
    td.sweep("open", trials=1, set={"timeout": 1}, db=trials, progress=False)
    before = [text.read_bytes(), trials.read_bytes()]
    record = td.run_trial("open", set={"timeout": 1}, record=kept).record

    class Never(td.Planner):
        def plan(self, request):
            raise AssertionError("it flies")

    parts = td.Registries()
    parts.add(Never)
    for path, error, why in [
        (text, FileExistsError, "notes.txt: a file that is no record of a flight is in its place"),
        (trials, FileExistsError, "trials.db: a file that is no record"),
        (tmp_path / "none" / "a.db", FileNotFoundError, "a.db: there is no directory .*none"),
        (tmp_path, IsADirectoryError, "a file must be named"),
    ]:
        with pytest.raises(error, match=why):
            td.run_trial("open", planner="never", registries=parts, record=path)
        with pytest.raises(error, match=why):
            record.save(path)
    assert [text.read_bytes(), trials.read_bytes()] == before
    record.save(kept)
    assert td.run_trial("open", set={"timeout": 2}, record=kept).simulated_s > 1.5
    assert td.Record(kept)["vehicle"]["t"].max() > 1.5
    (tmp_path / "empty.db").touch()
    record.save(tmp_path / "empty.db")
    assert sorted(os.listdir(tmp_path)) == ["empty.db", "kept.db", "notes.txt", "trials.db"]


def test_a_folder_that_cannot_be_written_to_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: str(path) != str(tmp_path))
    with pytest.raises(PermissionError, match="a.db: nothing can be written to"):
        td.run_trial("open", set={"timeout": 1}, record=tmp_path / "a.db")


def test_what_is_no_record_is_told(tmp_path):
    text, trials = tmp_path / "notes.txt", tmp_path / "trials.db"
    text.write_text("mine " * 100)
    td.sweep("open", trials=1, set={"timeout": 1}, db=trials, progress=False)
    for path in (text, trials):
        with pytest.raises(td.BadInput, match=f"{path.name}: it is no record of a flight"):
            td.Record(path)


def test_a_scenario_is_a_dictionary_a_file_or_a_name(tmp_path):
    (tmp_path / "mine.yaml").write_text("pad: {speed: 0.4}\n", encoding="utf-8")
    assert "speed: 0.4" in td.load_scenario(tmp_path / "mine.yaml").yaml
    world = td.load_scenario({"pad": {"speed": np.float64(0.4)}, "obstacles": {"boxes": []}})
    assert world.yaml == td.load_scenario(tmp_path / "mine.yaml").yaml
    assert td.load_scenario(world, set={"pad.speed": 0.7}).yaml != world.yaml
    assert "open" in td.scenarios()


@pytest.mark.parametrize(
    "call, error",
    [
        (lambda: td.run_trial("opn"), "opn: there is no such scenario file .did you mean open"),
        (lambda: td.run_trial("open", set={"pad.sped": 1.0}), "pad.sped"),
        (lambda: td.run_trial("open", set={"pad.speed": -1.0}), "pad.speed"),
        (lambda: td.run_trial("open", planner="nobody"), "nobody"),
        (lambda: td.run_trial({"pad": {"speed": "fast"}}), "pad.speed"),
        (lambda: td.run_trial({"pad": 3}), "pad"),
    ],
)
def test_a_scenario_that_cannot_be_flown_is_one_sentence(call, error):
    with pytest.raises(td.BadInput, match=error) as raised:
        call()
    assert isinstance(raised.value, ValueError) and "\n" not in str(raised.value)


def test_a_step_is_explained_as_the_program_does(run, tmp_path):
    path = tmp_path / "flight.db"
    td.run_trial("straight_turn", seed=1, record=path, set={"timeout": 4})
    told = td.explain_step(path, 3)
    assert told["input"] == td.explain_step(td.Record(path), 3)["input"], "of a record without its file, too"
    program = json.loads(run("plan", "--from", f"{path}:3", "--json").stdout)
    for told_one in (told, program):
        del told_one["wall_clock"], told_one["source"]
    # The module is another file than the program: each only answers its own records with the same bits for sure.
    program["same_as_record"] = told["same_as_record"]
    assert told == program and told["same_as_record"] is True
    with pytest.raises(IndexError, match="the record has the steps 0 to"):
        td.explain_step(path, 999)
    with pytest.raises(td.BadInput):
        td.explain_step(path, 0, set={"pad.speed": 2.0})


# Parts of one's own


class Low(td.Term):
    """Stays low."""

    window, weight, unit = 3, 20.0, "m"
    parameters = {"height": td.Parameter(2.0, 0.5, 10.0, "stays below [m]")}

    def value(self, w):
        return w.position[:, 2:] - self.height

    def loss(self):
        return td.HingeLoss(self.weight, 0.3)


class Straight(td.Planner):
    """A quintic to the pad, whatever stands between."""

    avoids = False
    parameters = {"share": td.Parameter(0.9, 0.1, 1.0, "of the limits")}

    def plan(self, request):
        duration = 0.8
        while duration < 30.0:
            end = request.pad.end_state(request.endpoint, request.t_start + duration)
            curve = td.hermite(request.start, end, 12, duration, request.t_start)
            bounds = curve.bounds()
            if (
                bounds["speed"] <= self.share * request.limits.speed
                and bounds["acceleration"] <= self.share * request.limits.acceleration
            ):
                return curve
            duration *= 1.1
        return "pad_unreachable"


@pytest.fixture(name="parts")
def own_parts():
    parts = td.Registries()
    parts.add(Low)
    parts.add(Straight)
    return parts


def test_a_term_of_ones_own_flies(parts):
    heights = [
        td.run_trial("straight_turn", seed=1, set=changes, registries=parts, record=True)
        for changes in ({"terms.low.weight": 0}, {}, {"terms.low.height": 1.5})
    ]
    assert all(result.landed for result in heights)
    highest = [result.record.states("vehicle")["pz"].max() for result in heights]
    assert highest[2] <= highest[1] <= highest[0]
    assert "low" in set(heights[2].record["term_cost"]["term"])
    times = parts.term_times["low"]
    assert times["calls"] > 100 and times["windows"] > times["calls"] and times["wall_s"] > 0.0


def test_a_term_that_costs_nothing_changes_nothing(parts):
    with_it = td.run_trial("open", seed=2, set={"terms.low.weight": 0}, registries=parts)
    without = td.run_trial("open", seed=2)
    assert without_times(with_it.document) == without_times(without.document)


def test_a_planner_of_ones_own_lands_and_is_judged(parts):
    result = td.run_trial("open", planner="straight", registries=parts, record=True)
    assert result.landed and result.planner == "straight" and result.backend == "none"
    again = td.run_trial("open", planner="straight", registries=parts)
    assert without_times(again.document) == without_times(result.document)
    hit = td.run_trial("straight_turn", planner="straight", registries=parts)
    assert hit.outcome == "collision" and "obstacle" in hit.detail
    slow = td.run_trial("open", planner="straight", registries=parts, set={"straight.share": 0.6})
    assert slow.time_to_land_s > result.time_to_land_s


def test_a_planner_that_has_no_plan_brakes(parts):
    class Never(td.Planner):
        def plan(self, request):
            return None

    class Kept(Straight):
        """Its second answer keeps the first."""

        name = "kept"
        asked = 0

        def plan(self, request):
            self.asked += 1
            return super().plan(request) if self.asked % 5 == 1 else td.KEEP

    parts.add(Never)
    parts.add(Kept)
    never = td.run_trial("open", planner="never", registries=parts, set={"timeout": 6})
    assert not never.landed and set(never.replans_by_reason) == {"search_failed"}
    assert td.run_trial("open", planner="kept", registries=parts).replans_by_status["kept"] > 5


def test_a_planner_may_look_at_its_map_during_the_call_alone(parts):
    kept = []

    class Looks(Straight):
        name = "looks"

        def plan(self, request):
            curve = super().plan(request)
            kept.append((request, request.map.first_blocked(curve), request.map.states().shape))
            return curve

    parts.add(Looks)
    td.run_trial("straight_turn", planner="looks", registries=parts)
    assert any(np.isfinite(blocked) for _, blocked, _ in kept)
    request = kept[0][0]
    for look in (lambda: request.map.states(), lambda: request.pad.at(0.0)):
        with pytest.raises(RuntimeError, match="of a call that has ended"):
            look()


@pytest.mark.parametrize(
    "plan, error",
    [
        (lambda r: r.nothing, "nothing"),
        (lambda r: 3, "it must be a UniformBspline, KEEP, None or a reason"),
        (lambda r: "no_reason", '"no_reason" is not among'),
        (lambda r: td.hermite(r.start, r.start, 6, 1.0, 0.0), "it must be request.t_start"),
    ],
)
def test_what_is_wrong_with_a_plan_comes_out(plan, error):
    class Odd(td.Planner):
        pass

    Odd.plan = lambda self, request: plan(request)
    parts = td.Registries()
    parts.add(Odd)
    with pytest.raises((AttributeError, TypeError, ValueError), match=error):
        td.run_trial("open", planner="odd", registries=parts, seed=7)


def test_a_map_is_lent_to_one_thread_and_to_a_planner_within():
    told = {}

    class Delegates(td.Planner):
        """Asks the library's planner."""

        inner = None

        def plan(self, request):
            if self.inner is None:
                self.inner = td.Replanner(td.ReplannerOptions(limits=request.limits))
                self.inner.commit_hover(request.start.p, request.t_now)
            asked = td.ReplanInput(t_now=request.t_now, t_start=request.t_start, vehicle=request.vehicle)
            goal = td.GoalAt(request.pad.at(request.t_start + 2.0).p_WP)
            told["status"] = self.inner.replan(request.map, asked, goal).status

            def look():
                try:
                    request.map.states()
                except RuntimeError as error:
                    told["other"] = str(error)

            thread = threading.Thread(target=look)
            thread.start()
            thread.join()
            return None

    parts = td.Registries()
    parts.add(Delegates)
    td.run_trial("open", planner="delegates", registries=parts, set={"timeout": 2})
    assert told["status"] in ("planned", "kept") and "lent to the thread" in told["other"]


def test_a_curve_that_starts_elsewhere_is_refused():
    class Jumps(td.Planner):
        def plan(self, request):
            far = td.SplineState(p=[50.0, 50.0, 20.0])
            return td.hermite(far, far, 6, 2.0, request.t_start)

    parts = td.Registries()
    parts.add(Jumps)
    with pytest.raises(ValueError, match="the curve starts .* m from request.start.p"):
        td.run_trial("open", planner="jumps", registries=parts)


def test_what_raises_while_it_is_made_keeps_its_type():
    class Odd(td.Planner):
        def __init__(self, **settings):
            raise LookupError("while it is made")

    class OddTerm(td.Term):
        def __init__(self, **settings):
            raise LookupError("while it is made")

    parts = td.Registries()
    parts.add(Odd)
    with pytest.raises(LookupError, match="while it is made"):
        parts.add(OddTerm)
    assert "odd_term" not in parts.terms
    parts.add(OddTerm, check=False)
    for call in (
        lambda: td.run_trial("open", planner="odd", registries=parts),
        lambda: td.LandingProblem(10, registries=parts),
        lambda: td.Replanner(registries=parts),
    ):
        with pytest.raises(LookupError, match="while it is made"):
            call()


def test_a_part_may_be_entered_again_where_one_says_so(parts):
    class Again(Low):
        name = "low"

    with pytest.raises(ValueError, match="low is registered already: with replace=True"):
        parts.add(Again)
    parts.add(Again, replace=True)
    assert parts.terms.count("low") == 1
    with pytest.raises(ValueError, match="smoothness"):
        parts.add(type("Smoothness", (Low,), {"name": "smoothness"}), replace=True)


def test_ctrl_c_ends_a_sweep_with_parts_of_ones_own():
    script = """
import touchdown as td
class Slow(td.Planner):
    def plan(self, request):
        sum(range(200000))
        return None
parts = td.Registries()
parts.add(Slow)
print("begins", flush=True)
try:
    td.sweep("open", planner="slow", registries=parts, trials=500, progress=False)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    for delay in (0.5, 0.7, 0.9):
        with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout.readline() == "begins\n"
            threading.Timer(delay, lambda: os.kill(process.pid, signal.SIGINT)).start()
            assert process.communicate(timeout=20)[0] == "interrupted\n"


def test_a_predictor_and_a_controller_of_ones_own_fly():
    class Same(td.PadPredictor):
        def predict(self, known):
            return known.predict()

    class Through:
        def __init__(self, known):
            self.known = known

        def at(self, t):
            return self.known.at(t)

    class Own(td.PadPredictor):
        def predict(self, known):
            assert known.mean.shape == (5,) and known.covariance.shape == (5, 5) and known.height == 0.5
            return Through(known.predict())

    class Hover(td.Controller):
        """Leans on nothing: it falls off course, and says no more."""

        def update(self, state, reference, disturbance, tilt_most):
            return td.ControlOutput(wrench=td.Wrench(thrust=self.vehicle.hover_thrust))

    parts = td.Registries()
    for part in (Same, Own, Hover):
        parts.add(part)
    usual = td.run_trial("open", seed=3)
    for name in ("same", "own"):
        mine = td.run_trial("open", seed=3, set={"pad.prediction": name}, registries=parts)
        assert mine.landed and mine.time_to_land_s == pytest.approx(usual.time_to_land_s, abs=0.2)
    fell = td.run_trial("open", seed=3, set={"controller": "hover", "timeout": 8}, registries=parts)
    assert not fell.landed


def test_a_controller_that_raises_is_heard():
    class Odd(td.Controller):
        def update(self, state, reference, disturbance, tilt_most):
            raise OverflowError("in control")

    parts = td.Registries()
    parts.add(Odd)
    with pytest.raises(OverflowError, match="in control"):
        td.run_trial("open", set={"controller": "odd"}, registries=parts)


@pytest.mark.parametrize(
    "part, error",
    [
        (int, "no class that derives from"),
        (Straight(), "no class that derives from"),
        (type("Landing", (td.Planner,), {}), "landing"),
        (type("Smoothness", (td.Term,), {"value": lambda self, w: w.q[:, 0]}), "smoothness"),
    ],
)
def test_what_cannot_be_entered_is_named(part, error):
    parts = td.Registries()
    before = (parts.planners, parts.terms)
    with pytest.raises((TypeError, ValueError), match=error):
        parts.add(part)
    assert (parts.planners, parts.terms) == before


def test_a_sweep_in_this_process_has_the_programs_rows(run, tmp_path):
    mine, its = tmp_path / "mine.db", tmp_path / "its.db"
    told = []
    td._touchdown._sweep("open", ["timeout=15"], ["pad.speed=0.5,1.0"], 6, 9, str(mine), td.Registries(),
                         lambda *state: told.append(state))
    run("sweep", "open", "--set", "timeout=15", "--vary", "pad.speed=0.5,1.0", "--trials", "6", "--seed", "9",
        "--db", str(its))
    query = "SELECT * FROM trial ORDER BY trial"
    import sqlite3

    rows = [sqlite3.connect(path).execute(query).fetchall() for path in (mine, its)]
    assert rows[0] == rows[1] and len(rows[0]) == 6
    assert told[0] == (6, 0, 0) and told[-1][:2] == (6, 6)


def test_a_trial_whose_planner_raises_is_a_row(tmp_path):
    class Odd(Straight):
        name = "odd"

        def plan(self, request):
            if request.t_now > 1.0:
                raise ArithmeticError("after a second")
            return super().plan(request)

    parts = td.Registries()
    parts.add(Odd)
    db = tmp_path / "odd.db"
    td._touchdown._sweep("open", ["planner=odd"], [], 3, 1, str(db), parts, None)
    import sqlite3

    rows = sqlite3.connect(db).execute("SELECT outcome, detail FROM trial").fetchall()
    assert [row[0] for row in rows] == ["error"] * 3 and "after a second" in rows[0][1]


def test_a_comparison_in_this_process_has_the_programs_solves(run, tmp_path, parts):
    of = {"problems": 3, "seed": 4, "repeats": 1, "backends": ["banded", "lbfgs"], "progress": False}
    its = td.compare(**of)
    mine = td.compare(**of, registries=td.Registries())
    assert mine.command is None and its.command.startswith("touchdown compare")
    columns = [column for column in mine.solves if not column.endswith("_ms")]
    assert {"cost", "iterations", "status"} < set(columns) < set(mine.solves)
    assert mine.solves[columns].equals(its.solves[columns])
    own = td.compare(**of, registries=parts)
    assert not own.problems.equals(mine.problems), "a term of one's own is in every problem"
    with pytest.raises(ValueError, match="pin is 1"):
        td.compare(pin=1, registries=parts)
    with pytest.raises(td.BadInput, match="simplex"):
        td.compare(backends=["simplex"], registries=parts)


def test_two_hundred_trials_leave_nothing_behind(parts):
    def fly_many(n):
        for seed in range(n):
            td.run_trial("open", seed=seed, planner=("landing", "straight")[seed % 2], registries=parts, set={"timeout": 1})

    fly_many(40)
    before = the_package.resident_kb()
    fly_many(200)
    assert the_package.resident_kb() - before < 6000, "less than 30 kB a flight"


def test_a_flight_ends_at_ctrl_c():
    script = """
import touchdown as td
print("begins", flush=True)
try:
    while True:
        td.run_trial("straight_turn")
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "begins\n"
        threading.Timer(0.4, lambda: os.kill(process.pid, signal.SIGINT)).start()
        assert process.communicate(timeout=20)[0] == "interrupted\n"


def test_flights_in_threads_are_the_same():
    documents = [None] * 3

    def fly(i):
        documents[i] = without_times(td.run_trial("open", seed=3).document)

    threads = [threading.Thread(target=fly, args=(i,)) for i in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert documents[0] == documents[1] == documents[2] is not None
