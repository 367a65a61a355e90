# SPDX-License-Identifier: BSD-3-Clause
"""Checks the pages of docs/notebooks: made from the current notebooks, small, and without the place of their making."""
import base64
import io
import re
import subprocess
import sys
from pathlib import Path

import nbformat
import numpy as np
import pytest
from PIL import Image

FOLDER = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(FOLDER))

import render  # noqa: E402

PAGES = FOLDER.parent / "docs" / "notebooks"
NAMES = sorted(path.stem for path in FOLDER.glob("*.ipynb"))


def without_outputs(name):
    notebook = nbformat.read(FOLDER / f"{name}.ipynb", as_version=4)
    return notebook, render.sources(render.to_markdown(notebook, name)[0])


@pytest.fixture(name="page", params=NAMES)
def page_of(request):
    return request.param, (PAGES / f"{request.param}.md").read_text(encoding="utf-8")


def test_a_page_has_the_text_and_the_code_of_its_notebook(page):
    name, text = page
    assert render.sources(text) == without_outputs(name)[1], (
        f"docs/notebooks/{name}.md is of an older notebook: cmake --build build/release --target notebooks_pages"
    )
    assert text.count(render.OUTPUT[0]) == text.count(render.OUTPUT[1]) > 2, "and outputs"


def test_another_word_or_a_cell_less_is_noticed():
    notebook, before = without_outputs(NAMES[0])
    notebook.cells[1].source += "\n# one more"
    assert render.sources(render.to_markdown(notebook, NAMES[0])[0]) != before
    notebook, _ = without_outputs(NAMES[0])
    del notebook.cells[2]
    assert render.sources(render.to_markdown(notebook, NAMES[0])[0]) != before


def test_nothing_but_the_pages_and_their_pictures_is_there(page):
    assert {path.stem for path in PAGES.glob("*.md")} == set(NAMES)
    name, text = page
    shown = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text)
    assert shown and sorted(shown) == sorted(path.name for path in PAGES.glob(f"{name}_*"))


def test_pictures_are_small():
    sizes = [path.stat().st_size for path in PAGES.glob("*.png")]
    assert max(sizes) < 120_000 and sum(sizes) < 2_000_000


def test_a_page_does_not_say_where_it_was_made(page):
    absolute = re.findall(r"(?<![\w.:/<])/(?:[\w.-]+/)+[\w.-]+", page[1])
    assert [path for path in absolute if not path.startswith("/usr/bin/")] == []
    assert "Traceback" not in page[1]


def png_of_noise(height, width, noisy=300):
    """White, except for so many columns."""
    pixels = np.full((height, width, 3), 255, dtype=np.uint8)
    pixels[:, :noisy] = np.random.default_rng(1).integers(0, 255, (height, noisy, 3))
    png = io.BytesIO()
    Image.fromarray(pixels).save(png, "PNG")
    return png.getvalue()


def test_outputs_become_markdown():
    wide = png_of_noise(400, 2000)
    table = '<div><style scoped>x {}</style>\n<table border="1" class="dataframe">\n\n<tr id="a">\n<th rowspan="2">a</th>'
    cell = nbformat.v4.new_code_cell("x = 1\n\n\ny = 2")
    cell.outputs = [
        nbformat.v4.new_output("stream", text="two words\n"),
        nbformat.v4.new_output("display_data", {"text/html": table + "\n</tr>\n</table></div>"}),
        nbformat.v4.new_output("display_data", {"image/png": base64.b64encode(wide).decode()}),
    ]
    words = nbformat.v4.new_markdown_cell("see [that](02_that.ipynb) and `docs/sweep.md`")
    page, pictures = render.to_markdown(nbformat.v4.new_notebook(cells=[words, cell]), "01_this")
    assert "see [that](02_that.md) and [docs/sweep.md](../sweep.md)" in page
    assert "x = 1\n\n\ny = 2" in page and "\n    two words\n" in page
    assert '<table>\n<tr><th rowspan="2">a</th></tr>\n</table>' in page
    (name,) = pictures
    assert name.startswith("01_this_") and f"]({name})" in page
    small = Image.open(io.BytesIO(pictures[name]))
    assert small.width == render.PICTURE_WIDTH and len(pictures[name]) < render.PICTURE_BYTES
    assert "two words" not in render.sources(page) and "y = 2" in render.sources(page)
    with pytest.raises(ValueError, match="larger than 120000 bytes"):
        render.small(png_of_noise(1000, 1100, noisy=1000))


def test_a_notebook_runs_in_the_environment_that_python_sh_makes(tmp_path):
    script = (FOLDER.parent / "python.sh").read_text(encoding="utf-8")
    kernel = re.search(r'"\$environment/bin/python" (-m ipykernel install .*) >', script)
    assert kernel, "it has no kernel"
    python = tmp_path / "own" / "bin" / "python"
    subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", tmp_path / "own"], check=True)
    subprocess.run([python, *kernel[1].split()], check=True)
    notebook = nbformat.read(FOLDER / f"{NAMES[0]}.ipynb", as_version=4)
    notebook.cells = [nbformat.v4.new_code_cell("import sys\nprint('here:', sys.prefix)")]
    nbformat.write(notebook, tmp_path / "where.ipynb")
    subprocess.run([python, FOLDER / "render.py", tmp_path / "where.ipynb", tmp_path / "where.html"], check=True)
    assert f"here: {tmp_path / 'own'}" in (tmp_path / "where.html").read_text(encoding="utf-8")
