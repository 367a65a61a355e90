# SPDX-License-Identifier: BSD-3-Clause
import os
import sqlite3
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import touchdown_notebook as nb  # noqa: E402


@pytest.fixture()
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("TOUCHDOWN_PROGRAM", os.environ["TOUCHDOWN_PROGRAM"])  # as it was, afterwards
    monkeypatch.setenv("TOUCHDOWN_NOTEBOOK_OUT", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    nb.start("here")
    return tmp_path / "here"


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """A folder with the record of a short flight, and its profile."""
    path = tmp_path_factory.mktemp("flown")
    before = os.getcwd()
    os.chdir(path)
    try:
        nb.run("touchdown land open --set timeout=2 --record a.db", allowed=(1,), quiet=True)
        nb.run("touchdown profile --from a.db --repeats 2 --db p.db", quiet=True)
    finally:
        os.chdir(before)
    return path


def profile_of(flown):
    """The tables that stage_times takes, as touchdown.read gives them."""
    return {name: nb.table(flown / "p.db", f"SELECT * FROM {name}") for name in ("stage", "replan")}


def test_the_program_is_the_one_that_is_named(monkeypatch, tmp_path):
    assert nb.program() == Path(os.environ["TOUCHDOWN_PROGRAM"]).resolve()
    monkeypatch.setenv("TOUCHDOWN_PROGRAM", str(tmp_path / "none"))
    with pytest.raises(FileNotFoundError, match="none, the value of TOUCHDOWN_PROGRAM, is no program"):
        nb.program()


def test_without_a_program_the_way_to_one_is_said(monkeypatch, tmp_path):
    monkeypatch.delenv("TOUCHDOWN_PROGRAM")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(nb, "ROOT", tmp_path)
    with pytest.raises(FileNotFoundError, match="run ./demo.sh"):
        nb.program()
    built = tmp_path / "build" / "native" / "bin" / "touchdown"
    built.parent.mkdir(parents=True)
    built.touch(mode=0o755)
    assert nb.program() == built


def test_the_program_of_the_installed_package_comes_before_a_build(monkeypatch, tmp_path):
    monkeypatch.delenv("TOUCHDOWN_PROGRAM")
    package = SimpleNamespace(origin=str(tmp_path / "touchdown" / "__init__.py"))
    monkeypatch.setattr(nb.importlib.util, "find_spec", lambda name: package if name == "touchdown" else None)
    assert nb.program() != tmp_path / "touchdown" / "bin" / "touchdown"
    (tmp_path / "touchdown" / "bin").mkdir(parents=True)
    (tmp_path / "touchdown" / "bin" / "touchdown").touch(mode=0o755)
    assert nb.program() == tmp_path / "touchdown" / "bin" / "touchdown"


def test_a_folder_of_its_own_without_old_results(tmp_path, monkeypatch):
    monkeypatch.setenv("TOUCHDOWN_NOTEBOOK_OUT", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "again" / "study").mkdir(parents=True)
    for name in ("old.db", "study/old.db", "main.cc"):
        (tmp_path / "again" / name).touch()
    (tmp_path / "elsewhere.db").touch()
    nb.start("again")
    assert Path.cwd() == tmp_path / "again"
    assert sorted(p.name for p in tmp_path.rglob("*.*")) == ["elsewhere.db", "main.cc"]


def test_a_command_prints_what_it_prints(folder, capfd):
    assert nb.run("touchdown list scenarios") is None
    assert "straight_turn" in capfd.readouterr().out
    nb.run("touchdown list scenarios", quiet=True)
    assert "straight_turn" not in capfd.readouterr().out
    scenarios = nb.run("touchdown list scenarios --json")
    assert "open" in [scenario["name"] for scenario in scenarios]
    nb.run("cmake -E echo 'two words'")
    assert "two words\n" in capfd.readouterr().out


def test_a_failure_is_said_in_a_sentence(folder):
    with pytest.raises(nb.CommandFailed, match="status 2: .*no_such_key"):
        nb.run("touchdown land open --set no_such_key=1")
    with pytest.raises(nb.CommandFailed, match="status 1: .*timeout"):
        nb.run("touchdown land open --set timeout=1")
    nb.run("touchdown land open --set timeout=1", allowed=(0, 1), quiet=True)


def test_more_output_than_a_pipe_holds(folder, capfd):
    script = "import sys; [print('x' * 99, file=f) for _ in range(9999) for f in (sys.stderr, sys.stdout)]"
    nb.run(f'{sys.executable} -c "{script}"')
    assert capfd.readouterr().out.count("x" * 99) >= 9999


def test_tables_are_read_only(folder):
    with pytest.raises(FileNotFoundError, match="none.db"):
        nb.table("none.db", "SELECT 1")
    with sqlite3.connect("some.db") as db:
        db.execute("CREATE TABLE t(x)")
        db.execute("INSERT INTO t VALUES (3)")
    assert nb.table("some.db", "SELECT x FROM t").x.tolist() == [3]
    with pytest.raises(Exception, match="readonly"):
        nb.table("some.db", "DELETE FROM t")


def test_a_flight_is_measured_from_the_pad(flown):
    way = nb.flight(flown / "a.db")
    assert way.t.iloc[0] == pytest.approx(0.0) and way.t.iloc[-1] == pytest.approx(2.0, abs=0.1)
    # open: from (0, 0, 2.5) to a pad at (7, 6.5), whose deck is 0.5 m high.
    assert way.to_pad.iloc[0] == pytest.approx((7.0**2 + 6.5**2) ** 0.5, abs=1e-3)
    assert way.above_pad.iloc[0] == pytest.approx(2.0, abs=1e-3)
    assert way.to_pad.iloc[-1] < way.to_pad.iloc[0]


def test_stage_times_add_up_and_are_the_median_of_the_passes(flown):
    times = nb.stage_times(profile_of(flown))
    steps = nb.table(flown / "p.db", "SELECT COUNT(*) n, COUNT(DISTINCT replan) steps FROM replan")
    assert len(times) == steps.steps[0] == steps.n[0] / 2
    assert times.t_now.is_monotonic_increasing
    assert times[nb.STAGES].sum(axis=1).to_numpy() == pytest.approx(times.total.to_numpy())
    samples = nb.table(flown / "p.db", "SELECT cpu_ms FROM stage WHERE replan = 3 AND stage = 'solve'")
    assert times.solve[3] == pytest.approx(samples.cpu_ms.median())


def test_a_rate_has_its_interval():
    assert nb.rate(10, 10) == "10 of 10, 95 % [69, 100] %"
    assert nb.rate(0, 4) == "0 of 4, 95 % [0, 60] %"


def test_pictures_are_made(flown, tmp_path):
    times = nb.stage_times(profile_of(flown))
    figures = [
        nb.flights_figure({"one": flown / "a.db", "two": flown / "a.db"}, zones=[(1.0, 2.0, 0.5)]),
        nb.stages_figure(times, 20.0),
        nb.distributions_figure({"banded": times.total}, "ms"),
    ]
    for figure in figures:
        image = nb.show(figure)
        assert image.data[:4] == b"\x89PNG"
        (tmp_path / "picture.png").write_bytes(image.data)
    assert nb.picture(tmp_path / "picture.png").data[:4] == b"\x89PNG"
