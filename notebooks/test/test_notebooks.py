# SPDX-License-Identifier: BSD-3-Clause
"""Checks the committed notebooks: valid, with cell ids, without outputs, and listed where they are executed."""
import re
from pathlib import Path

import nbformat
import pytest

FOLDER = Path(__file__).resolve().parent.parent
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


@pytest.fixture(params=NOTEBOOKS, ids=lambda path: path.stem)
def notebook(request):
    return nbformat.read(request.param, as_version=nbformat.NO_CONVERT)


def test_all_of_them_are_executed():
    listed = re.search(r"set\(notebooks ([^)]*)\)", (FOLDER / "CMakeLists.txt").read_text())
    assert listed.group(1).split() == [path.stem for path in NOTEBOOKS]


def test_the_format_is_valid_and_has_cell_ids(notebook):
    assert (notebook.nbformat, notebook.nbformat_minor) >= (4, 5)
    nbformat.validate(notebook)
    ids = [cell.id for cell in notebook.cells]
    assert len(set(ids)) == len(ids)


def test_nothing_that_a_run_leaves_is_committed(notebook):
    for cell in notebook.cells:
        if cell.cell_type == "code":
            assert cell.outputs == [] and cell.execution_count is None, cell.id
        assert "attachments" not in cell and cell.metadata == {}, cell.id
    assert set(notebook.metadata) <= {"kernelspec", "language_info"}
    assert set(notebook.metadata.language_info) == {"name"}


def test_it_tells_a_story_and_checks_it(notebook):
    first, last = notebook.cells[0], notebook.cells[-1]
    assert first.cell_type == "markdown" and first.source.startswith("# ")
    assert "**" in first.source and "?**" in first.source, "the question is in bold"
    assert last.source.startswith("## What to try next")
    code = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "code")
    assert re.search(r"^assert ", code, re.MULTILINE)
    assert re.search(r"nb\.(picture|show)\(", code)


def test_links_between_the_notebooks_lead_somewhere(notebook):
    for cell in notebook.cells:
        for name in re.findall(r"\]\((\w+\.ipynb)\)", cell.source):
            assert (FOLDER / name).is_file(), name


def test_what_the_text_names_exists(notebook):
    for cell in notebook.cells:
        for name in re.findall(r"`((?:docs|evaluation|notebooks)/[\w./]+)`", cell.source):
            assert (FOLDER.parent / name).exists(), name
