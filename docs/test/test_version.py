# SPDX-License-Identifier: BSD-3-Clause
"""Every find_package of the installed package asks for the version that is here."""
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_every_find_package_asks_for_this_version():
    version = re.search(r"project\(touchdown VERSION (\d+\.\d+)", (ROOT / "CMakeLists.txt").read_text())[1]
    names = subprocess.run(["git", "-C", ROOT, "ls-files", "*.md", "*.txt", "*.ipynb"], capture_output=True, text=True,
                           check=True).stdout.split()  # fmt: skip
    asked = {name: re.findall(r"find_package\(touchdown (\d\S*?)[ )]", (ROOT / name).read_text(encoding="utf-8")) for name in names}
    wrong = {name: found for name, found in asked.items() if any(other != version for other in found)}
    assert sum(map(len, asked.values())) >= 9, "where are they?"
    assert not wrong, f"the version is {version}: {wrong}"
    assert f"version: {version}." in (ROOT / "CITATION.cff").read_text()


def test_the_debian_package_is_of_this_version():
    version = re.search(r"project\(touchdown VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
    assert (ROOT / "cmake" / "debian" / "changelog").read_text().startswith(f"touchdown ({version}-1) ")
