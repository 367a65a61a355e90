# SPDX-License-Identifier: BSD-3-Clause
"""One flight: its result as data, its record as arrays."""
import json
import os
import sqlite3
import tempfile
from contextlib import closing
from dataclasses import dataclass, field
from typing import Any, Dict, List, Mapping, Optional, Tuple, Union

import numpy as np

from touchdown import _touchdown
from touchdown._touchdown import BadInput
from touchdown._results import PathLike, check_folder, open_result
from touchdown._scenarios import ScenarioLike, overrides, scenario_text


@dataclass(frozen=True)
class Touchdown:
    """First contact of a foot with the deck."""

    error_m: float
    relative_velocity_mps: Tuple[float, float, float]
    tilt_deg: float
    tilt_over_equilibrium_deg: float


def _is_record(path: PathLike) -> bool:
    try:
        with open_result(path) as file:
            told = file.execute("SELECT value FROM meta WHERE key = 'format'").fetchone()
    except sqlite3.DatabaseError:
        return False
    return told == ("touchdown record",)


def _check_record_path(path: PathLike) -> None:
    """Raises OSError where no record can be written, or where it would replace another file."""
    check_folder(path)
    if os.path.exists(path) and os.path.getsize(path) > 0 and not _is_record(path):
        raise FileExistsError(f"{os.fspath(path)}: a file that is no record of a flight is in its place.")


class Record:
    """The tables of a recorded flight (docs/record.md): record["vehicle"]["px"] is an array, record.frame("vehicle") a
    pandas frame. The file is read once, when the record is made. Raises FileNotFoundError; BadInput where it is no
    record."""

    def __init__(self, path: PathLike) -> None:
        if not os.path.isfile(path):
            raise FileNotFoundError(f"{os.fspath(path)}: there is no such record.")
        if not _is_record(path):
            raise BadInput(f"{os.fspath(path)}: it is no record of a flight.")
        self._db = sqlite3.connect(":memory:", check_same_thread=False)
        with open_result(path) as file:
            file.backup(self._db)
        self.meta = dict(self._db.execute("SELECT key, value FROM meta"))

    def save(self, path: PathLike) -> None:
        """Writes it to a file, as `touchdown replay`, `plan` and `profile` read it. Raises OSError where it cannot, also in
        place of a file that is no record."""
        _check_record_path(path)
        with closing(sqlite3.connect(os.fspath(path))) as file:
            self._db.backup(file)

    @property
    def tables(self) -> List[str]:
        """Their names."""
        rows = self._db.execute("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name")
        return [name for (name,) in rows]

    def __getitem__(self, table: str) -> Dict[str, np.ndarray]:
        """The columns of a table as arrays by name; NULL of a number is NaN."""
        if table not in self.tables:
            raise KeyError(f"the record has no table {table}, it has {', '.join(self.tables)}")
        cursor = self._db.execute(f"SELECT * FROM {table} ORDER BY rowid")
        names = [column[0] for column in cursor.description]
        rows = cursor.fetchall()
        return {name: _column([row[i] for row in rows]) for i, name in enumerate(names)}

    def frame(self, table: str) -> Any:
        """A table as a pandas frame."""
        import pandas as pd

        return pd.DataFrame(self[table])

    def states(self, table: str, source: str = "true") -> Dict[str, np.ndarray]:
        """The columns of `vehicle` or `pad` from this source: "true" or "estimate"."""
        columns = self[table]
        rows = columns["source"] == source
        return {name: column[rows] for name, column in columns.items() if name != "source"}


def _column(values: List[Any]) -> np.ndarray:
    if all(value is None or isinstance(value, (int, float)) for value in values):
        if values and all(isinstance(value, int) for value in values):
            return np.array(values)
        return np.array([np.nan if value is None else value for value in values], dtype=float)
    return np.array(values, dtype=object)


@dataclass(frozen=True)
class TrialResult:
    """The result of a flight: the document of `touchdown land --json` as attributes. `document` is all of it, `record`
    the tables, if they were asked for. None stands for what does not apply."""

    landed: bool
    outcome: str
    detail: str
    time_to_land_s: Optional[float]
    t_star_s: Optional[float]
    t_star_upper_s: Optional[float]
    time_ratio: Optional[float]
    within_limits: bool
    touchdown: Optional[Touchdown]
    mean_abs_error_last_5s_m: Dict[str, Optional[float]]
    min_clearance_m: Optional[float]
    simulated_s: float
    effort_n2s: float
    saturation_share: float
    max_speed_mps: float
    max_acceleration_mps2: float
    replans: int
    replans_by_status: Dict[str, int]
    replans_by_reason: Dict[str, int]
    replans_forbidden_by: Dict[str, int]
    gate_steps: Dict[str, int]
    first_tag_s: Optional[float]
    following: Optional[Dict[str, Any]]
    estimator: Optional[Dict[str, Any]]
    own_state: Optional[Dict[str, Any]]
    safety: Optional[Dict[str, Any]]
    map_prior: Optional[Dict[str, Any]]
    looks: int
    no_way: Optional[Dict[str, Any]]
    planner: str
    backend: str
    scenario: str
    seed: int
    wall_clock: Dict[str, Any] = field(repr=False)
    document: Dict[str, Any] = field(repr=False)
    record: Optional[Record] = field(default=None, repr=False)

    @classmethod
    def _of(cls, document: Dict[str, Any], record: Optional[Record]) -> "TrialResult":
        names = [f for f in cls.__dataclass_fields__ if f not in ("document", "record", "touchdown")]
        touched = document["touchdown"]
        if touched["error_m"] is None:  # no foot has touched the deck
            touched = None
        return cls(
            **{name: document.get(name) for name in names},
            touchdown=Touchdown(**{**touched, "relative_velocity_mps": tuple(touched["relative_velocity_mps"])})
            if touched
            else None,
            document=document,
            record=record,
        )


def load_scenario(
    scenario: ScenarioLike = "straight_turn",
    *,
    set: Optional[Mapping[str, Any]] = None,
    registries: Optional[_touchdown.Registries] = None,
) -> _touchdown.Scenario:
    """A Scenario: of a shipped name, a path, a dictionary as a scenario file has it, or one that is there already.

    `set` changes keys: {"pad.speed": 1.2}. Raises BadInput with one sentence."""
    if isinstance(scenario, _touchdown.Scenario):
        if not set:
            return scenario
        return _touchdown.Scenario.parse(scenario_text(scenario), overrides(set), registries)
    if isinstance(scenario, Mapping):
        return _touchdown.Scenario.parse(scenario_text(scenario), overrides(set), registries)
    return _touchdown.Scenario.load(os.fspath(scenario), overrides(set), registries)


def run_trial(
    scenario: ScenarioLike = "straight_turn",
    *,
    seed: Optional[int] = None,
    set: Optional[Mapping[str, Any]] = None,
    planner: Optional[str] = None,
    backend: Optional[str] = None,
    registries: Optional[_touchdown.Registries] = None,
    record: Union[bool, PathLike] = False,
) -> TrialResult:
    """Flies one trial: a pure function of scenario and seed, except for its times.

    scenario    as in load_scenario
    seed        of what is drawn; None: the scenario's
    set         keys of the scenario to change: {"pad.speed": 1.2}
    planner, backend   short for the keys planner and solver.backend
    registries  Registries, where parts of Python take part
    record      True: the result has a `record`; a path: the file is kept there and replaces an older record

    Returns a TrialResult. Raises BadInput where the scenario cannot be flown, and OSError where the record cannot be
    written. What a part of Python raises in flight is raised here.
    """
    changes = dict(set or {})
    if planner is not None:
        changes["planner"] = planner
    if backend is not None:
        changes["solver.backend"] = backend
    if seed is not None:
        changes["seed"] = int(seed)
    if record and record is not True:
        _check_record_path(record)
    flown = load_scenario(scenario, set=changes, registries=registries)
    if not record:
        return TrialResult._of(json.loads(_touchdown._run(flown, registries, "")), None)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "record.db") if record is True else os.fspath(record)
        document = json.loads(_touchdown._run(flown, registries, path))
        return TrialResult._of(document, Record(path))


def explain_step(
    record: Union[Record, PathLike],
    step: int,
    *,
    set: Optional[Mapping[str, Any]] = None,
    registries: Optional[_touchdown.Registries] = None,
) -> Dict[str, Any]:
    """A recorded replanning step, asked again and explained: the document of `touchdown plan --from RECORD:STEP --json`.

    `set` changes keys solver.*, terms.*, planning.guides, planning.max_work and planning.warm_start. Raises BadInput, and
    IndexError for a step that is not there."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "record.db") if isinstance(record, Record) else os.fspath(record)
        if isinstance(record, Record):
            record.save(path)
        return json.loads(_touchdown._explain(path, int(step), overrides(set), registries))
