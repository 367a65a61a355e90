#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Executes a notebook from a fresh kernel and writes it with its outputs.

The output is one HTML file, which needs no other file and no network, or Markdown with small pictures beside it, as in
docs/notebooks.

    /usr/bin/python3 notebooks/render.py NOTEBOOK.ipynb OUT.html
    /usr/bin/python3 notebooks/render.py NOTEBOOK.ipynb OUT.md
"""
import base64
import copy
import io
import os
import re
import sys
import time
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from nbconvert import HTMLExporter, MarkdownExporter
from PIL import Image

CELL_SECONDS = 600
PICTURE_WIDTH = 1100  # [pixels]
PICTURE_BYTES = 120_000
# What a run leaves stands between these marks, which no reader sees.
OUTPUT = ("<!-- output -->", "<!-- end of output -->")
_OUTPUTS = re.compile(f"{OUTPUT[0]}.*?{OUTPUT[1]}", re.DOTALL)
TEMPLATE = f"""{{% extends 'markdown/index.md.j2' %}}
{{% block output_group %}}
{OUTPUT[0]}

{{{{ super() }}}}

{OUTPUT[1]}
{{% endblock %}}
"""


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


def small(png):
    """The picture with as many colours as PICTURE_BYTES allows."""
    picture = Image.open(io.BytesIO(png)).convert("RGB")
    picture.thumbnail((PICTURE_WIDTH, 10 * PICTURE_WIDTH))
    for colours in (128, 64, 32, 16):
        out = io.BytesIO()
        picture.quantize(colours, dither=Image.Dither.NONE).save(out, "PNG", optimize=True)
        if len(out.getvalue()) < PICTURE_BYTES:
            return out.getvalue()
    raise ValueError(f"a picture of {picture.size} pixels is larger than {PICTURE_BYTES} bytes")


def plain_table(html):
    """A table without its style: what a reader of Markdown shows of HTML."""
    html = re.sub(r"<style.*?</style>|</?div[^>]*>", "", html, flags=re.DOTALL)
    html = re.sub(r' (?:id|class|border|style)="[^"]*"', "", html).replace(" >", ">")
    html = "\n".join(line.strip() for line in html.splitlines() if line.strip())  # a blank line would end it
    return re.sub(r"\n(?=<t[hd]|</tr)", "", html)


def to_markdown(notebook, name):
    """(page, {file name: PNG}), with links between the notebooks and to docs/ as links between the pages."""
    notebook = copy.deepcopy(notebook)
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = re.sub(r"\]\((\w+)\.ipynb\)", r"](\1.md)", cell.source)
            cell.source = re.sub(r"`(docs/(\w+\.md))`", r"[\1](../\2)", cell.source)
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            if "image/png" in data:
                data["image/png"] = base64.b64encode(small(base64.b64decode(data["image/png"]))).decode()
            if "text/html" in data:
                data["text/html"] = plain_table(data["text/html"])
    exporter = MarkdownExporter(raw_template=TEMPLATE)
    resources = {"metadata": {"name": name}, "unique_key": name, "output_files_dir": None}
    body, resources = exporter.from_notebook_node(notebook, resources=resources)
    body = body.replace("![png](", "![What the cell above draws](")
    body += f"\nThis page is [the notebook](../../notebooks/{name}.ipynb), executed; times are those of one run.\n"
    body = "\n".join(line.rstrip() for line in body.splitlines()).strip() + "\n"
    return re.sub(_OUTPUTS, lambda output: re.sub(r"\n{3,}", "\n\n", output[0]), body), resources["outputs"]


def sources(page):
    """A Markdown page without traces of a run."""
    return re.sub(r"\n{2,}", "\n\n", re.sub(_OUTPUTS, "", page))


def main(arguments):
    """Command line; returns the exit status."""
    if len(arguments) != 2 or Path(arguments[1]).suffix not in (".html", ".md"):
        print("usage: render.py NOTEBOOK.ipynb OUT.html|OUT.md", file=sys.stderr)
        return 2
    source, page = map(Path, arguments)
    begin = time.monotonic()
    try:
        notebook = execute(source)
    except CellExecutionError as error:
        print(f"{source.name}: {error}", file=sys.stderr)
        return 1
    page.parent.mkdir(parents=True, exist_ok=True)
    if page.suffix == ".html":
        page.write_text(to_html(notebook, source.stem), encoding="utf-8")
    else:
        text, pictures = to_markdown(notebook, source.stem)
        for old in page.parent.glob(f"{source.stem}_*.png"):
            old.unlink()
        for picture, png in pictures.items():
            (page.parent / picture).write_bytes(png)
        page.write_text(text, encoding="utf-8")
    print(f"{page}: {time.monotonic() - begin:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
