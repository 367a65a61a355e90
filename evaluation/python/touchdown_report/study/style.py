# SPDX-License-Identifier: BSD-3-Clause
"""How the figures of a report look, and how they are kept: PNG for the report, SVG for a paper."""
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from touchdown_report.style import STYLE  # noqa: E402

# Okabe and Ito's palette, then the same broken.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
DASHES = ["-", (0, (4, 1.5)), (0, (1.2, 1.2))]
OUTCOME_COLOURS = {
    "landed": "#009E73",
    "followed": "#7FCDB4",
    "arrived": "#4DAC26",
    "timeout": "#BBBBBB",
    "stood": "#999933",
    "collision": "#D55E00",
    "tip_over": "#CC79A7",
    "bounced_off": "#E69F00",
    "hard_touchdown": "#8C510A",
    "tilted_touchdown": "#F0E442",
    "lost_pad": "#56B4E9",
    "infeasible": "#0072B2",
    "off_pad": "#B2DF8A",
    "unstable": "#6A3D9A",
    "disarmed_in_air": "#CAB2D6",
    "hung": "#777777",
    "crashed": "#444444",
    "error": "#000000",
}
PAGE = 11.0  # width of a figure [inch]


def looks(names):
    """{name: colour and line style} for a set of methods."""
    return {
        name: {"color": COLOURS[i % len(COLOURS)], "ls": DASHES[i // len(COLOURS) % len(DASHES)]}
        for i, name in enumerate(names)
    }


def outcome_colour(name):
    return OUTCOME_COLOURS[name]


def legend_above(figure, handles, labels, most=6):
    """One legend over all panels."""
    figure.legend(
        handles,
        labels,
        ncol=max(1, min(len(labels), most)),
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        fontsize=8.5,
    )


class Gallery:
    """Draws figures and keeps each as FOLDER/figures/NAME.png and .svg."""

    def __init__(self, folder):
        self._folder = folder
        os.makedirs(os.path.join(folder, "figures"), exist_ok=True)

    def keep(self, name, draw, *arguments):
        """`draw(*arguments)` makes the figure; returns the PNG's path relative to the folder."""
        style = {**STYLE, "svg.hashsalt": name, "svg.fonttype": "none", "legend.frameon": False}
        with plt.rc_context(style):
            figure = draw(*arguments)
            path = os.path.join("figures", name)
            full = os.path.join(self._folder, path)
            figure.savefig(full + ".png", dpi=130, bbox_inches="tight")
            figure.savefig(full + ".svg", bbox_inches="tight", metadata={"Date": None})
            plt.close(figure)
        return path + ".png"
