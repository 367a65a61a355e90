# SPDX-License-Identifier: BSD-3-Clause
"""Reading a recorded landing (docs/record.md)."""
import json

import numpy as np

from touchdown_report import database

SUPPORTED_VERSION = "20"


class RecordError(Exception):
    """The file is no record that this package can read; the message is one sentence."""


class Record:
    """One landing: `meta`, `result` (the land --json document) and the tables as arrays."""

    def __init__(self, path):
        self._path = path
        database.read(path, "record", "meta", SUPPORTED_VERSION, RecordError, self._read)

    def _read(self, db, meta):
        self.meta = meta
        self.result = json.loads(self.meta["result_json"])
        self.vehicle = self._array(
            db, "SELECT t, px, py, pz, vx, vy, vz FROM vehicle WHERE source = 'true' ORDER BY t"
        )
        self.pad = self._array(
            db, "SELECT t, px, py, pz, yaw FROM pad WHERE source = 'true' ORDER BY t"
        )
        self.air = self._array(db, "SELECT t, vx, vy, vz FROM air ORDER BY t")
        self.modes = [row[0] for row in db.execute("SELECT mode FROM mode ORDER BY t")]
        self.events = db.execute("SELECT t, kind, text FROM event ORDER BY t").fetchall()
        self.obstacles = self._obstacles(db)
        self.zones = [
            (row[0], row[1], row[2:5], row[5:8])
            for row in db.execute(
                "SELECT term, shape, cx, cy, cz, size_x, size_y, size_z FROM zone ORDER BY id"
            )
        ]
        self.prior = self._prior(db)
        self.plans = self._plans(db)

    @staticmethod
    def _array(db, query):
        rows = db.execute(query).fetchall()
        if not rows:
            raise RecordError("The record holds no states.")
        return np.array(rows, dtype=float)

    @staticmethod
    def _obstacles(db):
        """Dictionaries with kind, centre, size, yaw; of a mesh its surface: corners of each triangle, (n, 3, 3)."""
        surfaces = {
            obstacle: np.frombuffer(corners, "<f4").reshape(-1, 3)[
                np.frombuffer(triangles, "<i4").reshape(-1, 3)
            ]
            for obstacle, corners, triangles in db.execute("SELECT * FROM surface")
        }
        rows = db.execute(
            "SELECT id, kind, cx, cy, cz, size_x, size_y, size_z, yaw FROM obstacle ORDER BY id"
        )
        return [
            {
                "kind": row[1],
                "centre": np.array(row[2:5]),
                "size": np.array(row[5:8]),
                "yaw": row[8],
                "surface": surfaces.get(row[0]),
            }
            for row in rows
        ]

    @staticmethod
    def _prior(db):
        """Cubes of map.prior by their state, lower ones first: lowest cell and side, shape (n, 4)."""
        rows = dict(db.execute("SELECT state, cubes FROM prior"))
        return {
            state: np.frombuffer(rows[state], "<i4").reshape(-1, 4)
            for state in ("occupied", "gone", "new")
            if state in rows
        }

    @staticmethod
    def _plans(db):
        """Control points of every new plan, by id."""
        plans = {}
        query = (
            "SELECT c.plan, c.x, c.y, c.z FROM control_point c JOIN plan p ON p.id = c.plan "
            "WHERE p.status = 'planned' ORDER BY c.plan, c.i"
        )
        for plan, x, y, z in db.execute(query):
            plans.setdefault(plan, []).append((x, y, z))
        return {plan: np.array(points) for plan, points in plans.items()}

    def contact_index(self):
        """Index of the last sample up to first contact; the last sample if there was none."""
        for t, kind, _ in self.events:
            if kind == "contact":
                return int(np.searchsorted(self.vehicle[:, 0], t, side="right") - 1)
        return len(self.vehicle) - 1

    def mean_wind(self):
        """Mean velocity of the air at the vehicle up to first contact, horizontal."""
        return self.air[: self.contact_index() + 1, 1:3].mean(axis=0)

    def scenario_value(self, group, key):
        """One scalar of the effective scenario, as text; '' if it is not there."""
        inside = False
        for line in self.meta["scenario_yaml"].splitlines():
            if not line.startswith(" "):
                inside = line == group + ":"
            elif inside and line.strip().startswith(key + ": "):
                return line.split(": ", 1)[1]
        return ""
