# SPDX-License-Identifier: BSD-3-Clause
"""The pages are short and plain, and a page that is not is named."""
import documents
import pytest
import words

OPENING = "# A page\n\nLook up a thing.\n"


def page(tmp_path, text):
    path = tmp_path / "page.md"
    path.write_text(text, encoding="utf-8")
    return words.page(documents.Document(path))


def sentence(length):
    """One of so many words."""
    return "Fly " + "over " * (length - 2) + "it."


def test_the_pages_are_short_and_plain():
    found, others = ([*map(words.page, read())] for read in (documents.pages, documents.artefacts))
    print(words.text("pages", found), words.text("artefacts", others), sep="\n")
    assert len(found) > 40, "where are the pages?"
    assert {"CONTRIBUTING.md", "docs/results/hostile/tables.md", "evaluation/page/web/README.md"} <= {other.name for other in others}
    assert not (wrong := words.wrong(found, others)), "\n".join(wrong)


def test_a_plain_page_is_plain(tmp_path):
    assert words.wrong_on(page(tmp_path, OPENING + sentence(35))) == []


@pytest.mark.parametrize(
    "text, named",
    [
        (OPENING + sentence(36), "page.md:3: a sentence of 36 words"),
        (OPENING + "\n- Short.\n- " + sentence(36), "page.md:6: a sentence of 36 words"),
        (OPENING + "\n| Short; " + sentence(36) + " | b |\n", "page.md:5: a sentence of 36 words"),
        (OPENING + "Fly. " * 2494, "page.md has 2501 words; 2500 are the most"),
        ("# A page\n\n## At once\n\nLook up a thing.\n", "does not begin with a sentence"),
        ("# A page\n\n| a | b |\n", "does not begin with a sentence"),
        (OPENING + "\nThe pad drives.\n", "has words of docs/glossary.md (pad), and no link to it"),
    ],
    ids=["sentence", "item", "cell", "page", "heading", "table", "glossary"],
)
def test_what_is_wrong_is_named(tmp_path, text, named):
    said = words.wrong_on(page(tmp_path, text), {"pad", "hull"})
    assert len(said) == 1 and named in said[0], said


def test_a_term_with_the_link_is_right(tmp_path):
    assert words.wrong_on(page(tmp_path, OPENING + "\nThe [pad](glossary.md#pad) drives.\n"), {"pad"}) == []


def test_what_is_no_prose_is_no_sentence(tmp_path):
    text = OPENING + "\n## Head\n\n| a cell. | b |\n\n```sh\nrun it.\n```\n\n$$\nx = y.\n$$\n\nIt is $a b c$, `d e f` or [two words](to.md). No.\n"
    lengths = [(line, len(found)) for line, found in page(tmp_path, text).sentences]
    assert lengths == [(3, 4), (17, 7), (17, 1)]


def test_parts_of_cells_are_counted_alone(tmp_path):
    found = page(tmp_path, OPENING + "\n| `a | b` is; one. Two | 3 | four<br>it is five |\n|---|---|---|\n").cells
    assert [" ".join(part) for _, part in found] == ["code is;", "one.", "Two", "four", "it is five"]


def test_other_documents_have_short_sentences(tmp_path):
    other = page(tmp_path, "Fly. " * 2501 + "\n\n" + sentence(36))
    assert len(words.too_long(other)) == 1


def test_pages_together_have_limits(tmp_path):
    plain = page(tmp_path, OPENING + "\nFly. " * 2000)
    assert words.wrong_in_all([plain] * 17) == []
    assert "the pages have 36126 words; 35000 are the most" in words.wrong_in_all([plain] * 18)
    long = page(tmp_path, OPENING + sentence(26) + "\n\n" + sentence(25))
    assert "1 of 3 sentences have more than 25 words; 1% are the most" in words.wrong_in_all([long])


@pytest.mark.parametrize("word", ["foretold", "Foretells", "reckons with", "betters", "dearer", "mends", "of late", "put aside", "LonePart", "Contestant", "kThere"])
def test_a_word_that_stops_readers_is_named(word):
    assert words.banned("page.md", f"A line.\nIt is {word} here.\n") == [f"page.md:2: {word.split(' w')[0].removesuffix(' with')}"]


@pytest.mark.parametrize("text", ["dead reckoning", "Dead reckoning", "recommended", "an amendment", "not of latency", "of later ones"])
def test_other_words_are_not(text):
    assert words.banned("page.md", text) == []


def test_words_are_looked_for_in_sources_and_pages():
    names = {name for name, _ in words.sources()}
    assert {"README.md", "planning/replan/replanner.cc", "docs/test/rooms.py", "notebooks/01_first_landing.ipynb", "Dockerfile", ".ci/deep",
            "evaluation/data/hostile/rows.sql", "evaluation/page/web/src/page.css"} <= names  # fmt: skip
    assert not names & {"docs/results/paper/report.md", "docs/playground.html", "evaluation/data/replay/replay.js", "docs/landing.png"}
