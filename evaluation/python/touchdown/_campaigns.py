# SPDX-License-Identifier: BSD-3-Clause
"""Sweeps, comparisons and studies: flown by the program, read into frames."""
from __future__ import annotations

import json
import os
import re
import shlex
import sys
import tempfile
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Tuple

from touchdown import _touchdown
from touchdown._touchdown import BadInput
from touchdown._program import ProgramFailed, Word, check, is_progress, run_words, share_path
from touchdown._progress import Bar
from touchdown._ranges import Range, number_in, within
from touchdown._results import PathLike, check_folder, numbers, open_result, read, typed, types_of
from touchdown._scenarios import ScenarioLike, Variation, overrides, scenario_word, variation_text

if TYPE_CHECKING:
    import pandas as pd

_LOST = ("error", "crashed", "hung")

# The program's own ranges. They also hold for flights in this process.
_RANGES: Dict[str, Range] = {
    "trials": (1, 10**6), "seed": (0, 2**53), "jobs": (1, 1024), "trial_limit": (0.1, 1e6),
    "problems": (1, 10**5), "every": (1, 10**5), "starts": (1, 1000), "repeats": (1, 1000), "gap": (1e-9, 1.0),
    "deadline_ms": (1e-3, 1e5), "backend_seconds": (0.1, 1e6), "pin": (0, 1023),
}  # fmt: skip


@dataclass(repr=False, eq=False)
class SweepResult:
    """What `sweep` flew.

    trials    a row a trial: columns of the tables trial and timing (docs/record.md), one for each varied key, and
              `command`, which flies it alone. If the scenario was a dictionary, the command names a file that is gone
    cells     a row for each combination of listed values: the values, planned and flown trials, succeeded, `rate` and
              its 95 % interval `rate_lo`, `rate_hi`, medians of the landed
    manifest  {key: value}: build, machine, `scenario_yaml` of the first trial
    command   what was run, without temporary files; None: flown in this process
    db        the file of the trials; None: it is not kept
    report    the program's own report, which `print` shows
    """

    trials: pd.DataFrame
    cells: pd.DataFrame
    manifest: Dict[str, str]
    command: Optional[str]
    db: Optional[Path]
    report: str = ""

    def __str__(self) -> str:
        return self.report or repr(self)

    def __repr__(self) -> str:
        succeeded, trials = self.cells["succeeded"].sum(), len(self.trials)
        return f"<sweep of {self.manifest['scenario']}: {succeeded} of {trials} trials succeeded>"


@dataclass(repr=False, eq=False)
class CompareResult:
    """What `compare` measured.

    summary   a row a backend (docs/record.md); for a set of known problems a row for each problem and backend
    solves    a row a solve: table solve
    problems  table problem
    refusals  backends that did not run all, and why: table refusal
    manifest  {key: value}: settings, build, machine
    command   what was run, without temporary files; None: solved in this process
    db        the file; None: it is not kept
    """

    summary: pd.DataFrame
    solves: pd.DataFrame
    problems: pd.DataFrame
    refusals: pd.DataFrame
    manifest: Dict[str, str]
    command: Optional[str]
    db: Optional[Path]

    def __repr__(self) -> str:
        return f"<comparison: {len(self.problems)} problems, {len(self.solves)} solves>"


@dataclass(repr=False, eq=False)
class StudyResult:
    """What `study` flew.

    folder   all that it wrote: report.html, csv/, figures/, records/ (docs/evaluation_protocol.md)
    rates    a row for each method in each cell: counts, rate with its 95 % interval, medians, outcomes
    trials   a row a trial: cell, method, labels, figures, times, and the command that flies it alone
    replans  a row a replanning step: its times [ms]
    plan     what study.json says
    report   the page; None: it was not written
    command  what was run
    """

    folder: Path
    rates: pd.DataFrame
    trials: pd.DataFrame
    replans: pd.DataFrame
    plan: Dict[str, Any]
    report: Optional[Path]
    command: str

    def __repr__(self) -> str:
        return f"<study {self.plan['study']}: {len(self.trials)} trials in {self.folder}>"


def _options(**values: Any) -> List[Word]:
    """{name: value} as --name value. None and False: not given; True: a flag; a list: with commas."""
    words: List[Word] = []
    for name, value in values.items():
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            words.append(option)
        elif isinstance(value, (list, tuple)):
            words += [option, ",".join(map(str, value))]
        else:
            words += [option, value]
    return words


def _command(words: Sequence[Word]) -> str:
    return shlex.join(["touchdown", *(os.fspath(w) if isinstance(w, os.PathLike) else str(w) for w in words)])


def _trials(db: Path) -> Dict[str, Any]:
    """The content of a SweepResult, from a file of trials."""
    import pandas as pd

    with open_result(db) as reading:

        def table(query: str) -> pd.DataFrame:
            return pd.read_sql_query(query, reading)

        trials = table(
            "SELECT trial.*, timing.*, planned.replay AS command FROM trial JOIN timing USING(trial) "
            "JOIN planned USING(trial) ORDER BY trial"
        )
        trials = trials.loc[:, ~trials.columns.duplicated()]
        trials = numbers(trials, {**types_of(reading, "timing"), **types_of(reading, "trial")})
        cells = numbers(table("SELECT * FROM cell ORDER BY cell"), types_of(reading, "cell"))
        varied = table("SELECT key, kind FROM varied_key ORDER BY rowid")
        of_trials = table("SELECT * FROM variation").pivot(index="trial", columns="key", values="value")
        of_cells = table("SELECT * FROM cell_value").pivot(index="cell", columns="key", values="value")
        manifest = dict(reading.execute("SELECT key, value FROM manifest"))
    trials["landed"] = trials["landed"].astype(bool)
    command = trials.pop("command")
    for key in varied["key"]:
        trials[key] = typed(trials["trial"].map(of_trials[key]))
    trials["command"] = command
    for place, key in enumerate(varied.loc[varied["kind"] == "list", "key"]):
        cells.insert(1 + place, key, typed(cells["cell"].map(of_cells[key])))
    rate = cells["succeeded"] / cells["trials"].where(cells["trials"] > 0)
    cells.insert(cells.columns.get_loc("rate_lo"), "rate", rate)
    return {"trials": trials, "cells": cells, "manifest": manifest}


def _fly(words: Sequence[Word], db: Path, bar: Bar) -> Tuple[int, str, List[str]]:
    """Runs the program, whose trials grow in `db`."""

    def watch(_: str) -> None:
        import pandas  # noqa: F401  while the program flies, for it takes half a second

        bar.show_trials(db)

    done = run_words(words, watch)
    if done[0] in (0, 1):
        bar.show_trials(db)
    return done


def _judged(done: Tuple[int, str, List[str]], lost: bool) -> Tuple[int, str, List[str]]:
    """Status 1 without a complaint says that trials were lost: they are rows."""
    status, out, lines = done
    if status == 1 and lost and (not lines or is_progress(lines[-1])):
        status = 0
    return status, out, lines


def _check_ranges(**options: Any) -> None:
    """Raises BadInput, in the program's words, before anything is flown."""
    for name, value in options.items():
        if value is not None and not within(value, _RANGES[name]):
            option = name.replace("_", "-")
            raise BadInput(f"--{option}: {value} is no {number_in(_RANGES[name])}")


def _check_in_process(jobs: int, db: Optional[PathLike], **options: Any) -> None:
    """Refuses options that cannot be used with parts written in Python. Raises ValueError."""
    if db is not None:
        try:
            check_folder(db)
        except OSError as problem:
            raise BadInput(f"--db {problem}") from None
    for name, value in options.items():
        if value is not None:
            raise ValueError(f"{name} is {value!r}: it cannot be used with registries")
    if jobs > 1:
        warnings.warn(f"jobs is {jobs}: parts written in Python fly in this process, one by one", stacklevel=3)


def sweep(
    scenario: ScenarioLike,
    *,
    trials: int = 20,
    seed: int = 1,
    vary: Optional[Mapping[str, Variation]] = None,
    set: Optional[Mapping[str, Any]] = None,
    planner: Optional[str] = None,
    backend: Optional[str] = None,
    jobs: int = 1,
    db: Optional[PathLike] = None,
    html: Optional[PathLike] = None,
    record: Optional[str] = None,
    picture: Optional[PathLike] = None,
    trial_limit: Optional[float] = None,
    retry: bool = False,
    progress: bool = True,
    registries: Any = None,
) -> SweepResult:
    """Flies many landings of one scenario (docs/sweep.md), `jobs` at a time, each in a process of its own.

    scenario     a shipped name, a path, or a dictionary of keys (docs/scenario.md)
    seed         of the sweep; those of its trials follow from it
    vary         {key: values}: a list of values that are taken in turn, or a tuple (lo, hi) to draw from
    set          {key: value}, in every trial; planner and backend are short for two of these keys
    db           keeps the trials in an SQLite file; a file of the same sweep is continued
    html         writes the report as a page; with record="failures" or "all" it links pages of these flights
    picture      PNG of success and time to land over what is varied
    trial_limit  wall time after which a trial is given up [s]
    retry        flies trials in db again that crashed, hung or ended in an error
    progress     shows a bar, where tqdm is installed
    registries   with parts that are written in Python: the trials are then flown in this process, one by one

    A trial that crashed or hung is a row with that outcome. Ctrl-C ends all at once; with db the same call continues
    from there. Raises BadInput for what the program refuses, ValueError for what cannot be written as text,
    FileNotFoundError where there is no program, ProgramFailed otherwise.
    """
    if record is not None and html is None:
        raise ValueError(f"record is {record!r}: it needs html, since the report links the flights")
    _check_ranges(trials=trials, seed=seed, jobs=jobs, trial_limit=trial_limit)
    if retry and db is None:
        raise ValueError("retry is True: there is nothing to fly again without db")
    settings = overrides(set)
    settings += [f"planner={planner}"] if planner is not None else []
    settings += [f"solver.backend={backend}"] if backend is not None else []
    variations = [variation_text(key, values) for key, values in (vary or {}).items()]
    with tempfile.TemporaryDirectory(prefix="touchdown-") as temporary, Bar("trial", progress) as bar:
        word = scenario_word(scenario, Path(temporary))
        kept = None if db is None else Path(db)
        file = kept or Path(temporary) / "trials.db"
        if registries is not None:
            _check_in_process(jobs, db, html=html, picture=picture, trial_limit=trial_limit, retry=retry or None)
            _touchdown._sweep(
                word,
                settings,
                variations,
                trials,
                seed,
                str(file),
                registries,
                lambda all, flown, succeeded: bar.show(flown, all, succeeded),
            )
            return SweepResult(**_trials(file), command=None, db=kept)
        words: List[Word] = _options(trials=trials, seed=seed, jobs=jobs)
        for option, texts in (("--set", settings), ("--vary", variations)):
            for text in texts:
                words += [option, text]
        words += _options(trial_limit=trial_limit, retry=retry, picture=picture, html=html, record=record)
        told = word if isinstance(scenario, (str, os.PathLike)) else Path(word).name
        done = _fly(["sweep", word, *words, "--db", file], file, bar)
        if done[0] not in (0, 1) or not file.is_file():
            check(*done)
        result = SweepResult(
            **_trials(file),
            command=_command(["sweep", told, *words, *_options(db=kept)]),
            db=kept,
            report=done[1],
        )
    check(*_judged(done, bool(result.trials["outcome"].isin(_LOST).any())))
    return result


def compare(
    *,
    problem_set: str = "landing",
    source: Optional[PathLike] = None,
    problems: Optional[int] = None,
    every: Optional[int] = None,
    starts: Optional[int] = None,
    backends: Optional[Sequence[str]] = None,
    set: Optional[Mapping[str, Any]] = None,
    arrival: Optional[str] = None,
    limits: Optional[str] = None,
    endpoint: Optional[str] = None,
    seed: Optional[int] = None,
    gap: Optional[float] = None,
    repeats: Optional[int] = None,
    deadline_ms: Optional[float] = None,
    backend_seconds: Optional[float] = None,
    pin: Optional[int] = None,
    db: Optional[PathLike] = None,
    picture: Optional[PathLike] = None,
    allow_debug: bool = False,
    progress: bool = True,
    registries: Optional[_touchdown.Registries] = None,
) -> CompareResult:
    """Compares solver backends on what flights ask for, or on a set of known problems (docs/compare.md).

    source       a flight's record, or a file of a sweep or study; its problems are taken (--from)
    backends     which ones; None: all that can solve the problems
    set          {key: value} of every flight's scenario
    gap          relative to the best known cost; within it a problem counts as solved
    deadline_ms  solves are also stopped after this wall time
    pin          runs on this CPU only
    db           keeps every solve in a new SQLite file
    registries   with terms that are written in Python: the flights are then flown, and solved, in this process

    The others are the options of the same names; None leaves the program's default. Raises BadInput for what the
    program refuses, ProgramFailed otherwise.
    """
    _check_ranges(
        problems=problems, every=every, starts=starts, seed=seed, gap=gap, repeats=repeats, deadline_ms=deadline_ms,
        backend_seconds=backend_seconds, pin=pin,
    )  # fmt: skip
    if isinstance(backends, str):
        backends = backends.split(",")
    if backends is not None and len(backends) == 0:
        raise BadInput("--backends: none is named")
    words: List[Word] = ["compare", *_options(problem_set=problem_set, **{"from": source})]
    for text in overrides(set):
        words += ["--set", text]
    words += _options(
        problems=problems, every=every, starts=starts, backends=backends, arrival=arrival, limits=limits,
        endpoint=endpoint, seed=seed, gap=gap, repeats=repeats, deadline_ms=deadline_ms,
        backend_seconds=backend_seconds, pin=pin, picture=picture, allow_debug=allow_debug,
    )  # fmt: skip
    with tempfile.TemporaryDirectory(prefix="touchdown-") as temporary, Bar("problem", progress) as bar:
        file = Path(temporary) / "compare.db" if db is None else Path(db)

        if registries is not None:
            _check_in_process(
                1, db, pin=pin, picture=picture, starts=starts, problem_set=None if problem_set == "landing" else problem_set
            )
            if file.exists():
                raise BadInput(f"--db {file}: the file exists; a study is never overwritten.")
            short = {"solver.arrival": arrival, "solver.limits": limits, "solver.endpoint": endpoint}
            given = {
                "source": None if source is None else os.fspath(source),
                "set": overrides({**(set or {}), **{key: word for key, word in short.items() if word is not None}}),
                "seed": seed, "problems": problems, "every": every, "gap": gap, "repeats": repeats,
                "backends": None if backends is None else list(backends),
                "deadline_ms": deadline_ms, "backend_seconds": backend_seconds,
            }  # fmt: skip
            _touchdown._compare(given, str(file), registries, lambda done, all: bar.show(done, all))
            return _compared(read(file), None, None, db)

        def watch(said: str) -> None:
            told = re.findall(r"(\d+) of (\d+) problems, ", said)
            if told:
                bar.show(int(told[-1][0]), int(told[-1][1]))

        status, out, lines = run_words([*words, "--json", "--db", file], watch if bar else None)
        check(status, out, lines)
        watch("\n".join(lines))
        frames = read(file)
    return _compared(frames, out, _command(words if db is None else [*words, "--db", file]), db)


def _compared(
    frames: Dict[str, Any], document: Optional[str], command: Optional[str], db: Optional[PathLike]
) -> CompareResult:
    import pandas as pd

    if document is not None and "summary" not in frames:  # of a set of known problems
        frames["summary"] = pd.DataFrame(json.loads(document)["cells"])
    return CompareResult(
        summary=frames["summary"],
        solves=frames["solve"],
        problems=frames["problem"],
        refusals=frames["refusal"],
        manifest=dict(frames["manifest"].to_numpy()),
        command=command,
        db=None if db is None else Path(db),
    )


def _study_frames(folder: Path) -> Any:
    """The folder as touchdown_report reads it: on the path, or shipped with the package."""
    share = share_path()
    if share is not None and str(share / "python") not in sys.path:
        sys.path.append(str(share / "python"))
    from touchdown_report.study.data import Study

    return Study(str(folder))


def study(
    file: PathLike,
    *,
    out: PathLike,
    quick: bool = False,
    cells: Optional[Sequence[str]] = None,
    methods: Optional[Sequence[str]] = None,
    trials: Optional[int] = None,
    jobs: int = 1,
    seed: Optional[int] = None,
    retry: bool = False,
    record: Optional[str] = None,
    progress: bool = True,
) -> StudyResult:
    """Flies every method in every cell of a study (docs/evaluation_protocol.md) into the folder `out`.

    file            a study file, or the name of a shipped one
    quick           the short form
    cells, methods  only these
    trials          number of trials of each method in each cell: the first seeds
    record          flies these trials again with a record and a page: "failures" or "all"

    The same call continues a study that was interrupted. The report needs scipy and statsmodels; without them a
    warning says so, and `report` is None. Raises as `sweep` does.
    """
    import pandas as pd

    folder = Path(out)
    words: List[Word] = ["study", "run", file]
    words += _options(
        out=out, quick=quick, cells=cells, methods=methods, trials=trials, jobs=jobs, seed=seed, retry=retry,
        record=record,
    )  # fmt: skip
    db = folder / "study.db"
    with Bar("trial", progress) as bar:
        done = _fly([*words, "--json"], db, bar)
    told = json.loads(done[1]) if done[0] in (0, 1) and done[1] else {"errors": 0}
    check(*_judged(done, told["errors"] > 0))
    frames = _study_frames(folder)
    return StudyResult(
        folder=folder,
        rates=pd.DataFrame(told["parts"]),
        trials=frames.trials,
        replans=frames.replans,
        plan=frames.plan,
        report=Path(told["report"]) if told["report"] else None,
        command=_command(words),
    )
