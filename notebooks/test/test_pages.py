# SPDX-License-Identifier: BSD-3-Clause
"""The rendered pages, which CTest has just made: complete, and readable without a network."""
import os
import re
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parent.parent
PAGES = Path(os.environ["TOUCHDOWN_NOTEBOOK_PAGES"])
NAMES = os.environ["TOUCHDOWN_NOTEBOOKS"].split(",")


@pytest.fixture(params=NAMES)
def page(request):
    return (PAGES / f"{request.param}.html").read_text(encoding="utf-8")


def test_the_pictures_are_inside(page):
    pictures = re.findall(r'<img[^>]*?src="(.{0,30})', page, re.DOTALL)
    assert pictures and all(source.startswith("data:image/png;base64,") for source in pictures)


def test_nothing_is_fetched(page):
    fetched = re.findall(r'<(?:script|link|img|iframe)[^>]*?(?:src|href)="([^"]{0,60})', page)
    assert [source for source in fetched if source and not source.startswith("data:")] == []
    assert not re.search(r"@import|url\(\s*['\"]?(?!['\"]?(?:data:|#))", page)
    assert "cdn" not in re.sub(r"base64,[A-Za-z0-9+/=\s]+", "", page).lower()


def test_links_lead_to_the_other_pages(page):
    assert '.ipynb"' not in page
    for name in re.findall(r'href="(\w+)\.html"', page):
        assert (FOLDER / f"{name}.ipynb").is_file()
