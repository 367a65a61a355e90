# SPDX-License-Identifier: BSD-3-Clause
"""A machine whose OSMesa can make no context: said in one sentence, before anything is flown."""
import os
import subprocess

import pytest


def without_osmesa(command, cwd):
    library = os.environ.get("TOUCHDOWN_NO_OSMESA")
    if not library:
        pytest.skip("TOUCHDOWN_NO_OSMESA is not set; CTest sets it where nothing is sanitized")
    return subprocess.run(
        command,
        capture_output=True,
        text=True,
        cwd=cwd,
        check=False,
        env={**os.environ, "LD_PRELOAD": library},
    )


@pytest.mark.parametrize(
    ("arguments", "fast"),  # whether sensing: fast is a way out
    [
        (("land", "open", "--set", "sensing=rendered", "--record", "out"), True),
        (("sweep", "open", "--trials", "2", "--set", "sensing=rendered", "--db", "out"), True),
        (("study", "pad", "--trials", "1", "--set", "sensing=rendered", "--db", "out"), True),
        (("study", "tags", "--poses", "2", "--db", "out"), False),
        (("land", "open", "--video", "out.mp4"), False),
    ],
)
def test_without_rendering_it_ends_with_one_sentence(program, tmp_path, arguments, fast):
    done = without_osmesa([program, *arguments], tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1
    assert "OSMesa" in done.stderr and ("sensing: fast" in done.stderr) == fast
    assert not list(tmp_path.iterdir())


def test_so_does_the_export_of_a_flight_with_images(program, tmp_path):
    words = ["land", "open", "--set", "sensing=rendered", "--set", "timeout=1", "--record", "f.db"]
    subprocess.run([program, *words], cwd=tmp_path, capture_output=True, check=False)
    done = without_osmesa([program, "export", "f.db", "--mcap", "f.mcap"], tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith("touchdown: f.db, whose images are rendered, needs off-screen rendering")
    assert [path.name for path in tmp_path.iterdir()] == ["f.db"]
