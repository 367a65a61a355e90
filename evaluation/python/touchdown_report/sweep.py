# SPDX-License-Identifier: BSD-3-Clause
"""The outcome of a sweep over the keys that it varied.

Over lists of values: success and median time to land (two keys: heat maps). Over a key drawn from a range: every
trial's time to land.

    /usr/bin/python3 -m touchdown_report.sweep TRIALS.db OUT.png
"""
import json
import sys
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from touchdown_report import command_line, database  # noqa: E402
from touchdown_report.outcomes import DONE  # noqa: E402
from touchdown_report.style import STYLE, sign  # noqa: E402

SUPPORTED_VERSION = "9"
MOST_LISTS = 2
LANDED, FAILED = "#0072B2", "#D55E00"


class SweepError(Exception):
    """The file is no sweep that can be drawn; the message is one sentence."""


class Cell:
    """The trials with one combination of listed values: `trials`, `succeeded`, and the 95 % interval of
    the rate `low`, `high`. `time` is the median time to land [s] of those that landed, or None."""

    def __init__(self, trials, succeeded, low, high, time):
        self.trials, self.succeeded = trials, succeeded
        self.low, self.high, self.time = low, high, time

    @property
    def rate(self):
        return self.succeeded / self.trials

    def __str__(self):
        return f"{self.succeeded}/{self.trials}\n[{100 * self.low:.0f}, {100 * self.high:.0f}] %"


class Sweep:
    """One file: `manifest`, `lists` {key: values in order}, `ranges` (keys), and for each key `trials(key)`.
    `cells` is {tuple of one value of each list: Cell} as far as trials of them were flown."""

    def __init__(self, path):
        self._path = path
        database.read(path, "sweep", "manifest", SUPPORTED_VERSION, SweepError, self._read)

    def _read(self, db, manifest):
        if manifest.get("format") != "touchdown trials":
            raise SweepError(f"{self._path}: not a sweep.")
        self.manifest = manifest
        keys = db.execute("SELECT key, unit, kind FROM varied_key ORDER BY rowid").fetchall()
        self._units = {key: unit for key, unit, _ in keys}
        self.lists = {key: [] for key, _, kind in keys if kind == "list"}
        self.ranges = [key for key, _, kind in keys if kind == "range"]
        if not keys or len(self.lists) > MOST_LISTS:
            raise SweepError(
                f"{self._path}: the picture of a sweep needs a varied key, and lists of values for two "
                f"at most: here {len(keys)} are varied, {len(self.lists)} of them by a list."
            )
        places = {}
        for cell, key, value in db.execute("SELECT cell, key, value FROM cell_value ORDER BY rowid"):
            places.setdefault(cell, {})[key] = value
            if value not in self.lists[key]:
                self.lists[key].append(value)
        self.cells = {}
        for cell, *figures in db.execute(
            "SELECT cell, trials, succeeded, rate_lo, rate_hi, time_to_land_median_s FROM cell "
            "WHERE trials > 0"
        ):
            place = places.get(cell, {})
            self.cells[tuple(place[key] for key in self.lists)] = Cell(*figures)
        self._trials = {}
        for key, *trial in db.execute(
            "SELECT key, value, time_to_land_s, outcome FROM trial JOIN variation USING(trial) ORDER BY trial"
        ):
            *figures, outcome = trial
            self._trials.setdefault(key, []).append([*figures, outcome in DONE])

    def trials(self, key):
        """Of every trial [value of the key, time to land in s or None, whether it succeeded]."""
        return self._trials.get(key, [])

    def label(self, key):
        unit = self._units[key]
        return f"{key} [{unit}]" if unit else key


def ticks(axis, values):
    """The values as they were written, at 0, 1, …; words lean, so that they do not run together."""
    long = max(len(value) for value in values) > 8
    axis.set_ticks(range(len(values)), labels=values, rotation=25 if long else 0)


def draw_map(axes, sweep, figure_of, text_of, colours, span):
    """A heat map over both lists; a combination that was not flown stays empty."""
    (across, columns), (up, rows) = sweep.lists.items()
    cells = [[sweep.cells.get((x, y)) for x in columns] for y in rows]
    known = [[np.nan if cell is None else figure_of(cell) for cell in row] for row in cells]
    image = axes.imshow(known, origin="lower", aspect="auto", cmap=colours, vmin=span[0], vmax=span[1])
    for j, row in enumerate(cells):
        for i, cell in enumerate(row):
            if cell is None:
                continue
            red, green, blue, _ = image.cmap(image.norm(known[j][i]))
            dark = np.isfinite(known[j][i]) and 0.3 * red + 0.6 * green + 0.1 * blue < 0.5
            axes.text(
                i, j, text_of(cell), ha="center", va="center", fontsize=8, color="white" if dark else "black"
            )
    ticks(axes.xaxis, columns)
    ticks(axes.yaxis, rows)
    axes.set_xlabel(sweep.label(across))
    axes.set_ylabel(sweep.label(up))
    axes.grid(False)
    # White lines between the cells: neighbours of the same colour are still two.
    axes.set_xticks(np.arange(1, len(columns)) - 0.5, minor=True)
    axes.set_yticks(np.arange(1, len(rows)) - 0.5, minor=True)
    axes.grid(True, which="minor", color="white", lw=2)
    axes.set_axisbelow(False)
    axes.tick_params(which="minor", length=0)


def draw_maps(rate, time, sweep):
    draw_map(rate, sweep, lambda cell: cell.rate, str, "Blues", (0.0, 1.0))
    known = [cell.time for cell in sweep.cells.values() if cell.time is not None]
    draw_map(
        time,
        sweep,
        lambda cell: np.nan if cell.time is None else cell.time,
        lambda cell: "none landed" if cell.time is None else f"{cell.time:.2f} s",
        "Oranges",
        (min(known), max(known)) if known else (0.0, 1.0),
    )
    time.set_title("median time to land")


def draw_rates(axes, sweep, values):
    """The rate of each value with its interval."""
    for place, value in enumerate(values):
        cell = sweep.cells.get((value,))
        if cell is None:
            continue
        reach = [[cell.rate - cell.low], [cell.high - cell.rate]]
        axes.errorbar(place, cell.rate, yerr=reach, fmt="o", color=LANDED, capsize=4)
        axes.annotate(
            str(cell), (place, cell.rate), (7, 0), textcoords="offset points", va="center", fontsize=8
        )
    axes.set_ylim(-0.04, 1.04)
    axes.set_ylabel("success rate")


def draw_times(axes, sweep, key, values):
    """Every landing's time over its value, and the median."""
    for place, value in enumerate(values):
        times = [t for v, t, _ in sweep.trials(key) if v == value and t is not None]
        axes.plot([place] * len(times), times, "o", ms=3.5, alpha=0.5, color=LANDED)
        if times:
            median = sweep.cells[value,].time
            axes.plot([place - 0.2, place + 0.2], [median, median], color="black")
            axes.annotate(f"{median:.2f} s", (place + 0.22, median), va="center", fontsize=8)
    axes.set_ylabel("time to land [s]")
    axes.set_title("time to land: trials and median")


def draw_list(rate, time, sweep):
    ((key, values),) = sweep.lists.items()
    draw_rates(rate, sweep, values)
    draw_times(time, sweep, key, values)
    for axes in (rate, time):
        ticks(axes.xaxis, values)
        axes.set_xlim(-0.5, len(values) - 0.3)
        axes.set_xlabel(sweep.label(key))


def draw_cloud(axes, sweep, key):
    """A point for each landing; failures, which have no time, stand along the upper edge."""
    trials = [(float(value), time, good) for value, time, good in sweep.trials(key)]
    landed = [(value, time) for value, time, _ in trials if time is not None]
    failed = [value for value, _, good in trials if not good]
    points = np.array(landed).T if landed else ([], [])
    axes.plot(*points, "o", ms=4, color=LANDED, label=f"{len(landed)} landed")
    axes.plot(
        failed,
        [0.95] * len(failed),
        "x",
        color=FAILED,
        label=f"{len(failed)} failed: no time",
        transform=axes.get_xaxis_transform(),
    )
    axes.margins(y=0.15)
    axes.set_xlabel(sweep.label(key))
    axes.set_ylabel("time to land [s]")
    axes.set_title(f"time to land over {key}")
    axes.legend(loc="lower right", fontsize=7.5)


def headline(sweep):
    manifest = sweep.manifest
    cells = sweep.cells.values()
    flown = sum(c.trials for c in cells)
    counts = f"{sum(c.succeeded for c in cells)} of {flown} trials succeeded"
    if flown < int(manifest["trials"]):
        counts += f" ({manifest['trials']} planned)"
    if () in sweep.cells:
        counts += f", 95 % {str(sweep.cells[()]).splitlines()[1]}"
    settings = " ".join(json.loads(manifest["set"])) or "as shipped"
    return (
        f"{manifest['scenario']}: {counts}",
        f"95 % Clopper-Pearson intervals  ·  sweep seed {manifest['sweep_seed']}  ·  {settings}  ·  "
        f"{manifest['cpu']}  ·  build {manifest['build_type']}, revision {manifest['revision']}",
    )


def figure_of(sweep):
    """The matplotlib figure: panels of rate and time over the lists, then one panel for each range."""
    with plt.rc_context(STYLE):
        lists = 2 if sweep.lists else 0
        panels = lists + len(sweep.ranges)
        across = min(2, panels)
        down = -(-panels // across)
        widest = max([len(values) for values in sweep.lists.values()] or [0])
        width = across * max(5.4, 1.2 + 0.95 * widest)
        figure, axes = plt.subplots(
            down, across, figsize=(width, 0.9 + 3.8 * down), squeeze=False, layout="constrained"
        )
        axes = list(axes.flat)
        if sweep.lists:
            (draw_maps if len(sweep.lists) == 2 else draw_list)(*axes[:2], sweep)
            axes[0].set_title("success: k/n with 95 % interval")
        for panel, key in zip(axes[lists:], sweep.ranges):
            draw_cloud(panel, sweep, key)
        for empty in axes[panels:]:
            empty.axis("off")
        title, provenance = headline(sweep)
        sign(figure, title, textwrap.fill(provenance, int(17 * width)))
        return figure


def draw(sweep, path):
    figure = figure_of(sweep)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def main(arguments):
    """Command line; returns the exit status."""
    return command_line.run(
        arguments,
        "touchdown_report.sweep TRIALS OUT.png",
        lambda source, picture: draw(Sweep(source), picture),
        (SweepError,),
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
