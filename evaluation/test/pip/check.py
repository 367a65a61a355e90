# SPDX-License-Identifier: BSD-3-Clause
"""Checks that the package below the named folder is whole, and flies with the program of its installation."""
import os
import sys
from pathlib import Path

import touchdown
from touchdown import _program

place = Path(sys.argv[1]).resolve()
package = Path(touchdown.__file__).resolve().parent
for there in (package, touchdown.program_path(), _program.share_path()):
    assert place in Path(there).parents, f"{there} is not in {place}"
assert os.path.samefile(touchdown.program_path().parent.parent / "share" / "touchdown", _program.share_path())
assert (package / "py.typed").is_file()

# As it is told by the program itself, which must not fall back on the tree that it was built from.
for scenario in ("open", "straight_turn"):
    assert (_program.share_path() / "scenarios" / f"{scenario}.yaml").is_file()
flown = touchdown.sweep("open", trials=2, set={"timeout": 1}, progress=False)
assert list(flown.trials["outcome"]) == ["timeout", "timeout"]
assert " open " in flown.trials["command"][0]

cells = "cells: [{name: c, title: C, scenario: open, labels: {x: 1}}]"
methods = "methods: [{name: a, title: A, trials: 1}]"
Path("s.yaml").write_text(f"title: s\nreport: plain\nseed: 1\nreference: a\nset: {{timeout: 1.5}}\n{cells}\n{methods}\n")
studied = touchdown.study("s.yaml", out=f"study_{place.name}", progress=False)
assert len(studied.trials) == 1
import touchdown_report  # noqa: E402  of the package, by now

assert place in Path(touchdown_report.__file__).resolve().parents
assert touchdown.solve.__module__ == "touchdown._solve"
