# SPDX-License-Identifier: BSD-3-Clause
"""`--video` for a user: the file and the failures."""
import json
import os
import subprocess

import pytest


def probe(path):
    done = subprocess.run(
        ["ffprobe", "-v", "error", "-select_streams", "v", "-show_streams", "-of", "json", str(path)],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    (stream,) = json.loads(done.stdout)["streams"]
    return stream


def test_a_flight_and_its_record_give_the_same_video(run, tmp_path):
    record, flown, again = (tmp_path / name for name in ("f.db", "flown.mp4", "again.mp4"))
    done = run("land", "open", "--set", "timeout=1", "--record", str(record), "--video", str(flown))
    assert done.returncode == 1 and done.stdout.startswith("timeout"), done.stderr
    done = run("replay", str(record), "--video", str(again))
    assert done.returncode == 0 and done.stdout == f"{again}: a video of the flight\n", done.stderr
    assert "pictures" in done.stderr  # how far it is
    assert flown.read_bytes() == again.read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["again.mp4", "f.db", "flown.mp4"]
    stream = probe(flown)
    assert (stream["codec_name"], stream["width"], stream["height"]) == ("h264", 1280, 720)
    assert (stream["r_frame_rate"], stream["pix_fmt"]) == ("25/1", "yuv420p")
    held = 1.5  # the last picture
    assert float(stream["duration"]) == pytest.approx(1.0 + held, abs=0.08)


def test_a_signal_leaves_nothing_of_a_video(interrupted):
    interrupted("land", "open", "--video", "f.mp4", begun="f.mp4.table.partial-*")


@pytest.mark.parametrize(
    ("path", "why"),
    [("f.avi", "the name must end in .mp4"), ("none/f.mp4", "there is no directory none")],
)
def test_a_bad_name_is_refused_before_the_flight(run, tmp_path, path, why):
    for command in (("land", "open"), ("replay", "none.db")):
        done = run(*command, "--video", path, cwd=tmp_path)
        assert done.returncode == 2 and done.stdout == ""
        assert why in done.stderr and len(done.stderr.strip().splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_a_scene_that_cannot_be_drawn_is_refused_before_the_flight(run, tmp_path):
    done = run("land", "open", "--set", "pad.deck_size=0.6", "--video", "f.mp4", cwd=tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert "pad.deck_size must be in [1.28, 5] m with a video" in done.stderr
    assert not list(tmp_path.iterdir())


def test_replay_needs_a_record_and_something_to_make(run, tmp_path):
    done = run("replay", "none.db", "--video", "f.mp4", cwd=tmp_path)
    assert done.returncode == 2 and "none.db: there is no such record" in done.stderr
    assert run("replay", "none.db").returncode == 2
    done = run("land", "open", "--record", "f.mp4", "--video", "f.mp4", cwd=tmp_path)
    assert done.returncode == 2 and "the same file" in done.stderr
    assert not list(tmp_path.iterdir())


def test_without_the_encoder_nothing_is_flown(program, tmp_path):
    done = subprocess.run([program, "land", "open", "--video", "f.mp4"], cwd=tmp_path, capture_output=True,
                          text=True, check=False, env={**os.environ, "PATH": str(tmp_path)})  # fmt: skip
    assert done.returncode == 2 and done.stdout == ""
    assert "install the package ffmpeg" in done.stderr and not list(tmp_path.iterdir())


def test_an_encoder_that_fails_leaves_the_result(program, tmp_path):
    encoder = tmp_path / "bin" / "ffmpeg"
    encoder.parent.mkdir()
    encoder.write_text("#!/bin/sh\necho disk full >&2\nexit 1\n")
    encoder.chmod(0o755)
    done = subprocess.run([program, "land", "open", "--set", "timeout=1", "--video", "f.mp4"], cwd=tmp_path,
                          capture_output=True, text=True, check=False, env={**os.environ, "PATH": str(encoder.parent)})  # fmt: skip
    assert done.returncode == 1 and done.stdout.startswith("timeout")
    assert "--video f.mp4: the video was not made: ffmpeg failed (disk full)" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["bin"]
