# SPDX-License-Identifier: BSD-3-Clause
"""`touchdown export` for a user: its output and its failures. evaluation/mcap/node tests the content of the file."""
import subprocess

import pytest


@pytest.fixture(scope="module")
def record(program, tmp_path_factory):
    path = tmp_path_factory.mktemp("export") / "f.db"
    words = ["land", "straight_turn", "--set", "sensing=rendered", "--set", "timeout=4", "--record", path]
    subprocess.run([program, *words], capture_output=True, check=False)
    return path


def test_it_says_where_the_file_is_and_how_far_it_was(run, record, tmp_path):
    file = tmp_path / "f.mcap"
    done = run("export", str(record), "--mcap", str(file))
    assert done.returncode == 0 and done.stdout == f"{file}: open it in Foxglove or Rerun\n", done.stderr
    assert "messages" in done.stderr
    bytes_ = file.read_bytes()
    assert bytes_[:8] == bytes_[-8:] == b"\x89MCAP0\r\n"
    assert list(tmp_path.iterdir()) == [file]


def test_a_signal_leaves_nothing_of_it(interrupted, record):
    interrupted("export", record, "--mcap", "f.mcap", begun="f.mcap.partial-*")


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["none.db", "--mcap", "f.mcap"], "none.db: there is no such record"),
        (["none.db", "--mcap", "f.bag"], "the name must end in .mcap"),
        (["none.db", "--mcap", "none/f.mcap"], "there is no directory none"),
        (["f.mcap", "--mcap", "f.mcap"], "the same file"),
        (["none.db"], "--mcap is required"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(run, tmp_path, words, why):
    done = run("export", *words, cwd=tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert why in done.stderr and len(done.stderr.strip().splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_a_file_of_another_kind_is_named(run, tmp_path):
    (tmp_path / "f.db").write_text("a text")
    done = run("export", "f.db", "--mcap", "f.mcap", cwd=tmp_path)
    assert done.returncode == 2 and "f.db: not a record that this build reads" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["f.db"]
