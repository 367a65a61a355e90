# SPDX-License-Identifier: BSD-3-Clause
"""The paper's numbers beside ours, and its figures flown again.

The paper: J. Guo, X. Dong, Y. Gao, D. Li, Z. Tu, "Simultaneous Obstacles Avoidance and Robust Autonomous
Landing of a UAV on a Moving Vehicle", Electronics 11(19) 3110, 2022. It shows single flights.
"""
import numpy as np

from touchdown_report.record import Record
from touchdown_report.study import paper_figures, statistics, tables
from touchdown_report.study.texts import interval, number, of

STYLES = ("vertical", "planned")  # the paper's own first
TIMES = {"case_1_sigma_0.01": paper_figures.LANDS_AFTER["1"], "case_2_sigma_0.01": paper_figures.LANDS_AFTER["2"]}
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
    """Whether our interval lies below the paper's figure, by the rule that `write` states."""
    if np.isnan(estimate.value):
        return "not shown: none landed"
    if np.isnan(estimate.lo) or np.isnan(estimate.hi):
        return "too few trials"
    if estimate.hi < figure:
        return "better"
    return "worse" if estimate.lo > figure else "not shown"


def _lands(trials):
    """Whether it lands, by the rule that `write` states."""
    rate = statistics.rate(int(trials["landed"].sum()), len(trials))
    if rate.lo > 0.5:
        return "reproduced"
    return "not reproduced" if rate.hi < 0.5 else "not shown"


def _landed(study, cell, method):
    if not _flown(study, cell, method):
        return "–"
    landed = study.part(cell, method)["landed"]
    return of(int(landed.sum()), statistics.rate(int(landed.sum()), len(landed)))


def _measured(study, cell, column, digits):
    """A figure of both styles with n, where the style makes it comparable."""
    texts = []
    for method in STYLES:
        if not _flown(study, cell, method) or not study.follows_before_it_sinks(cell, method):
            texts.append("–")
            continue
        estimate = _estimate(study, cell, method, column)
        texts.append(f"{interval(estimate, digits)} (n {estimate.n})")
    return texts


def _survival(study, cell, method):
    trials = study.part(cell, method)
    return statistics.time_to_land(trials["time_to_land_s"], trials["landed"], trials["horizon_s"])


def _half_landed(study, cell, method):
    if not _flown(study, cell, method):
        return "–"
    half = _survival(study, cell, method).median
    return f"{interval(half, 1)} (n {half.n})"


def _of_some(study, cell):
    """The part of the flights that a verdict is about, if not all landed."""
    landed = study.part(cell, "vertical")["landed"]
    return "" if landed.all() else f", of the {landed.sum()} of {len(landed)} that landed"


def _verdict(study, cell, column, error):
    if not study.follows_before_it_sinks(cell, "vertical"):
        return "not comparable"
    return _below(_estimate(study, cell, "vertical", column), error) + _of_some(study, cell)


def number_rows(study):
    """Every number of the paper beside ours: rows of COLUMNS."""
    rows = []
    for case in ("1", "2"):
        for sigma in SIGMAS:
            cell = f"case_{case}_sigma_{sigma}"
            if not _flown(study, cell, "vertical"):
                continue
            rows.append(
                [
                    f"case {case}, σ {sigma} m: lands",
                    "1 flight shown",
                    *(_landed(study, cell, method) for method in STYLES),
                    _lands(study.part(cell, "vertical")),
                ]
            )
    for cell, paper in TIMES.items():
        if not _flown(study, cell, "vertical"):
            continue
        rows.append(
            [
                f"case {cell[5]}, half have landed after [s]",
                f"{paper:g}",
                *(_half_landed(study, cell, method) for method in STYLES),
                _below(_survival(study, cell, "vertical").median, paper),
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
                        *_measured(study, cell, column, 3),
                        _verdict(study, cell, column, error),
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
            followed = study.part("figure_4_following", method)
            estimate = statistics.bootstrap(
                followed.loc[tables.not_cut_short(followed), "following_mean_error_m"]
            )
            behind = f"{interval(estimate)} (n {estimate.n} of {len(followed)})"
        rows.append(
            [
                study.method_words(method),
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
        "The paper shows one flight for each number and names no interval. Ours, with 95 % intervals: rates "
        "(Clopper-Pearson), the time by which half of all n flights had landed (Kaplan-Meier), and medians of errors over "
        "the n landed flights (bootstrap). The paper's own style is the vertical descent: verdicts are about it. Better: "
        "the whole interval lies below the paper's number; worse: above it; not shown: the interval holds it. "
        "Landing is reproduced where the whole interval of the rate lies above one half, and is not where it lies below."
    )
    document.table(COLUMNS, number_rows(study))
    document.text(
        "The errors are means over the last 5 s. Then a planned descent is still on its way to the pad, so that they "
        "compare with nothing."
    )
    document.heading(3, "Approach")
    document.text("First within 0.5 m of the pad's centre, horizontally; one recorded flight each, as in the paper.")
    document.table(["", "paper", "ours, vertical descent", "ours, planned descent"], approach_rows(study))
    document.heading(2, "Figure 4: what the baselines do behind a pad at 0.8 m/s")
    document.text(
        f"The paper: the baseline follows about {FOLLOWS_BEHIND} m behind and does not land. Here, as found; the "
        "distance is the mean horizontal one over the last 10 s of flights that only follow, above the pad, "
        "of those that end without an accident, however far behind."
    )
    document.table(["method", "landed", "how the others ended", "follows behind by [m]"], baseline_rows(study))
    for name, caption, draw, arguments in paper_figures.figures(study):
        document.picture(gallery.keep(name, draw, *arguments), caption)
