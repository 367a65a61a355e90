# SPDX-License-Identifier: BSD-3-Clause
"""The includes agree with docs/rooms.md and docs/architecture.md, and a breach of the rules is found."""
import pytest
import rooms

PAGE = """
| room | what is in it | may include |
|---|---|---|
| `solvers/linear` | matrices | |
| `solvers/banded` | steps | `linear` |
| `planning/map` | cells | `solvers/` |
| `planning/replan` | a step | `map` |
"""
HOUSE = {
    "solvers/linear/matrix.cc": '#include "solvers/linear/matrix.h"\nnamespace {\nconstexpr double kSmall = 1;\nstruct Row {\n};\ndouble Sum(const Row& row) {\n}\n}  // namespace\n',
    "solvers/linear/matrix.h": "#include <Eigen/Core>\n",
    "solvers/banded/step.cc": '#include "touchdown/solvers/banded/step.h"\n#include "solvers/linear/matrix.h"\n',
    "solvers/include/touchdown/solvers/banded/step.h": "#include <vector>\n",
    "planning/map/cells.h": '#include "touchdown/solvers/banded/step.h"\n',
    "planning/replan/replanner.cc": '#include "planning/map/cells.h"\n',
    "planning/test/cells_test.cc": '#include "evaluation/base/words.h"\n',
}


def said(root, files):
    """The breaches in HOUSE with `files` changed."""
    for path, content in {**HOUSE, **files}.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text(content)
    return rooms.wrong_in(rooms.sources(root), rooms.allowed(PAGE))


def test_includes_are_what_the_page_says():
    files = rooms.sources()
    page = rooms.TABLE.read_text(encoding="utf-8")
    print(rooms.text(files))
    assert len(files) > 400, "where are the sources?"
    assert not (wrong := rooms.wrong_in(files, rooms.allowed(page))), "\n".join(wrong)


def test_a_house_in_order_is_in_order(tmp_path):
    assert said(tmp_path, {}) == []


@pytest.mark.parametrize(
    "path, content, sentence",
    [
        ("solvers/linear/matrix.cc", '#include "planning/map/cells.h"\n', "solvers/linear includes planning/, which its line"),
        ("solvers/linear/matrix.cc", '#include "touchdown/solvers/banded/step.h"\n', "solvers/linear includes solvers/banded"),
        ("planning/map/cells.cc", '#include "planning/replan/replanner.h"\n', "(planning/replan/replanner.h)"),
        ("planning/replan/replanner.cc", "", "planning/replan may include planning/map, and does not"),
        ("control/law.cc", "", "control has no line"),
        ("solvers/include/touchdown/solvers/banded/step.h", '#include "solvers/linear/matrix.h"\n', "public and includes solvers/linear/matrix.h"),
        ("solvers/include/touchdown/solvers/banded/step.h", "#include <ceres/ceres.h>\n", "public and includes ceres/ceres.h"),
        *[("solvers/linear/other.cc", f"namespace {{\n{twice}\n}}  // namespace\n", "is in an anonymous namespace of")
          for twice in ("constexpr std::array<double, 2> kSmall = {1, 2};", "struct Row {", "double Sum(const Row& row) {")],
    ],
)  # fmt: skip
def test_a_breach_is_named(tmp_path, path, content, sentence):
    assert any(sentence in line for line in said(tmp_path, {path: content}))


def test_an_upward_line_is_no_leave(tmp_path):
    page = PAGE.replace("| matrices | |", "| matrices | `banded` |")
    files = {"solvers/linear/matrix.cc": '#include "touchdown/solvers/banded/step.h"\n'}
    said(tmp_path, files)
    wrong = rooms.wrong_in(rooms.sources(tmp_path), rooms.allowed(page))
    assert any("solvers/banded, which stands below it" in line for line in wrong)


def test_a_full_room_is_named(tmp_path):
    wrong = said(tmp_path, {f"planning/map/part_{i}.h": "" for i in range(rooms.MOST_FILES)})
    assert wrong == ["planning/map holds 51 files; 50 are the most"]


def test_the_drawing_is_the_include_graph():
    page = rooms.PICTURE.read_text(encoding="utf-8")
    assert rooms.drawn(page)[1] == rooms.drawing(rooms.sources()), "python3 docs/test/rooms.py --draw draws it anew"


def test_rooms_that_include_each_other_are_named(tmp_path):
    said(tmp_path, {"planning/map/cells.h": '#include "planning/replan/plan.h"\n'})
    with pytest.raises(ValueError, match="include each other: planning/map -> planning/replan -> planning/map"):
        rooms.drawing(rooms.sources(tmp_path))


def test_an_include_is_drawn_unless_it_follows_from_others(tmp_path):
    said(tmp_path, {"planning/replan/plan.cc": '#include "planning/map/cells.h"\n#include "planning/path/path.h"\n',
                    "planning/path/path.h": '#include "planning/map/cells.h"\n#include "touchdown/solvers/banded/step.h"\n'})  # fmt: skip
    assert rooms.drawing(rooms.sources(tmp_path)) == """flowchart TB
  subgraph solvers
    direction TB
    solvers_banded_[banded] --> solvers_linear_
    solvers_linear_[linear]
  end
  subgraph planning
    direction TB
    planning_map_[map]
    planning_path_[path] --> planning_map_
    planning_replan_[replan] --> planning_path_
  end
  planning ==> solvers"""
