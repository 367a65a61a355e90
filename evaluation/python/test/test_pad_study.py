# SPDX-License-Identifier: BSD-3-Clause
import json

import pytest

from touchdown_report.pad_study import PadStudy, PadStudyError


def test_a_study_of_the_pad_filter_is_written_and_drawn(run, tmp_path):
    table, picture = str(tmp_path / "s.db"), tmp_path / "s.png"
    done = run(
        *("study", "pad", "--scenarios", "circle", "--sigmas", "0.01", "--trials", "2"),
        *("--json", "--db", table, "--picture", str(picture)),
    )
    assert done.returncode in (0, 1), done.stderr  # two flights need not fulfil the demands
    cells = json.loads(done.stdout)["cells"]
    read = PadStudy(table)
    assert read.sigmas == [0.01] and list(read.cells) == [("circle", "turn")]
    for cell in cells:
        if cell["course"] != "turn" or cell["source"] == "all":
            continue
        for model in ("paper", "turn_rate"):
            drawn = read.cells["circle", "turn"][0.01, cell["source"], model]
            assert drawn[0] == pytest.approx(cell[model]["rmse_prediction_m"])
    assert picture.read_bytes()[:4] == b"\x89PNG"


def test_another_study_is_refused(record_path):
    with pytest.raises(PadStudyError):
        PadStudy(record_path)


def test_bad_input_is_one_sentence_and_writes_nothing(run, tmp_path):
    for arguments in (
        ("--scenarios", "nowhere"),
        ("--sigmas", "nan"),
        ("--set", "gps.rate=-1"),
        ("--set", "gps.sigma=1"),
        ("--set", "own_state=estimated"),
        ("--db", str(tmp_path / "missing" / "s.db")),
    ):
        done = run("study", "pad", "--trials", "1", *arguments)
        assert done.returncode == 2 and done.stdout == ""
        assert len(done.stderr.strip().splitlines()) == 1
    assert not list(tmp_path.iterdir())
