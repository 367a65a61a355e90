# SPDX-License-Identifier: BSD-3-Clause
"""Result files: SQLite, read only, with a version that the reader knows."""
import contextlib
import os
import sqlite3


def read(path, what, table, version, error, use):
    """use(database, {key: value}) of a file that holds `what`, whose `table` tells its version.

    Raises `error` with one sentence for a file that is missing, is no such file or has another version.
    Opens it for writing, where the file lets it, so that what a killed writer left can be recovered.
    """
    if not os.path.isfile(path):
        raise error(f"{path}: there is no such file.")
    try:
        with contextlib.closing(sqlite3.connect(f"file:{path}?mode=rw", uri=True)) as database:
            database.execute("PRAGMA query_only=ON")
            facts = dict(database.execute(f"SELECT key, value FROM {table}"))
            if facts.get("version") != version:
                raise error(
                    f"{path}: {what} version {facts.get('version')}, "
                    f"this package reads version {version}."
                )
            use(database, facts)
    except sqlite3.Error as problem:
        raise error(f"{path}: not a {what} ({problem}).") from problem
