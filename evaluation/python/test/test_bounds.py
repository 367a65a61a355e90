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

import pytest

MEMORY = 4_000_000 << 10  # as `ulimit -v 4000000`
SOON = 10.0  # [s]


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
    shutil.copy(os.path.join(os.path.dirname(__file__), "../../../sim/models/mini.xml"), tmp_path / "a.xml")
    refused(bounded("land", "open", "--set", "vehicle=a.xml"), "a.airframe.yaml:1: ")


@pytest.mark.parametrize("command", ["replay a.db --html a.html", "export a.db --mcap a.mcap", "profile --from a.db", "plan --from a.db:1"])
def test_a_comma_in_a_record_ends(bounded, record_path, tmp_path, command):
    shutil.copy(record_path, tmp_path / "a.db")
    with sqlite3.connect(tmp_path / "a.db") as db:
        db.execute("UPDATE meta SET value = ',' WHERE key = 'scenario_yaml'")
    refused(bounded(*shlex.split(command)), "a.db")


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


@pytest.mark.parametrize("special", ["fifo", "/dev/zero", "."])
@pytest.mark.parametrize("command", OPENED.values(), ids=OPENED)
def test_what_is_no_file_is_not_opened(bounded, tmp_path, command, special):
    os.mkfifo(tmp_path / "fifo")
    refused(bounded(*shlex.split(command.format(special))), special)


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
    assert not list(tmp_path.glob("*partial*"))
