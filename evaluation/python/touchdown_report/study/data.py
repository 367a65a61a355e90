# SPDX-License-Identifier: BSD-3-Clause
"""Reading a study's folder: study.json (the plan) and study.db (every trial)."""
import json
import os
import urllib.parse

import pandas as pd

from touchdown_report import database
from touchdown_report.study.document import plain

SUPPORTED_VERSION = "9"


class StudyError(Exception):
    """The folder is no study that this package can read; the message is one sentence."""


class Study:
    """`plan` (study.json), `manifest` {key: value}, `trials` and `replans`. A row of `trials` is a trial with its cell,
    method, labels, figures, timing and `command`. A row of `replans` is a replanning step with its times."""

    def __init__(self, folder):
        self.folder = folder
        path = os.path.join(folder, "study.json")
        try:
            with open(path, encoding="utf-8") as stream:
                self.plan = json.load(stream)
        except OSError as problem:
            raise StudyError(f"{path}: it cannot be read ({problem.strerror}).") from problem
        except ValueError as problem:
            raise StudyError(f"{path}: not a study's plan ({problem}).") from problem
        self.path = os.path.join(folder, "study.db")
        database.read(self.path, "study", "manifest", SUPPORTED_VERSION, StudyError, self._read)

    def _read(self, db, manifest):
        self.manifest = manifest
        trials = pd.read_sql(
            "SELECT trial.*, timing.*, planned.replay AS command FROM trial JOIN timing USING(trial) "
            "JOIN planned USING(trial) ORDER BY trial",
            db,
        )
        trials = trials.loc[:, ~trials.columns.duplicated()]
        labels = pd.read_sql("SELECT trial, key, value FROM variation", db)
        if trials.empty or labels.empty:
            raise StudyError(f"{self.path}: the study holds no trial.")
        labels = labels.pivot(index="trial", columns="key", values="value")
        trials = trials.join(labels, on="trial")
        trials["landed"] = trials["landed"].astype(bool)
        parts = {(part["cell"], part["method"]): part for part in self.plan["parts"]}
        keys = list(zip(trials["cell"], trials["method"]))
        trials["horizon_s"] = [parts[key]["timeout_s"] for key in keys]
        self.trials = trials
        self.replans = pd.read_sql("SELECT trial, replan, wall_ms, cpu_ms FROM replan_time", db)

    def part(self, cell, method):
        """The trials of one method in one cell, by seed."""
        chosen = self.trials[(self.trials["cell"] == cell) & (self.trials["method"] == method)]
        return chosen.set_index("seed").sort_index()

    def parts(self):
        """(cell, method) of everything flown, in the order of the study's file."""
        flown = set(zip(self.trials["cell"], self.trials["method"]))
        planned = [(part["cell"], part["method"]) for part in self.plan["parts"]]
        return [part for part in planned if part in flown]

    def cells(self):
        """Names of the cells that were flown, in the order of the study's file."""
        return list(dict.fromkeys(cell for cell, _ in self.parts()))

    def methods(self, cell=None):
        """Names of the methods that were flown, in the order of the study's file."""
        flown = {method for c, method in self.parts() if cell in (None, c)}
        return [m["name"] for m in self.plan["methods"] if m["name"] in flown]

    def _title(self, kind, name):
        return next(entry["title"] for entry in self.plan[kind] if entry["name"] == name)

    def cell_title(self, name):
        return self._title("cells", name)

    def method_title(self, name):
        return self._title("methods", name)

    def cell_words(self, name):
        """The title, for a Document."""
        return plain(self.cell_title(name))

    def method_words(self, name):
        return plain(self.method_title(name))

    def labels(self, cell):
        return next(entry["labels"] for entry in self.plan["cells"] if entry["name"] == cell)

    def asks_to_land(self, cell, method):
        """False where flights only follow the pad. Following is measured only then."""
        return bool(self.part(cell, method)["following_mean_error_m"].isna().all())

    def follows_before_it_sinks(self, cell, method):
        """Whether the style keeps above the pad before it descends."""
        part = next(p for p in self.plan["parts"] if (p["cell"], p["method"]) == (cell, method))
        if "descent" not in part:
            raise StudyError(f"{self.folder}/study.json: it lacks the descent of its parts; fly the study anew.")
        return part["descent"] == "vertical"

    @property
    def reference(self):
        return self.plan["reference"]

    def page_link(self, name):
        """A link to the page that shows a recorded flight; '' where there is none."""
        page = f"records/{name}.html"
        if not os.path.exists(os.path.join(self.folder, page)):
            return ""
        return f"[look at it]({urllib.parse.quote(page)})"

    def record_path(self, cell, method):
        """The recorded flight of the first trial, or None."""
        path = os.path.join(self.folder, "records", f"{cell}-{method}.db")
        return path if os.path.exists(path) else None
