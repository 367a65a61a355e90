# SPDX-License-Identifier: BSD-3-Clause
"""The Python that makes the program's reports: the user's, if it has what they need."""
import ast
import json
import pathlib
import re
import subprocess
import sys

import pytest

import touchdown_report

PACKAGE = pathlib.Path(touchdown_report.__file__).parent
PICTURE = ("land", "open", "--plot", "x.png")
TINY_STUDY = """
title: A tiny study
seed: 3
reference: planned
set: {timeout: 2}
cells:
  - {name: field, scenario: open}
methods:
  - {name: planned, trials: 1, quick: 1}
"""


@pytest.fixture(scope="module")
def make_environment(tmp_path_factory):
    """A virtual environment; returns its folder."""

    def make(name, *options):
        folder = tmp_path_factory.mktemp("environment") / name
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", *options, folder], check=True, timeout=120)
        return folder

    return make


@pytest.fixture(scope="module")
def plain(make_environment):
    return make_environment("plain")


@pytest.fixture
def unnamed(monkeypatch, tmp_path_factory):
    """An environment that does not name a Python, and the means to name one."""
    for name in ("TOUCHDOWN_PYTHON", "VIRTUAL_ENV", "CONDA_PREFIX", "PYTHONPATH"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("PATH", str(tmp_path_factory.mktemp("empty")))
    return monkeypatch


def imported(files):
    """The packages, beside Python's own and this one, that these files import."""
    names = set()
    for file in files:
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Import):
                names.update(alias.name.split(".")[0] for alias in node.names)
            elif isinstance(node, ast.ImportFrom):
                names.add(node.module.split(".")[0])
    return names - set(sys.stdlib_module_names) - {"touchdown_report"}


def said_to_lack(sentence):
    return set(re.search(r" lacks ([\w, ]+) \(", sentence).group(1).split(", "))


def test_an_active_environment_makes_the_picture_and_is_named(unnamed, make_environment, run, tmp_path):
    folder = make_environment("with packages", "--system-site-packages")
    unnamed.setenv("VIRTUAL_ENV", str(folder))
    done = run(*PICTURE, "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stderr == f"touchdown: the report is made by {folder}/bin/python3 (VIRTUAL_ENV)\n"
    assert json.loads(done.stdout)["landed"] is True
    assert [p.name for p in tmp_path.iterdir()] == ["x.png"]


def write_packages(folder, what):
    """Packages that are found, and say which they are when they are imported."""
    for name in ("numpy", "matplotlib"):
        (folder / f"{name}.py").write_text(f"raise ImportError('{what}')\n")


def test_an_environment_has_packages_of_its_own(unnamed, make_environment, run, tmp_path):
    folder = make_environment("own")
    (site,) = folder.glob("lib/python3*/site-packages")
    write_packages(site, "those of the environment")
    unnamed.setenv("VIRTUAL_ENV", str(folder))
    done = run(*PICTURE, cwd=tmp_path)
    assert done.returncode == 1
    assert done.stderr.endswith(f"those of the environment (by {folder}/bin/python3).\n"), done.stderr


def test_packages_on_the_users_own_path_are_found(unnamed, plain, run, tmp_path, tmp_path_factory):
    mine = tmp_path_factory.mktemp("mine")
    write_packages(mine, "those of PYTHONPATH")
    unnamed.setenv("TOUCHDOWN_PYTHON", f"{plain}/bin/python3")
    unnamed.setenv("PYTHONPATH", str(mine))
    done = run(*PICTURE, cwd=tmp_path)
    assert done.returncode == 1 and "those of PYTHONPATH (by " in done.stderr, done.stderr


def test_an_environment_without_packages_is_passed_without_a_word(unnamed, plain, run, tmp_path):
    unnamed.setenv("VIRTUAL_ENV", str(plain))
    done = run(*PICTURE, cwd=tmp_path)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["x.png"]


def test_of_one_that_is_named_is_said_what_pictures_need(unnamed, plain, run, tmp_path):
    unnamed.setenv("TOUCHDOWN_PYTHON", f"{plain}/bin/python3")
    done = run(*PICTURE, cwd=tmp_path)
    assert done.returncode == 1 and list(tmp_path.iterdir()) == []
    sentence = done.stderr.strip()
    assert sentence.startswith(f"touchdown: --plot x.png: the picture was not drawn: {plain}/bin/python3 (TOUCHDOWN_PYTHON) lacks ")
    assert said_to_lack(sentence) == imported(PACKAGE.glob("*.py"))
    assert sentence.endswith(f" ({plain}/bin/python3 -m pip install numpy matplotlib).")


def test_a_study_says_before_and_after_its_flights_what_its_report_needs(unnamed, plain, run, tmp_path):
    (tmp_path / "tiny.yaml").write_text(TINY_STUDY)
    unnamed.setenv("TOUCHDOWN_PYTHON", f"{plain}/bin/python3")
    study = ("study", "run", "tiny.yaml", "--out", "out", "--jobs", "1")
    flown = run(*study, cwd=tmp_path)
    assert flown.returncode == 0, flown.stderr
    assert flown.stderr.startswith("touchdown: The report could not be written yet: ")
    refused = run(*study, "--report-only", cwd=tmp_path)
    assert refused.returncode == 1
    assert refused.stderr.startswith("touchdown: out: the report was not written: ")
    for done in (flown, refused):
        assert said_to_lack(done.stderr) == imported(PACKAGE.rglob("*.py"))
    unnamed.delenv("TOUCHDOWN_PYTHON")
    done = run(*study, "--report-only", cwd=tmp_path)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert (tmp_path / "out" / "report.html").exists()
