# SPDX-License-Identifier: BSD-3-Clause
"""How well the pad is predicted by both models of its filter (docs/pad_filter.md).

    /usr/bin/python3 -m touchdown_report.pad_study STUDY.db OUT.png
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from touchdown_report import command_line, database  # noqa: E402
from touchdown_report.style import STYLE  # noqa: E402

SUPPORTED_VERSION = "2"
MODELS = {"paper": "#E69F00", "turn_rate": "#0072B2"}
SOURCES = {"gps": "GPS alone", "tags": "tags seen"}
COURSES = ["straight", "turn"]


class PadStudyError(Exception):
    """The file holds no study of the pad filter; the message is one sentence."""


class PadStudy:
    """One file: `manifest`, `sigmas`, and `cells[scenario, course][sigma, source, model]`. A cell has the root mean
    square of the prediction's error [m], and the ratio of the models with its interval."""

    def __init__(self, path):
        self._path = path
        database.read(path, "pad study", "manifest", SUPPORTED_VERSION, PadStudyError, self._read)

    def _read(self, db, manifest):
        if manifest.get("format") != "touchdown pad study":
            raise PadStudyError(f"{self._path}: not a pad study.")
        self.manifest = manifest
        self.cells = {}
        for scenario, sigma, course, source, model, *figures in db.execute(
            "SELECT scenario, gps_sigma_m, course, source, model, prediction_m, ratio, ratio_lo, "
            "ratio_hi FROM cell ORDER BY rowid"
        ):
            if course in COURSES and source in SOURCES:
                cell = self.cells.setdefault((scenario, course), {})
                cell[sigma, source, model] = figures
        if not self.cells:
            raise PadStudyError(f"{self._path}: the study has no straight and no turn.")
        self.sigmas = sorted({sigma for cell in self.cells.values() for sigma, _, _ in cell})


def draw_cell(axes, cell, sigmas):
    """Bars of both models by GPS and source; over each pair the ratio with its interval."""
    groups = [(s, source) for source in SOURCES for s in sigmas if (s, source, "paper") in cell]
    places = np.arange(len(groups))
    for i, (model, colour) in enumerate(MODELS.items()):
        heights = [cell[(*group, model)][0] for group in groups]
        axes.bar(places + 0.38 * (i - 0.5), heights, 0.36, color=colour, label=model)
    for place, group in zip(places, groups):
        top = max(cell[(*group, model)][0] for model in MODELS)
        _, ratio, low, high = cell[(*group, "turn_rate")]
        axes.text(place, top, f"{ratio:.2f}\n[{low:.2f}, {high:.2f}]", ha="center", va="bottom", fontsize=7)
    axes.set_xticks(places, labels=[f"σ {s:g} m\n{SOURCES[source]}" for s, source in groups], fontsize=7.5)
    axes.margins(y=0.2)
    axes.set_ylabel("error 1.5 s ahead, RMS [m]")


def draw(study, path):
    with plt.rc_context(STYLE):
        count = len(study.cells)
        figure, axes = plt.subplots(
            1, count, figsize=(max(6.0, 4.6 * count), 3.8), layout="constrained", squeeze=False
        )
        for panel, ((scenario, course), cell) in zip(axes.flat, study.cells.items()):
            draw_cell(panel, cell, study.sigmas)
            panel.set_title(f"{scenario}, {course}")
        axes[0, 0].legend(loc="upper left", frameon=False)
        figure.savefig(path, dpi=150)
        plt.close(figure)


def main(arguments):
    """Command line; returns the exit status."""
    return command_line.run(
        arguments,
        "touchdown_report.pad_study STUDY OUT.png",
        lambda source, picture: draw(PadStudy(source), picture),
        (PadStudyError,),
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
