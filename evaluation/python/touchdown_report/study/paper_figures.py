# SPDX-License-Identifier: BSD-3-Clause
"""The paper's figures 4 and 7 to 13 in its layout, from recorded flights: the first trial of each cell."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Rectangle

from touchdown_report.landing import draw_obstacles
from touchdown_report.record import Record
from touchdown_report.study.style import PAGE, legend_above

LOOKS = {
    "vertical": ("#0072B2", "vertical descent"),
    "planned": ("#D55E00", "planned descent"),
    "ego": ("#CC79A7", "EGO-Planner, 5 Hz"),
    "ego_2hz": ("#E69F00", "EGO-Planner, 2 Hz"),
    "pid": ("#009E73", "PID"),
}
PAD = "#2B2B2B"
LANDS_AFTER = {"1": 26.0, "2": 28.0}  # the paper's flights, by case [s]
LAST = 5.0  # of a flight, "near the landing point" [s]


class Flight:
    """A recorded flight until contact, or to its end."""

    def __init__(self, record):
        end = record.contact_index() + 1
        self.t = record.vehicle[:end, 0]
        self.vehicle = record.vehicle[:end, 1:4]
        self.pad = record.pad[:end, 1:4]
        self.obstacles = record.obstacles
        self.landed = bool(record.result["landed"])
        self.half = 0.5 * float(record.scenario_value("pad", "deck_size") or 1.5)

    @property
    def error(self):
        return self.vehicle - self.pad


def flights(study, cell, methods):
    """{method: its recorded flight in `cell`}, of those that are there."""
    paths = {method: study.record_path(cell, method) for method in methods}
    return {method: Flight(Record(path)) for method, path in paths.items() if path}


def _end_mark(axes, x, y, landed, colour):
    mark, size = ("*", 13) if landed else ("X", 8)
    axes.plot(x, y, mark, ms=size, mfc=colour, mec="white", mew=0.8, zorder=6)


def _limits(panels):
    """Corners that hold every path of all panels: one scale for all."""
    every = [flight for _, found in panels for flight in found.values()]
    points = np.vstack([path[:, :2] for flight in every for path in (flight.vehicle, flight.pad)])
    return points.min(axis=0) - 1.5, points.max(axis=0) + 1.5


def _plan_view(axes, found, limits):
    longest = max(found.values(), key=lambda flight: flight.t[-1])
    draw_obstacles(axes, longest.obstacles, False)
    axes.plot(longest.pad[:, 0], longest.pad[:, 1], color=PAD, lw=1.3, ls=(0, (4, 2)), label="landing pad")
    axes.plot(*longest.pad[0, :2], "s", ms=5, mfc="white", mec=PAD)
    for method, flight in found.items():
        colour, title = LOOKS[method]
        axes.plot(flight.vehicle[:, 0], flight.vehicle[:, 1], color=colour, lw=1.7, label=title, zorder=4)
        _end_mark(axes, *flight.vehicle[-1, :2], flight.landed, colour)
    axes.plot(*longest.vehicle[0, :2], "o", ms=5, mfc="white", mec="#333333", zorder=5)
    lo, hi = limits
    axes.set_xlim(lo[0], hi[0])
    axes.set_ylim(lo[1], hi[1])
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x [m]")


def _heights(axes, found):
    longest = max(found.values(), key=lambda flight: flight.t[-1])
    axes.plot(longest.t, longest.pad[:, 2], color=PAD, lw=1.3, ls=(0, (4, 2)))
    for method, flight in found.items():
        axes.plot(flight.t, flight.vehicle[:, 2], color=LOOKS[method][0], lw=1.5)
        _end_mark(axes, flight.t[-1], flight.vehicle[-1, 2], flight.landed, LOOKS[method][0])
    axes.set_xlabel("time [s]")
    axes.set_ylim(bottom=0.0)


def trajectories(panels):
    """Figures 7, 10 and 13: plan views side by side, heights below. `panels`: [(title, flights)]."""
    figure, axes = plt.subplots(
        2,
        len(panels),
        figsize=(PAGE, 6.2),
        squeeze=False,
        layout="constrained",
        gridspec_kw={"height_ratios": [2.6, 1.0]},
    )
    for column, (title, found) in enumerate(panels):
        _plan_view(axes[0, column], found, _limits(panels))
        _heights(axes[1, column], found)
        axes[0, column].set_title(title, fontsize=9)
    axes[0, 0].set_ylabel("y [m]")
    axes[1, 0].set_ylabel("z [m]")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    legend_above(figure, handles, labels)
    return figure


def positions(found):
    """Figures 8 and 11: position of quadrotor and pad over time, a column for each style."""
    figure, axes = plt.subplots(
        3, len(found), figsize=(PAGE, 5.6), squeeze=False, layout="constrained", sharex=True, sharey="row"
    )
    for column, (method, flight) in enumerate(found.items()):
        colour, title = LOOKS[method]
        for row, axis in enumerate("xyz"):
            panel = axes[row, column]
            panel.plot(flight.t, flight.pad[:, row], color=PAD, lw=1.3, ls=(0, (4, 2)), label="landing pad")
            panel.plot(flight.t, flight.vehicle[:, row], color=colour, lw=1.6, label="quadrotor")
            if flight.landed:
                panel.axvline(flight.t[-1], color="#009E73", lw=1.0)
            if column == 0:
                panel.set_ylabel(f"{axis} [m]")
        end = "lands" if flight.landed else "ends"
        axes[0, column].set_title(f"{title}: {end} after {flight.t[-1]:.1f} s", fontsize=9)
        axes[2, column].set_xlabel("time [s]")
        axes[0, column].legend(fontsize=8)
    return figure


def near_landing(found):
    """Figures 9 and 12: the position error over the last seconds. Each style has a column with scales of
    its own, because a straight line in one is the whole approach in the other."""
    figure, axes = plt.subplots(
        3, len(found), figsize=(PAGE, 5.0), squeeze=False, layout="constrained"
    )
    for column, (method, flight) in enumerate(found.items()):
        colour, title = LOOKS[method]
        late = flight.t >= flight.t[-1] - LAST
        for row, label in enumerate(("error in x [m]", "error in y [m]", "height over deck [m]")):
            panel = axes[row, column]
            panel.plot(flight.t[late], flight.error[late, row], color=colour, lw=1.7)
            panel.axhline(0.0, color=PAD, lw=0.9, ls=(0, (4, 2)))
            panel.set_ylabel(label)
        axes[0, column].set_title(f"{title}, last {LAST:g} s before contact", fontsize=9)
        axes[2, column].set_xlabel("time [s]")
    return figure


def following(found):
    """Figure 4: from the side, and the distance behind the pad over time."""
    figure, (side, behind) = plt.subplots(
        2, 1, figsize=(PAGE, 5.6), layout="constrained", gridspec_kw={"height_ratios": [1.0, 1.2]}
    )
    longest = max(found.values(), key=lambda flight: flight.t[-1])
    side.plot(longest.pad[:, 0], longest.pad[:, 2], color=PAD, lw=1.3, ls=(0, (4, 2)), label="landing pad")
    for method, flight in found.items():
        colour, title = LOOKS[method]
        side.plot(flight.vehicle[:, 0], flight.vehicle[:, 2], color=colour, lw=1.6, label=title)
        _end_mark(side, flight.vehicle[-1, 0], flight.vehicle[-1, 2], flight.landed, colour)
        behind.plot(flight.t, -flight.error[:, 0], color=colour, lw=1.6)
        _end_mark(behind, flight.t[-1], -flight.error[-1, 0], flight.landed, colour)
    behind.add_patch(
        Rectangle((0.0, -longest.half), longest.t[-1], 2 * longest.half, fc="#F1EDE4", ec="none", zorder=0)
    )
    behind.axhline(0.0, color=PAD, lw=1.0, ls=(0, (4, 2)))
    behind.axhline(0.5, color="#777777", lw=0.9, ls=":")
    behind.annotate(
        "0.5 m, the paper's", (1.0, 0.5), xycoords=("axes fraction", "data"), xytext=(-4, 3),
        textcoords="offset points", fontsize=8, color="#555555", ha="right",
    )  # fmt: skip
    behind.set_ylim(-1.0, 2.5)
    behind.set_xlabel("time [s]")
    behind.set_ylabel("behind the pad's centre [m]")
    behind.set_title("Distance behind the pad along its way; the deck is shaded", fontsize=9)
    side.set_xlabel("x [m]")
    side.set_ylabel("z [m]")
    side.set_ylim(bottom=0.0)
    side.set_title("From the side", fontsize=9)
    legend_above(figure, *side.get_legend_handles_labels())
    return figure


def _panels(study, cells, methods):
    flown = [cell for cell in cells if cell in study.cells()]
    panels = [(study.cell_title(cell), flights(study, cell, methods)) for cell in flown]
    return [(title, found) for title, found in panels if found]


def figures(study):
    """(name, caption, draw, arguments) of every figure whose flights are recorded."""
    both = ("vertical", "planned")
    note = "★ touchdown, ✕ not landed; dashed: the pad. First trial of each cell."
    found = flights(study, "figure_4", ("ego_2hz", "ego", "pid", *both))
    if found:
        yield "figure_04", f"Figure 4. Behind a pad at 0.8 m/s along x. {note}", following, (found,)
    for case, first in (("1", 7), ("2", 10)):
        panels = _panels(study, [f"case_{case}_sigma_{s}" for s in ("0.01", "0.5", "1.0")], both)
        if panels:
            yield (
                f"figure_{first:02d}",
                f"Figure {first}. Case {case}: trajectories with GPS noise. {note}",
                trajectories,
                (panels,),
            )
        found = flights(study, f"case_{case}_sigma_0.01", both)
        if found:
            yield (
                f"figure_{first + 1:02d}",
                f"Figure {first + 1}. Case {case}: position of quadrotor and pad, σ 0.01 m. The paper lands after "
                f"{LANDS_AFTER[case]:g} s.",
                positions,
                (found,),
            )
            yield (
                f"figure_{first + 2:02d}",
                f"Figure {first + 2}. Case {case}: position error near the landing point, σ 0.01 m.",
                near_landing,
                (found,),
            )
    for case in ("1", "2"):
        panels = _panels(study, [f"case_{case}_wind_{w}" for w in ("4", "7", "11")], both)
        if panels:
            yield (
                f"figure_13_case_{case}",
                f"Figure 13. Case {case}: trajectories in wind. {note}",
                trajectories,
                (panels,),
            )
