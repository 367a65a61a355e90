# SPDX-License-Identifier: BSD-3-Clause
"""One text, two forms: a report is a list of blocks, written as Markdown and as one HTML file with its
pictures inside."""
import base64
import html
import itertools
import os
import re

CSS = """
body { font: 15px/1.5 "DejaVu Sans", system-ui, sans-serif; color: #222; max-width: 72rem; margin: 2rem auto;
  padding: 0 1.2rem; }
h1 { font-size: 1.7rem; } h2 { margin-top: 2.2rem; border-bottom: 1px solid #ddd; } h3 { margin-top: 1.6rem; }
table { border-collapse: collapse; font-size: 13px; margin: 0.8rem 0; display: block; overflow-x: auto; }
th, td { border: 1px solid #ddd; padding: 0.25rem 0.55rem; text-align: left; vertical-align: top; }
th { background: #f5f5f5; } td.number { text-align: right; font-variant-numeric: tabular-nums; }
figure { margin: 1.2rem 0; } figure img { max-width: 100%; } figcaption { font-size: 13px; color: #555; }
code { background: #f5f5f5; padding: 0 0.2rem; } pre { background: #f5f5f5; padding: 0.6rem; overflow-x: auto; }
.contents { columns: 2; font-size: 14px; }
"""
NUMBER = re.compile(r"^[-+<]?\s?[\d.]+(e-?\d+)?( ?%)?$")


def plain(words):
    """Words from outside, such as a title, for a text of a Document: nothing in them is markup, in either form."""
    words = re.sub(r"[\\`*<>\[\]|&~]|(?<!\w)_|_(?!\w)", lambda special: f"&#{ord(special[0])};", words)
    return " ".join(words.split())


def _inline(text):
    """HTML of a line with `code`, **bold** and [links](to/a/file)."""
    return "".join(
        f"<code>{html.escape(piece, quote=False)}</code>" if code else _prose(piece)
        for piece, code in zip(text.split("`"), itertools.cycle([False, True]))
    )


def _prose(text):
    text = re.sub(r"&amp;(#\d+;)", r"&\1", html.escape(text, quote=False))  # of plain()
    text = re.sub(r"\*\*([^*]+)\*\*", r"<b>\1</b>", text)
    return re.sub(r'\[([^]]+)\]\(([^)"]+)\)', r'<a href="\2">\1</a>', text)


def _anchor(title):
    return re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-")


class Document:
    """Blocks in their order, their texts with `code`, **bold** and [links](to/a/file). The title has no markup.
    Pictures are files in the document's folder."""

    def __init__(self, title):
        self.title = title
        self._blocks = []

    def heading(self, level, text):
        self._blocks.append(("heading", level, text))

    def text(self, text):
        self._blocks.append(("text", text))

    def points(self, lines):
        self._blocks.append(("points", list(lines)))

    def code(self, text):
        self._blocks.append(("code", text))

    def table(self, columns, rows):
        """Cells are texts; `rows` may be empty, then there is no table."""
        if rows:
            self._blocks.append(("table", list(columns), [[str(cell) for cell in row] for row in rows]))

    def picture(self, path, caption):
        """`path` of a PNG, relative to the document's folder."""
        self._blocks.append(("picture", path, caption))

    def tables(self):
        """Every table as it is shown: {chapter, columns, rows}, the chapter being the heading above it. Words that
        plain() made are again as they were."""
        shown, chapter = [], ""
        for kind, *block in self._blocks:
            if kind == "heading":
                chapter = block[1]
            elif kind == "table":
                columns, *rows = [[html.unescape(text) for text in row] for row in (block[0], *block[1])]
                shown.append({"chapter": chapter, "columns": columns, "rows": rows})
        return shown

    def markdown(self):
        out = [f"# {plain(self.title)}", ""]
        for kind, *block in self._blocks:
            if kind == "heading":
                out += ["#" * block[0] + " " + block[1], ""]
            elif kind == "text":
                out += [block[0], ""]
            elif kind == "points":
                out += [f"- {line}" for line in block[0]] + [""]
            elif kind == "code":
                out += ["```sh", block[0], "```", ""]
            elif kind == "picture":
                out += [f"![{block[1]}]({block[0]})", "", f"*{block[1]}*", ""]
            else:
                columns, rows = block
                out.append("| " + " | ".join(columns) + " |")
                out.append("|" + "---|" * len(columns))
                out += ["| " + " | ".join(c.replace("|", "\\|") for c in row) + " |" for row in rows]
                out.append("")
        return "\n".join(out)

    def html(self, folder):
        chapters = [block[1] for kind, *block in self._blocks if kind == "heading" and block[0] == 2]
        contents = "".join(f'<li><a href="#{_anchor(c)}">{_inline(c)}</a></li>' for c in chapters)
        out = [
            "<!DOCTYPE html>",
            f'<html lang="en"><head><meta charset="utf-8"><title>{html.escape(self.title)}</title>',
            f"<style>{CSS}</style></head><body>",
            f"<h1>{html.escape(self.title, quote=False)}</h1>",
            f'<ul class="contents">{contents}</ul>',
        ]
        for kind, *block in self._blocks:
            out.append(getattr(self, f"_html_{kind}")(folder, *block))
        return "\n".join(out + ["</body></html>", ""])

    @staticmethod
    def _html_heading(_, level, text):
        return f'<h{level} id="{_anchor(text)}">{_inline(text)}</h{level}>'

    @staticmethod
    def _html_text(_, text):
        return f"<p>{_inline(text)}</p>"

    @staticmethod
    def _html_points(_, lines):
        return "<ul>" + "".join(f"<li>{_inline(line)}</li>" for line in lines) + "</ul>"

    @staticmethod
    def _html_code(_, text):
        return f"<pre>{html.escape(text)}</pre>"

    @staticmethod
    def _html_table(_, columns, rows):
        head = "".join(f"<th>{_inline(c)}</th>" for c in columns)
        body = "".join(
            "<tr>"
            + "".join(
                f'<td class="number">{_inline(c)}</td>' if NUMBER.match(c) else f"<td>{_inline(c)}</td>"
                for c in row
            )
            + "</tr>"
            for row in rows
        )
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    @staticmethod
    def _html_picture(folder, path, caption):
        with open(os.path.join(folder, path), "rb") as stream:
            data = base64.b64encode(stream.read()).decode("ascii")
        text = html.escape(caption)
        return (
            f'<figure><img src="data:image/png;base64,{data}" alt="{text}">'
            f"<figcaption>{_inline(caption)}</figcaption></figure>"
        )
