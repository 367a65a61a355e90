# SPDX-License-Identifier: BSD-3-Clause
"""The contribution of each part: the default with one thing changed, over all cells."""
from touchdown_report.study import figures, tables
from touchdown_report.study.statistics import Estimate
from touchdown_report.study.texts import interval, p_value


def rows(study, comparisons):
    """One row for each change, over all cells: success, and paired differences to the default."""
    out = []
    for _, row in comparisons[comparisons["cell"] == tables.ALL_CELLS].iterrows():
        figures_of = []
        for column, scale, digits in (("time_to_land_s", 1, 2), ("touchdown_error_m", 100, 2), ("effort_n2s", 1, 1)):
            name = f"difference_{column}"
            figures_of.append(
                interval(Estimate(*(scale * row[f"{name}{end}"] for end in ("", "_lo", "_hi")), 0), digits)
            )
        out.append(
            [
                study.method_words(row["method"]),
                str(row["pairs"]),
                str(row["reference_only"]),
                str(row["method_only"]),
                p_value(row["p_holm"]),
                *figures_of,
            ]
        )
    return out


def write(study, document, gallery, parts, comparisons):
    """The chapter of the paired differences."""
    if comparisons.empty:
        return
    document.heading(2, "What each part contributes")
    document.text(
        "Each change against the default on the same seeds, over all cells. Only default: pairs in which the "
        "default alone landed; p: permutations by seed, after Holm. Differences: the median over pairs in which "
        "both landed, the changed one less the default, with its 95 % bootstrap interval, which resamples seeds: the cells share "
        "them. An interval that holds 0 shows no difference."
    )
    document.table(
        [
            "change",
            "pairs",
            "only default",
            "only changed",
            "p (Holm)",
            "time to land [s]",
            "touchdown error [cm]",
            "effort [N² s]",
        ],
        rows(study, comparisons),
    )
    path = gallery.keep("differences", figures.differences, study, comparisons)
    document.picture(path, "Paired differences to the default.")
