# SPDX-License-Identifier: BSD-3-Clause
"""CTest says where the built program is (TOUCHDOWN_PROGRAM) and what was built (TOUCHDOWN_BUILD)."""
import os
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))


@pytest.fixture(scope="session", autouse=True)
def program():
    path = os.environ.get("TOUCHDOWN_PROGRAM")
    if not path or not os.environ.get("TOUCHDOWN_BUILD"):
        pytest.skip("TOUCHDOWN_PROGRAM and TOUCHDOWN_BUILD are not set; CTest sets them")
    return path
