# SPDX-License-Identifier: BSD-3-Clause
"""Results of any study's trials, as pandas tables. They have one row for each method in each cell, for each
pair of methods, for each outcome and for each failure."""
import numpy as np
import pandas as pd

from touchdown_report.outcomes import DONE
from touchdown_report.study import statistics

# Column of a trial: name in the tables. All are of landed trials.
FIGURES = {
    "time_to_land_s": "time_to_land_median_s",
    "touchdown_error_m": "touchdown_error_median_m",
    "mean_abs_error_x_m": "mean_abs_error_x_median_m",
    "mean_abs_error_y_m": "mean_abs_error_y_median_m",
    "time_ratio": "time_ratio_median",
    "effort_n2s": "effort_median_n2s",
}
# Five seconds before contact a planned descent is still on its way: there they compare with nothing.
LAST_5_S = ("mean_abs_error_x_m", "mean_abs_error_y_m")
PAIRED = ("time_to_land_s", "touchdown_error_m", "effort_n2s")
ALL_CELLS = "all"


def succeeded(trials):
    """What counts: that the task is done."""
    return trials["outcome"].isin(DONE)


def not_cut_short(trials):
    """Flights of a following task that went on until their time was up, however far behind."""
    return trials["outcome"].isin(["followed", "timeout", "lost_pad", "infeasible"])


def parts(study):
    """One row for each method in each cell: rates, medians with intervals, time to land with what did not
    land censored."""
    rows = []
    for cell, method in study.parts():
        trials = study.part(cell, method)
        good = int(succeeded(trials).sum())
        rate = statistics.rate(good, len(trials))
        row = {
            "cell": cell,
            "method": method,
            **study.labels(cell),
            "trials": len(trials),
            "succeeded": good,
            "rate_lo": rate.lo,
            "rate_hi": rate.hi,
        }
        landed = trials[trials["landed"]]
        for column, name in FIGURES.items():
            told = study.follows_before_it_sinks(cell, method) or column not in LAST_5_S
            estimate = statistics.bootstrap(landed[column] if told else [])
            row |= {name: estimate.value, f"{name}_lo": estimate.lo, f"{name}_hi": estimate.hi}
        survival = statistics.time_to_land(
            trials["time_to_land_s"], trials["landed"], trials["horizon_s"]
        )
        row |= {
            "half_landed_s": survival.median.value,
            "half_landed_lo_s": survival.median.lo,
            "half_landed_hi_s": survival.median.hi,
        }
        following = statistics.bootstrap(trials.loc[not_cut_short(trials), "following_mean_error_m"])
        row |= {
            "following_error_median_m": following.value,
            "following_error_lo_m": following.lo,
            "following_error_hi_m": following.hi,
            "min_clearance_m": trials["min_clearance_m"].astype(float).min(),
        }
        rows.append(row)
    return pd.DataFrame(rows)


def outcomes(study):
    """Counts of every outcome, one row for each method in each cell."""
    counts = study.trials.groupby(["cell", "method"])["outcome"].value_counts().unstack(fill_value=0)
    return counts.reindex(pd.MultiIndex.from_tuples(study.parts(), names=["cell", "method"]))


def _compare(study, cell, method, pairs):
    """One row. `pairs` are (trials of the method, of the reference), by seed, of one cell or of each of them all."""
    successes = [(succeeded(reference), succeeded(own)) for own, reference in pairs]
    alone = cell != ALL_CELLS
    success = statistics.paired_success(*successes[0]) if alone else statistics.pooled_success(successes)
    row = {
        "cell": cell,
        "method": method,
        "reference": study.reference,
        "seeds": len(set().union(*(own.index.intersection(reference.index) for own, reference in pairs))),
        "pairs": success.pairs,
        "reference_only": success.first_only,
        "method_only": success.second_only,
        "p": success.p,
    }
    for column in PAIRED:
        figures = [
            (own.loc[own["landed"], column], reference.loc[reference["landed"], column])
            for own, reference in pairs
        ]
        estimate = statistics.paired_difference(*figures[0]) if alone else statistics.pooled_difference(figures)
        row |= {
            f"difference_{column}": estimate.value,
            f"difference_{column}_lo": estimate.lo,
            f"difference_{column}_hi": estimate.hi,
            f"difference_{column}_pairs": estimate.n,
        }
    return row


def comparisons(study):
    """Each method against the reference on the same seeds, in each cell and over all cells that both
    flew in (`cell` = all). Over all cells the seeds are independent, the pairs are not. `p_holm` is adjusted over the
    cells, and separately over the methods."""
    rows = []
    pooled = {}
    for cell, method in study.parts():
        if method == study.reference or study.reference not in study.methods(cell):
            continue
        pair = study.part(cell, method), study.part(cell, study.reference)
        rows.append(_compare(study, cell, method, [pair]))
        pooled.setdefault(method, []).append(pair)
    in_cells = len(rows)
    for method, pairs in pooled.items():
        rows.append(_compare(study, ALL_CELLS, method, pairs))
    table = pd.DataFrame(rows)
    if not table.empty:
        adjusted = statistics.holm(table["p"][:in_cells]) + statistics.holm(table["p"][in_cells:])
        table.insert(table.columns.get_loc("p") + 1, "p_holm", adjusted)
    return table


def failures(study):
    """Every trial that did not fulfil its task, with the command that flies it again."""
    bad = study.trials[~succeeded(study.trials)]
    return bad[["trial", "cell", "method", "seed", "outcome", "simulated_s", "detail", "command"]]


def trials(study):
    """Every trial, labels first, without empty columns."""
    lead = ["trial", "cell", "method", "seed"]
    labels = [key for key in study.labels(study.cells()[0]) if key in study.trials]
    rest = [c for c in study.trials if c not in lead + labels + ["command"]]
    return study.trials[lead + labels + rest + ["command"]].dropna(axis=1, how="all")


def errors(study):
    """How many trials ended in an error of the program."""
    return int(study.trials["outcome"].isin(["error", "crashed", "hung"]).sum())


def finite(value):
    """A figure as JSON has it: null where there is none."""
    if isinstance(value, (np.floating, float)):
        return float(value) if np.isfinite(value) else None
    if isinstance(value, np.integer):
        return int(value)
    return value
