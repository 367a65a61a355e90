#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The style of the pages: words by page, long sentences, and banned words.

    python3 docs/test/words.py    prints a table of the pages, and what is wrong
"""
import re
import sys
from dataclasses import dataclass

import documents

# len(text.split()) of a whole page: tables, code and formulas count.
MOST_WORDS = {"README.md": 1500, "docs/architecture.md": 2000}
MOST_OF_A_PAGE = 2500
MOST_OF_ALL = 35000
LONGEST_SENTENCE = 35
LONG_SENTENCE = 25
MOST_LONG = 0.01  # share of the sentences of all pages
# Dead reckoning is a term of the field.
BANNED = re.compile(
    r"foretell\w*|foretold|(?<!dead )(?<!dead-)\breckon\w*|\bbetters\b|\bdearer\b|\bmend(?:s|ed|ing|able)?\b"
    r"|\buser's to\b|\bof late\b|\bput aside\b|\bkBeside\b|\bkThere\b|LoneParts?\b|Contestant",
    re.I,
)
# Reports of studies keep their words.
UNCHECKED = re.compile(r"docs/results/\w+/report\.md|docs/test/(test_)?words\.py")
ABBREVIATION = re.compile(r"\b(e\.g|i\.e|et al|Fig|eq|vs|Dr|No|[A-Z])\.")


@dataclass(frozen=True)
class Page:
    document: documents.Document
    sentences: list  # (line, words)
    cells: list  # the same of tables

    @property
    def name(self):
        return self.document.name

    @property
    def words(self):
        return len(self.document.text.split())

    @property
    def long(self):
        return sum(len(words) > LONG_SENTENCE for _, words in self.sentences)

    @property
    def longest(self):
        return max((len(words) for _, words in self.sentences + self.cells), default=0)


def plain(line):
    """A line of prose as it is read: a code span or a formula is one word, a link its text."""
    line = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", line)
    line = re.sub(r"`[^`]*`", "code", line)
    line = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", line)
    line = re.sub(r"\$[^$]*\$", "x", line)
    return re.sub(r"[*_]{1,2}", "", ABBREVIATION.sub(lambda found: found[0].replace(".", ""), line))


def sentences(document):
    """The sentences of a page, without headings, tables and blocks: [(line of the paragraph, words)]. A paragraph and
    an item of a list end a sentence, too."""
    paragraphs, open_paragraph, formula = [], None, False
    for number, line in document.prose:
        formula ^= line.count("$$") % 2 == 1
        item = re.match(r"\s*(?:[-*]|\d+\.|>)\s+", line)
        if not line.strip() or item or formula or re.match(r"#|\s*\||\$\$", line):
            open_paragraph = None
        if not line.strip() or formula or re.match(r"#|\s*\||.*\$\$$", line):
            continue
        if open_paragraph is None:
            open_paragraph = (number, [])
            paragraphs.append(open_paragraph)
        open_paragraph[1].append(plain(line[item.end() :] if item else line).strip())
    found = []
    for number, lines in paragraphs:
        parts = re.split(r"(?<=[.!?])\s+(?=[A-Z0-9\"'(]|code)", " ".join(lines))
        found += [(number, part.split()) for part in parts if re.search(r"[A-Za-z]{2}", part)]
    return found


def cells(document):
    """The parts of the cells of tables, which end with a full stop, a semicolon, a break or the cell: [(line, words)]."""
    found = []
    for number, line in document.prose:
        if re.match(r"\s*\|", line):
            parts = re.split(r"\||(?<=[.;])\s+|<br>", plain(line))
            found += [(number, part.split()) for part in parts if re.search(r"[A-Za-z]{2}", part)]
    return found


def page(document):
    return Page(document, sentences(document), cells(document))


def banned(name, text):
    """A sentence for each banned word."""
    return [f"{name}:{text.count(chr(10), 0, found.start()) + 1}: {found[0]}" for found in BANNED.finditer(text)]


def sources():
    """(name, text) of every file in which words are banned."""
    return [(name, content) for name, content in documents.sources() if not UNCHECKED.match(name)]


def glossary_terms(glossary):
    """The terms of the glossary's tables and lists: what is bold there."""
    return {term.lower() for _, line in glossary.document.prose for term in re.findall(r"\*\*([\w\s*\\-]+?)\*\*", line)}


def too_long(page):
    """A sentence for each one that is too long."""
    return [f"{page.name}:{line}: a sentence of {len(words)} words: {' '.join(words)[:80]} ..."
            for line, words in page.sentences + page.cells if len(words) > LONGEST_SENTENCE]  # fmt: skip


def wrong_on(page, terms=frozenset()):
    """A sentence for each thing that is wrong on one page."""
    said = too_long(page)
    most = MOST_WORDS.get(page.name, MOST_OF_A_PAGE)
    if page.words > most:
        said.append(f"{page.name} has {page.words} words; {most} are the most")
    body = [line for _, line in page.document.prose if line.strip() and not re.match(r"# |!\[", line)]
    if not body or re.match(r"#|\||- ", body[0]):
        said.append(f"{page.name} does not begin with a sentence")
    links = {to.partition("#")[0].rpartition("/")[2] for _, to in page.document.links()}
    used = sorted(term for term in terms if re.search(rf"\b{re.escape(term)}\b", page.document.text, re.I))
    if used and "glossary.md" not in links and not page.name.endswith("glossary.md"):
        said.append(f"{page.name} has words of docs/glossary.md ({', '.join(used[:3])}), and no link to it")
    return said


def wrong_in_all(found):
    """A sentence for each limit that the pages break together."""
    said = []
    words = sum(page.words for page in found)
    if words > MOST_OF_ALL:
        said.append(f"the pages have {words} words; {MOST_OF_ALL} are the most")
    count, long = sum(len(page.sentences) for page in found), sum(page.long for page in found)
    if long > MOST_LONG * count:
        said.append(f"{long} of {count} sentences have more than {LONG_SENTENCE} words; {MOST_LONG:.0%} are the most")
    return said


def text(kind, found):
    """The table: a row a page, and the sums."""
    lines = [f"words  sentences  > {LONG_SENTENCE}  longest  {kind}"]
    lines += [f"{page.words:5}  {len(page.sentences):9}  {page.long:4}  {page.longest:7}  {page.name}" for page in found]
    words, count, long = (sum(column) for column in zip(*((page.words, len(page.sentences), page.long) for page in found)))
    lines.append(f"{words:5}  {count:9}  {long:4}  {max(page.longest for page in found):7}  {len(found)} {kind}")
    return "\n".join(lines)


def wrong(found, others):
    """A sentence for each thing that is wrong: on pages, in other documents (only the length of sentences), in sources."""
    glossary = next(page for page in found if page.name == "docs/glossary.md")
    terms = glossary_terms(glossary)
    said = [sentence for page in found for sentence in wrong_on(page, terms)] + wrong_in_all(found)
    said += [sentence for other in others for sentence in too_long(other)]
    return said + [sentence for name, content in sources() for sentence in banned(name, content)]


if __name__ == "__main__":
    read, others = [*map(page, documents.pages())], [*map(page, documents.artefacts())]
    print(text("pages", read), text("artefacts", others), sep="\n\n")
    problems = wrong(read, others)
    print("\n".join(problems))
    sys.exit(bool(problems))
