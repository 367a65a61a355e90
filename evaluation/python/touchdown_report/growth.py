# SPDX-License-Identifier: BSD-3-Clause
"""How the time of a replanning step grows (docs/replan_study.md): with the horizon, the clutter, the
map's cells and the pairs that were bound.

    /usr/bin/python3 -m touchdown_report.growth STUDY.db OUT.png
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from touchdown_report import command_line, database  # noqa: E402
from touchdown_report.style import STYLE  # noqa: E402

SUPPORTED_VERSION = "4"
STAGES = ["predict", "check", "search", "pairs", "solve", "certificate"]
COLOURS = ["#999999", "#56B4E9", "#E69F00", "#CC79A7", "#0072B2", "#009E73"]
# Column of table `part`, label of the axis.
VARIED = {
    "horizon_m": "horizon [m]",
    "density_per_m2": "pillars per square metre",
    "resolution_m": "side of a map cell [m]",
}


class GrowthError(Exception):
    """The file holds no growth of replanning times; the message is one sentence."""


class Growth:
    """One file: `manifest`, `usual` (the settings of the steps), and per axis the steps' times.
    `times[name]` is {value: array}, with a step per row, the stages and the total in the columns."""

    def __init__(self, path):
        self._path = path
        database.read(
            path, "replanning study", "manifest", SUPPORTED_VERSION, GrowthError, self._read
        )

    def _read(self, db, manifest):
        self.manifest = manifest
        columns = ", ".join(f"{stage}_wall_ms" for stage in STAGES + ["total"])
        self.times = {}
        pairs = []
        for name in VARIED:
            rows = db.execute(
                f"SELECT {name}, pairs, {columns} FROM step JOIN part USING(part) "
                "WHERE varied = ? ORDER BY part, scene",
                (name,),
            ).fetchall()
            if not rows:
                raise GrowthError(f"{self._path}: the study has no part growth.")
            pairs += [row[1:] for row in rows]
            values = sorted({row[0] for row in rows})
            self.times[name] = {v: np.array([r[2:] for r in rows if r[0] == v]) for v in values}
        self.by_pairs = by_pairs(np.array(pairs))
        self.usual = db.execute(
            "SELECT kind, backend, arrival, limits, guides, seed FROM part WHERE varied = 'horizon_m'"
        ).fetchone()


def by_pairs(rows):
    """Rows (pairs, times ...) in classes of the number of pairs: {(from, to): times}."""
    classes = {}
    low, end = 0, 1
    while low <= rows[:, 0].max(initial=0):
        inside = rows[(rows[:, 0] >= low) & (rows[:, 0] < end), 1:]
        if len(inside):
            classes[(low, end - 1)] = inside
        low, end = end, max(5, 2 * end - 1)
    return classes


def draw_axes(axes, classes, labels):
    """Stacked means of the stages as bars, quantiles of the total over them."""
    places = np.arange(len(classes))
    floor = np.zeros(len(classes))
    for i, stage in enumerate(STAGES):
        mean = np.array([times[:, i].mean() for times in classes])
        axes.bar(places, mean, 0.6, floor, color=COLOURS[i], label=f"{stage}, mean")
        floor += mean
    total = [times[:, -1] for times in classes]
    for quantile, marker in ((0.5, "_"), (0.95, "^"), (0.99, "x")):
        axes.plot(
            places,
            [np.quantile(t, quantile) for t in total],
            ls="none",
            marker=marker,
            ms=9 if marker == "_" else 5,
            mew=2 if marker == "_" else 1.2,
            color="#000000",
            label="total, median" if quantile == 0.5 else f"total, p{quantile * 100:.0f}",
        )
    axes.set_xticks(places, labels=labels)
    axes.set_ylim(0.0, None)
    axes.set_ylabel("wall time [ms]")


def draw(growth, path):
    kind, backend, arrival, limits, guides, seed = growth.usual
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, 2, figsize=(11.0, 7.5), layout="constrained")
        for panel, (name, label) in zip(axes.flat, VARIED.items()):
            times = growth.times[name]
            draw_axes(panel, list(times.values()), [f"{value:g}" for value in times])
            panel.set_xlabel(label)
        classes = growth.by_pairs
        labels = [f"{low}" if low == high else f"{low}–{high}" for low, high in classes]
        counts = [len(times) for times in classes.values()]
        draw_axes(axes[1, 1], list(classes.values()), [f"{a}\n({n})" for a, n in zip(labels, counts)])
        axes[1, 1].set_xlabel("pairs bound (steps)")
        handles, names = axes[0, 0].get_legend_handles_labels()
        axes[0, 0].legend(handles, names, loc="upper left", ncol=2, fontsize=7.5, frameon=False)
        figure.suptitle(
            f"Replanning step in forests of kind {kind}: {backend}, {arrival} arrival, "
            f"{limits} limits, {guides} guide path{'s' if guides > 1 else ''}, seed {seed}",
            x=0.01,
            ha="left",
            fontsize=11,
            fontweight="bold",
        )
        figure.savefig(path, dpi=150)
        plt.close(figure)


def main(arguments):
    """Command line; returns the exit status."""
    return command_line.run(
        arguments,
        "touchdown_report.growth STUDY OUT.png",
        lambda source, picture: draw(Growth(source), picture),
        (GrowthError,),
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
