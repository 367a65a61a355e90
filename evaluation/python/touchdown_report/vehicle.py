# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a vehicle (`touchdown check-vehicle --picture`), from above and from the right.

It has the hull, feet, rotors and their senses, the axes of the vehicle's frame B and those of its inertia.

    /usr/bin/python3 -m touchdown_report.vehicle VEHICLE.json OUT.png
"""
import json
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.patches import Circle, Polygon, Rectangle  # noqa: E402

from touchdown_report import command_line  # noqa: E402
from touchdown_report.style import STYLE  # noqa: E402

# Okabe and Ito's palette.
LEFT, RIGHT, HULL, FOOT, INERTIA = "#0072B2", "#D55E00", "#999999", "#2B2B2B", "#CC79A7"
AXES = ("#D55E00", "#009E73", "#0072B2")  # of x, y, z
VIEWS = (("from above", 0, 1), ("from the right", 0, 2))


class VehicleError(Exception):
    """The file is no document of a vehicle; the message is one sentence."""


def load(path):
    """The document of `touchdown check-vehicle --json`."""
    if not os.path.isfile(path):
        raise VehicleError(f"{path}: there is no such file.")
    with open(path, encoding="utf-8") as file:
        try:
            document = json.load(file)
        except ValueError as error:
            raise VehicleError(f"{path}: not a document of a vehicle ({error}).") from error
    if not isinstance(document, dict) or not {"file", "model", "outlines", "warnings"} <= set(document):
        raise VehicleError(f"{path}: not a document of a vehicle.")
    if document["model"] is None:
        raise VehicleError(f"{path}: the vehicle has faults, so that there is none to draw.")
    return document


def hull_of(points):
    """Corners of the convex hull of points in the plane, all around (monotone chain)."""
    points = sorted({(round(x, 9), round(y, 9)) for x, y in points})
    if len(points) < 3:
        return points

    def half(ordered):
        chain = []
        for p in ordered:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2:]
                if (bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) > 0:
                    break
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(points) + half(reversed(points))


def draw_rotor(axes, index, rotor, radius, across, up, size):
    """A disc with its sense of rotation, opposite to its reaction torque. From the side it is a line."""
    hub = rotor["p_BR"]
    x, y = hub[across], hub[up]
    turns_left = rotor["moment_B"][2] < 0
    colour = LEFT if turns_left else RIGHT
    if up == 2:
        axes.plot([x - radius, x + radius], [y, y], color=colour, lw=2)
        axes.annotate("", (x, y + 0.35 * size), (x, y), arrowprops={"arrowstyle": "->", "color": colour})
        return
    axes.add_patch(Circle((x, y), radius, fc=colour, alpha=0.15, ec="none"))
    angle = np.linspace(0.3, 5.2, 60) * (1 if turns_left else -1)
    axes.plot(x + 0.7 * radius * np.cos(angle), y + 0.7 * radius * np.sin(angle), color=colour, lw=1.2)
    axes.annotate("", (x + 0.7 * radius * np.cos(angle[-1]), y + 0.7 * radius * np.sin(angle[-1])),
                  (x + 0.7 * radius * np.cos(angle[-2]), y + 0.7 * radius * np.sin(angle[-2])),
                  arrowprops={"arrowstyle": "->", "color": colour})  # fmt: skip
    axes.text(x, y, f"{index}\n{rotor['hover']:.3g} of {rotor['range'][1]:.3g} N", ha="center", va="center", fontsize=7.5)


def draw_view(axes, document, across, up):
    """One view: the horizontal axis of the picture is that of B's axis `across`."""
    model, hull, feet = document["model"], document["model"]["hull"], document["model"]["feet"]
    size = hull["radius"]
    for outline in document["outlines"]:
        corners = hull_of([(p[across], p[up]) for p in outline])
        if len(corners) > 2:
            axes.add_patch(Polygon(corners, fc="#DDDDDD", ec="#BBBBBB", lw=0.5))
    if up == 1:
        axes.add_patch(Circle((0, 0), hull["radius"], fc="none", ec=HULL, ls="--", label="hull"))
    else:
        axes.add_patch(Rectangle((-size, hull["bottom"]), 2 * size, hull["top"] - hull["bottom"], fc="none", ec=HULL,
                                 ls="--", label="hull"))  # fmt: skip
    feet_x = [feet["radius"] * np.cos(a) for a in feet["azimuths"]]
    feet_y = [feet["radius"] * np.sin(a) if up == 1 else feet["bottom"] for a in feet["azimuths"]]
    axes.plot(feet_x, feet_y, "o", color=FOOT, ms=4, label="feet")
    rotors = [(i, a) for i, a in enumerate(model["actuators"]) if a["thrust"] > 0]
    others = [np.linalg.norm(np.subtract(a["p_BR"], b["p_BR"])) for i, a in rotors for j, b in rotors if j > i]
    radius = model["rotor_radius_m"] or 0.45 * min(others, default=0.6 * size)
    for index, rotor in rotors:
        draw_rotor(axes, index, rotor, radius, across, up, size)
    for axis, (name, colour) in enumerate(zip("xyz", AXES)):
        if axis in (across, up):
            tip = (0.5 * size if axis == across else 0, 0.5 * size if axis == up else 0)
            axes.annotate("", tip, (0, 0), arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.6})
            axes.text(*(1.12 * np.array(tip)), name, color=colour, ha="center", va="center")
    for k, axis in enumerate(np.array(model["axes_of_inertia"])):
        end = 0.9 * size * np.array([axis[across], axis[up]])
        axes.plot([-end[0], end[0]], [-end[1], end[1]], color=INERTIA, lw=0.8, ls=":",
                  label="axes of inertia" if k == 0 else None)  # fmt: skip
    reach = max(1.1 * size, *(1.1 * (np.hypot(*a["p_BR"][:2]) + radius) for _, a in rotors))
    low = min(feet["bottom"], hull["bottom"]) - 0.3 * size if up == 2 else -reach
    axes.set(xlim=(-reach, reach), ylim=(low, reach if up == 1 else max(hull["top"] + 0.5 * size, 0.6 * size)),
             aspect="equal", xlabel=f"{'xyz'[across]} [m]", ylabel=f"{'xyz'[up]} [m]")  # fmt: skip


def draw(document, path):
    """Writes the picture."""
    model = document["model"]
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, 2, figsize=(10.5, 5.2), layout="constrained")
        for panel, (title, across, up) in zip(axes, VIEWS):
            draw_view(panel, document, across, up)
            panel.set_title(title)
        axes[1].legend(loc="lower right", fontsize=7.5, frameon=False)
        hover = document["hover"]
        said = f"hover {'held' if hover['held'] else 'not held'}" if hover else "not flown"
        figure.suptitle(f"{os.path.basename(document['file'])}: {model['mass_kg']:.3g} kg, thrust {model['thrust_to_weight']:.2f} "
                        f"times the weight, {said}", x=0.01, ha="left", fontsize=11, fontweight="bold")  # fmt: skip
        lines = [f"warning: {w['what']}" for w in document["warnings"]]
        lines.append("A rotor's number is its place in the file; its thrust in hover, of its greatest. "
                     "Blue turns left, seen from above, orange right.")  # fmt: skip
        if not model["rotor_radius_m"]:
            lines.append("The file does not say how large the discs are: they are drawn for the eye.")
        figure.supxlabel("\n".join(lines), x=0.01, ha="left", fontsize=7.5, color="#555555")
        figure.savefig(path, dpi=130)
        plt.close(figure)


def main(arguments):
    """Command line; returns the exit status."""
    return command_line.run(
        arguments,
        "touchdown_report.vehicle VEHICLE.json OUT.png",
        lambda source, picture: draw(load(source), picture),
        (VehicleError,),
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
