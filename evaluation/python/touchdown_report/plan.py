# SPDX-License-Identifier: BSD-3-Clause
"""The picture of one planning problem and its solution (`touchdown plan --picture`).

Both views have the map, what was known before the flight, guide paths, pairs, the old curve, the new one and those
that lost. Other panels show speed and acceleration against the limits, and cost by iteration.

    /usr/bin/python3 -m touchdown_report.plan PLAN.json OUT.png
"""
import json
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.collections import PatchCollection  # noqa: E402
from matplotlib.patches import Rectangle  # noqa: E402

from touchdown_report import bspline, command_line, prior, zones  # noqa: E402
from touchdown_report.style import STYLE  # noqa: E402

# Okabe and Ito's palette.
NEW, OLD, GUIDE, PAIR, PAD = "#0072B2", "#999999", "#009E73", "#D55E00", "#2B2B2B"
# Of rounds that gave no plan: those that lead around the first obstacle as the plan does, and the others.
SAME_WAY = {"color": "#56B4E9", "lw": 1.3, "ls": (0, (5, 1.5, 1, 1.5)), "label": "lost: another round"}
OTHER_WAY = {"color": "#E69F00", "lw": 1.6, "ls": (0, (1, 1.2)), "label": "lost: another way around"}
PRIOR_REACH = 1.0  # beyond what was flown and the map's cells around it, that is drawn [m]
TERMS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#000000"]
MARKERS = ["o", "s", "^", "v", "D", "x", "+", "*"]


class PlanError(Exception):
    """The file is no document of a plan; the message is one sentence."""


def load(path):
    """The document of `touchdown plan`, with the map's occupied cells."""
    if not os.path.isfile(path):
        raise PlanError(f"{path}: there is no such file.")
    with open(path, encoding="utf-8") as file:
        try:
            plan = json.load(file)
        except ValueError as error:
            raise PlanError(f"{path}: not a document of a plan ({error}).") from error
    if not isinstance(plan, dict) or not {"input", "attempts", "result", "occupied", "prior"} <= set(plan):
        raise PlanError(f"{path}: not a document of a plan.")
    return plan


def best_round(plan):
    """The round that gave the result; None where nothing was solved."""
    attempt = plan["attempts"][-1] if plan["attempts"] else None
    if attempt is None or attempt["best"] is None:
        return None
    return attempt["rounds"][attempt["best"]]


def lost_rounds(plan):
    """(round, whether it took another way around the first obstacle) of each round that gave no plan, in order. A round
    without pairs takes none."""
    won = best_round(plan) if plan["result"]["status"] == "planned" else None
    guide = won["guide"] if won else 0
    return [
        (solve, bool(solve["pairs"]) and solve["guide"] != guide)
        for attempt in plan["attempts"]
        for solve in attempt["rounds"]
        if solve is not won and np.isfinite(np.array(solve["curve"]["control_points"], float)).all()
    ]


def costs_by_iteration(plan):
    """(cost of each term after each iteration of all rounds, shape (n, terms); the terms' names;
    index of the first iteration of each round). Attempts need not have the same terms."""
    solves = [solve for attempt in plan["attempts"] for solve in attempt["rounds"]]
    names = list(dict.fromkeys(name for solve in solves for name in solve["cost_by_term"]))
    rows, starts = [], []
    for solve in solves:
        starts.append(len(rows))
        columns = [names.index(name) for name in solve["cost_by_term"]]
        for iteration in solve["trace"]:
            rows.append(np.zeros(len(names)))
            rows[-1][columns] = iteration["cost_by_term"]
    return np.array(rows).reshape(len(rows), len(names)), names, starts


def draw_cells(axes, plan, down):
    """Columns of occupied cells, seen from above or from the south."""
    cells = np.array(plan["occupied"], dtype=int).reshape(-1, 3)
    seen = np.unique(cells[:, [0, down]], axis=0)
    edge = plan["resolution"]
    squares = [Rectangle((x * edge, y * edge), edge, edge) for x, y in seen]
    axes.add_collection(PatchCollection(squares, facecolor="#DDD8CF", edgecolor="none"))


def flown(plan):
    """What is flown without a newer plan, as pieces (t, points, speed, acceleration). It is the curve, or the curve
    committed before until its stored stop begins, and the stop."""
    result = plan["result"]
    stop = result.get("stop")
    pieces = []
    for curve, until in [(result["curve"], stop["t_stop"] if stop else np.inf)] + (
        [(stop["curve"], np.inf)] if stop else []
    ):
        t, speed, acceleration = bspline.derivative_norms(curve["control_points"], curve["h"], 8)
        keep = curve["t0"] + t <= until
        points = bspline.sample(curve["control_points"], 8)
        pieces.append((curve["t0"] + t[keep], points[keep], speed[keep], acceleration[keep]))
    return pieces


def draw_view(axes, plan, down):
    draw_cells(axes, plan, down)
    zones.draw(
        axes,
        [(z["term"], z["shape"], z["centre_W"], z["size_m"]) for z in plan["zones"]],
        down,
    )
    if plan["prior"]:
        edge = plan["resolution"]
        cells = edge * np.array(plan["occupied"], dtype=int).reshape(-1, 3)
        near = np.vstack([cells, *(points for _, points, _, _ in flown(plan))])
        cubes = {"occupied": np.array(plan["prior"], dtype=int)}
        prior.draw(axes, cubes, edge, near, PRIOR_REACH, down)
    for solve, other_way in lost_rounds(plan):
        curve = bspline.sample(solve["curve"]["control_points"])
        axes.plot(curve[:, 0], curve[:, down], **(OTHER_WAY if other_way else SAME_WAY))
    for path in plan["guide_paths"]:
        points = np.array(path)
        axes.plot(points[:, 0], points[:, down], color=GUIDE, lw=1.2, ls=":", label="guide path")
    old = bspline.sample(plan["input"]["committed"]["control_points"])
    axes.plot(old[:, 0], old[:, down], color=OLD, lw=2.0, ls="--", label="committed before")
    new = np.vstack([points for _, points, _, _ in flown(plan)])
    status = plan["result"]["status"]
    won = "won" if status == "planned" else "flown"
    axes.plot(new[:, 0], new[:, down], color=NEW, lw=2.2, label=f"{won}: {status}")
    solve = best_round(plan)
    if solve and solve["pairs"]:
        p = np.array([pair["p"] for pair in solve["pairs"]])
        v = np.array([pair["v"] for pair in solve["pairs"]])
        axes.quiver(
            *(p[:, 0], p[:, down], v[:, 0], v[:, down]),
            **{"color": PAIR, "angles": "xy", "scale_units": "xy", "scale": 2.5, "width": 0.003},
            label="half-spaces {p, v}",
            zorder=4,
        )
    if plan["input"]["pad"]:
        pad = np.array([state["p_WP"] for state in plan["input"]["pad"]])
        axes.plot(pad[:, 0], pad[:, down], color=PAD, lw=1.2, label="predicted pad")
        axes.plot(*pad[-1, [0, down]], "s", ms=6, mfc="white", mec=PAD)
    vehicle = plan["input"]["p_WB"]
    axes.plot(vehicle[0], vehicle[down], "o", ms=6, mfc="white", mec="#333333")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]" if down == 1 else "z [m]")


def draw_profiles(axes, plan):
    limits = plan["input"]["limits"]
    t, _, speed, acceleration = (np.concatenate(column) for column in zip(*flown(plan)))
    dashes = (0, (4, 1.5))
    axes.plot(t, speed, color=NEW, label="speed [m/s]")
    axes.plot(t, acceleration, color=PAIR, ls=dashes, label="acceleration [m/s²]")
    axes.axhline(limits["speed_mps"], color=NEW, lw=0.8)
    axes.axhline(limits["acceleration_mps2"], color=PAIR, lw=0.8, ls=dashes)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("t [s]")
    axes.set_title("speed and acceleration, limits thin")
    axes.legend(frameon=False)


def draw_costs(axes, plan):
    axes.set_title("cost by iteration, rounds divided")
    axes.set_xlabel("iteration of all rounds")
    costs, names, starts = costs_by_iteration(plan)
    if len(costs) == 0:
        axes.text(0.5, 0.5, "nothing was solved", ha="center", transform=axes.transAxes)
        return
    x = np.arange(1, len(costs) + 1)
    shown = [i for i in range(costs.shape[1]) if costs[:, i].max() > 0.0]
    for i in shown:
        values = np.where(costs[:, i] > 0.0, costs[:, i], np.nan)
        look = i % len(TERMS)
        axes.plot(x, values, marker=MARKERS[look], ms=4, color=TERMS[look], label=names[i])
    axes.plot(x, costs.sum(axis=1), color="#333333", lw=1.0, ls="--", label="all")
    for start in starts[1:]:
        axes.axvline(start + 0.5, color="#BBBBBB", lw=0.8)
    axes.set_yscale("log")
    axes.legend(frameon=False, fontsize=8)


def draw(plan, path):
    result = plan["result"]
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, 2, figsize=(12.0, 8.0), layout="constrained")
        draw_view(axes[0, 0], plan, 1)
        axes[0, 0].set_title("plan view")
        draw_view(axes[0, 1], plan, 2)
        axes[0, 1].set_title("side view from the south")
        handles = dict(zip(*reversed(axes[0, 0].get_legend_handles_labels())))
        for entry in prior.legend_entries(["occupied"] if plan["prior"] else []):
            handles[entry.get_label()] = entry
        axes[0, 0].legend(handles.values(), handles.keys(), frameon=False, fontsize=8)
        draw_profiles(axes[1, 0], plan)
        draw_costs(axes[1, 1], plan)
        reason = "" if result["reason"] == "none" else f" ({result['reason']})"
        figure.suptitle(
            f"{plan['source']}, backend {plan['backend']}: {result['status']}{reason}, "
            f"{result['solves']} solves",
            **{"x": 0.01, "ha": "left", "fontsize": 11, "fontweight": "bold"},
        )
        figure.savefig(path, dpi=150)
        plt.close(figure)


def main(arguments):
    """Command line; returns the exit status."""
    return command_line.run(
        arguments,
        "touchdown_report.plan PLAN.json OUT.png",
        lambda source, picture: draw(load(source), picture),
        (PlanError,),
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
