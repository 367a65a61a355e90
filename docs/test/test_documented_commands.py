# SPDX-License-Identifier: BSD-3-Clause
"""Every shell block of README.md and docs/ runs in a folder as ./demo.sh leaves it. Stand-ins (stand_in.py)
replace the programs that it calls. So a new command is covered as soon as a page has it."""
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from documents import ROOT, SHELL, Document, documents

STAND_IN = Path(__file__).resolve().parent / "stand_in.py"
CALLED = ["demo.sh", "deb.sh", "test.sh", "python.sh", "my_env/bin/python", "build/release/bin/touchdown", "build/release/estimation/estimation_test",
          "build/release/sim/sim_test", "build/own/own_program", "build/own_parts/own_parts", "build/own_backend/own_backend",
          "build/go_to_goal/go_to_goal", "build/onboard/onboard", "bin/cmake",
          "bin/apt", "bin/docker"]  # fmt: skip
# Words that stand for something: NAME, FILE, N, K=V.
PLACEHOLDER = re.compile(r"\b[A-Z]+\b|\.\.\.|…")
HEAD = """set -uET
trap 'export DOCUMENT_LINE=$LINENO' DEBUG
trap 'echo "$LINENO: status $? from $BASH_COMMAND" >>"$DOCUMENT_LOG.errors"' ERR
"""


def written():
    """The documents without the pages of the notebooks, whose commands run with the notebooks."""
    return [document for document in documents() if not document.name.startswith("docs/notebooks/")]


def make_folder(folder):
    """The repository as the commands see it: sources to read, stand-ins to call, cp, id, and ffmpeg for videos."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("sim", "evaluation"):
        (folder / name).symlink_to(ROOT / name)
    shutil.copytree(ROOT / "docs" / "examples", folder / "docs" / "examples")
    for name in CALLED:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).symlink_to(STAND_IN)
    for name in ("cp", "ffmpeg", "id"):
        (folder / "bin" / name).symlink_to(shutil.which(name) or f"/usr/bin/{name}")
    return folder


def run_script(script, folder):
    """Runs it there. Returns what was wrong, by line, and what ran."""
    log = folder / "log"
    environment = dict(os.environ, PATH=str(folder / "bin"), DOCUMENT_LOG=str(log))
    # The traps come from a file of their own, so that line 1 of the script is line 1.
    (folder / "head").write_text(HEAD)
    done = subprocess.run(
        ["/bin/bash", "-c", 'source "$0" && source "$1"', "./head", "/dev/stdin"],
        input=script, text=True, cwd=folder, env=environment, capture_output=True, check=False,
        timeout=900,
    )  # fmt: skip
    entries = [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []
    wrong = [f"{e['line']}: {shlex.join(e['arguments'])}: {e['wrong']}" for e in entries if "wrong" in e]
    told = {sentence.split(":")[0] for sentence in wrong}
    errors = Path(f"{log}.errors")
    if errors.exists():  # of the shell itself: what a stand-in says is known already
        wrong += [e for e in errors.read_text().splitlines() if e.split(":")[0] not in told]
    if done.stderr:
        wrong.append(done.stderr)
    return wrong, [entry for entry in entries if "short" in entry]


@pytest.fixture(scope="session")
def after_demo(tmp_path_factory):
    """What ./demo.sh leaves in out/, made by the command that it ends with."""
    folder = make_folder(tmp_path_factory.mktemp("demo"))
    (folder / "out").mkdir()
    flights = re.findall(r"^build/release/bin/touchdown land .*$", (ROOT / "demo.sh").read_text(), re.M)
    assert len(flights) == 1
    wrong, _ = run_script(flights[0], folder)
    assert not wrong, "\n".join(wrong)
    return folder / "out"


def test_demo_builds_all_that_is_installed():
    """Pages have `cmake --install` after it. `./test.sh bare` does both in a bare system."""
    assert re.search(r"^build_release OFF$", (ROOT / "demo.sh").read_text(), re.M), "some targets only"


@pytest.fixture
def folder(after_demo):
    with tempfile.TemporaryDirectory() as path:
        folder = make_folder(Path(path) / "touchdown")
        shutil.copytree(after_demo, folder / "out")
        yield folder


@pytest.fixture(scope="session")
def commands(program):
    """The sub-commands that there are."""
    top = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    found = set(re.findall(r"^  ([a-z-]+)  ", top, re.M))
    assert "land" in found
    return found


def inline_commands(document, commands):
    """Commands in code spans that are complete; those that only name an option are checked below."""
    for line, span in document.spans():
        words = span.split()
        complete = len(words) > 2 and not words[-1].startswith("--") and not PLACEHOLDER.search(span)
        if complete and words[0] == "touchdown" and words[1] in commands:
            yield line, f"build/release/bin/{span}"


@pytest.mark.parametrize("document", written(), ids=lambda document: document.name)
def test_every_command_runs(document, folder, commands):
    lines = document.script().split("\n")
    for line, command in inline_commands(document, commands):
        lines[line - 1] += f"; {command}" if lines[line - 1] else command
    wrong, ran = run_script("\n".join(lines), folder)
    print(f"{len(ran)} commands, {sum(entry['cpu_s'] for entry in ran):.1f} s of CPU time")
    for entry in sorted(ran, key=lambda entry: -entry["cpu_s"])[:5]:
        print(f"{entry['cpu_s']:6.2f} s  line {entry['line']}: {shlex.join(entry['short'])}")
    assert not wrong, "\n".join(f"{document.name}:{sentence}" for sentence in wrong)


def test_the_lines_of_pandas_read_a_record(folder):
    blocks = [block for block in Document(ROOT / "docs" / "record.md").blocks if block.language == "python"]
    assert len(blocks) == 1 and len(blocks[0].text.splitlines()) == 6, "six lines"
    done = subprocess.run([sys.executable, "-c", blocks[0].text], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert re.search(r"planned +\d+", done.stdout), done.stdout


def test_no_command_hides_where_it_is_not_collected():
    starts = re.compile(r"\s*(\$ )?(build/|touchdown [a-z]|\./\w+\.sh|cmake -|cmake --|ctest|apt|docker |git )")
    hidden = []
    for document in written():
        other = [(n, line) for n, line in document.prose if line.startswith("    ")]
        for block in document.blocks:
            lines = list(enumerate(block.text.split("\n"), block.line))
            if block.language not in SHELL:  # text: what was printed, of which the first line tells
                other += lines[:1] if block.language == "text" else lines
        hidden += [f"{document.name}:{n}: {line}" for n, line in other if starts.match(line)]
    assert not hidden, "put these into ```sh blocks:\n" + "\n".join(hidden)


def test_options_named_in_prose_exist(program, commands):
    helps, wrong = {}, []
    for document in written():
        for line, span in document.spans():
            words = [word.strip(",;").split("|")[0] for word in span.split()]
            if words[0] != "touchdown" or len(words) < 2 or words[1] not in commands:
                continue
            study = words[1] == "study" and len(words) > 2 and words[2].islower()
            command = tuple(words[1:3] if study else words[1:2])
            if command not in helps:
                done = subprocess.run([program, *command, "--help"], capture_output=True, text=True, check=False)  # fmt: skip
                helps[command] = done.stdout if done.returncode == 0 else ""
            options = [word.split("=")[0] for word in words if word.startswith("--")]
            wrong += [f"{document.name}:{line}: {span}" for o in options or [""]
                      if not helps[command] or not re.search(rf"{o}\b", helps[command])]  # fmt: skip
    assert not wrong, "the program has no such command or option:\n" + "\n".join(wrong)


def test_keys_named_in_prose_exist():
    """`key=value` and `--set key=value` in prose, against the table that is checked by the schema."""
    table = (ROOT / "docs" / "reference" / "scenario_keys.md").read_text()
    keys = set(re.findall(r"^\| `([a-z_.]+)`", table, re.M))
    wrong = []
    for document in written():
        for line, span in document.spans():
            for key in re.findall(r"(?:^|--set |--vary )'?([a-z_]+(?:\.[a-z_]+)*)=", span):
                patterned = key.startswith(("terms.", "solver.options."))
                if key not in keys and not patterned:
                    wrong.append(f"{document.name}:{line}: {span}")
    assert not wrong, "no scenario has these keys:\n" + "\n".join(wrong)


@pytest.mark.parametrize(
    "command, sentence",
    [
        ("build/release/bin/touchdown land open --no-such-option", "--no-such-option"),
        ("build/release/bin/touchdown sweep open --set pad.sped=1", "pad.sped"),
        ("build/release/bin/touchdown list terms --json; build/release/bin/touchdown flutter", "flutter"),
        ("touchdown list terms", "touchdown: command not found"),
        ("mv out out2", "mv: command not found"),
        ("build/release/bin/no_such_program", "No such file"),
        ("./demo.sh --fast", "demo.sh knows no --fast"),
        ("cmake --preset fast", "no preset fast"),
        ("cmake -S docs/nowhere -B build/x", "docs/nowhere"),
        ("cmake --preset release -DTOUCHDOWN_WITH_MAGIC=ON", "TOUCHDOWN_WITH_MAGIC"),
        ("cmake -E tar", "no rule"),
        ("apt install touchdown", "no rule"),
        ("docker run touchdown land no_such_world", "no_such_world"),
        ("build/release/sim/sim_test --gtest_filter=NoSuch.*", "no test"),
    ],
)
def test_a_wrong_command_is_found_with_its_line(command, sentence, folder):
    path = folder / "wrong.md"
    path.write_text(f"A page.\n\n```sh\n# First.\n{command}\n```\n")
    wrong, _ = run_script(Document(path).script(), folder)
    assert len(wrong) >= 1 and wrong[0].startswith("5: "), wrong
    assert sentence in "\n".join(wrong)


def test_a_command_that_stays_long_is_found(folder, monkeypatch):
    monkeypatch.setenv("TOUCHDOWN_CPU_SECONDS", "1")
    wrong, _ = run_script("build/release/bin/touchdown study tags --width 4000", folder)
    assert "more than 1 s of CPU time" in wrong[0] and "needs a rule" in wrong[0]
