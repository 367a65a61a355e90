# SPDX-License-Identifier: BSD-3-Clause
"""The picture of one landing: plan view, side view, approach in the pad's frame, time history.

    /usr/bin/python3 -m touchdown_report.landing RECORD OUT.png
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.collections import PolyCollection  # noqa: E402
from matplotlib.colors import to_rgb  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.patches import Circle, Polygon, Rectangle  # noqa: E402

from touchdown_report import bspline, command_line, prior, zones  # noqa: E402
from touchdown_report.outcomes import DONE  # noqa: E402
from touchdown_report.record import Record, RecordError  # noqa: E402
from touchdown_report.style import STYLE  # noqa: E402

# Okabe and Ito's palette, and dashes: colour and line style of each mode.
MODE_LOOKS = {
    "hovering": ("#999999", (0, (1, 1))),
    "tracking": ("#0072B2", "-"),
    "landing": ("#D55E00", (0, (2.5, 0.7))),
    "disarmed": ("#009E73", (0, (1, 0.5))),
    "hold": ("#E69F00", (0, (1.5, 1.5))),
    "go_around": ("#CC79A7", (0, (5, 1, 1, 1))),
    "emergency_stop": ("#000000", (0, (3, 2))),
}
ANOTHER_LOOK = ("#8C510A", (0, (4, 1.5)))  # of a mode that is not among them
DONE_COLOUR, FAILED_COLOUR = "#009E73", "#D55E00"
LEAST_WIND = 0.05  # that is shown [m/s]
WIND_ARROW = 36.0  # its length [points]
LEAST_WAY = 0.5  # of a path that gets an arrowhead [m]
LEAST_BAND = 0.08  # of the time axis, that has room for a mode's name
PAD_COLOUR = "#2B2B2B"
PLAN_COLOUR = "#56B4E9"
BUILDING_FACE = "#DDD8CF"
BUILDING_EDGE = "#8C857A"
HIGHEST_SHADE = 8.0  # of a mesh from above [m]
PRIOR_REACH = 15.0  # beyond the flight, that is drawn [m]
MOST_IN_A_ROW = 8  # of the legend
MOST_NUMBERED = 40  # obstacles whose height stands in the picture
PICTURE_STYLE = {
    **STYLE,
    "axes.labelcolor": "#333333",
    "xtick.color": "#555555",
    "ytick.color": "#555555",
}


def title_lines(record):
    """Headline with the outcome, and a line with the figures."""
    result = record.result
    what = result["outcome"].replace("_", " ")
    headline = f"{result['scenario']}: {what}"
    figures = []
    if result["landed"]:
        headline += f" after {result['time_to_land_s']:.1f} s"
        touchdown = result["touchdown"]
        speed = np.linalg.norm(touchdown["relative_velocity_mps"])
        figures += [
            f"touchdown error {touchdown['error_m']:.3f} m",
            f"relative speed {speed:.2f} m/s",
        ]
    elif result["outcome"] in DONE:
        headline += f" after {result['simulated_s']:.1f} s"
    if result["min_clearance_m"] is not None:
        figures.append(f"least clearance {result['min_clearance_m']:.2f} m")
    figures += [f"{result['replans']} replans", f"seed {result['seed']}"]
    return headline, "  ·  ".join(figures)


def look_of(mode):
    """Colour and line style of a mode; a record may have one that is not known here."""
    return MODE_LOOKS.get(mode, ANOTHER_LOOK)


def runs_of(modes):
    """(mode, first index, last index) of each stretch of one mode."""
    starts = [i for i, mode in enumerate(modes) if i == 0 or mode != modes[i - 1]]
    return [(modes[i], i, j - 1) for i, j in zip(starts, starts[1:] + [len(modes)])]


def mode_path(axes, x, y, modes, **kwargs):
    """The curve (x, y), each stretch as its mode looks, up to where the next one begins."""
    for mode, first, last in runs_of(modes):
        colour, dashes = look_of(mode)
        piece = slice(first, last + 2)
        axes.plot(x[piece], y[piece], color=colour, ls=dashes, **kwargs)


def arrowhead(axes, x, y, colour):
    """The direction of the curve (x, y) at half its length."""
    lengths = np.append(0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y))))
    if lengths[-1] < LEAST_WAY:
        return
    middle = int(np.searchsorted(lengths, 0.5 * lengths[-1]))
    before = int(np.searchsorted(lengths, 0.5 * lengths[-1] - 0.1))
    axes.annotate(
        "",
        xy=(x[middle], y[middle]),
        xytext=(x[before - 1], y[before - 1]),
        arrowprops={"arrowstyle": "-|>,head_length=0.8,head_width=0.4", "color": colour, "lw": 0.0},
        zorder=5,
    )


def draw_wind(axes, record):
    """The mean wind as an arrow, in the corner that is farthest from the vehicle's way."""
    wind = record.mean_wind()
    speed = float(np.hypot(*wind))
    if speed < LEAST_WIND:
        return
    to_axes = axes.transData + axes.transAxes.inverted()
    way = to_axes.transform(record.vehicle[:, 1:3])
    corners = np.array([(x, y) for x in (0.1, 0.9) for y in (0.12, 0.9)])
    place = max(corners, key=lambda corner: np.hypot(*(way - corner).T).min())
    half = 0.5 * WIND_ARROW / 72.0 * axes.figure.dpi * wind / speed
    middle = axes.transAxes.transform(place)
    tail, head = axes.transAxes.inverted().transform([middle - half, middle + half])
    axes.annotate(
        "",
        xy=head,
        xytext=tail,
        xycoords="axes fraction",
        textcoords="axes fraction",
        arrowprops={"arrowstyle": "-|>,head_length=0.7,head_width=0.35", "color": "#333333", "lw": 2.0},
        zorder=7,
    )
    axes.annotate(
        f"flight's mean wind {speed:.1f} m/s",
        place,
        xycoords="axes fraction",
        xytext=(0.0, -0.5 * WIND_ARROW - 4.0),
        textcoords="offset points",
        **{"ha": "center", "va": "top", "fontsize": 8, "zorder": 7},
        bbox={"fc": "white", "ec": "none", "alpha": 0.8, "pad": 1.0},
    )


def deck_outline(pad_row, half):
    """Corners of the square deck in the world, closed, shape (5, 2)."""
    _, px, py, _, yaw = pad_row
    corners = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1], [1, 1]]) * half
    c, s = np.cos(yaw), np.sin(yaw)
    return corners @ np.array([[c, s], [-s, c]]) + [px, py]


def draw_obstacles(axes, obstacles, side):
    """Outlines from above, or from the south with the nearer ones in front."""
    order = sorted(obstacles, key=lambda o: -o["centre"][1]) if side else obstacles
    numbered = len(obstacles) <= MOST_NUMBERED
    for obstacle in order:
        (cx, cy, cz), (sx, sy, sz) = obstacle["centre"], obstacle["size"]
        look = {"facecolor": BUILDING_FACE, "edgecolor": BUILDING_EDGE, "lw": 0.8, "zorder": 1}
        if side:
            look["alpha"] = 0.45
        if obstacle["kind"] == "mesh":
            draw_surface(axes, obstacle["surface"], side)
        elif obstacle["kind"] == "sphere" or (obstacle["kind"] == "cylinder" and not side):
            axes.add_patch(Circle((cx, cz if side else cy), sx / 2, **look))
        elif side:
            wide = sx
            if obstacle["kind"] == "box":
                wide = abs(sx * np.cos(obstacle["yaw"])) + abs(sy * np.sin(obstacle["yaw"]))
            axes.add_patch(Rectangle((cx - wide / 2, cz - sz / 2), wide, sz, **look))
        else:
            axes.add_patch(
                Rectangle(
                    (cx - sx / 2, cy - sy / 2),
                    sx,
                    sy,
                    angle=np.degrees(obstacle["yaw"]),
                    rotation_point="center",
                    **look,
                )
            )
            if numbered:
                axes.annotate(
                    f"{sz:g} m", (cx, cy), ha="center", va="center", fontsize=7, color=BUILDING_EDGE
                )


def draw_surface(axes, triangles, side):
    """A mesh by its triangles, shape (n, 3, 3); from above the higher ones are darker."""
    if side:
        look = {"facecolor": BUILDING_FACE, "alpha": 0.45}
    else:
        triangles = triangles[np.argsort(triangles[:, :, 2].max(axis=1))]
        share = np.clip(triangles[:, :, 2].mean(axis=1) / HIGHEST_SHADE, 0.0, 1.0)[:, None]
        light, dark = np.array(to_rgb("#F2F0EC")), np.array(to_rgb(BUILDING_EDGE))
        look = {"facecolor": light + share * (dark - light)}
    shapes = triangles[:, :, [0, 2] if side else [0, 1]]
    axes.add_collection(PolyCollection(shapes, edgecolor="none", zorder=1, **look))


def draw_world(axes, record, contact, half, side):
    """Plan view (side=False: x, y) or side view (side=True: x, z)."""
    down = 3 if side else 2
    vehicle, pad = record.vehicle[: contact + 1], record.pad[: contact + 1]
    draw_obstacles(axes, record.obstacles, side)
    edge = float(record.meta["map_resolution"])
    prior.draw(axes, record.prior, edge, record.vehicle[:, 1:4], PRIOR_REACH, down - 1)
    zones.draw(axes, record.zones, down - 1)
    for points in record.plans.values():
        curve = bspline.sample(points)
        axes.plot(curve[:, 0], curve[:, down - 1], color=PLAN_COLOUR, lw=0.6, alpha=0.45, zorder=2)
    axes.plot(pad[:, 1], pad[:, down], color=PAD_COLOUR, lw=1.2, ls=(0, (4, 2)), zorder=5)
    mode_path(axes, vehicle[:, 1], vehicle[:, down], record.modes[: contact + 1], lw=2.4, zorder=4)
    arrowhead(axes, vehicle[:, 1], vehicle[:, down], "#333333")
    arrowhead(axes, pad[:, 1], pad[:, down], PAD_COLOUR)
    axes.plot(*vehicle[0, [1, down]], "o", ms=7, mfc="white", mec="#333333", mew=1.5, zorder=5)
    axes.plot(*pad[0, [1, down]], "s", ms=6, mfc="white", mec=PAD_COLOUR, mew=1.5, zorder=5)
    for index, fill in ((0, "none"), (contact, "#FFFFFF")):
        row = record.pad[index]
        if side:
            axes.plot([row[1] - half, row[1] + half], [row[3], row[3]], color=PAD_COLOUR, lw=2.5)
        else:
            axes.add_patch(
                Polygon(deck_outline(row, half), fc=fill, ec=PAD_COLOUR, lw=1.2, zorder=3)
            )
    if record.result["outcome"] in DONE:
        axes.plot(*vehicle[-1, [1, down]], "*", ms=15, mfc=DONE_COLOUR, mec="white", zorder=6)
    else:
        axes.plot(*vehicle[-1, [1, down]], "X", ms=11, mfc=FAILED_COLOUR, mec="white", zorder=6)


def frame_plan_view(plan, side, record, contact):
    """Limits that hold both paths and the obstacles near them, at one scale in both views."""
    everything = np.vstack([record.vehicle[: contact + 1, 1:3], record.pad[: contact + 1, 1:3]])
    lo, hi = everything.min(axis=0) - 2.0, everything.max(axis=0) + 2.0
    figure_size = plan.figure.get_size_inches()
    width, height = plan.get_position().size * figure_size
    scale = max((hi[0] - lo[0]) / width, (hi[1] - lo[1]) / height)  # metres an inch
    middle = 0.5 * (lo + hi)
    x_limits = middle[0] + 0.5 * scale * width * np.array([-1.0, 1.0])
    plan.set_xlim(x_limits)
    plan.set_ylim(middle[1] + 0.5 * scale * height * np.array([-1.0, 1.0]))
    side.set_xlim(x_limits)
    side.set_ylim(0.0, scale * side.get_position().height * figure_size[1])
    plan.set_ylabel("y [m]")
    side.set_ylabel("z [m]")
    side.set_xlabel("x [m]")
    plan.set_title("Plan view")
    side.set_title("Side view from the south")


def pad_frame(record, contact):
    """Vehicle relative to the pad along the pad's axes, shape (n, 3)."""
    offset = record.vehicle[: contact + 1, 1:4] - record.pad[: contact + 1, 1:4]
    yaw = record.pad[: contact + 1, 4]
    c, s = np.cos(yaw), np.sin(yaw)
    return np.stack(
        [c * offset[:, 0] + s * offset[:, 1], -s * offset[:, 0] + c * offset[:, 1], offset[:, 2]],
        axis=1,
    )


def draw_pad_frame(axes, record, contact, half):
    """The last metres as the deck sees them."""
    relative = pad_frame(record, contact)
    axes.add_patch(Rectangle((-half, -half), 2 * half, 2 * half, fc="#F4F1EC", ec=PAD_COLOUR, lw=1.4))
    axes.add_patch(Rectangle((-0.075, -0.075), 0.15, 0.15, fc="none", ec=PAD_COLOUR, lw=0.8))
    for cx in (-0.36, 0.36):
        for cy in (-0.36, 0.36):
            axes.add_patch(
                Rectangle((cx - 0.2, cy - 0.2), 0.4, 0.4, fc="none", ec="#BBBBBB", lw=0.8)
            )
    mode_path(axes, relative[:, 0], relative[:, 1], record.modes[: contact + 1], lw=2.0)
    done = record.result["outcome"] in DONE
    mark = ("*", 14, DONE_COLOUR) if done else ("X", 10, FAILED_COLOUR)
    axes.plot(*relative[-1, :2], mark[0], ms=mark[1], mfc=mark[2], mec="white", zorder=5)
    axes.set_xlim(-2 * half, 2 * half)
    axes.set_ylim(-2 * half, 2 * half)
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlabel("ahead of the pad's centre [m]")
    axes.set_ylabel("to its left [m]")
    axes.set_title("In the pad's frame")


def draw_history(axes, record, contact):
    """Horizontal distance to the pad and height above it over time, modes as bands."""
    t = record.vehicle[: contact + 1, 0]
    relative = pad_frame(record, contact)
    modes = record.modes[: contact + 1]
    for mode, first, last in runs_of(modes):
        begin, end = t[first], t[min(last + 1, len(t) - 1)]
        axes.axvspan(begin, end, color=look_of(mode)[0], alpha=0.13, lw=0)
        if end - begin > LEAST_BAND * (t[-1] - t[0]):
            axes.text(
                0.5 * (begin + end), 0.98, mode.replace("_", " "), color="#555555", fontsize=7,
                ha="center", va="top", transform=axes.get_xaxis_transform(),
            )  # fmt: skip
    axes.plot(t, np.hypot(relative[:, 0], relative[:, 1]), color="#333333", lw=1.6)
    axes.plot(t, relative[:, 2], color="#333333", lw=1.3, ls=(0, (5, 2)))
    axes.set_xlim(t[0], max(t[-1], t[0] + 0.1))
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("[m]")
    axes.set_title("Distance to the pad")
    axes.legend(
        [Line2D([], [], color="#333333"), Line2D([], [], color="#333333", ls=(0, (5, 2)))],
        ["horizontal", "height"],
        frameon=False,
        loc="center right",
    )


def legend_entries(record, contact):
    """Handles for the states that occurred and for everything else drawn."""
    seen = list(dict.fromkeys(record.modes[: contact + 1]))
    handles = [
        Line2D([], [], color=look_of(m)[0], ls=look_of(m)[1], lw=2.4, label=m.replace("_", " "))
        for m in seen
    ]
    handles += [
        Line2D([], [], color=PAD_COLOUR, lw=1.6, ls=(0, (4, 2)), label="pad vehicle"),
        Line2D([], [], color=PLAN_COLOUR, lw=1.0, label="plans as they were made"),
        Line2D([], [], marker="o", ls="", mfc="white", mec="#333333", mew=1.5, label="start"),
    ]
    if record.result["outcome"] in DONE:
        label = "touchdown" if record.result["landed"] else "done"
        handles.append(
            Line2D([], [], marker="*", ls="", ms=12, mfc=DONE_COLOUR, mec="white", label=label)
        )
    else:
        handles.append(
            Line2D([], [], marker="X", ls="", ms=9, mfc=FAILED_COLOUR, mec="white", label="end, not done")
        )
    return handles + prior.legend_entries(record.prior)


def draw(record, out_path):
    """Draws the picture of `record` to `out_path` (format by its extension)."""
    contact = record.contact_index()
    half = 0.5 * float(record.scenario_value("pad", "deck_size") or 1.5)
    with plt.rc_context(PICTURE_STYLE):
        figure = plt.figure(figsize=(13.0, 8.6), dpi=140)
        grid = figure.add_gridspec(
            2, 2, width_ratios=[1.75, 1.0], height_ratios=[2.5, 1.0],
            left=0.055, right=0.985, bottom=0.105, top=0.885, hspace=0.2, wspace=0.13,
        )  # fmt: skip
        plan, side = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[1, 0])
        close, history = figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1])
        draw_world(plan, record, contact, half, side=False)
        draw_world(side, record, contact, half, side=True)
        frame_plan_view(plan, side, record, contact)
        draw_wind(plan, record)
        draw_pad_frame(close, record, contact, half)
        draw_history(history, record, contact)
        headline, figures = title_lines(record)
        figure.text(0.055, 0.955, headline, fontsize=15, fontweight="bold", color="#222222")
        figure.text(0.055, 0.925, figures, fontsize=10, color="#555555")
        handles = legend_entries(record, contact)
        rows = 1 if len(handles) <= MOST_IN_A_ROW else 2
        figure.legend(
            handles=handles, loc="lower center", ncol=-(-len(handles) // rows), frameon=False,
            bbox_to_anchor=(0.5, 0.008 if rows == 1 else -0.006),
        )  # fmt: skip
        figure.savefig(out_path)
        plt.close(figure)


def main(arguments):
    """Command line; returns the exit status."""
    return command_line.run(
        arguments,
        "touchdown_report.landing RECORD OUT.png",
        lambda source, picture: draw(Record(source), picture),
        (RecordError,),
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
