# SPDX-License-Identifier: BSD-3-Clause
"""Figures that any study has: success, outcomes, time to land, differences to the reference."""
import math
import textwrap

import matplotlib.pyplot as plt
import numpy as np

from touchdown_report.outcomes import DONE
from touchdown_report.study import statistics, tables
from touchdown_report.study.style import PAGE, legend_above, looks, outcome_colour


def _grid(count, across, height, **options):
    """`count` panels, `across` in a row; the figure and the panels."""
    down = math.ceil(count / across)
    figure, axes = plt.subplots(
        down, across, figsize=(PAGE, height * down + 0.7), squeeze=False, layout="constrained", **options
    )
    for empty in axes.flat[count:]:
        empty.axis("off")
    return figure, list(axes.flat[:count])


def success(study, parts):
    """Success rates with their intervals, a panel for each cell."""
    methods = study.methods()
    cells = study.cells()
    figure, panels = _grid(len(cells), min(4, len(cells)), 0.24 * len(methods) + 0.6, sharex=True, sharey=True)
    look = looks(methods)
    for panel, cell in zip(panels, cells):
        for place, method in enumerate(reversed(methods)):
            row = parts[(parts["cell"] == cell) & (parts["method"] == method)]
            if row.empty:
                continue
            row = row.iloc[0]
            share = row["succeeded"] / row["trials"]
            panel.errorbar(
                100 * share,
                place,
                xerr=[[100 * (share - row["rate_lo"])], [100 * (row["rate_hi"] - share)]],
                fmt="o",
                ms=5,
                capsize=3,
                color=look[method]["color"],
            )
        panel.set_title(study.cell_title(cell), fontsize=9)
        panel.set_yticks(range(len(methods)), [study.method_title(m) for m in reversed(methods)], fontsize=8)
        panel.set_xlim(-5, 105)
        panel.set_ylim(-0.6, len(methods) - 0.4)
    figure.supxlabel("succeeded [%], 95 % Clopper-Pearson", fontsize=9)
    return figure


def outcomes(study, counts):
    """How the trials ended, as shares, a panel for each method."""
    methods = study.methods()
    cells = study.cells()
    figure, panels = _grid(len(methods), min(4, len(methods)), 0.2 * len(cells) + 0.6, sharex=True, sharey=True)
    names = [name for name in counts.columns if counts[name].sum() > 0]
    names.sort(key=lambda name: (name not in DONE, -counts[name].sum()))
    for panel, method in zip(panels, methods):
        for place, cell in enumerate(reversed(cells)):
            if (cell, method) not in counts.index:
                continue
            row = counts.loc[(cell, method)]
            left = 0.0
            for name in names:
                width = 100.0 * row[name] / row.sum()
                panel.barh(place, width, left=left, color=outcome_colour(name), height=0.75)
                left += width
        panel.set_title(textwrap.fill(study.method_title(method), 30), fontsize=9)
        panel.set_yticks(range(len(cells)), [study.cell_title(c) for c in reversed(cells)], fontsize=8)
        panel.set_xlim(0, 100)
        panel.grid(False)
    handles = [plt.Rectangle((0, 0), 1, 1, color=outcome_colour(name)) for name in names]
    labels = [name.replace("_", " ") for name in names]
    legend_above(figure, handles, labels, 8)
    figure.supxlabel("share of the trials [%]", fontsize=9)
    return figure


def landing_times(study):
    """Kaplan-Meier curves of the share that has landed, a panel for each cell."""
    methods = study.methods()
    cells = [c for c in study.cells() if study.trials.loc[study.trials["cell"] == c, "landed"].any()]
    figure, panels = _grid(max(1, len(cells)), min(4, max(1, len(cells))), 2.0, sharex=True, sharey=True)
    look = looks(methods)
    drawn = {}
    last = study.trials.loc[study.trials["landed"], "time_to_land_s"].max()
    for panel, cell in zip(panels, cells):
        for method in study.methods(cell):
            trials = study.part(cell, method)
            curve = statistics.time_to_land(
                trials["time_to_land_s"], trials["landed"], trials["horizon_s"]
            )
            (line,) = panel.step(curve.time, curve.landed, where="post", lw=1.5, **look[method])
            if len(trials) >= 10:
                panel.fill_between(
                    curve.time, curve.lo, curve.hi, step="post", alpha=0.13, lw=0, color=look[method]["color"]
                )
            drawn[method] = line
        panel.set_title(study.cell_title(cell), fontsize=9)
        panel.set_ylim(-0.03, 1.03)
        panel.set_xlim(0.0, 1.05 * last if np.isfinite(last) else None)
    names = [m for m in methods if m in drawn]
    if names:
        legend_above(figure, [drawn[m] for m in names], [study.method_title(m) for m in names], 4)
    figure.supxlabel("time [s]", fontsize=9)
    figure.supylabel("share that has landed", fontsize=9)
    return figure


DIFFERENCES = (
    ("time_to_land_s", 1.0, "time to land [s]"),
    ("touchdown_error_m", 100.0, "touchdown error [cm]"),
    ("effort_n2s", 1.0, "effort [N² s]"),
)


def differences(study, comparisons):
    """Paired differences to the reference over all cells, with the cells' own as small marks."""
    methods = [m for m in study.methods() if m != study.reference and (comparisons["method"] == m).any()]
    figure, panels = _grid(len(DIFFERENCES), len(DIFFERENCES), 0.34 * len(methods) + 0.8, sharey=True)
    for panel, (column, scale, label) in zip(panels, DIFFERENCES):
        name = f"difference_{column}"
        for place, method in enumerate(reversed(methods)):
            rows = comparisons[comparisons["method"] == method]
            pooled = rows[rows["cell"] == "all"].iloc[0]
            own = rows.loc[rows["cell"] != "all", name].to_numpy(dtype=float) * scale
            panel.plot(own, np.full(len(own), place - 0.22), "|", ms=6, color="#999999")
            value = pooled[name] * scale
            if not np.isfinite(value):
                panel.annotate(" no pair landed", (0, place), fontsize=7, color="#777777", va="center")
                continue
            lo, hi = pooled[f"{name}_lo"] * scale, pooled[f"{name}_hi"] * scale
            reach = None if not np.isfinite(lo) else [[value - lo], [hi - value]]
            panel.errorbar(value, place, xerr=reach, fmt="o", ms=5, capsize=3, color="#0072B2")
        panel.axvline(0.0, color="#333333", lw=0.8)
        panel.set_yticks(range(len(methods)), [study.method_title(m) for m in reversed(methods)], fontsize=8)
        panel.set_ylim(-0.6, len(methods) - 0.4)
        panel.set_title(f"difference in {label}", fontsize=9)
    figure.supxlabel(
        f"median of the paired differences to {study.method_title(study.reference)}, 95 % bootstrap; "
        "grey marks: single cells",
        fontsize=9,
    )
    return figure
