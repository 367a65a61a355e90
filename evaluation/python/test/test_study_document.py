# SPDX-License-Identifier: BSD-3-Clause
"""One text in two forms."""
import html
import re

import pytest

pytest.importorskip("statsmodels")

from touchdown_report.study.document import Document, plain  # noqa: E402
from touchdown_report.study.statistics import Estimate  # noqa: E402
from touchdown_report.study.texts import interval, number, of, p_value  # noqa: E402


def some_document(folder):
    (folder / "dot.png").write_bytes(b"\x89PNG...")
    document = Document("A <study>")
    document.heading(2, "First part")
    document.text("With `code | pipe` and **weight** & more, [a page](records/a.html).")
    document.table(["name", "value"], [["a | b", "1.5"], ["c", "2 of 3"]])
    document.table(["never"], [])
    document.picture("dot.png", "A dot.")
    document.code("touchdown land open")
    return document


def test_markdown_escapes_what_would_end_a_cell(tmp_path):
    text = some_document(tmp_path).markdown()
    assert "| a \\| b | 1.5 |" in text and "never" not in text
    assert "![A dot.](dot.png)" in text and "```sh\ntouchdown land open\n```" in text


def test_html_stands_alone(tmp_path):
    text = some_document(tmp_path).html(str(tmp_path))
    assert "<h1>A &lt;study&gt;</h1>" in text
    assert "<code>code | pipe</code> and <b>weight</b> &amp; more, <a href=\"records/a.html\">a page</a>." in text
    assert '<td class="number">1.5</td>' in text and "<td>2 of 3</td>" in text
    assert 'src="data:image/png;base64,iVBORy4uLg=="' in text
    assert "http" not in text and 'href="#first-part"' in text


def test_titles_are_no_markup(tmp_path):
    title = "a|b *c* `d` [e](http://f) <img src=x> \\ _g_ h_i\n# j"
    document = Document(title)
    document.table([plain(title), "n"], [[plain(title), "**1**"]])
    text = document.markdown()
    row = next(line for line in text.splitlines() if "**1**" in line)
    assert row.count("|") == 3 and not re.search(r"[*`<>\[\]\\]", row.replace("**1**", ""))
    assert len(text.splitlines()) == 5 and "h_i # j" in text
    page = document.html(str(tmp_path))
    shown = html.unescape(page.split("<td>")[1].split("</td>")[0])
    assert shown == " ".join(title.split()) and "<img" not in page and "<a " not in page.split("<h1>")[1]
    assert document.tables()[0]["rows"] == [[" ".join(title.split()), "**1**"]]


def test_figures_as_text():
    assert interval(Estimate(1.234, 1.2, 1.3, 9)) == "1.23 [1.20, 1.30]"
    assert interval(Estimate(1.234, float("nan"), float("nan"), 2), 1) == "1.2"
    assert interval(Estimate(float("inf"), 1.0, float("nan"), 3)) == "∞"
    assert of(97, Estimate(0.97, 0.9148, 0.9938, 100)) == "97 of 100 [91.5, 99.4] %"
    assert (p_value(0.0391), p_value(1e-9), number(None)) == ("0.0391", "< 0.0001", "–")
