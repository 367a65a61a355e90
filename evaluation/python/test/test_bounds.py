# SPDX-License-Identifier: BSD-3-Clause
"""Nothing hangs: files without end, texts that never finish, signals in the middle of every command."""
import os
import resource
import shlex
import shutil
import signal
import sqlite3
import subprocess
import time
import zlib
from pathlib import Path

import pytest

MEMORY = 4_000_000 << 10  # as `ulimit -v 4000000`
SOON = 10.0  # [s]
ROOT = Path(__file__).resolve().parents[3]
MODELS, WORLDS = ROOT / "sim/models", ROOT / "docs/examples/worlds"


@pytest.fixture
def bounded(program, tmp_path):
    """Runs the program in tmp_path with bounds on memory and time."""

    def call(*arguments):
        return subprocess.run([program, *arguments], capture_output=True, text=True, cwd=tmp_path, check=False, timeout=SOON,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY)))

    return call


def refused(done, name):
    assert done.returncode == 2, done.stderr
    assert name in done.stderr and done.stderr.count("\n") == 1, done.stderr


@pytest.mark.parametrize("command", ["land a.yaml", "plan a.yaml", "sweep a.yaml", "study run a.yaml", "fly a.yaml"])
def test_a_comma_is_no_scenario(bounded, tmp_path, command):
    (tmp_path / "a.yaml").write_text(",")
    refused(bounded(*shlex.split(command)), "a.yaml:1: ")


def test_a_comma_is_no_airframe(bounded, tmp_path):
    (tmp_path / "a.airframe.yaml").write_text(",")
    shutil.copy(MODELS / "mini.xml", tmp_path / "a.xml")
    refused(bounded("land", "open", "--set", "vehicle=a.xml"), "a.airframe.yaml:1: ")


@pytest.mark.parametrize("command", ["replay a.db --html a.html", "export a.db --mcap a.mcap", "profile --from a.db", "plan --from a.db:1"])
def test_a_comma_in_a_record_ends(bounded, record_path, tmp_path, command):
    shutil.copy(record_path, tmp_path / "a.db")
    with sqlite3.connect(tmp_path / "a.db") as db:
        db.execute("UPDATE meta SET value = ',' WHERE key = 'scenario_yaml'")
    refused(bounded(*shlex.split(command)), "a.db")


@pytest.mark.parametrize("command", ["replay a.db --html a.html", "profile --from a.db", "plan --from a.db:8"])
def test_a_curve_that_leaves_the_world_is_refused(bounded, record_path, tmp_path, command):
    shutil.copy(record_path, tmp_path / "a.db")
    with sqlite3.connect(tmp_path / "a.db") as db:
        db.execute("UPDATE state_point SET x = 1e308 WHERE i = 1")
    refused(bounded(*shlex.split(command)), "a.db: its table state_point")


OPENED = {
    "scenario": "land {}",
    "study": "study run {}",
    "map": "land open --set map.prior={}",
    "waypoints": "land open --set pad.motion=waypoints --set pad.waypoints={}",
    "mesh": "land open --set 'obstacles.meshes=[{{file: {}}}]'",
    "octomap": "land open --set 'obstacles.octomaps=[{{file: {}}}]'",
    "heights": "land open --set 'obstacles.height_fields=[{{file: {}, size: [9, 9], height: 1}}]'",
    "vehicle": "land open --set vehicle={}",
    "record": "replay {} --html a.html",
    "trials": "merge b.db {}",
}


@pytest.mark.parametrize("special", ["fifo", "/dev/zero", "folder"])
@pytest.mark.parametrize("command", OPENED.values(), ids=OPENED)
def test_what_is_no_file_is_not_opened(bounded, tmp_path, command, special):
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "folder").mkdir()
    refused(bounded(*shlex.split(command.format(special))), special)


MJCF_TRAPS = {
    "include": '<include file="fifo"/>',
    "mesh": '<asset><mesh name="trap" file="fifo"/></asset>',
    "texture": '<asset><texture name="trap" type="2d" builtin="flat" width="60000" height="60000"/></asset>',
    "hfield": '<asset><hfield name="trap" size="1 1 1 1" nrow="30000" ncol="30000"/></asset>',
    "composite": '<worldbody><body><composite type="grid" count="300 300 1" spacing="0.1"/></body></worldbody>',
    "geom": "<worldbody>" + '<geom size="1"/>' * 20000 + "</worldbody>",
    "size": '<size njmax="2000000000"/>',
}


@pytest.mark.parametrize("model", ["quadrotor", "mini"])
@pytest.mark.parametrize("trap", MJCF_TRAPS)
def test_a_vehicle_opens_no_trap(bounded, tmp_path, model, trap):
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "a.xml").write_text((MODELS / f"{model}.xml").read_text().replace("</mujoco>", MJCF_TRAPS[trap] + "</mujoco>"))
    done = bounded("land", "open", "--set", "vehicle=a.xml", "--set", "timeout=1")
    if trap == "texture" and model == "mini":  # what is imported has no need of pictures
        assert done.returncode == 1, done.stderr
    else:
        refused(done, "fifo" if trap in ("include", "mesh") else f"<{trap}>")


def test_a_mesh_opens_no_other_file(bounded, tmp_path):
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "a.obj").write_text("mtllib fifo\n" + (WORLDS / "courtyard.obj").read_text())
    done = bounded("land", "open", "--set", "obstacles.meshes=[{file: a.obj, at: [-60, -60, 0]}]", "--set", "timeout=1")
    assert done.returncode == 1, done.stderr


def test_a_mesh_is_no_archive(bounded, tmp_path):
    (tmp_path / "a.3mf").write_bytes(b"PK")
    refused(bounded("land", "open", "--set", "obstacles.meshes=[{file: a.3mf}]"), "a.3mf: its name must end with .obj")


def test_the_texts_of_a_picture_are_not_inflated(bounded, tmp_path):
    picture = (WORLDS / "hills.png").read_bytes()
    body = b"k\0\0" + zlib.compress(bytes(8_000_000), 9)
    text = len(body).to_bytes(4, "big") + b"zTXt" + body + zlib.crc32(b"zTXt" + body).to_bytes(4, "big")
    (tmp_path / "a.png").write_bytes(picture[:33] + text * 1000 + picture[33:])
    done = bounded("land", "open", "--set", "obstacles.height_fields=[{file: a.png, size: [9, 9], height: 1, at: [-60, -60, 0]}]",
                   "--set", "timeout=1")
    assert done.returncode == 1, done.stderr


def test_no_name_is_too_long(bounded, tmp_path):
    (tmp_path / "a.yaml").write_text("? " + "a" * 4_000_000)
    done = bounded("land", "a.yaml")
    refused(done, "a.yaml:1: ")
    assert len(done.stderr) < 5000
    refused(bounded("replay", "a" * 300, "--html", "a.html"), "aaa: there is no such record")


@pytest.mark.parametrize("command", ["replay a.db --html a.html", "export a.db --mcap a.mcap"])
def test_a_record_computes_nothing(bounded, record_path, tmp_path, command):
    shutil.copy(record_path, tmp_path / "a.db")
    with sqlite3.connect(tmp_path / "a.db") as db:
        db.execute("ALTER TABLE event DROP COLUMN text")
        db.execute("ALTER TABLE event ADD COLUMN text TEXT GENERATED ALWAYS AS (hex(zeroblob(20000000)))")
    refused(bounded(*shlex.split(command)), "a.db")


LONG = {
    "land": "land straight_turn --record a.db --set timeout=600 --set tags.rate=0.01",
    "sweep": "sweep forest --trials 1000 --db a.db",
    "compare": "compare --problems 1000 --db a.db",
    "hostile": "study hostile --flights 1000 --db a.db",
    "study": "study paper --quick --out paper",
    "tags": "study tags",
    "replan": "study replan",
    "profile": "profile --trials 1000",
    "video": "replay {record} --video a.mp4",
}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("command", LONG.values(), ids=LONG)
def test_a_signal_ends_every_command(program, record_path, tmp_path, command, number):
    process = subprocess.Popen([program, *shlex.split(command.format(record=record_path))], cwd=tmp_path,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    time.sleep(0.5)
    assert process.poll() is None, process.communicate()[1]
    process.send_signal(number)
    process.communicate(timeout=SOON)
    assert process.returncode in (-number, 128 + number)
    assert not list(tmp_path.rglob("*partial*"))
