#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Does a change leave every flight as it was? Runs 24 command lines and keeps what each answers, times apart, and a
digest of every set-point and every plan, a file each.

    .ci/same_flights.py out/before; (change, build); .ci/same_flights.py out/after; diff -r out/before out/after

Takes about three minutes. The program is build/release/bin/touchdown."""
import argparse
import hashlib
import json
import sqlite3
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "build" / "release" / "bin" / "touchdown"
BELOW = ["--set", "pad.motion=static", "--set", "pad.start=[0, 0]", "--set", "start.position=[0, 0, 2]"]
GUSTS = ["--set", "wind.mean=6", "--set", "wind.max=12"]
FLIGHTS = [
    ["land", "circle"],
    ["land", "figure4"],
    ["land", "forest", "--seed", "2"],
    ["land", "open"],
    ["land", "open_fast"],
    ["land", "straight_turn"],
    ["land", "tunnel"],
    ["fly", "goal"],
    ["fly", "goal", "--set", "go_to.velocity=[0.3, 0, 0]"],
    ["fly", "open", "--set", "task=follow"],
    ["land", "open", *BELOW],
    ["land", "open", "--set", "descent=vertical"],
    ["land", "circle", "--set", "sensing=rendered"],
    ["land", "straight_turn", "--set", "own_state=estimated", *GUSTS],
    ["land", "forest", "--set", "depth.drop=0.9"],
    ["land", "circle", "--set", "planning.latency=100"],
    ["land", "circle", "--set", "solver.arrival=fixed", "--set", "solver.limits=hard"],
    ["land", "circle", "--backend", "lbfgs"],
    ["land", "forest", "--planner", "ego"],
    ["land", "open", "--planner", "ego-velocity"],
    ["land", "open", "--planner", "pid"],
]
# Answers without a record.
OTHERS = [
    ["sweep", "forest", "--trials", "4", "--seed", "3"],
    ["study", "hostile", "--flights", "6", "--seed", "3"],
    ["compare", "--problems", "3", "--backends", "banded,lbfgs", "--repeats", "1"],
]
TIMES = {"wall_clock", "time_ms", "wall_time_ms", "tight_time_ms", "ms_per_iteration", "shares", "build", "machine"}


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(item) for key, item in value.items() if key not in TIMES}
    return [without_times(item) for item in value] if isinstance(value, list) else value


def digest(record, table):
    rows = sqlite3.connect(record).execute(f"SELECT * FROM {table} ORDER BY rowid")
    return hashlib.sha256("\n".join(map(repr, rows)).encode()).hexdigest()


def answer(line, record=None):
    more = ["--record", record] if record else []
    run = subprocess.run([PROGRAM, *line, *more, "--json"], capture_output=True, text=True, cwd=ROOT)
    if run.returncode not in (0, 1):
        sys.exit(f"touchdown {' '.join(line)}: status {run.returncode}\n{run.stderr}")
    result = {"command": line, "status": run.returncode, "answer": without_times(json.loads(run.stdout))}
    if record:
        result["set-points"] = digest(record, "reference")
        result["plans"] = digest(record, "control_point")
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        for number, line in enumerate(FLIGHTS + OTHERS, 1):
            record = f"{scratch}/{number}.db" if line in FLIGHTS else None
            (folder / f"{number:02}.json").write_text(json.dumps(answer(line, record), indent=1) + "\n")
            print(f"{number:2} of {len(FLIGHTS + OTHERS)}: touchdown {' '.join(line)}", flush=True)


if __name__ == "__main__":
    main()
