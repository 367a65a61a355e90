#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Files and command lines as strangers have them, broken at random, through the program.

    .ci/mutated_inputs.py [--count 100] [--seed 1] [--keep DIR] [KIND...]

Each run gets 4 GB of address space and 10 s. It must end by itself, with status 0, 1 (the flight fell short) or 2, and
for 2 with one sentence that names the file. Prints a row for each kind, and every finding with its command.
"""
import argparse
import concurrent.futures
import os
import random
import re
import resource
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = Path(os.environ.get("TOUCHDOWN_PROGRAM", ROOT / "build/release/bin/touchdown"))
WORLDS, VEHICLES = ROOT / "docs/examples/worlds", ROOT / "docs/examples/vehicles"
MEMORY, TIME = 4_000_000 << 10, 10.0
NOTE = re.compile("warning: |trials were flown before")  # may stand before a sentence
# What no sentence holds.
RAW = re.compile(r"std::|terminate|what\(\)|basic_string|bad_alloc|vector::|map::at|\[json|unknown exception|yaml-cpp")
SHORT = ["--set", "timeout=1"]
NASTY = ["", "0", "-1", "1e308", "-1e308", "nan", ".inf", "9223372036854775808", "1e-320", "~", "true", "[]", "{}", ",", "&a",
         "*a", "!!binary x", "x" * 5000, "[" * 600, "{a: " * 600, "\0", "\xff\xfe", "'", '"', "-", "? ", "|", "2147483648", "<b>",
         "none", "/dev/zero", "/", "../..", "65536"]


def mutated_bytes(data, rng):
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 4, 16])):
        at = rng.randrange(len(data) + 1)
        kind = rng.randrange(6)
        if kind == 0 and data:
            data[min(at, len(data) - 1)] ^= 1 << rng.randrange(8)
        elif kind == 1:
            data[at:at + 4] = rng.choice([b"\xff" * 4, b"\0" * 4, b"\x7f\xff\xff\xff", b"\xff\xff\xff\x7f", rng.randbytes(4)])
        elif kind == 2:
            del data[at:at + rng.choice([1, 4, 64, len(data)])]
        elif kind == 3:
            data[at:at] = data[rng.randrange(len(data) + 1):][:rng.choice([1, 8, 64, 4096])]
        elif kind == 4:
            data[at:at] = rng.randbytes(rng.choice([1, 4, 32]))
        else:
            size = rng.choice([1, 8, 64])
            data[at:at + size] = bytes(size)
    return bytes(data)


TEXT_BOMB = [b"zTXt", b"k\0\0" + zlib.compress(bytes(8_000_000), 9)]


def mutated_png(data, rng):
    """A chunk is another one, and its checksum is right; or there are texts that expand to gigabytes."""
    chunks, at = [], 8
    while at < len(data):
        size = int.from_bytes(data[at:at + 4], "big")
        chunks.append([data[at + 4:at + 8], data[at + 8:at + 8 + size]])
        at += 12 + size
    for _ in range(rng.choice([1, 2])):
        chunk = chunks[0] if rng.random() < 0.4 else rng.choice(chunks)
        if rng.random() < 0.1:
            chunks[1:1] = [TEXT_BOMB] * 300
        elif rng.random() < 0.2:
            chunks.insert(rng.randrange(len(chunks) + 1), [rng.choice([b"tEXt", b"PLTE", b"zTXt", b"IDAT", chunk[0]]), rng.randbytes(40)])
        elif chunk[0] == b"IDAT" and rng.random() < 0.7:
            chunk[1] = zlib.compress(rng.randbytes(rng.choice([0, 100, 200_000])))
        else:
            chunk[1] = mutated_bytes(chunk[1], rng)
    return data[:8] + b"".join(len(body).to_bytes(4, "big") + kind + body + zlib.crc32(kind + body).to_bytes(4, "big")
                               for kind, body in chunks)


def mutated_text(text, rng):
    for _ in range(rng.choice([1, 1, 2, 3, 8])):
        kind = rng.randrange(7)
        words = list(re.finditer(r"[\w.+-]+", text))
        lines = text.split("\n")
        if kind <= 2 and words:
            word = rng.choice(words)
            new = rng.choice(NASTY + [rng.choice(words).group(), word.group() * 3, "-" + word.group(), str(rng.gauss(0, 1e3))])
            text = text[:word.start()] + new + text[word.end():]
        elif kind == 3:
            lines.insert(rng.randrange(len(lines) + 1), rng.choice(lines))
            text = "\n".join(lines)
        elif kind == 4:
            del lines[rng.randrange(len(lines))]
            text = "\n".join(lines)
        elif kind == 5:
            at = rng.randrange(len(text) + 1)
            text = text[:at] + rng.choice(NASTY + list(",:[]{}<>/\"'#%@`\t")) + text[at:]
        else:
            text = mutated_bytes(text.encode("latin-1", "replace"), rng).decode("latin-1")
    return text


def mutated_database(path, rng):
    """A row, a value, a column or a table that is another one; or bytes that are."""
    if rng.random() < 0.3:
        path.write_bytes(mutated_bytes(path.read_bytes(), rng))
        return
    with sqlite3.connect(path) as db:
        tables = [row[0] for row in db.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        for _ in range(rng.choice([1, 1, 2, 4])):
            if not tables:
                return
            table = rng.choice(tables)
            try:
                columns = [row[1] for row in db.execute(f"PRAGMA table_info({table})")]
                column = rng.choice(columns)
                rows = [str(row[0]) for row in db.execute(f"SELECT rowid FROM {table} LIMIT 100000")]  # a view has no end
                where = f"WHERE rowid IN ({', '.join(rng.sample(rows, min(len(rows), rng.choice([1, 3, 1000]))))})"
                value = rng.choice([None, 0, -1, 1, 2**31, 2**63 - 1, -2**63, 1e308, float("inf"), "", "x", b"\xff\xfe", "1",
                                    "<b>", ",", "[" * 10000, "{\"a\": 1}", "x" * 100000])
                what = rng.randrange(8)
                if what == 7:  # the last change: whoever reads the table computes
                    db.execute(f"ALTER TABLE {table} ADD COLUMN zz TEXT GENERATED ALWAYS AS (hex(zeroblob(20000000))) VIRTUAL")
                    return
                if what <= 3:
                    db.execute(f"UPDATE {table} SET {column} = ? {where if rng.random() < 0.8 else ''}", (value,))
                elif what == 4:
                    db.execute(f"DELETE FROM {table} {where if rng.random() < 0.7 else ''}")
                elif what == 5:
                    db.execute(f"INSERT OR REPLACE INTO {table} SELECT * FROM {table} {where}")
                else:
                    db.execute(rng.choice([
                        f"DROP TABLE {table}", f"ALTER TABLE {table} DROP COLUMN {column}",
                        f"ALTER TABLE {table} RENAME COLUMN {column} TO x",
                        f"ALTER TABLE {table} RENAME TO x", f"CREATE TABLE IF NOT EXISTS zz AS SELECT * FROM {table}",
                        f"CREATE TRIGGER trap BEFORE INSERT ON {table} BEGIN SELECT RAISE(FAIL, 'trap'); END"]))
                    if rng.random() < 0.3:
                        db.execute(f"CREATE VIEW {table} AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) "
                                   f"SELECT {', '.join('i AS ' + c for c in columns)} FROM n")
            except (sqlite3.Error, IndexError):
                pass


class Inputs:
    """What the kinds begin with, made once."""

    def __init__(self, folder):
        self.record, self.sweep = folder / "record.db", folder / "sweep.db"
        for command in (["land", "straight_turn", "--record", self.record, "--set", "timeout=1.5"],
                        ["sweep", "open", "--trials", "4", "--vary", "pad.speed=0.5,1", "--db", self.sweep, *SHORT]):
            subprocess.run([PROGRAM, *command], cwd=ROOT, capture_output=True, check=False)
        for path in (self.record, self.sweep):
            if not path.exists():
                raise SystemExit(f"{path.name} was not written")
            with sqlite3.connect(path) as db:
                db.execute("PRAGMA journal_mode=DELETE")


# What would be opened, inflated, or multiplied, if a reader followed it.
TRAPS = {
    ".xml": ['<include file="/dev/zero"/>', '<include file="input.xml"/>', '<asset><mesh name="trap" file="fifo"/></asset>',
             '<asset><texture name="trap" type="2d" builtin="flat" width="60000" height="60000"/></asset>',
             '<asset><hfield name="trap" size="1 1 1 1" nrow="30000" ncol="30000"/></asset>', '<size nconmax="2000000000"/>',
             '<worldbody>' + '<geom size="1"/>' * 10000 + '</worldbody>',
             '<worldbody><body><composite type="grid" count="300 300 1" spacing="0.1"><geom size="0.02"/></composite></body></worldbody>'],
    ".obj": ["mtllib fifo\n", "mtllib /dev/zero\n", "f 1 2 3\n" * 100000, "usemtl x\nmap_Kd fifo\n"],
}


def with_trap(text, suffix, rng):
    at = text.rfind("</mujoco>") if suffix == ".xml" else text.find("\n") + 1
    return text[:at] + rng.choice(TRAPS[suffix]) + text[at:]


def text_kind(files, suffix, command):
    def make(inputs, folder, rng):
        path = folder / ("input" + suffix)
        text = rng.choice(files).read_text(encoding="latin-1")
        if suffix in TRAPS and rng.random() < 0.2:
            text = with_trap(text, suffix, rng)
        else:
            text = mutated_text(text, rng)
        path.write_bytes(text.encode("latin-1", "replace"))
        return path, command(path, rng)
    return make


def bytes_kind(files, command):
    def make(inputs, folder, rng):
        source = rng.choice(files)
        path = folder / ("input" + source.suffix)
        data = source.read_bytes()
        if source.suffix == ".obj":
            text = data.decode("latin-1")
            text = with_trap(text, ".obj", rng) if rng.random() < 0.2 else mutated_text(text, rng)
            data = text.encode("latin-1", "replace")
        change = mutated_png if source.suffix == ".png" and rng.random() < 0.8 else mutated_bytes
        path.write_bytes(data if source.suffix == ".obj" and rng.random() < 0.7 else change(data, rng))
        return path, command(path, rng)
    return make


def record(inputs, folder, rng):
    path = folder / "input.db"
    shutil.copy(inputs.record, path)
    mutated_database(path, rng)
    return path, rng.choice([
        ["replay", path, "--html", folder / "out.html"], ["export", path, "--mcap", folder / "out.mcap"],
        ["profile", "--from", path], ["plan", "--from", f"{path}:3"]])


def sweep(inputs, folder, rng):
    path = folder / "input.db"
    shutil.copy(inputs.sweep, path)
    mutated_database(path, rng)
    again = ["sweep", "open", "--trials", "4", "--vary", "pad.speed=0.5,1", "--db", path, *SHORT]
    return path, rng.choice([again, ["merge", folder / "out.db", path],
                             ["compare", "--from", path, "--problems", "1", "--backends", "banded", "--repeats", "1"]])


def airframe(inputs, folder, rng):
    vehicle = rng.choice(sorted(VEHICLES.glob("*.airframe.yaml")))
    name = vehicle.name.split(".")[0]
    shutil.copy(VEHICLES / f"{name}.xml", folder / "input.xml")
    path = folder / "input.airframe.yaml"
    path.write_bytes(mutated_text(vehicle.read_text(encoding="latin-1"), rng).encode("latin-1", "replace"))
    return folder / "input.", ["land", "open", "--set", f"vehicle={folder / 'input.xml'}", *SHORT]


def study(inputs, folder, rng):
    """A sound file is refused at its folder, which is not there."""
    files = sorted((ROOT / "evaluation/studies").glob("*.yaml"))
    make = text_kind(files, ".yaml", lambda path, rng: ["study", "run", path, "--out", folder / "out", "--report-only"])
    return None, make(inputs, folder, rng)[1]


def command_line(inputs, folder, rng):
    words = rng.choice([
        ["land", "circle", "--set", "wind.mean=7", "--seed", "7", *SHORT],
        ["sweep", "forest", "--trials", "1", "--vary", "pad.speed=0.5..1", *SHORT],
        ["plan", "--backend", "banded", "--set", "limits.speed=2"], ["check-term", "jerk"], ["list", "backends", "--json"],
        ["merge", str(folder / "m.db"), "a.db", "b.db"], ["study", "run", "x.yaml", "--out", str(folder / "s")],
        ["profile", "open", "--flights", "1", *SHORT], ["fly", "goal", "--set", "go_to.goal=[8, 0, 2]", *SHORT]])
    for _ in range(rng.choice([1, 1, 2, 4])):
        at = rng.randrange(len(words) + 1)
        new = rng.choice(NASTY + ["--set", "--seed", "--help", "a=b", "=", "--db", "land", "pad.speed=", "--jobs=0"]).replace("\0", "")
        what = rng.randrange(3)
        if what == 0 and at < len(words):
            words[at] = mutated_text(words[at], rng).replace("\0", "")
        elif what == 1:
            words.insert(at, new)
        elif at < len(words):
            words[at] = new
    return None, words


def height_field(path, rng):
    return ["land", "open", "--set", f"obstacles.height_fields=[{{file: {path}, size: [9, 9], height: 2, at: [-40, -40, 0]}}]", *SHORT]


def mesh(path, rng):
    return ["land", "open", "--set", f"obstacles.meshes=[{{file: {path}, at: [-60, -60, 0]}}]", *SHORT]


def octomap(path, rng):
    return ["land", "open", "--set", rng.choice([f"obstacles.octomaps=[{{file: {path}, at: [-60, -60, 0]}}]", f"map.prior={path}"]), *SHORT]


KINDS = {
    "scenario": text_kind(sorted((ROOT / "evaluation/scenarios").glob("*.yaml")) + sorted(WORLDS.glob("*.yaml")), ".yaml",
                          lambda path, rng: ["fly", path, *SHORT]),
    "airframe": airframe,
    "study": study,
    "record": record,
    "sweep": sweep,
    "octomap": bytes_kind(sorted(WORLDS.glob("*.bt")), octomap),
    "mesh": bytes_kind([WORLDS / "courtyard.obj"], mesh),
    "png": bytes_kind([WORLDS / "hills.png"], height_field),
    "waypoints": text_kind([ROOT / "docs/examples/waypoints.csv"], ".csv",
                           lambda path, rng: ["land", "open", "--set", "pad.motion=waypoints", "--set", f"pad.waypoints={path}", *SHORT]),
    "mjcf": text_kind(sorted(VEHICLES.glob("*.xml")) + [ROOT / "sim/models/mini.xml"], ".xml",
                      lambda path, rng: ["land", "open", "--set", f"vehicle={path}", *SHORT]),
    "command line": command_line,
}


def limited():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def fault_of(command, path):
    """The fault of one run; none: it is as it must be."""
    begin = time.monotonic()
    try:
        done = subprocess.run([PROGRAM, *map(str, command)], cwd=ROOT, capture_output=True, timeout=TIME, preexec_fn=limited,
                              stdin=subprocess.DEVNULL, check=False)
    except subprocess.TimeoutExpired:
        return "hangs", TIME, None
    took = time.monotonic() - begin
    err = done.stderr.decode("utf-8", "replace")
    lines = [line for line in err.splitlines() if not NOTE.search(line) and line.strip()]
    if done.returncode not in (0, 1, 2):
        return f"ends with {done.returncode}: {err[-200:]}", took, done.returncode
    if RAW.search(err):
        return f"raw: {err[-200:]}", took, done.returncode
    if done.returncode == 1 and any(line.startswith("touchdown: ") for line in lines):
        return f"calls the input a fault of its own: {err[-200:]}", took, 1
    if done.returncode == 2:
        if len(lines) != 1:
            return f"{len(lines)} lines: {err[-300:]}", took, 2
        if path is not None and str(path) not in err and path.name not in err:
            return f"does not name the file: {err[-200:]}", took, 2
    return None, took, done.returncode


def run_one(kind, number, seed, inputs, keep):
    rng = random.Random(f"{seed} {kind} {number}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        os.mkfifo(folder / "fifo")
        path, command = KINDS[kind](inputs, folder, rng)
        fault, took, status = fault_of(command, path)
        if fault and keep:
            (folder / "fifo").unlink()
            shutil.copytree(folder, Path(keep) / f"{kind.replace(' ', '_')}_{number}", dirs_exist_ok=True)
        return number, fault, took, status, " ".join(map(str, command))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(KINDS))
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", help="a folder for the inputs of findings")
    arguments = parser.parse_args()
    findings = 0
    with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        inputs = Inputs(Path(name))
        print(f"{'kind':14}{'inputs':>8}{'taken':>8}{'refused':>8}{'findings':>9}{'longest':>9}", flush=True)
        for kind in arguments.kinds or KINDS:
            runs = list(pool.map(lambda number, kind=kind: run_one(kind, number, arguments.seed, inputs, arguments.keep),
                                 range(arguments.count)))
            faults = [run for run in runs if run[1]]
            findings += len(faults)
            print(f"{kind:14}{len(runs):8}{sum(run[3] in (0, 1) for run in runs):8}{sum(run[3] == 2 for run in runs):8}"
                  f"{len(faults):9}{max(run[2] for run in runs):8.1f}s", flush=True)
            for number, fault, _, _, command in faults[:20]:
                print(f"  {number}: {fault.strip()}\n      touchdown {command[:300]!r}", flush=True)
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
