#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Executes a notebook from a fresh kernel and writes it with its outputs as one HTML file, which
needs nothing beside it and no network.

    /usr/bin/python3 notebooks/render.py NOTEBOOK.ipynb OUT.html
"""
import os
import sys
import time
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from nbconvert import HTMLExporter

CELL_SECONDS = 600


def execute(path):
    """The notebook with its outputs. Raises CellExecutionError at the first cell that fails."""
    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # else the kernel warns about its own debugger
    notebook = nbformat.read(path, as_version=4)
    resources = {"metadata": {"path": str(Path(path).resolve().parent)}}
    NotebookClient(notebook, timeout=CELL_SECONDS, resources=resources).execute()
    return notebook


def to_html(notebook, title):
    """One page, with links between the notebooks as links between the pages."""
    # Both scripts would be fetched from a server, and no notebook has a formula or a widget.
    exporter = HTMLExporter(require_js_url="", mathjax_url="")
    body, _ = exporter.from_notebook_node(notebook, resources={"metadata": {"name": title}})
    return body.replace('.ipynb"', '.html"')


def main(arguments):
    """Command line; returns the exit status."""
    if len(arguments) != 2:
        print("usage: render.py NOTEBOOK.ipynb OUT.html", file=sys.stderr)
        return 2
    source, page = map(Path, arguments)
    begin = time.monotonic()
    try:
        notebook = execute(source)
    except CellExecutionError as error:
        print(f"{source.name}: {error}", file=sys.stderr)
        return 1
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text(to_html(notebook, source.stem), encoding="utf-8")
    print(f"{page}: {time.monotonic() - begin:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
