# SPDX-License-Identifier: BSD-3-Clause
"""Python's values in scenarios and on the program's command line."""
import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies

from the_package import touchdown
from touchdown import _scenarios

VALUES = [
    (0.5, "0.5"),
    (1e-7, "1e-07"),
    (3, "3"),
    (True, "true"),
    (np.float64(0.1), "0.1"),
    (np.int32(4), "4"),
    (np.bool_(False), "false"),
    ([1, 0.5, 0], "[1, 0.5, 0]"),
    (np.array([1.5, 2.0]), "[1.5, 2.0]"),
    ("geometric", "geometric"),
    ("a: b", '"a: b"'),
    ("", '""'),
    (Path("out/way.csv"), "out/way.csv"),
    ({"speed": np.float64(2.0)}, '{"speed": 2.0}'),
]


@pytest.mark.parametrize("value, text", VALUES)
def test_values_are_written_as_yaml_reads_them(value, text):
    assert _scenarios.value_text(value) == text


@given(strategies.floats(allow_nan=False, allow_infinity=False))
def test_numbers_keep_every_bit(value):
    text = _scenarios.value_text(value)
    assert math.copysign(1.0, float(text)) == math.copysign(1.0, value) and float(text) == value
    assert json.loads(_scenarios.value_text(np.float64(value))) == value


def test_what_has_no_text_is_refused():
    with pytest.raises(TypeError, match="is no value of a scenario: it must be a number"):
        _scenarios.value_text(object())
    with pytest.raises(touchdown.BadInput, match="gps.sigma must be a number in .*, not 'NaN'"):
        touchdown.sweep("open", trials=1, set={"gps.sigma": math.nan})
    with pytest.raises(touchdown.BadInput, match="gps.sigma must be a number in .*, not empty"):
        touchdown.sweep("open", trials=1, set={"gps.sigma": None})


def test_variations_are_lists_and_ranges():
    assert _scenarios.variation_text("a", [0.01, 0.5]) == "a=0.01,0.5"
    assert _scenarios.variation_text("a", np.array([1, 2])) == "a=1,2"
    assert _scenarios.variation_text("a", (0.5, np.float64(1.5))) == "a=0.5..1.5"
    assert _scenarios.variation_text("a", ["geometric", "paper"]) == "a=geometric,paper"
    assert _scenarios.variation_text("a", [True, False]) == "a=true,false"


@pytest.mark.parametrize(
    "values, why",
    [
        ((1, 2, 3), "a tuple is a range"),
        ("12", "must be a list of values or a tuple"),
        (3, "must be a list of values or a tuple"),
        ({"a": 1}, "must be a list of values or a tuple"),
        ([[1, 2]], "no comma"),
        (["../a.xml"], "no comma and no two dots"),
    ],
)
def test_variations_that_cannot_be_written_are_refused(values, why):
    with pytest.raises(ValueError, match=why):
        _scenarios.variation_text("pad.start", values)


NESTED = {
    "description": "A wall: \"in the way\", 'ü'",
    "pad": {"motion": "circle", "speed": np.float64(0.7), "start": np.array([6.0, 5.5])},
    "start.yaw_random": True,
    "planning": {"latency": "measured"},
    "map.prior": "none",
    "wind": {"mean": 1e-7, "max": 0},
    "terms": {"tilt_limit": {"weight": 2}},
    "timeout": 1,
    "obstacles": {"boxes": [{"centre": (2.5, 3), "size": [1, 1, 4.0]}], "spheres": []},
}
WRITTEN = """
description: "A wall: \\"in the way\\", 'ü'"
pad: {motion: circle, speed: 0.7, start: [6.0, 5.5]}
start.yaw_random: true
planning: {latency: measured}
map.prior: none
wind: {mean: 1e-7, max: 0}
terms: {tilt_limit: {weight: 2}}
timeout: 1
obstacles:
  boxes:
    - {centre: [2.5, 3], size: [1, 1, 4.0]}
"""


def test_a_dictionary_is_the_scenario_that_its_keys_say(tmp_path):
    file = tmp_path / "scenario.yaml"
    file.write_text(WRITTEN, encoding="utf-8")
    of_file, of_keys = (touchdown.sweep(s, trials=1, progress=False) for s in (file, NESTED))
    assert of_keys.manifest["scenario_yaml"] == of_file.manifest["scenario_yaml"]
    assert of_keys.manifest["scenario"] == of_file.manifest["scenario"] == "scenario"
    assert of_keys.command == "touchdown sweep scenario.yaml --trials 1 --seed 1 --jobs 1"
    assert NESTED["pad"]["start"].tolist() == [6.0, 5.5]  # untouched


def test_a_key_that_is_unknown_is_told_with_its_line():
    with pytest.raises(touchdown.BadInput, match=r"scenario.yaml:3: unknown key pad.sped"):
        touchdown.sweep({"pad": {"sped": 1}}, trials=1)
