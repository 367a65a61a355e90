# SPDX-License-Identifier: BSD-3-Clause
"""Scenarios as Python has them: names, paths, dictionaries, values."""
import json
import os
import re
from pathlib import Path
from typing import Any, List, Mapping, Optional, Sequence, Tuple, Union

from touchdown._touchdown import Scenario

ScenarioLike = Union[str, "os.PathLike[str]", Mapping[str, Any], Scenario]
"""A shipped one by its name, a file by its path, its keys (docs/scenario.md), nested or dotted, or a loaded one."""

Variation = Union[Sequence[Any], Tuple[float, float]]
"""Of a varied key: a list of values that are taken in turn, or a tuple (lo, hi), a range that is drawn from."""

_PLAIN_TEXT = re.compile(r"[\w./+-]+")


def _plain(value: Any) -> Any:
    """Types that JSON does not know: NumPy's numbers and arrays, paths, other mappings."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return dict(value)
    raise TypeError(f"{value!r} is no value of a scenario: it must be a number, a text, a truth or a list of these")


def value_text(value: Any) -> str:
    """A value as `--set KEY=` takes it. YAML reads what JSON writes."""
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str) and _PLAIN_TEXT.fullmatch(value):
        return value
    return json.dumps(value, default=_plain, ensure_ascii=False)


def overrides(keys: Optional[Mapping[str, Any]]) -> List[str]:
    """{key: value} as the words KEY=VALUE."""
    return [f"{key}={value_text(value)}" for key, value in (keys or {}).items()]


def variation_text(key: str, values: Variation) -> str:
    """The word KEY=LO..HI or KEY=a,b,c. Raises ValueError."""
    if isinstance(values, tuple):
        if len(values) != 2:
            raise ValueError(f"vary[{key!r}] is {values}: a tuple is a range (lo, hi), values in turn are a list")
        return f"{key}={value_text(values[0])}..{value_text(values[1])}"
    if isinstance(values, (str, Mapping)) or not hasattr(values, "__iter__"):
        raise ValueError(f"vary[{key!r}] is {values!r}: it must be a list of values or a tuple (lo, hi)")
    texts = [value_text(value) for value in values]
    for text in texts:
        if "," in text or ".." in text:
            raise ValueError(f"vary[{key!r}] has {text}: a value must have no comma and no two dots in a row")
    return f"{key}={','.join(texts)}"


def scenario_text(scenario: Union[Mapping[str, Any], Scenario]) -> str:
    """The text of its file. YAML reads what JSON writes."""
    if isinstance(scenario, Scenario):
        return scenario.yaml
    return json.dumps(dict(scenario), default=_plain, ensure_ascii=False, indent=1) + "\n"


def scenario_word(scenario: ScenarioLike, folder: Path) -> str:
    """The scenario's name or path. A scenario without a file becomes one in `folder`."""
    if not isinstance(scenario, (Mapping, Scenario)):
        return os.fspath(scenario)
    path = folder / "scenario.yaml"
    path.write_text(scenario_text(scenario), encoding="utf-8")
    return str(path)
