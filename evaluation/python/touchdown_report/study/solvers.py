# SPDX-License-Identifier: BSD-3-Clause
"""Backends in the closed loop: latency, deadlines, quality of what is flown, profile of the replan time."""
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

from touchdown_report.study import figures, statistics, tables
from touchdown_report.study.statistics import Estimate
from touchdown_report.study.style import PAGE, legend_above, looks
from touchdown_report.study.texts import interval, number, percent


def latency(study):
    """One row for each backend in each cell: replanning steps, quantiles of their thread CPU time [ms],
    and steps that took longer than their latency in flight."""
    steps = study.replans.merge(study.trials[["trial", "cell", "method"]], on="trial")
    rows = []
    for (cell, method), own in steps.groupby(["cell", "method"], sort=False):
        trials = study.part(cell, method)
        median, p95, p99 = statistics.quantiles(own["cpu_ms"])
        rows.append(
            {
                "cell": cell,
                "method": method,
                "steps": len(own),
                "cpu_median_ms": median,
                "cpu_p95_ms": p95,
                "cpu_p99_ms": p99,
                "cpu_max_ms": float(own["cpu_ms"].max()),
                "deadline_misses": int(trials["deadline_misses"].sum()),
                "deadline_miss_share": trials["deadline_misses"].sum() / max(1, trials["replans"].sum()),
            }
        )
    return pd.DataFrame(rows)


def trial_costs(study, cells):
    """Median CPU time of a replanning step in each trial: rows are worlds (cell and seed), columns
    backends; infinite where the trial did not land. Worlds that not all flew are left out."""
    medians = study.replans.groupby("trial")["cpu_ms"].median().rename("cost")
    trials = study.trials[study.trials["cell"].isin(cells)].join(medians, on="trial")
    cost = trials["cost"].where(trials["landed"], np.inf).fillna(np.inf)
    costs = trials.assign(cost=cost).pivot(index=["cell", "seed"], columns="method", values="cost")
    return costs.dropna()


def _common_cells(study):
    """Cells that every backend flew with a fixed latency."""
    everyone = set(study.methods())
    return [
        cell
        for cell in study.cells()
        if set(study.methods(cell)) == everyone and study.labels(cell).get("latency") != "measured"
    ]


def draw_profile(study, costs):
    """Performance profile, and the distribution of the replan time."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(PAGE, 4.6), layout="constrained")
    methods = [m for m in study.methods() if m in costs.columns]
    look = looks(study.methods())
    for method, (ratios, shares) in statistics.performance_profile(costs[methods]).items():
        left.step(
            np.append(ratios, 1e4), np.append(shares, shares[-1:] if len(shares) else [0.0]),
            where="post", lw=1.5, label=study.method_title(method), **look[method],
        )  # fmt: skip
    largest = costs.replace(np.inf, np.nan).div(costs.min(axis=1), axis=0).max().max()
    left.set_xscale("log")
    left.set_xlim(1.0, max(2.0, 1.3 * largest) if np.isfinite(largest) else 2.0)
    left.set_ylim(-0.02, 1.03)
    left.set_xlabel("replan time over the fastest backend's")
    left.set_ylabel("share of the worlds")
    left.set_title("Performance profile, median CPU time of a step in a trial", fontsize=9)
    steps = study.replans.merge(study.trials[["trial", "method"]], on="trial")
    for method in methods:
        times = np.sort(steps.loc[steps["method"] == method, "cpu_ms"].to_numpy())
        right.plot(times, np.arange(1, len(times) + 1) / len(times), lw=1.4, **look[method])
    right.set_xscale("log")
    right.set_ylim(-0.02, 1.03)
    right.set_xlabel("CPU time of a replanning step [ms]")
    right.set_ylabel("share of the steps")
    right.set_title("All steps", fontsize=9)
    legend_above(figure, *left.get_legend_handles_labels())
    return figure


def write(study, document, gallery, parts, comparisons):
    """The chapters about backends."""
    times = latency(study)
    document.heading(2, "Latency in the loop")
    document.text(
        "Thread CPU time of whole replanning steps (prediction, checks, search, solves, certificate), all steps of all trials. "
        "A deadline is missed where a step's wall time exceeds the latency that its plan was flown with: that of the scenario, or where "
        "the measured latency is fed back 1.2 times that of the step before. Trials of the first kind share the machine with other jobs; "
        "those of the second fly after them, one at a time."
    )
    document.table(
        ["cell", "backend", "steps", "median [ms]", "p95 [ms]", "p99 [ms]", "worst [ms]", "deadlines missed"],
        [
            [
                study.cell_words(row["cell"]),
                study.method_words(row["method"]),
                str(row["steps"]),
                *(number(row[f"cpu_{q}_ms"], 2) for q in ("median", "p95", "p99", "max")),
                f"{row['deadline_misses']} ({percent(row['deadline_miss_share'])})",
            ]
            for _, row in times.iterrows()
        ],
    )
    cells = _common_cells(study)
    costs = trial_costs(study, cells)
    path = gallery.keep("profile", draw_profile, study, costs)
    document.picture(
        path,
        f"Dolan and More's performance profile over {len(costs)} worlds ({', '.join(study.cell_words(c) for c in cells)}); "
        "a world that a backend did not land in counts as infinitely slow. Ranks below the leader depend on who else is compared.",
    )
    document.heading(2, "Quality of what is flown")
    document.text(
        "Medians over the landed trials: time to land over the certified lower bound T*, effort (integral of the "
        "rotors' squared thrusts) and touchdown error."
    )
    document.table(
        ["cell", "backend", "time over T*", "effort [N² s]", "touchdown error [cm]"],
        [
            [
                study.cell_words(row["cell"]),
                study.method_words(row["method"]),
                *(
                    interval(Estimate(*(scale * row[f"{name}{end}"] for end in ("", "_lo", "_hi")), 0), digits)
                    for name, scale, digits in (
                        ("time_ratio_median", 1, 3),
                        ("effort_median_n2s", 1, 1),
                        ("touchdown_error_median_m", 100, 2),
                    )
                ),
            ]
            for _, row in parts.iterrows()
        ],
    )
    if not comparisons.empty:
        path = gallery.keep("differences", figures.differences, study, comparisons)
        document.picture(path, f"Paired differences to {study.method_words(study.reference)} over all cells.")
