# SPDX-License-Identifier: BSD-3-Clause
"""What the pages below the folder that is named link there, is there. Sources stay in the repository."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "docs" / "test"))
from documents import Document  # noqa: E402

docs = Path(sys.argv[1]).resolve() / "docs"
links = [(page, (page.parent / to.partition("#")[0]).resolve())
         for page in docs.rglob("*.md") for _, to in Document(page).links() if not to.startswith("http")]  # fmt: skip
links = [(page, to) for page, to in links if docs in to.parents or to.name == "packages.txt"]
assert len(links) > 300, len(links)
missing = [f"{page}: {to}" for page, to in links if not to.exists()]
assert not missing, "\n".join(missing)
