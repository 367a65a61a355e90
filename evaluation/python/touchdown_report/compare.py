# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of a comparison of solver backends (docs/compare.md).

They show the performance profile (Dolan and Moré, 2002), the distribution of the time to the gap, and the
time per iteration over the number of control points.

    /usr/bin/python3 -m touchdown_report.compare COMPARISON.db OUT.png
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from touchdown_report import command_line, database  # noqa: E402
from touchdown_report.style import STYLE, made_with, sign  # noqa: E402

SUPPORTED_VERSION = "3"
# A line style for each backend: colour alone does not tell ten of them apart.
COLOURS = ["#000000", "#E69F00", "#56B4E9", "#009E73", "#D55E00", "#0072B2", "#CC79A7", "#999999"]
DASHES = ["-", "--", ":", "-."]
LEAST = 5  # problems of a size whose median is drawn
# Beside the axes: curves fill all of them.
LEGEND = {"fontsize": 7.5, "loc": "center left", "bbox_to_anchor": (1.0, 0.5), "frameon": False}


class CompareError(Exception):
    """The file is no comparison that this package can read; the message is one sentence."""


class Comparison:
    """One file: `manifest` (dict), `backends` in order, `timed` (problems that were), what was asked
    of how many problems, and times."""

    def __init__(self, path):
        database.read(path, "comparison", "manifest", SUPPORTED_VERSION, CompareError, self._read)

    def _read(self, db, manifest):
        self.manifest = manifest
        self.backends = [name for name, in db.execute("SELECT backend FROM summary ORDER BY rowid")]
        rated = "reference_cost IS NOT NULL AND NOT standing"
        (self.timed,) = db.execute(f"SELECT COUNT(*) FROM problem WHERE {rated}").fetchone()
        self.problems, self.free, self.hard, self.explicit, self.flights = db.execute(
            "SELECT COUNT(*), SUM(free_arrival), SUM(hard_limits), SUM(explicit_endpoint), "
            "(SELECT COUNT(*) FROM flight) FROM problem"
        ).fetchone()
        self._gap = db.execute(
            "SELECT problem, backend, CASE reached WHEN 1 THEN time_cpu_ms END "
            "FROM solve WHERE phase = 'gap'"
        ).fetchall()
        self._tight = db.execute(
            "SELECT points, backend, time_cpu_ms / iterations FROM solve JOIN problem USING(problem) "
            "WHERE phase = 'tight' AND iterations > 0 AND reference_cost IS NOT NULL"
        ).fetchall()

    def times(self):
        """Milliseconds to the gap: {backend: {problem: ms}}, the median of the repeats, infinite
        where the problem was not solved. Problems that a backend was not run on are left out."""
        repeats = {name: {} for name in self.backends}
        for problem, backend, ms in self._gap:
            repeats[backend].setdefault(problem, []).append(np.inf if ms is None else ms)
        return {name: {k: middle(v) for k, v in runs.items()} for name, runs in repeats.items()}

    def per_iteration(self, backend):
        """Median milliseconds per iteration of the tight solves: {points: ms}."""
        times = {}
        for size, name, ms in self._tight:
            if name == backend:
                times.setdefault(size, []).append(ms)
        return {size: float(np.median(times[size])) for size in sorted(times) if len(times[size]) >= LEAST}


def middle(values):
    """The median; infinite if one of the two middle values is infinite."""
    low, high = (np.quantile(values, 0.5, method=m) for m in ("lower", "higher"))
    return float(low if low == high else (low + high) / 2)


def steps(values, count):
    """The distribution function of the finite values: (values in order, fraction of `count`)."""
    values = np.sort(np.asarray(values, dtype=float))
    solved = values[np.isfinite(values)]
    return solved, np.arange(1, len(solved) + 1) / max(1, count)


def profile(times, count):
    """Dolan and Moré: {backend: (ratios, fractions)}, the fraction of `count` problems that a
    backend solves within `ratio` times the fastest backend's time. Problems that none solved count,
    and one that a backend was not run on counts as not solved by it."""
    best = {}
    for runs in times.values():
        for problem, ms in runs.items():
            best[problem] = min(ms, best.get(problem, np.inf))
    return {
        backend: steps([ms / best[k] if np.isfinite(ms) else np.inf for k, ms in runs.items()], count)
        for backend, runs in times.items()
    }


def ecdf(times, count):
    """{backend: (milliseconds, fraction of `count` problems solved by then)}."""
    return {backend: steps(list(runs.values()), count) for backend, runs in times.items()}


def looks(backends):
    """Colour and dashes of each backend."""
    return {
        name: {"color": COLOURS[i % len(COLOURS)], "ls": DASHES[i // len(COLOURS) % len(DASHES)]}
        for i, name in enumerate(backends)
    }


def label_of(backend, solved, run, count):
    """The legend distinguishes problems that a backend was not run on from problems that it failed on."""
    return f"{backend} ({solved} of {count}{'' if run == count else f'; {run} of {count} run'})"


def draw_steps(axes, curves, styles, runs, count):
    """Step curves on a logarithmic axis, each drawn on to the right edge."""
    right = max([x[-1] for x, _ in curves.values() if len(x)] or [10.0]) * 1.3
    for backend, (x, y) in curves.items():
        if len(x) == 0:
            axes.plot([], [], label=label_of(backend, 0, runs[backend], count), **styles[backend])
            continue
        axes.step(
            np.concatenate([[x[0]], x, [right]]),
            np.concatenate([[0.0], y, [y[-1]]]),
            where="post",
            lw=1.6,
            label=label_of(backend, len(x), runs[backend], count),
            **styles[backend],
        )
    axes.set_xscale("log")
    axes.set_ylim(0.0, 1.02)


def draw_times(row, comparison, styles):
    times = comparison.times()
    count = comparison.timed
    runs = {backend: len(of_backend) for backend, of_backend in times.items()}
    draw_steps(row[0], profile(times, count), styles, runs, count)
    row[0].set_title("performance profile")
    row[0].set_xlabel("time / fastest backend's time on the same problem")
    row[0].set_ylabel("fraction of problems solved")
    draw_steps(row[1], ecdf(times, count), styles, runs, count)
    row[1].set_title("time to the gap")
    row[1].set_xlabel("thread CPU time [ms]")
    row[1].legend(**LEGEND)


def draw_scaling(axes, beside, comparison, styles):
    for backend in comparison.backends:
        known = comparison.per_iteration(backend)
        if not known:
            continue
        axes.plot(
            list(known),
            list(known.values()),
            marker="o",
            ms=3,
            lw=1.4,
            label=backend,
            **styles[backend],
        )
    axes.set_xscale("log")
    axes.set_yscale("log")
    sizes = sorted({n for backend in comparison.backends for n in comparison.per_iteration(backend)})
    shown = sizes[:: max(1, len(sizes) // 8)]
    axes.set_xticks(shown, [str(n) for n in shown])
    axes.minorticks_off()
    axes.set_xlabel("control points")
    axes.set_ylabel("thread CPU time per iteration [ms]")
    axes.set_title("scaling, tight solves")
    handles, labels = axes.get_legend_handles_labels()
    beside.axis("off")
    beside.legend(handles, labels, **{**LEGEND, "bbox_to_anchor": (0.0, 0.5)})


def headline(comparison):
    word = {key: value.strip('"') for key, value in comparison.manifest.items()}
    source = word["from"] or f"drawn flights, seed {word['seed']}"
    return (
        f"{comparison.problems} problems as {comparison.flights} flights posed them ({source}): free arrival "
        f"{comparison.free}, hard limits {comparison.hard}, "
        f"explicit end {comparison.explicit}; {comparison.timed} timed",
        f"solved: within {float(word['gap']):.0e} of the best known cost and feasible, judged "
        f"outside the solvers  ·  {made_with(word)}",
    )


def draw(comparison, path):
    styles = looks(comparison.backends)
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, 2, figsize=(11.0, 8.1), squeeze=False, layout="constrained")
        draw_times(axes[0], comparison, styles)
        draw_scaling(*axes[1], comparison, styles)
        sign(figure, *headline(comparison))
        figure.savefig(path, dpi=150)
        plt.close(figure)


def main(arguments):
    """Command line; returns the exit status."""
    return command_line.run(
        arguments,
        "touchdown_report.compare COMPARISON OUT.png",
        lambda source, picture: draw(Comparison(source), picture),
        (CompareError,),
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
