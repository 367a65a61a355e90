# SPDX-License-Identifier: BSD-3-Clause
"""The package as it was built. Tests that import this are skipped if it was not built. CTest tells of a module that it
built. Also functions that its tests share."""
import contextlib
import ctypes
import os
import sqlite3
import time

import numpy as np
import pytest

try:
    import touchdown  # noqa: F401
except ImportError as missing:
    if os.environ.get("TOUCHDOWN_PYTHON_MODULE"):
        raise
    pytest.skip(f"the Python module was not built ({missing})", allow_module_level=True)


# Memory


def resident_kb():
    """The memory of this process, without memory that its allocator keeps."""
    ctypes.CDLL("libc.so.6").malloc_trim(0)
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024


# Processes


def alive(process):
    """The process still runs: it is not gone and no zombie."""
    try:
        with open(f"/proc/{process}/stat", encoding="utf-8") as stat:
            return stat.read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def descendants(process):
    """Ids of all processes below this one."""
    parents = {}
    for entry in os.listdir("/proc"):
        with contextlib.suppress(OSError, ValueError):
            with open(f"/proc/{int(entry)}/stat", encoding="utf-8") as stat:
                parents[int(entry)] = int(stat.read().rsplit(")", 1)[1].split()[1])
    found = [process]
    for above in found:
        found += [child for child, parent in parents.items() if parent == above]
    return found[1:]


def wait_for(what, limit_s=60.0):
    end = time.monotonic() + limit_s
    while not what():
        assert time.monotonic() < end
        time.sleep(0.02)


# Files


def rows(path, query):
    with contextlib.closing(sqlite3.connect(path)) as db:
        cursor = db.execute(query)
        return [column[0] for column in cursor.description], cursor.fetchall()


def same(value, stored):
    """Bit by bit; what is missing is NaN in a column of numbers."""
    if stored is None:
        return value is None or np.isnan(value)
    if isinstance(stored, float):
        return float(value).hex() == stored.hex()
    return value == stored


def assert_equal(frame, columns, stored):
    assert len(frame) == len(stored) > 0
    for place, column in enumerate(columns):
        for value, of_file in zip(frame[column], [row[place] for row in stored]):
            assert same(value, of_file), (column, value, of_file)
