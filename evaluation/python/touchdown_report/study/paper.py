# SPDX-License-Identifier: BSD-3-Clause
"""The paper's numbers beside ours, and its figures flown again.

The paper: J. Guo, X. Dong, Y. Gao, D. Li, Z. Tu, "Simultaneous Obstacles Avoidance and Robust Autonomous
Landing of a UAV on a Moving Vehicle", Electronics 11(19) 3110, 2022. It shows single flights.
"""
import numpy as np

from touchdown_report.record import Record
from touchdown_report.study import paper_figures, statistics
from touchdown_report.study.texts import interval, number, of

STYLES = ("vertical", "planned")  # the paper's own first
BASELINES = ("ego_2hz", "ego", "ego_10hz", "ego_velocity")
TIMES = {"case_1_sigma_0.01": 26.0, "case_2_sigma_0.01": 28.0}  # [s]
WINDS = {"0.3": (0.226, 0.263), "4": (0.241, 0.340), "7": (0.380, 0.427), "11": (0.394, 0.489)}  # x, y [m]
SIGMAS = ("0.01", "0.5", "1.0")
FOLLOWS_BEHIND = 0.5  # [m]
COLUMNS = ("result", "paper", "ours, vertical descent", "ours, planned descent", "verdict")


def _flown(study, cell, method):
    return (cell, method) in study.parts()


def _estimate(study, cell, method, column):
    trials = study.part(cell, method)
    return statistics.bootstrap(trials.loc[trials["landed"], column])


def _below(estimate, figure):
    """Whether our interval lies below the paper's figure."""
    if not np.isfinite(estimate.value):
        return "not shown: none landed"
    if not np.isfinite(estimate.hi):
        return "too few trials"
    if estimate.hi < figure:
        return "better"
    return "worse" if estimate.lo > figure else "not shown"


def _landed(study, cell, method):
    if not _flown(study, cell, method):
        return "–"
    landed = study.part(cell, method)["landed"]
    return of(int(landed.sum()), statistics.rate(int(landed.sum()), len(landed)))


def _measured(study, cell, column, digits, note):
    """A figure of both styles with n."""
    texts = []
    for method in STYLES:
        if not _flown(study, cell, method):
            texts.append("–")
            continue
        estimate = _estimate(study, cell, method, column)
        texts.append(f"{interval(estimate, digits)} (n {estimate.n}){note.get(method, '')}")
    return texts


def number_rows(study):
    """Every number of the paper beside ours: rows of COLUMNS."""
    rows = []
    for case in ("1", "2"):
        for sigma in SIGMAS:
            cell = f"case_{case}_sigma_{sigma}"
            if not _flown(study, cell, "vertical"):
                continue
            rates = [study.part(cell, m)["landed"] for m in STYLES if _flown(study, cell, m)]
            rows.append(
                [
                    f"case {case}, σ {sigma} m: lands",
                    "1 flight shown",
                    *(_landed(study, cell, method) for method in STYLES),
                    "reproduced" if all(r.all() for r in rates) else "lands in most" if all(
                        r.mean() > 0.5 for r in rates
                    ) else "not reproduced",
                ]
            )
    for cell, paper in TIMES.items():
        if not _flown(study, cell, "vertical"):
            continue
        rows.append(
            [
                f"case {cell[5]}, time to land [s]",
                f"{paper:g}",
                *_measured(study, cell, "time_to_land_s", 1, {}),
                _below(_estimate(study, cell, "vertical", "time_to_land_s"), paper),
            ]
        )
    for wind, errors in WINDS.items():
        for case in ("1", "2"):
            cell = f"case_{case}_wind_{wind}"
            if not _flown(study, cell, "vertical"):
                continue
            for axis, error in zip("xy", errors):
                column = f"mean_abs_error_{axis}_m"
                rows.append(
                    [
                        f"Table 1, wind {wind} m/s, mean error in {axis} [m], case {case}",
                        f"{error:.3f}",
                        *_measured(study, cell, column, 3, {"planned": " †"}),
                        _below(_estimate(study, cell, "vertical", column), error),
                    ]
                )
    return rows


def baseline_rows(study):
    """Figure 4 as found: does a baseline land, and how far behind does it follow."""
    rows = []
    for method in study.methods():
        if not _flown(study, "figure_4", method):
            continue
        trials = study.part("figure_4", method)
        ends = trials["outcome"].value_counts()
        behind = "–"
        if _flown(study, "figure_4_following", method):
            estimate = statistics.bootstrap(
                study.part("figure_4_following", method)["following_mean_error_m"]
            )
            behind = f"{interval(estimate)} (n {estimate.n})"
        rows.append(
            [
                study.method_title(method),
                _landed(study, "figure_4", method),
                ", ".join(f"{count} {name}" for name, count in ends.items() if name != "landed") or "–",
                behind,
            ]
        )
    return rows


def approach_rows(study):
    """When the recorded flights are first within 0.5 m of the pad, horizontally."""
    rows = []
    for case, paper in (("1", "10 s"), ("2", "15 s")):
        texts = []
        for method in STYLES:
            path = study.record_path(f"case_{case}_sigma_0.01", method)
            if path is None:
                texts.append("–")
                continue
            record = Record(path)
            near = np.hypot(*(record.vehicle[:, 1:3] - record.pad[:, 1:3]).T) < 0.5
            texts.append(f"{number(record.vehicle[near.argmax(), 0], 1)} s" if near.any() else "never")
        rows.append([f"case {case}", paper, *texts])
    return rows


def write(study, document, gallery, parts, comparisons):
    """The paper's chapters."""
    document.heading(2, "The paper's numbers beside ours")
    document.text(
        "The paper shows one flight for each number and names no interval. Ours are medians over n landed "
        "flights with 95 % bootstrap intervals, and rates with 95 % Clopper-Pearson intervals; n says how much "
        "they show. The paper's own style is the vertical descent: verdicts are about it. Better: the whole interval "
        "lies below the paper's number; worse: above it; not shown: the interval holds it."
    )
    document.table(COLUMNS, number_rows(study))
    document.text(
        "† Five seconds before contact a planned descent is still on its way to the pad, so that this error "
        "compares with nothing; it stands here for completeness."
    )
    document.heading(3, "Approach")
    document.text("First within 0.5 m of the pad's centre, horizontally; one recorded flight each, as in the paper.")
    document.table(["", "paper", "ours, vertical descent", "ours, planned descent"], approach_rows(study))
    document.heading(2, "Figure 4: what the baselines do behind a pad at 0.8 m/s")
    document.text(
        f"The paper: the baseline follows about {FOLLOWS_BEHIND} m behind and does not land. Here, as found; the "
        "distance is the mean horizontal one over the last 10 s of flights that only follow, above the pad."
    )
    document.table(["method", "landed", "how the others ended", "follows behind by [m]"], baseline_rows(study))
    for name, caption, draw, arguments in paper_figures.figures(study):
        document.picture(gallery.keep(name, draw, *arguments), caption)
