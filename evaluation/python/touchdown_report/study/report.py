# SPDX-License-Identifier: BSD-3-Clause
"""Writes the report of a study: report.html, report.md, summary.json, csv/ and figures/."""
import json
import os

from touchdown_report.study import ablation, figures, paper, solvers, tables
from touchdown_report.study.document import Document, plain
from touchdown_report.study.statistics import Estimate
from touchdown_report.study.style import Gallery
from touchdown_report.study.texts import duration, interval, number, of, p_value

MOST_FAILURES = 8  # of a method in the report; all of them are in csv/failures.csv
OWN_CHAPTERS = {"paper": paper.write, "solvers": solvers.write, "ablation": ablation.write}


def _estimate(row, name):
    return Estimate(row[name], row[f"{name}_lo"], row[f"{name}_hi"], 0)


def _rate(row):
    return of(row["succeeded"], Estimate(0.0, row["rate_lo"], row["rate_hi"], row["trials"]))


def _success(study, document, gallery, parts):
    document.heading(2, "Success")
    document.text(
        "k of n [95 % Clopper-Pearson]. What counts as a success was fixed before: docs/evaluation_protocol.md."
    )
    methods = study.methods()
    rows = []
    for cell in study.cells():
        mine = parts[parts["cell"] == cell].set_index("method")
        rows.append([study.cell_words(cell)] + [_rate(mine.loc[m]) if m in mine.index else "" for m in methods])
    document.table(["cell", *(study.method_words(m) for m in methods)], rows)
    path = gallery.keep("success", figures.success, study, parts)
    document.picture(path, "Success of each method in each cell, with 95 % Clopper-Pearson intervals.")


def _outcomes(study, document, gallery, counts):
    document.heading(2, "How the trials ended")
    names = [name for name in counts.columns if counts[name].sum() > 0]
    rows = [
        [study.cell_words(cell), study.method_words(method), *(str(row[n]) if row[n] else "" for n in names)]
        for (cell, method), row in counts.iterrows()
    ]
    path = gallery.keep("outcomes", figures.outcomes, study, counts)
    document.picture(path, "Shares of the outcomes; every trial has exactly one.")
    document.table(["cell", "method", *names], rows)


def _times(study, document, gallery, parts):
    document.heading(2, "Time to land")
    document.text(
        "Kaplan-Meier estimate of the share that has landed by a time. What did not land is censored at the end "
        "of its time, also after a crash, so that a curve ends at the share that landed at all. "
        "Half landed: the time by which half of all trials, the failures among them, had landed."
    )
    path = gallery.keep("landing_times", figures.landing_times, study)
    document.picture(path, "Share that has landed over time; bands (10 trials or more): 95 %, pointwise.")
    rows = []
    for _, row in parts.iterrows():
        if not study.asks_to_land(row["cell"], row["method"]):
            continue
        half = Estimate(row["half_landed_s"], row["half_landed_lo_s"], row["half_landed_hi_s"], 0)
        rows.append(
            [
                study.cell_words(row["cell"]),
                study.method_words(row["method"]),
                f"{row['succeeded']} of {row['trials']}",
                interval(half, 1),
                interval(_estimate(row, "time_to_land_median_s"), 1),
                number(row["time_ratio_median"], 2),
                interval(
                    Estimate(*(100 * row[f"touchdown_error_median_m{e}"] for e in ("", "_lo", "_hi")), 0), 1
                ),
                number(row["min_clearance_m"], 2),
            ]
        )
    document.table(
        [
            "cell",
            "method",
            "succeeded",
            "half landed [s]",
            "time to land, of the landed [s]",
            "over T*",
            "touchdown error [cm]",
            "least clearance [m]",
        ],
        rows,
    )


def _comparisons(study, document, comparisons):
    if comparisons.empty:
        return
    reference = study.method_words(study.reference)
    document.heading(2, f"Against {reference}, on the same seeds")
    document.text(
        "Exact McNemar test of the success of paired trials in a cell: the same seed is the same world, start, wind and "
        "noise for every method. Over all cells: a permutation test that swaps the two methods in all cells of a seed at "
        "once, for the cells share their seeds and are not independent. The p-values after Holm are adjusted over the cells, "
        "and apart from them over the methods. With few seeds no difference can be shown: five reach p = 0.0625 at best. "
        "Differences: the median over pairs in which both landed, the method less the reference, with its bootstrap interval, "
        "which resamples seeds."
    )
    rows = []
    pooled_first = comparisons.sort_values("cell", key=lambda cell: cell != tables.ALL_CELLS, kind="stable")
    for _, row in pooled_first.iterrows():
        pooled = row["cell"] == tables.ALL_CELLS
        rows.append(
            [
                "**all cells**" if pooled else study.cell_words(row["cell"]),
                study.method_words(row["method"]),
                f"{row['pairs']} ({row['seeds']} seeds)" if pooled else str(row["pairs"]),
                str(row["reference_only"]),
                str(row["method_only"]),
                p_value(row["p"]),
                p_value(row["p_holm"]),
                *(
                    interval(
                        Estimate(*(scale * row[f"difference_{column}{end}"] for end in ("", "_lo", "_hi")), 0), 2
                    )
                    for column, scale in (("time_to_land_s", 1), ("touchdown_error_m", 100))
                ),
            ]
        )
    document.table(
        [
            *("cell", "method", "pairs", f"only {reference}", "only the method", "p", "p (Holm)"),
            *("time to land, difference [s]", "touchdown error, difference [cm]"),
        ],
        rows,
    )


def _failures(study, document, failures):
    document.heading(2, "Failures, and how to fly them again")
    if failures.empty:
        document.text("Every trial succeeded.")
        return
    document.text(
        f"{len(failures)} trials, all in `csv/failures.csv`. The command for any trial, failed or not, stands in "
        "`csv/trials.csv`; add `--html F.html` to look at it. `--record failures` makes such a page of every failure."
    )
    by_method = failures.sort_values(
        "method", key=lambda names: names.map(study.methods().index), kind="stable"
    )
    rows = [
        [
            study.cell_words(r.cell),
            study.method_words(r.method),
            r.outcome,
            study.page_link(f"trial_{r.trial}"),
            f"`{r.command}`",
        ]
        for r in by_method.groupby("method", sort=False).head(MOST_FAILURES).itertuples()
    ]
    document.table(["cell", "method", "outcome", "flight", "command"], rows)
    if len(rows) < len(failures):
        document.text(f"Of each method the first {MOST_FAILURES}; the others are in `csv/failures.csv`.")


def _recorded(study, document):
    rows = [
        [study.cell_words(cell), study.method_words(method), study.page_link(f"{cell}-{method}")]
        for cell in study.cells()
        for method in study.methods()
    ]
    rows = [row for row in rows if row[2]]
    if not rows:
        return
    document.heading(2, "Flights to look at")
    document.text("The first trial of these, each in a page of its own, beside its record in `records/`.")
    document.table(["cell", "method", "flight"], rows)
    others = [
        [str(trial.trial), study.cell_words(trial.cell), study.method_words(trial.method), trial.outcome, link]
        for trial in study.trials.itertuples()
        if (link := study.page_link(f"trial_{trial.trial}"))
    ]
    document.table(["trial", "cell", "method", "outcome", "flight"], others)


def _how(study, document):
    document.heading(2, "How this was made")
    plan, manifest = study.plan, study.manifest
    flown = plan.get("flights", [])
    seconds = sum(f["wall_s"] for f in flown)
    jobs = ", ".join(str(j) for j in sorted({f["jobs"] for f in flown})) or "–"
    document.points(
        [
            f"{len(study.trials)} trials in simulation, {study.trials['simulated_s'].sum() / 3600:.1f} h of flight, "
            f"{study.trials['cpu_s'].sum() / 60:.1f} min of CPU time; {duration(seconds)} of wall time with {jobs} jobs, "
            "of the runs that were not killed, recording and reporting not in it.",
            f"Study `{plan['study']}`{', the short form (--quick)' if plan['quick'] else ''}, seed {plan['seed']}: "
            "trial i has the same seed in every cell and with every method.",
            f"Set in every trial: {', '.join(f'`{k}={v}`' for k, v in plan['set'].items()) or 'nothing'}.",
            f"Machine: {manifest['cpu']}, {manifest['cpus']} CPUs.",
            f"Program: touchdown {manifest['touchdown_version']}, revision {manifest['revision']}, build "
            f"{manifest['build_type']} (`{manifest['compiler_flags'].strip()}`), compiler {manifest['compiler']}, MuJoCo "
            f"{manifest['mujoco']}; build hash `{manifest['build_hash']}`, plan hash `{manifest['plan_hash']}`.",
            "Statistics: scipy and statsmodels; seeds, sample sizes and definitions: docs/evaluation_protocol.md.",
        ]
    )
    refused = [part for part in plan["parts"] if part.get("refusal")]
    if refused:
        document.heading(3, "Not flown")
        document.table(
            ["cell", "method", "why"],
            [[study.cell_words(p["cell"]), study.method_words(p["method"]), plain(p["refusal"])] for p in refused],
        )
    document.heading(3, "Methods")
    document.table(
        ["method", "what is set"],
        [
            [study.method_words(m["name"]), " ".join(f"`{k}={v}`" for k, v in m["set"].items()) or "nothing: the defaults"]
            for m in plan["methods"]
            if m["name"] in study.methods()
        ],
    )


def _selected(study):
    """The selected part of the study, where it is not the whole."""
    asked = study.plan.get("selection")
    if not asked:
        return ""
    words = [f"{name}: {', '.join(asked[name])}" for name in ("cells", "methods") if asked[name]]
    words += [f"trials of each: {asked['trials']}"] if asked["trials"] else []
    return (
        f" This is a part of the study ({'; '.join(words)}). Its p-values after Holm are adjusted over this part alone."
    )


def _headline(study, document, parts):
    document.text(
        f"{len(study.trials)} trials, {len(study.cells())} cells, {len(study.methods())} methods."
        + (" This is the short form: few seeds, wide intervals." if study.plan["quick"] else "")
        + _selected(study)
    )
    document.text(
        "Unless a cell or a method sets it otherwise (`own_state`, `plant.*`, `sensing`), the vehicle knows its own state, its model is the "
        "vehicle that flies, and cameras are geometric. The height of the deck is always given."
    )
    points = []
    landings = parts[[study.asks_to_land(row.cell, row.method) for row in parts.itertuples()]]
    for method in study.methods():
        rows = landings[landings["method"] == method]
        if rows.empty:
            continue
        worst = rows.loc[(rows["succeeded"] / rows["trials"]).idxmin()]
        points.append(
            f"{study.method_words(method)}: {rows['succeeded'].sum()} of {rows['trials'].sum()} landed over all cells; "
            f"nowhere less than {_rate(worst)} ({study.cell_words(worst['cell'])})"
        )
    document.points(points)


def _rows(table):
    """A table as JSON: its columns as they stand in csv/."""
    return [{key: tables.finite(value) for key, value in row.items()} for _, row in table.iterrows()]


def _summary(study, document, parts, comparisons, counts, failures):
    """The page's content: numbers under the names of csv/, and its tables as texts."""
    titles = {"cell_title": study.cell_title, "method_title": study.method_title}
    rows = [
        {**row, **{key: title(row[key.removesuffix("_title")]) for key, title in titles.items()}}
        for row in _rows(parts)
    ]
    return {
        "study": study.plan["study"],
        "quick": study.plan["quick"],
        "seed": study.plan["seed"],
        "trials": len(study.trials),
        "errors": tables.errors(study),
        "report": os.path.join(study.folder, "report.html"),
        "parts": rows,
        "comparisons": _rows(comparisons),
        "outcomes": _rows(counts.reset_index()),
        "failures": _rows(failures),
        "tables": document.tables(),
    }


def _write(folder, name, text):
    """Writes a file whole or not at all."""
    path = os.path.join(folder, name)
    with open(path + ".part", "w", encoding="utf-8") as stream:
        stream.write(text)
    os.replace(path + ".part", path)


def write_report(study):
    """Writes everything that is made from the folder of a study."""
    gallery = Gallery(study.folder)
    document = Document(study.plan["title"])
    parts, comparisons = tables.parts(study), tables.comparisons(study)
    counts, failures = tables.outcomes(study), tables.failures(study)
    _headline(study, document, parts)
    own = OWN_CHAPTERS.get(study.plan["report"])
    if own:
        own(study, document, gallery, parts, comparisons)
    _success(study, document, gallery, parts)
    _outcomes(study, document, gallery, counts)
    _times(study, document, gallery, parts)
    _comparisons(study, document, comparisons)
    _failures(study, document, failures)
    _recorded(study, document)
    _how(study, document)

    summary = _summary(study, document, parts, comparisons, counts, failures)
    folder = os.path.join(study.folder, "csv")
    os.makedirs(folder, exist_ok=True)
    for name, table in (
        ("trials", tables.trials(study)),
        ("parts", parts),
        ("comparisons", comparisons),
        ("outcomes", counts.reset_index()),
        ("failures", failures),
    ):
        _write(folder, f"{name}.csv", table.to_csv(index=False))
    _write(study.folder, "report.md", document.markdown())
    _write(study.folder, "report.html", document.html(study.folder))
    _write(study.folder, "summary.json", json.dumps(summary, indent=2) + "\n")
