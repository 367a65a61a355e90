#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Memory and CPU time of each reader on the largest input that it allows; a table for docs/results/flight_software.

    .ci/largest_inputs.py [FOLDER]    makes the inputs there (0.2 GB); ends with 1 where one takes 4 GB, or a minute

Airframe and study files are read as scenarios are.
"""
import math
import os
import resource
import struct
import subprocess
import sys
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = Path(os.environ.get("TOUCHDOWN_PROGRAM", ROOT / "build/release/bin/touchdown"))
SHORT = ["--set", "timeout=1"]


def million_values(path):
    """4 MiB, a million values: 4 bytes each."""
    path.write_text("description: [" + ",".join(["abc"] * 999_990) + "]\n")
    return ["fly", path]


def waypoints(path):
    lines = ["t,x,y"]
    size = 6
    t = 0
    while size < (16 << 20) - 40:
        lines.append(f"{t / 64:.6f},{t / 128:.6f},0.0")
        size += len(lines[-1]) + 1
        t += 1
    path.write_text("\n".join(lines) + "\n")
    return ["land", "open", "--set", "pad.motion=waypoints", "--set", f"pad.waypoints={path}", *SHORT]


def leaves(depth, per_leaf):
    """The bytes of a full tree in OctoMap's .bt, depth first, and its nodes."""
    last = struct.pack("<H", per_leaf)
    nodes, body = 9, last
    for _ in range(depth - 1):
        body = struct.pack("<H", 0xFFFF) + body * 8
        nodes = 1 + 8 * nodes
    return body, nodes


def deep(body, nodes, levels):
    """The same below `levels` nodes with one child each: small cells."""
    for _ in range(levels):
        body, nodes = struct.pack("<H", 0x0003) + body, nodes + 1
    return body, nodes


def octomap(path, depth, pattern):
    body, nodes = leaves(depth, pattern)
    body, nodes = deep(body, nodes, 16 - depth)
    path.write_bytes(f"# Octomap OcTree binary file\nid OcTree\nsize {nodes}\nres 0.1\ndata\n".encode() + body)


def prior(path):
    """Eight children a node on seven levels, 2.4 million nodes, below a chain of single ones."""
    octomap(path, 7, 0x5556)  # one occupied leaf in eight
    return ["land", "open", "--set", f"map.prior={path}", *SHORT]


def cells(path):
    octomap(path, 7, 0x5556)
    return ["land", "open", "--set", f"obstacles.octomaps=[{{file: {path}, at: [3500, 3500, 3500]}}]", *SHORT]


def mesh(path):
    """A ball of 2 million triangles as text."""
    n, m = 1000, 1000
    with path.open("w") as out:
        out.write("v 0 0 1\n")
        for i in range(1, m):
            for k in range(n):
                a, b = math.pi * i / m, 2 * math.pi * k / n
                out.write(f"v {math.sin(a) * math.cos(b):.9f} {math.sin(a) * math.sin(b):.9f} {math.cos(a):.9f}\n")
        out.write("v 0 0 -1\n")
        for k in range(n):
            out.write(f"f 1 {2 + k} {2 + (k + 1) % n}\n")
        for i in range(m - 2):
            for k in range(n):
                p, q = 2 + i * n + k, 2 + i * n + (k + 1) % n
                out.write(f"f {p} {p + n} {q}\nf {q} {p + n} {q + n}\n")
        last = 2 + (m - 1) * n
        for k in range(n):
            out.write(f"f {last} {last - n + (k + 1) % n} {last - n + k}\n")
    return ["land", "open", "--set", f"obstacles.meshes=[{{file: {path}, at: [-40, -40, 5]}}]", *SHORT]


def heights(path):
    side = 1024
    rows = b"".join(b"\0" + bytes(128 + int(60 * math.sin(i * k / 9000)) for k in range(side)) for i in range(side))
    chunk = lambda kind, body: len(body).to_bytes(4, "big") + kind + body + zlib.crc32(kind + body).to_bytes(4, "big")
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
    return ["land", "open", "--set", f"obstacles.height_fields=[{{file: {path}, size: [60, 60], height: 2, at: [-60, -60, 0]}}]", *SHORT]


def vehicle(path):
    text = (ROOT / "sim/models/quadrotor.xml").read_text()
    many = "".join(f'<geom type="sphere" size="0.01" pos="0 0 {i * 1e-6:.6f}" contype="0" conaffinity="0" mass="0"/>\n' for i in range(3940))
    path.write_text(text.replace("</body>", many + "</body>", 1))
    return ["check-vehicle", path]


def plan(path):
    """A study's plan of brackets alone."""
    path.parent.mkdir(exist_ok=True)
    path.write_text("[" * (4 << 20))
    return ["study", "run", "paper", "--quick", "--out", path.parent]


def trials(path):
    """2,000 trials of a second."""
    subprocess.run([PROGRAM, "sweep", "open", "--trials", "2000", "--set", "timeout=1", "--db", path, "--jobs", "2"], cwd=ROOT,
                   capture_output=True, check=False)
    merged = path.with_suffix(".merged.db")
    merged.unlink(missing_ok=True)
    return ["merge", merged, path]


def record(path):
    """A flight of ten minutes."""
    subprocess.run([PROGRAM, "land", "straight_turn", "--set", "timeout=600", "--set", "camera.drop=1",
                    "--record", path], cwd=ROOT, capture_output=True, check=False)
    return ["replay", path, "--html", path.with_suffix(".html")]


CASES = [("scenario", "big.yaml", million_values), ("waypoints", "way.csv", waypoints), ("map.prior", "prior.bt", prior),
         ("octomap", "cells.bt", cells), ("mesh", "ball.obj", mesh), ("height field", "heights.png", heights),
         ("vehicle", "vehicle.xml", vehicle), ("study's plan", "plan/study.json", plan), ("trials", "trials.db", trials),
         ("record", "record.db", record)]


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/largest")
    folder.mkdir(parents=True, exist_ok=True)
    print("| reader | input [MB] | CPU time [s] | memory [MB] | what it says |\n|---|---|---|---|---|")
    status = 0
    for name, file, make in CASES:
        path = (folder / file).absolute()
        command = make(path)
        child = subprocess.Popen([PROGRAM, *map(str, command)], cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0)))
        said = child.stderr.read().decode("utf-8", "replace")
        _, ended, usage = os.wait4(child.pid, 0)
        took, memory = usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024
        if took > 60.0 or memory > 4000.0 or os.WIFSIGNALED(ended):
            status = 1
        print(f"| {name} | {path.stat().st_size / 1e6:.1f} | {took:.1f} | {memory:.0f} | "
              f"{said.strip().splitlines()[-1][:150] if said.strip() else 'read'} |", flush=True)
    return status


if __name__ == "__main__":
    sys.exit(main())
