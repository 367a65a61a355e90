# SPDX-License-Identifier: BSD-3-Clause
"""The parts of the documents: fenced blocks, code spans, links, headings, each with its line."""
import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SHELL = ("sh", "bash")


@dataclass(frozen=True)
class Block:
    line: int  # of the first line inside
    language: str
    text: str


class Document:
    def __init__(self, path):
        self.path = path
        self.name = str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else path.name
        self.blocks = []
        self.prose = []  # (line number, text), without what is fenced
        fence, start, language = None, 0, ""
        lines = path.read_text().split("\n")
        for number, line in enumerate(lines, 1):
            if fence is None and (opening := re.match(r" *(```+)\s*(\w*)\s*$", line)):
                fence, start, language = opening[1], number + 1, opening[2]
            elif fence is not None and line.strip() == fence:
                text = "\n".join(lines[start - 1 : number - 1])
                self.blocks.append(Block(start, language, text))
                fence = None
            elif fence is None:
                self.prose.append((number, line))
        assert fence is None, f"{self.name}:{start}: this block has no end"

    def spans(self):
        """Inline code, as (line number, text)."""
        return [(n, span) for n, line in self.prose for span in re.findall(r"`([^`]+)`", line)]

    def links(self):
        """Targets of links and pictures, as (line number, text)."""
        bare = [(n, re.sub(r"`[^`]*`", "", line)) for n, line in self.prose]
        return [(n, to) for n, line in bare for to in re.findall(r"\]\(([^)\s]+)\)", line)]

    def anchors(self):
        """The names under which links find the headings."""
        heads = [line.lstrip("#").strip() for _, line in self.prose if re.match(r"#+ ", line)]
        return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}

    def script(self):
        """All shell blocks as one script, each command on its line of the document."""
        lines = [""] * (len(self.path.read_text().split("\n")) + 1)
        for block in self.blocks:
            if block.language in SHELL:
                text = block.text.split("\n")
                lines[block.line - 1 : block.line - 1 + len(text)] = text
        return "\n".join(lines)


def documents():
    paths = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
    return [Document(path) for path in paths]
