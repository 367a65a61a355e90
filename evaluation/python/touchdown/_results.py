# SPDX-License-Identifier: BSD-3-Clause
"""Result files: where they may be written, and as frames (docs/record.md).

pandas is imported where it is used: most of the package does without."""
from __future__ import annotations

import json
import os
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Union

from touchdown._touchdown import BadInput

if TYPE_CHECKING:
    import pandas as pd

PathLike = Union[str, "os.PathLike[str]"]


def check_folder(path: PathLike) -> None:
    """Raises an OSError where no file can be written at `path`."""
    place = Path(path)
    if not place.parent.is_dir():
        raise FileNotFoundError(f"{place}: there is no directory {place.parent}.")
    if place.is_dir():
        raise IsADirectoryError(f"{place}: a file must be named, and this is a directory.")
    if not os.access(place.parent, os.W_OK):
        raise PermissionError(f"{place}: nothing can be written to {place.parent}.")


def open_result(path: PathLike) -> closing[sqlite3.Connection]:
    """Opens for writing, too, to recover what a killed writer left."""
    return closing(sqlite3.connect(f"{Path(path).absolute().as_uri()}?mode=rw", uri=True))


def numbers(frame: pd.DataFrame, types: Dict[str, str]) -> pd.DataFrame:
    """Columns of numbers in which every one is missing are NaN, not None."""
    for name, kind in types.items():
        if name in frame and kind in ("REAL", "INTEGER") and frame[name].dtype == object:
            frame[name] = frame[name].astype(float)
    return frame


def types_of(db: sqlite3.Connection, table: str) -> Dict[str, str]:
    return {row[1]: row[2] for row in db.execute(f'PRAGMA table_info("{table}")')}


def typed(texts: pd.Series) -> pd.Series:
    """Values of a key that were written as text. They become numbers or booleans if all of them are."""
    import pandas as pd

    try:
        values: List[Any] = [json.loads(text) for text in texts]
    except ValueError:
        return texts
    if values and all(isinstance(value, (int, float)) for value in values):
        return pd.Series(values, index=texts.index, name=texts.name)
    return texts


def read(path: PathLike) -> Dict[str, pd.DataFrame]:
    """Every table of a result file, {name: frame}: of sweeps, studies, records, comparisons, profiles.

    Columns and units are those of docs/record.md, NULL is NaN; the manifest has the columns key and value. A file that
    is still written to can be read. Raises FileNotFoundError; BadInput where it is no result file.
    """
    import pandas as pd

    if not Path(path).is_file():
        raise FileNotFoundError(f"{os.fspath(path)}: there is no such file.")
    try:
        with open_result(path) as db:
            db.execute("PRAGMA query_only=ON")
            db.execute("BEGIN")  # what follows is of one moment
            tables = db.execute("SELECT name FROM sqlite_master WHERE type='table' ORDER BY rowid")
            names = [row[0] for row in tables]
            facts = [name for name in ("manifest", "meta") if name in names]
            if not facts or not db.execute(
                f"SELECT 1 FROM {facts[0]} WHERE key='format' AND value LIKE 'touchdown %'"
            ).fetchone():
                raise BadInput(f"{os.fspath(path)}: it is no result file of touchdown.")
            return {
                name: numbers(pd.read_sql_query(f'SELECT * FROM "{name}"', db), types_of(db, name)) for name in names
            }
    except sqlite3.Error as problem:
        raise BadInput(f"{os.fspath(path)}: it is no result file of touchdown ({problem}).") from problem
