#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the files of the example worlds: building.bt (OctoMap), courtyard.obj (triangle mesh), hills.png (heights),
and of the example beliefs wall_gone.bt and wall_new.bt (OctoMap).

    make_worlds.py FOLDER [SEED]

Standard library and numpy. The same seed gives the same bytes.
"""

import struct
import sys
import zlib
from pathlib import Path

import numpy as np

CELL = 0.1  # of the building [m]
BELIEF_CELL = 0.2  # of the beliefs [m]
FREE, OCCUPIED, INNER = 1, 2, 3  # codes of a child in OctoMap's binary format; 0: not known


def building(rng):
    """Occupied cells, shape (x, y, z), of a house of 16 x 12 m with two floors of 2.9 m and a passage through it.

    Its corner is at the origin. The passage is 3.2 m wide and 2.8 m high, from y = 0 to y = 12. Walls are 0.2 m thick.
    """
    cells = np.zeros((160, 120, 60), dtype=bool)

    def fill(low, high, value=True):
        (x0, y0, z0), (x1, y1, z1) = ((np.asarray(p) / CELL).round().astype(int) for p in (low, high))
        cells[x0:x1, y0:y1, z0:z1] = value

    for base in (0.0, 3.0):  # outer walls, and the ceiling above them
        fill((0, 0, base), (16, 12, base + 2.8))
        fill((0.2, 0.2, base), (15.8, 11.8, base + 2.8), False)
        fill((0, 0, base + 2.8), (16, 12, base + 3.0))
    left = 6.4 + 0.1 * rng.integers(-4, 5)
    for x in (left - 0.2, left + 3.2):  # the passage's walls
        fill((x, 0, 0), (x + 0.2, 12, 2.8))
    fill((left, 0, 0), (left + 3.2, 12, 2.8), False)
    for _ in range(2):  # pillars in it, beside the way through
        y = 0.1 * rng.integers(30, 90)
        x = left + (0.0 if rng.random() < 0.5 else 2.8)
        fill((x, y, 0), (x + 0.4, y + 0.4, 2.8))
    for base in (0.0, 3.0):  # rooms, each with a door
        for x in (0.1 * rng.integers(25, 45), 0.1 * rng.integers(115, 135)):
            fill((x, 0.2, base), (x + 0.2, 11.8, base + 2.8))
            y = 0.1 * rng.integers(20, 90)
            fill((x, y, base), (x + 0.2, y + 1.0, base + 2.1), False)
        for y in (0.0, 11.8):  # windows
            for x in (1.0, 4.0, 11.0, 14.0):
                fill((x, y, base + 0.9), (x + 1.2, y + 0.2, base + 2.1), False)
    return np.where(cells, OCCUPIED, 0)


def belief(walls):
    """A yard of 16 x 12 x 4 m, free except for walls of 3 m height. Each wall is from (x, y) to (x, y) [m]."""
    cells = np.full((80, 60, 20), FREE)
    for low, high in walls:
        (x0, y0), (x1, y1) = ((np.asarray(p) / BELIEF_CELL).round().astype(int) for p in (low, high))
        cells[x0:x1, y0:y1, :15] = OCCUPIED
    return cells


def write_octomap(path, cells, edge):
    """OctoMap's binary format: two bits to a child, the first bit lowest. `cells[x, y, z]`, from the origin on: 0 unknown,
    FREE or OCCUPIED; `edge` [m]."""
    count = 0

    def node(low, side):
        """The state of all its cells if they agree, or the bytes of the node."""
        nonlocal count
        x, y, z = low
        part = cells[x : x + side, y : y + side, z : z + side]
        if part.size == 0 or not part.any():
            return 0
        if part.shape == (side,) * 3 and (part == part[0, 0, 0]).all():
            return int(part[0, 0, 0])
        half = side // 2
        kinds, below = 0, b""
        for i in range(8):
            child = node((x + half * (i & 1), y + half * (i >> 1 & 1), z + half * (i >> 2 & 1)), half)
            if child == 0:
                continue
            count += 1
            kinds |= (child if isinstance(child, int) else INNER) << 2 * i
            below += b"" if isinstance(child, int) else child
        return struct.pack("<H", kinds) + below

    root = node((0, 0, 0), 256)
    # The tree's own root spans 65536 cells, whose middle is the origin: eight levels above this one.
    side = 256
    while side < 32768:
        root = struct.pack("<H", INNER) + root
        count, side = count + 1, side * 2
    root = struct.pack("<H", INNER << 14) + root  # the octant of positive coordinates
    count += 2
    head = f"# Octomap OcTree binary file\nid OcTree\nsize {count}\nres {edge}\ndata\n"
    Path(path).write_bytes(head.encode() + root)


class Solids:
    """Closed surfaces, written as one OBJ file."""

    def __init__(self):
        self.corners, self.faces = [], []

    def prism(self, outline, base, top):
        """Upright, over a convex outline against the clock; top: one height, or one for each corner."""
        n, first = len(outline), len(self.corners)
        tops = np.broadcast_to(top, n)
        self.corners += [(x, y, base) for x, y in outline]
        self.corners += [(x, y, z) for (x, y), z in zip(outline, tops)]
        self.faces.append([first + i for i in reversed(range(n))])
        self.faces += [[first + n, first + n + i, first + n + i + 1] for i in range(1, n - 1)]
        for i in range(n):
            j = (i + 1) % n
            self.faces.append([first + i, first + j, first + n + j, first + n + i])

    def box(self, low, high, **kwargs):
        (x0, y0, z0), (x1, y1, z1) = low, high
        self.prism([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], z0, kwargs.get("top", z1))

    def dome(self, centre, radius, rings=8, sides=16):
        """A ball of flat faces."""
        first = len(self.corners)
        for ring in range(1, rings):
            polar = np.pi * ring / rings
            for side in range(sides):
                turn = 2 * np.pi * side / sides
                offset = (np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar))
                self.corners.append(tuple(np.asarray(centre) + radius * np.asarray(offset)))
        top, bottom = len(self.corners), len(self.corners) + 1
        self.corners += [tuple(np.add(centre, (0, 0, z))) for z in (radius, -radius)]
        for side in range(sides):
            after = (side + 1) % sides
            self.faces.append([top, first + side, first + after])
            last = first + (rings - 2) * sides
            self.faces.append([bottom, last + after, last + side])
            for ring in range(rings - 2):
                a, b = first + ring * sides + side, first + ring * sides + after
                self.faces.append([a, a + sides, b + sides, b])

    def write(self, path):
        lines = [f"v {x:.4f} {y:.4f} {z:.4f}" for x, y, z in self.corners]
        lines += ["f " + " ".join(str(i + 1) for i in face) for face in self.faces]
        path.write_text("# made by make_worlds.py\n" + "\n".join(lines) + "\n")


def courtyard(rng):
    """Four wings with pitched roofs about a court of 16 x 16 m, a gate of 4 m in the south, trees in the court."""
    solids = Solids()
    gate = 0.25 * rng.integers(-8, 9)
    ridge = 5.0 + 0.25 * rng.integers(0, 5)
    for x0, x1 in ((-12.0, gate - 2.0), (gate + 2.0, 12.0)):
        solids.box((x0, -12.0, 0.0), (x1, -8.0, 4.0))
    solids.box((gate - 2.0, -12.0, 3.2), (gate + 2.0, -8.0, 4.0))  # the gate's lintel
    solids.box((-12.0, 8.0, 0.0), (12.0, 12.0, 0.0), top=[4.0, 4.0, ridge, ridge])
    solids.box((-12.0, -8.0, 0.0), (-8.0, 8.0, 0.0), top=[ridge, 4.0, 4.0, ridge])
    solids.box((8.0, -8.0, 0.0), (12.0, 8.0, 0.0), top=[4.0, ridge, ridge, 4.0])
    turns = np.arange(8) * np.pi / 4  # the fountain, in the middle of the pad's circle
    solids.prism([(1.2 * np.cos(t), 1.2 * np.sin(t)) for t in turns], 0.0, 0.9)
    solids.dome((0.0, 0.0, 1.6), 0.6)
    for x, y in ((-6.3, -6.3), (6.3, -6.3), (6.3, 6.3), (-6.3, 6.3)):  # trees
        x, y = x + rng.uniform(-0.4, 0.4), y + rng.uniform(-0.4, 0.4)
        solids.prism([(x + 0.15 * np.cos(t), y + 0.15 * np.sin(t)) for t in turns], 0.0, 2.0)
        solids.dome((x, y, 2.6), rng.uniform(0.7, 1.0))
    return solids


def hills(rng, side=129):
    """Heights in [0, 1], shape (side, side), rows from north to south: a valley along x, hills beside it."""
    grid = np.linspace(-1.0, 1.0, side)
    x, y = np.meshgrid(grid, -grid)
    heights = np.zeros((side, side))
    for _ in range(24):
        cx, cy = rng.uniform(-1, 1, 2)
        width = rng.uniform(0.08, 0.25)
        heights += rng.uniform(0.3, 1.0) * np.exp(-((x - cx) ** 2 + (y - cy) ** 2) / (2 * width**2))
    heights /= heights.max()
    valley = np.clip((np.abs(y) - 0.15) / 0.15, 0.0, 1.0)
    return heights * valley**2 * (3 - 2 * valley)


def write_png(path, heights):
    values = (heights * 65535.0).round().astype(">u2")

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + row.tobytes() for row in values)
    size = struct.pack(">IIBBBBB", values.shape[1], values.shape[0], 16, 0, 0, 0, 0)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", size)
        + chunk(b"IDAT", zlib.compress(rows, 9))
        + chunk(b"IEND", b"")
    )


def main(folder, seed=1):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    write_octomap(folder / "building.bt", building(np.random.default_rng([seed, 1])), CELL)
    courtyard(np.random.default_rng([seed, 2])).write(folder / "courtyard.obj")
    write_png(folder / "hills.png", hills(np.random.default_rng([seed, 3])))
    stands = ((5.0, 4.0), (5.2, 8.0))
    write_octomap(folder / "wall_gone.bt", belief([stands, ((8.0, 0.0), (8.2, 6.0))]), BELIEF_CELL)
    write_octomap(folder / "wall_new.bt", belief([stands]), BELIEF_CELL)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__.strip())
    main(sys.argv[1], *map(int, sys.argv[2:]))
