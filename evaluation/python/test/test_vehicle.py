# SPDX-License-Identifier: BSD-3-Clause
import json
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

from touchdown_report import vehicle
from touchdown_report.vehicle import VehicleError

HEXA = str(Path(__file__).resolve().parents[3] / "docs" / "examples" / "vehicles" / "hexa.xml")


def test_hull_of_points_is_all_around():
    corners = vehicle.hull_of([(0, 0), (2, 0), (2, 2), (0, 2), (1, 1), (1, 0)])
    assert sorted(corners) == [(0, 0), (0, 2), (2, 0), (2, 2)]


def test_a_vehicle_is_drawn(run, tmp_path):
    done = run("check-vehicle", HEXA, "--picture", str(tmp_path / "v.png"))
    assert done.returncode == 0, done.stderr
    assert "held after" in done.stdout
    image = plt.imread(tmp_path / "v.png")
    assert image.shape[1] > 1000
    left, right = [((image[:, :, :3] - colour) ** 2).sum(axis=2).min() for colour in ((0, 0.447, 0.698), (0.835, 0.369, 0))]
    assert left < 0.01 and right < 0.01  # rotors of both senses


def test_what_is_no_vehicle_is_refused(run, tmp_path):
    document = json.loads(run("check-vehicle", HEXA, "--json").stdout)
    assert len(document["model"]["actuators"]) == 6
    path = tmp_path / "v.json"
    for damage, why in (({"model": None}, "has faults"), (None, "not a document")):
        path.write_text(json.dumps({**document, **damage} if damage else {"a": 1}))
        with pytest.raises(VehicleError, match=why):
            vehicle.load(str(path))
    with pytest.raises(VehicleError, match="no such file"):
        vehicle.load(str(tmp_path / "none.json"))
