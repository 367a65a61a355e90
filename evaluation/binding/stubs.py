#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints the type stub of touchdown._touchdown, from the signatures that the module itself gives.

    PYTHONPATH=build/release/python python3 stubs.py > evaluation/python/touchdown/_touchdown.pyi
"""
import inspect
import re
import sys
from typing import Literal, get_args, get_origin

from touchdown import _touchdown

HEAD = '''# Made by evaluation/binding/stubs.py: a test says when it is to be made again.
from typing import Any, Callable, Dict, List, Literal, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

'''
OPERATORS = ["add", "radd", "sub", "rsub", "mul", "rmul", "truediv", "rtruediv", "neg"]
SPECIAL = {f"__{name}__" for name in [*OPERATORS, "copy", "deepcopy"]}
ARRAY = re.compile(r"numpy\.ndarray\[(numpy\.)?(\w+)(\[[^\]]*\])?(, [^\]]*)?\]")
KINDS = {"float64": "np.float64", "int32": "np.int32", "uint8": "np.uint8", "bool": "np.bool_", "float32": "np.float32"}


def split(text):
    """Arguments at the commas that are in no brackets or quotes."""
    parts, depth, quote, start = [], 0, "", 0
    for i, c in enumerate(text):
        if quote:
            quote = "" if c == quote and text[i - 1] != "\\" else quote
        elif c in "\"'":
            quote = c
        elif c in "([{<":
            depth += 1
        elif c in ")]}>" and text[i - 1] != "-":
            depth -= 1
        elif c == "," and depth == 0:
            parts.append(text[start:i].strip())
            start = i + 1
    return [*parts, text[start:].strip()] if text[start:].strip() else parts


def typed(text, given):
    """A type of pybind11 in Python's words. With `given`, an array may be anything that becomes one."""
    text = ARRAY.sub(lambda m: "ArrayLike" if given else f"NDArray[{KINDS[m[2]]}]", text)
    text = re.sub(r"\bnumpy\.ndarray\b", "ArrayLike" if given else "NDArray[Any]", text)
    text = text.replace("touchdown._touchdown.", "")
    text = re.sub(r"\b(object|handle)\b", "Any", text)
    text = re.sub(r"\bdict\b", "Dict[str, Any]", text)
    text = re.sub(r"\blist\b", "List[Any]", text)
    text = re.sub(r"\btuple\b", "Tuple[Any, ...]", text)
    text = re.sub(r"\bfunction\b", "Callable[..., Any]", text)
    return text


def signatures(doc):
    """(arguments, result) of each overload in a docstring."""
    for line in (doc or "").splitlines():
        found = re.match(r"(?:\d+\. )?\w*\((.*)\) -> (.+)$", line)
        if found and not line.startswith("Overloaded"):
            yield split(found[1]), found[2].strip()


def argument(text):
    if text in ("*", "/"):
        return text
    if text.startswith("*"):
        return re.sub(r"^(\*+\w+).*", r"\1: Any", text)
    name, _, rest = text.partition(": ")
    kind, default, _ = rest.partition(" = ")
    if name == "self":
        return "self"
    optional = kind
    if re.search(r" = None$", text) and not kind.startswith("Optional") and kind != "object":
        optional = f"Optional[{kind}]"
    return f"{name}: {typed(optional, True)}" + (" = ..." if default else "")


def function(name, doc, indent="", decorators=()):
    found = list(signatures(doc))
    lines = []
    for arguments, result in found:
        marks = [*decorators, "overload"] if len(found) > 1 else decorators
        lines += [f"{indent}@{mark}" for mark in marks]
        listed = ", ".join(argument(a) for a in arguments)
        back = "None" if name == "__init__" else typed(result, False)
        lines.append(f"{indent}def {name}({listed}) -> {back}: ...")
    return lines


def members(cls):
    lines = []
    fields = cls.__dict__.get("_fields")
    if fields is not None:
        kinds = {f: next(signatures(getattr(cls, f).fset.__doc__))[0][1].partition(": ")[2] for f in fields}
        listed = "".join(f", {f}: {typed(kinds[f], True)} = ..." for f in fields)
        lines.append(f"    _fields: Tuple[str, ...]")
        lines.append(f"    def __init__(self{', *' if listed else ''}{listed}) -> None: ...")
    for name, member in sorted(cls.__dict__.items()):
        if name == "__init__":
            if fields is None:
                made = function(name, member.__doc__, "    ")
                lines += made or ["    def __init__(self, *args: Any, **kwargs: Any) -> None: ..."]
        elif isinstance(member, property):
            _, result = next(signatures(member.fget.__doc__))
            lines.append("    @property")
            lines.append(f"    def {name}(self) -> {typed(result, False)}: ...")
            if member.fset:
                kind = next(signatures(member.fset.__doc__))[0][1].partition(": ")[2]
                lines.append(f"    @{name}.setter")
                lines.append(f"    def {name}(self, value: {typed(kind, True)}) -> None: ...")
        elif isinstance(member, staticmethod):
            lines += function(name, member.__func__.__doc__, "    ", ["staticmethod"])
        elif callable(member) and (not name.startswith("__") or name in SPECIAL):
            lines += function(name, member.__doc__, "    ")
    return lines or ["    ..."]


def stub():
    lines = [HEAD.replace("Tuple\n", "Tuple, overload\n")]
    for name, value in sorted(vars(_touchdown).items()):
        if get_origin(value) is Literal:
            lines.append(f"{name} = Literal[{', '.join(repr(word) for word in get_args(value))}]".replace("'", '"'))
    lines += ["", "__version__: str", ""]
    for name, value in sorted(vars(_touchdown).items()):
        if inspect.isclass(value):
            base = value.__mro__[1].__name__
            base = "" if base == "pybind11_object" else f"({base})"
            lines += ["", f"class {name}{base}:", *members(value)]
        elif callable(value) and get_origin(value) is None:
            lines += ["", *function(name, value.__doc__)]
    return "\n".join(lines).replace("\n\n\n\n", "\n\n\n") + "\n"


if __name__ == "__main__":
    sys.stdout.write(stub())
