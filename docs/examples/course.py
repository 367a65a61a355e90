# SPDX-License-Identifier: BSD-3-Clause
"""Prints a scenario: 500 m among 60 buildings, drawn from a seed. `python3 docs/examples/course.py 1 > out/course.yaml`"""

import random
import sys

LENGTH = 500  # [m]
BUILDINGS = 60


def building(draw):
    """A box beside or on the straight way, 5 m from both ends: x, y, and its sides [m]."""
    while True:
        x, y = draw.uniform(10, LENGTH - 12), draw.uniform(-15, 15)
        size = draw.uniform(3, 12), draw.uniform(3, 16), draw.uniform(3, 25)
        if 5 <= x - size[0] / 2 and x + size[0] / 2 <= LENGTH - 4:
            return x, y, *size


def main(seed):
    draw = random.Random(seed)
    print(f"# Course {seed}: {LENGTH} m among {BUILDINGS} buildings.")
    print("task: go_to\npad: {motion: static, start: [-6, 0]}\nstart: {position: [0, 0, 2]}")
    print(f"go_to: {{goal: [{LENGTH}, 0, 2]}}\ntimeout: 600\nseed: {seed}\nobstacles:\n  boxes:")
    for _ in range(BUILDINGS):
        x, y, *size = building(draw)
        sides = ", ".join(f"{side:.2f}" for side in size)
        print(f"    - {{centre: [{x:.2f}, {y:.2f}], size: [{sides}]}}")


if len(sys.argv) != 2:
    sys.exit("course.py: which seed? For example: python3 docs/examples/course.py 1 > out/course.yaml")
main(int(sys.argv[1]))
