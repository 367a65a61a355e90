# SPDX-License-Identifier: BSD-3-Clause
"""Everything that the documents name exists: files, symbols, links, code. Every page can be found."""
import re

import pytest
from documents import ROOT, Document, documents, sources

PAGES = documents()
EXAMPLES = [ROOT / "docs" / "CMakeLists.txt", *sorted((ROOT / "docs" / "examples").rglob("*.*")),
            *sorted((ROOT / "evaluation" / "test" / "consumer").iterdir())]  # fmt: skip
FOLDERS = "touchdown|solvers|estimation|planning|control|sim|evaluation|docs|cmake"


def in_tree(path):
    """The place of a file that a page names. Public headers are named by their include path."""
    return re.sub(r"^touchdown/(\w+)/", r"\1/include/touchdown/\1/", path)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    wrong = []
    for line, target in page.links():
        if re.match(r"https?://", target):
            continue
        path, _, anchor = target.partition("#")
        there = (page.path.parent / path).resolve() if path else page.path
        if not there.exists():
            wrong.append(f"{page.name}:{line}: there is no {path}")
        elif anchor and anchor not in Document(there).anchors():
            wrong.append(f"{page.name}:{line}: {path or page.name} has no heading #{anchor}")
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_named_files_exist(page):
    wrong = []
    for line, span in page.spans():
        path = re.fullmatch(rf"((?:{FOLDERS})/[\w./-]*?)(?:\.\{{h,cc\}})?/?", span)
        if path and not list(ROOT.glob(in_tree(path[1]) + "*")):
            wrong.append(f"{page.name}:{line}: there is no {span}")
    assert not wrong, "\n".join(wrong)


def named_symbols(row):
    """(file, symbol) of the cells of a table row in which symbols follow their file."""
    for cell in row.split("|"):
        file = None
        for span in re.findall(r"`([^`]+)`", cell):
            if re.fullmatch(rf"({FOLDERS})/[\w/]+\.(h|cc|xml)", span):
                file = span
            elif file and re.fullmatch(r"[\w:]+", span):
                yield file, span


@pytest.mark.parametrize("name, fewest", [("docs/equations.md", 27), ("docs/ego.md", 10)])
def test_equations_name_symbols_that_exist(name, fewest):
    page = next(page for page in PAGES if page.name == name)
    rows, wrong = 0, []
    for line, text in page.prose:
        if not text.startswith("|") or "`" not in text:
            continue
        symbols = list(named_symbols(text))
        rows += bool(symbols)
        for file, symbol in symbols:
            if not re.search(rf"\b{symbol}\b", (ROOT / in_tree(file)).read_text()):
                wrong.append(f"{name}:{line}: {file} has no {symbol}")
    assert not wrong, "\n".join(wrong)
    assert rows >= fewest


def test_every_equation_of_the_paper_has_its_row():
    page = next(page for page in PAGES if page.name == "docs/equations.md")
    rows = {m[1]: list(named_symbols(text)) for _, text in page.prose if (m := re.match(r"\| (\d+) \|", text))}
    assert sorted(map(int, rows)) == list(range(1, 23))
    assert all(rows.values()), [number for number, symbols in rows.items() if not symbols]


def test_code_in_the_documents_is_code_of_the_examples():
    """Blocks of C++, CMake and YAML are excerpts of what the tests compile; blanks do not count."""
    known = ["".join(path.read_text(errors="replace").split()) for path in EXAMPLES if path.is_file()]
    wrong = []
    for page in PAGES:
        for block in page.blocks:
            text = "".join(block.text.split())
            if block.language in ("cpp", "cmake", "yaml") and not any(text in code for code in known):
                wrong.append(f"{page.name}:{block.line}")
    assert not wrong, "no file of docs/examples holds the code of\n" + "\n".join(wrong)


def linked(path):
    """The pages to which a page leads."""
    return {(path.parent / to.partition("#")[0]).resolve() for _, to in Document(path).links()}


def test_every_page_is_in_the_index():
    """Pages of results are listed in their own index, or in the summary that is listed there."""
    index, results = ROOT / "docs" / "README.md", ROOT / "docs" / "results" / "README.md"
    listed = linked(index) | linked(results)
    for summary in results.parent.glob("*.md"):
        listed |= linked(summary) & set((results.parent / summary.stem).rglob("*.md"))
    missing = [page.name for page in PAGES if page.path not in listed | {index, ROOT / "README.md"}]
    assert not missing, "docs/README.md does not name " + ", ".join(missing)
    assert index in linked(ROOT / "README.md") and results in linked(index)


def test_pages_that_sources_name_exist():
    wrong, found = [], 0
    for name, text in sources():
        if name.startswith("docs/test/"):  # names pages to test with
            continue
        for number, line in enumerate(text.split("\n"), 1):
            pages = re.findall(r"\bdocs/[\w/]+\.md", line)
            found += len(pages)
            wrong += [f"{name}:{number}: {page}" for page in pages if not (ROOT / page).exists()]
    assert found > 100, "where are they?"
    assert not wrong, "there is no such page:\n" + "\n".join(wrong)
