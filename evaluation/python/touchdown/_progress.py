# SPDX-License-Identifier: BSD-3-Clause
"""A bar that says how far a campaign is, where tqdm is installed."""
import sqlite3
import time
from pathlib import Path
from typing import Any, Optional

from touchdown._results import open_result


class Bar:
    """Drawn from the first time that something is shown; `wanted` False: never. Use it in a `with`."""

    def __init__(self, unit: str, wanted: bool):
        self._unit = unit
        self._begun = time.time()
        self._bar: Any = None
        self._make: Any = None
        if wanted:
            try:
                from tqdm.auto import tqdm
            except ImportError:
                return
            self._make = tqdm

    def __bool__(self) -> bool:
        return self._make is not None

    def show(self, done: int, all: int, succeeded: Optional[int] = None) -> None:
        if self._make is None:
            return
        if self._bar is None:
            self._bar = self._make(total=all, unit=self._unit)
            self._bar.start_t = self._begun
        if succeeded is not None:
            self._bar.set_postfix_str(f"{succeeded} succeeded", refresh=False)
        self._bar.update(done - self._bar.n)

    def show_trials(self, db: Path) -> None:
        """The progress in a file of trials, which may not exist yet."""
        if self._make is None or not db.is_file():
            return
        try:
            with open_result(db) as reading:
                row = reading.execute("SELECT sum(trials), sum(planned), sum(succeeded) FROM cell").fetchone()
        except sqlite3.Error:
            return
        self.show(*row)

    def __enter__(self) -> "Bar":
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()
