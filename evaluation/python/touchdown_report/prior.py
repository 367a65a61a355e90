# SPDX-License-Identifier: BSD-3-Clause
"""The occupied cells of a flight's map.prior, and where the flight found it wrong. They are cubes by their state, as in
the record's table `prior`. Each state has a hatch of its own."""
import numpy as np
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.patches import Patch, Rectangle

# Facecolour, edgecolour, hatch and legend entry.
LOOKS = {
    "occupied": ("none", "#8C7BB5", "////", "prior: occupied"),
    "gone": ("#F0E442", "#A89C00", "....", "prior: occupied, seen free"),
    "new": ("#CC79A7", "#9C3D74", "xxxx", "prior: free, seen occupied"),
}


def columns(cubes, down, low, high):
    """Which columns along the axis that is not looked at hold a cube, within [low, high) cells: shape (x, y or z)."""
    seen = np.unique(cubes[:, [0, down, 3]], axis=0)
    filled = np.zeros(high - low, dtype=bool)
    for x, y, side in seen:
        (x0, y0), (x1, y1) = np.clip([[x, y], [x + side, y + side]] - low, 0, high - low)
        filled[x0:x1, y0:y1] = True
    return filled


def rectangles(filled, low, edge):
    """The columns, in runs along x."""
    padded = np.pad(filled.astype(np.int8), ((1, 1), (0, 0)))
    steps = np.diff(padded, axis=0).T  # rows of one y or z
    (rows, begins), (_, ends) = np.nonzero(steps == 1), np.nonzero(steps == -1)
    return [
        Rectangle(((low[0] + x0) * edge, (low[1] + row) * edge), (x1 - x0) * edge, edge)
        for row, x0, x1 in zip(rows, begins, ends)
    ]


def outline(filled, low, edge):
    """The line around them, as its pieces of one cell, shape (n, 2, 2)."""
    padded = np.pad(filled.astype(np.int8), 1)
    across = np.argwhere(np.diff(padded, axis=0)[:, 1:-1] != 0)  # left and right of a cell
    along = np.argwhere(np.diff(padded, axis=1)[1:-1] != 0)
    pieces = [np.stack([at, at + step], axis=1) for at, step in ((across, [0, 1]), (along, [1, 0]))]
    return (np.concatenate(pieces) + low) * edge


def draw(axes, cubes_by_state, edge, way, reach, down):
    """From above (down = 1) or from the south (down = 2), within `reach` of the points of `way`, shape (n, 3)."""
    seen = way[:, [0, down]]
    low = np.floor((seen.min(axis=0) - reach) / edge).astype(int)
    high = np.ceil((seen.max(axis=0) + reach) / edge).astype(int)
    for order, (state, cubes) in enumerate(cubes_by_state.items()):
        face, line, hatch, _ = LOOKS[state]
        filled = columns(cubes, down, low, high)
        axes.add_collection(
            PatchCollection(
                rectangles(filled, low, edge),
                facecolor=face,
                edgecolor=line,
                hatch=hatch,
                lw=0.0,
                alpha=0.8,
                zorder=1.2 + 0.1 * order,
            )
        )
        axes.add_collection(
            LineCollection(outline(filled, low, edge), colors=line, lw=0.8, zorder=1.2 + 0.1 * order)
        )


def legend_entries(cubes_by_state):
    return [
        Patch(fc=face, ec=line, hatch=hatch, lw=0.8, label=label)
        for face, line, hatch, label in map(LOOKS.get, cubes_by_state)
    ]
