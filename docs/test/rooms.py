#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The rooms of the house: what each includes, as the sources say it and as docs/rooms.md allows it.

    python3 docs/test/rooms.py           prints the graph (files, room, what it includes) and every breach
    python3 docs/test/rooms.py --draw    draws it in docs/architecture.md
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("solvers", "estimation", "planning", "control", "sim", "evaluation")
MOST_FILES = 50
TABLE = ROOT / "docs" / "rooms.md"
PICTURE = ROOT / "docs" / "architecture.md"
# The only outside headers of a public header: the standard library and Eigen's arrays.
PUBLIC_NEEDS = re.compile(r"[a-z_]+|Eigen/\w+|sys/types\.h")

INCLUDE = re.compile(r'^\s*#include ([<"])([^">]+)[">]', re.M)


class Source:
    """One header or source: its `room`, whether it is `public`, and its `includes` of ours and of `others`."""

    def __init__(self, root, path):
        self.path = path.relative_to(root).as_posix()
        folder, *inner = self.path.split("/")
        self.public = inner[:2] == ["include", "touchdown"]
        inner = inner[3:] if self.public else inner
        self.room = "/".join([folder, *inner[:-1]])
        content = path.read_text(encoding="utf-8")
        found = [name for _, name in INCLUDE.findall(content)]
        self.includes = [name for name in found if name.removeprefix("touchdown/").split("/")[0] in FOLDERS]
        self.others = [name for name in found if name not in self.includes]
        self.hidden = hidden_names(content) if path.suffix == ".cc" else set()


def hidden_names(content):
    """What the anonymous namespaces of a source declare: constants, types, functions with their arguments."""
    names = set()
    for body in re.findall(r"^namespace \{\n(.*?)^\}  // namespace$", content, re.S | re.M):
        names |= set(re.findall(r"^const(?:expr)? [^;={(]*?\b(k\w+)", body, re.M))
        names |= set(re.findall(r"^(?:struct|class|enum class) (\w+)", body, re.M))
        names |= {" ".join(head.split()) for head in re.findall(r"^\w[\w:<>&* \[\]]*?\b(\w+\([^;{}()]*\)) \{$", body, re.M)}
    return names


def sources(root=ROOT):
    """Every header and source of a library, without tests and benchmarks."""
    found = []
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*.*")):
            inner = path.relative_to(root / folder).parts
            if path.suffix in (".h", ".cc") and inner[0] not in ("test", "bench"):
                found.append(Source(root, path))
    return found


def room_of(include):
    """The room of an included header."""
    return include.removeprefix("touchdown/").rpartition("/")[0]


def graph(files):
    """{room: rooms that its files include}"""
    edges = {file.room: set() for file in files}
    for file in files:
        edges[file.room] |= {room_of(name) for name in file.includes} - {file.room}
    return edges


def allowed(page):
    """The table of the page: [(room, what it may include)], in its order. Names without a slash are rooms of
    the same folder, or whole folders: `map`, `planning/`."""
    rows = []
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.split("|")]
        name = re.fullmatch(rf"`((?:{'|'.join(FOLDERS)})(?:/[\w/]+)?)`", cells[1]) if len(cells) == 5 else None
        if not name:
            continue
        folder = name[1].split("/")[0]
        may = [word if word.endswith("/") else f"{folder}/{word}" for word in re.findall(r"`([\w/]+)`", cells[3])]
        rows.append((name[1], may))
    return rows


def wrong_in(files, rows):
    """A sentence for each breach of the rules of the house."""
    said = []
    order = [room for room, _ in rows]
    may = dict(rows)
    for room, reached in sorted(graph(files).items()):
        if room not in may:
            said.append(f"{room} has no line in docs/rooms.md")
            continue
        folder = room.split("/")[0]
        wanted = {other if other.split("/")[0] == folder else other.split("/")[0] + "/" for other in reached}
        above = set(order[: order.index(room)])
        for other in sorted(wanted):
            if other not in may[room]:
                said.append(f"{room} includes {other}, which its line does not allow: {_who(files, room, other)}")
            elif other.rstrip("/") not in above and not any(a.startswith(other) for a in above):
                said.append(f"{room} includes {other}, which stands below it: {_who(files, room, other)}")
        said += [f"{room} may include {other}, and does not" for other in may[room] if other not in wanted]
        count = sum(file.room == room for file in files)
        if count > MOST_FILES:
            said.append(f"{room} holds {count} files; {MOST_FILES} are the most")
    said += [f"docs/rooms.md has a line for {room}, which is no room" for room in order if room not in graph(files)]
    for room in order:
        owner = {}
        for file in (file for file in files if file.room == room):
            for name in sorted(file.hidden):
                if name in owner:
                    said.append(f"{name} is in an anonymous namespace of {owner[name]} and of {file.path}: a room is compiled together")
                owner[name] = file.path
    for file in files:
        if not file.public:
            continue
        said += [f"{file.path} is public and includes {name}, which is not" for name in file.includes
                 if not name.startswith("touchdown/")]  # fmt: skip
        said += [f"{file.path} is public and includes {name}" for name in file.others
                 if not PUBLIC_NEEDS.fullmatch(name)]  # fmt: skip
    return said


def _who(files, room, other):
    return ", ".join(
        f"{file.path} ({name})"
        for file in files
        for name in file.includes
        if file.room == room and (room_of(name) + "/").startswith(other.rstrip("/") + "/") and room_of(name) != room
    )


def text(files):
    """The graph, a line a room."""
    lines = []
    for room, reached in sorted(graph(files).items(), key=lambda item: FOLDERS.index(item[0].split("/")[0])):
        lines.append(f"{sum(file.room == room for file in files):4} {room:28} {' '.join(sorted(reached))}")
    return "\n".join(lines)


def reduced(edges):
    """The edges of a graph that do not follow from others: {from: [to]}. ValueError if it has a circle."""

    def reached(start, path=()):
        if start in path:
            circle = path[path.index(start) :]
            first = circle.index(min(circle))
            raise ValueError("these include each other: " + " -> ".join(circle[first:] + circle[: first + 1]))
        return set().union(*({to} | reached(to, (*path, start)) for to in edges[start]))

    return {start: sorted(to for to in ends if not any(to in reached(other) for other in ends))
            for start, ends in edges.items()}  # fmt: skip


def drawing(files):
    """The graph as a Mermaid diagram: folders as boxes, their rooms inside. Arrows lead from what includes to what
    is included. Those that follow from others are left out."""
    edges = graph(files)
    folders = {folder: {room for room in edges if room.split("/")[0] == folder} for folder in FOLDERS}
    folders = {folder: rooms for folder, rooms in folders.items() if rooms}
    lines = ["flowchart TB"]
    for folder, rooms in folders.items():
        inside = reduced({room: edges[room] & rooms for room in sorted(rooms)})
        lines += [f"  subgraph {folder}", "    direction TB"]
        for room, ends in inside.items():
            to = f" --> {' & '.join(map(_node, ends))}" if ends else ""
            lines.append(f"    {_node(room)}[{room.removeprefix(folder + '/')}]{to}")
        lines.append("  end")
    between = {folder: {other.split("/")[0] for room in rooms for other in edges[room]} - {folder}
               for folder, rooms in folders.items()}  # fmt: skip
    lines += [f"  {folder} ==> {' & '.join(ends)}" for folder, ends in reduced(between).items() if ends]
    return "\n".join(lines)


def _node(room):
    """A name that is neither a folder nor a word of Mermaid."""
    return room.replace("/", "_") + "_"


def drawn(page):
    """The first diagram of the page."""
    return re.search(r"^```mermaid\n(.*?)\n```$", page, re.S | re.M)


if __name__ == "__main__":
    print(text(sources()))
    problems = wrong_in(sources(), allowed(TABLE.read_text(encoding="utf-8")))
    print("\n".join(problems))
    if sys.argv[1:] == ["--draw"]:
        content = PICTURE.read_text(encoding="utf-8")
        block = drawn(content)
        try:
            drawn_anew = drawing(sources())
        except ValueError as error:
            sys.exit(str(error))
        PICTURE.write_text(content[: block.start(1)] + drawn_anew + content[block.end(1) :], encoding="utf-8")
    sys.exit(bool(problems))
