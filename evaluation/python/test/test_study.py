# SPDX-License-Identifier: BSD-3-Clause
"""A small real study from end to end: flown, reported, continued, reported again without flying."""
import json
import re
import shutil
import sqlite3
import subprocess

import pytest

pytest.importorskip("statsmodels")
np = pytest.importorskip("numpy")
pd = pytest.importorskip("pandas")

from touchdown_report.study import paper as paper_chapter  # noqa: E402
from touchdown_report.study import statistics, tables  # noqa: E402
from touchdown_report.study.data import Study, StudyError  # noqa: E402
from touchdown_report.study.report import write_report  # noqa: E402

# Cells and methods with the names of the paper's study, so that its own chapters are drawn, too.
TINY = """
title: A tiny study
report: paper
seed: 3
reference: planned
set: {timeout: 12, start.position_spread: [1, 1, 0]}
cells:
  - {name: figure_4, scenario: open, title: "Straight on", labels: {wind_mps: 0}, set: {pad.motion: line}}
  - {name: case_1_wind_4, scenario: open, labels: {wind_mps: 4}, set: {wind.mean: 4}, methods: [planned, vertical]}
methods:
  - {name: planned, set: {descent: planned}, trials: 3, quick: 2, record: true}
  - {name: vertical, set: {descent: vertical, timeout: 5}, trials: 2, quick: 1}
  - {name: ego, title: "EGO, 5 Hz", set: {planner: ego, timeout: 3}, trials: 3, quick: 1}
"""


@pytest.fixture(scope="module")
def flown(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    (folder / "tiny.yaml").write_text(TINY)
    done = run("study", "run", "tiny.yaml", "--out", "out", "--jobs", "1", cwd=folder)
    assert done.returncode == 0, done.stderr
    return folder, done.stdout


def test_the_folder_holds_everything(flown):
    folder, said = flown
    out = folder / "out"
    assert {p.name for p in out.iterdir()} == {
        *("study.db", "study.json", "summary.json", "report.html", "report.md", "csv", "figures", "records")
    }
    recorded = {"figure_4-planned", "case_1_wind_4-planned"}
    assert {p.name for p in (out / "records").iterdir()} == {r + e for r in recorded for e in (".db", ".html")}
    for name in recorded:
        assert f'<a href="records/{name}.html">look at it</a>' in (out / "report.html").read_text()
    pictures = {p.stem for p in (out / "figures").iterdir()}
    assert {"success", "outcomes", "landing_times", "figure_04"} <= pictures
    for name in pictures:
        assert (out / "figures" / f"{name}.png").read_bytes()[:4] == b"\x89PNG"
        assert "<svg" in (out / "figures" / f"{name}.svg").read_text()
    assert "Straight on\n  planned" in said and "succeeded 3 of 3" in said


def test_the_report_says_what_the_table_holds(flown):
    out = flown[0] / "out"
    study = Study(str(out))
    parts = tables.parts(study).set_index(["cell", "method"])
    assert parts.loc[("figure_4", "planned"), "succeeded"] == 3
    assert parts.loc[("figure_4", "vertical"), ["trials", "succeeded"]].tolist() == [2, 0]
    assert parts.loc[("figure_4", "ego"), "half_landed_s"] == float("inf")
    with sqlite3.connect(out / "study.db") as db:
        times = [t for t, in db.execute("SELECT time_to_land_s FROM trial WHERE landed ORDER BY trial")]
    assert parts.loc[("figure_4", "planned"), "time_to_land_median_s"] == sorted(times[:3])[1]
    comparisons = tables.comparisons(study)
    ego = comparisons[(comparisons["method"] == "ego") & (comparisons["cell"] == "figure_4")].iloc[0]
    assert (ego["pairs"], ego["reference_only"], ego["method_only"], ego["p"]) == (3, 3, 0, 0.25)
    assert set(tables.outcomes(study).loc[("figure_4", "ego")].items()) >= {("timeout", 3), ("landed", 0)}
    text = (out / "report.md").read_text()
    assert "| Straight on | 3 of 3 [29.2, 100.0] % | 0 of 2 [0.0, 84.2] % | 0 of 3 [0.0, 70.8] % |" in text
    assert "EGO, 5 Hz" in text
    html = (out / "report.html").read_text()
    assert html.count("data:image/png;base64,") == html.count("<img") >= 4 and "http" not in html


def test_what_only_follows_counts_as_no_landing(flown, tmp_path):
    for name in ("study.db", "study.json"):
        (tmp_path / name).write_bytes((flown[0] / "out" / name).read_bytes())
    with sqlite3.connect(tmp_path / "study.db") as db:
        first = "(SELECT trial FROM variation WHERE key = 'cell' AND value = 'figure_4')"
        db.execute(f"UPDATE trial SET following_mean_error_m = 0.1 WHERE trial IN {first}")
    write_report(Study(str(tmp_path)))
    text = (tmp_path / "report.md").read_text()
    assert "- planned: 3 of 3 landed over all cells" in text and "- EGO" not in text


@pytest.mark.parametrize(
    "landed, paper, verdict",
    [
        (100, 62.0, "better"),
        (100, 45.0, "not shown"),
        (100, 20.0, "worse"),
        (55, 90.0, "not shown"),  # half have landed, the interval has no end
        (55, 20.0, "worse"),
        (45, 90.0, "not shown"),  # half never have
        (0, 60.0, "worse"),
    ],
)
def test_verdicts_are_about_all_flights(landed, paper, verdict):
    times = np.arange(1.0, 101.0)
    half = statistics.time_to_land(times, times <= landed, np.full(100, 200.0)).median
    assert paper_chapter._below(half, paper) == verdict


def test_landing_is_reproduced_where_the_interval_says_so():
    def verdict(good, of):
        return paper_chapter._lands(pd.DataFrame({"landed": [True] * good + [False] * (of - good)}))

    assert verdict(100, 100) == verdict(70, 100) == "reproduced"
    assert verdict(5, 5) == verdict(51, 100) == "not shown" and verdict(20, 100) == "not reproduced"


def test_seeds_are_paired(flown):
    study = Study(str(flown[0] / "out"))
    first, second = study.part("figure_4", "planned"), study.part("case_1_wind_4", "planned")
    assert list(first.index) == list(second.index) and len(set(first.index)) == 3
    assert set(study.part("figure_4", "vertical").index) < set(first.index)


def test_the_command_beside_a_failure_flies_it_again(flown, run):
    failures = pd.read_csv(flown[0] / "out" / "csv" / "failures.csv")
    one = failures[failures["method"] == "ego"].iloc[0]
    program, *words = one["command"].split()
    assert program == "touchdown" and words[:2] == ["land", "open"]
    done = run(*(word.strip("'") for word in re.findall(r"'[^']*'|\S+", " ".join(words))), "--json")
    again = json.loads(done.stdout)
    assert again["outcome"] == one["outcome"] and again["seed"] == one["seed"]
    assert again["simulated_s"] == pytest.approx(one["simulated_s"])


def test_a_finished_study_is_reported_again_without_a_flight(flown, run):
    folder, said = flown

    def trials():
        with sqlite3.connect(folder / "out" / "study.db") as db:
            return list(db.iterdump())

    before = trials()
    plan = (folder / "out" / "study.json").read_text()
    text = (folder / "out" / "report.md").read_text()
    for option in ((), ("--report-only",)):
        done = run("study", "run", "tiny.yaml", "--out", "out", *option, cwd=folder)
        assert done.returncode == 0 and done.stdout == said, done.stderr
    assert trials() == before
    assert (folder / "out" / "study.json").read_text() == plan
    assert (folder / "out" / "report.md").read_text() == text
    summary = json.loads(run("study", "run", "tiny.yaml", "--out", "out", "--report-only", "--json", cwd=folder).stdout)
    assert summary["trials"] == 13 and summary["errors"] == 0 and len(summary["parts"]) == 5


def test_a_part_flown_again_is_the_part_of_the_whole(flown, run):
    folder, _ = flown
    part = ("--cells", "figure_4", "--methods", "planned,ego", "--trials", "2")
    done = run("study", "run", "tiny.yaml", "--out", "part", *part, "--json", cwd=folder)
    assert done.returncode == 0, done.stderr
    rates = json.loads(done.stdout)
    assert [(p["method"], p["trials"]) for p in rates["parts"]] == [("planned", 2), ("ego", 2)]
    assert rates["parts"][1]["outcomes"] == {"timeout": 2}

    def rows(out):
        trials = Study(str(folder / out)).trials
        chosen = trials[(trials["cell"] == "figure_4") & trials["method"].isin(["planned", "ego"])]
        timing = [c for c in trials if c.endswith(("cpu_s", "wall_s", "_ms")) or c == "trial" or c.startswith("deadline_misses")]
        kept = chosen.groupby("method").head(2).drop(columns=timing)
        return kept.sort_values(["method", "seed"]).reset_index(drop=True)

    pd.testing.assert_frame_equal(rows("part"), rows("out"), check_exact=True)
    done = run("study", "run", "tiny.yaml", "--out", "out", *part, cwd=folder)
    assert done.returncode == 2 and "study.db" in done.stderr


def test_the_summary_has_what_the_page_shows(flown):
    out = flown[0] / "out"
    summary = json.loads((out / "summary.json").read_text())
    page = (out / "report.md").read_text()
    shown = [line for line in page.splitlines() if line.startswith("| ")]
    told = [
        "| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |"
        for table in summary["tables"]
        for row in (table["columns"], *table["rows"])
    ]
    assert told == shown
    for name in ("parts", "comparisons", "outcomes", "failures"):
        csv = pd.read_csv(out / "csv" / f"{name}.csv")
        assert len(summary[name]) == len(csv) and set(csv.columns) <= set(summary[name][0])


def test_an_error_of_the_last_seconds_is_told_where_the_style_follows_first(flown, tmp_path):
    for name in ("study.db", "study.json"):
        (tmp_path / name).write_bytes((flown[0] / "out" / name).read_bytes())
    with sqlite3.connect(tmp_path / "study.db") as db:
        db.execute(
            "UPDATE trial SET landed = 1, outcome = 'landed', time_to_land_s = 4, touchdown_error_m = 0.1, "
            "mean_abs_error_x_m = 0.25, mean_abs_error_y_m = 0.5"
        )
    write_report(Study(str(tmp_path)))
    parts = json.loads((tmp_path / "summary.json").read_text())["parts"]
    told = {(p["cell"], p["method"]): p["mean_abs_error_x_median_m"] for p in parts}
    assert told["case_1_wind_4", "vertical"] == 0.25 and told["case_1_wind_4", "planned"] is None
    rows = [line for line in (tmp_path / "report.md").read_text().splitlines() if "wind 4 m/s, mean error in x" in line]
    assert [cell.strip() for cell in rows[0].split("|")[3:5]] == ["0.250 (n 2)", "–"]


def test_another_form_of_the_study_is_refused(flown, run):
    folder, _ = flown
    done = run("study", "run", "tiny.yaml", "--out", "out", "--quick", cwd=folder)
    assert done.returncode == 2 and "study.db" in done.stderr and done.stderr.count("\n") == 1


@pytest.mark.parametrize("report", ["paper", "solvers", "ablation", "plain"])
@pytest.mark.parametrize("there", ["trial < 1", "trial = 3", "trial < 4", "trial IN (0, 3)", "trial > 8"])
def test_a_report_of_half_a_study(flown, tmp_path, report, there):
    for name in ("study.db", "study.json"):
        (tmp_path / name).write_bytes((flown[0] / "out" / name).read_bytes())
    plan = json.loads((tmp_path / "study.json").read_text())
    (tmp_path / "study.json").write_text(json.dumps({**plan, "report": report}))
    with sqlite3.connect(tmp_path / "study.db") as db:
        for table in ("trial", "timing", "replan_time"):
            db.execute(f"DELETE FROM {table} WHERE NOT ({there})")
        (count,) = db.execute("SELECT count(*) FROM trial").fetchone()
    write_report(Study(str(tmp_path)))
    assert f"{count} trials, " in (tmp_path / "report.md").read_text()


def test_a_study_can_be_reported_while_it_flies(program, run, tmp_path):
    (tmp_path / "tiny.yaml").write_text(TINY)
    process = subprocess.Popen([program, "study", "run", "tiny.yaml", "--out", "out", "--jobs", "1"], cwd=tmp_path)
    try:
        while True:
            done = run("study", "run", "tiny.yaml", "--out", "out", "--report-only", cwd=tmp_path)
            if done.returncode == 0:
                break
            assert done.returncode == 2 and ("study.db" in done.stderr or "study.json" in done.stderr)
    finally:
        process.kill()
        process.wait()
    assert "succeeded" in done.stdout


def test_failures_are_recorded_on_demand_and_linked(flown, run, tmp_path):
    shutil.copytree(flown[0], tmp_path, dirs_exist_ok=True)
    failed = pd.read_csv(tmp_path / "out" / "csv" / "failures.csv")["trial"]
    done = run("study", "run", "tiny.yaml", "--out", "out", "--record", "failures", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    report = (tmp_path / "out" / "report.html").read_text()
    assert len(failed) > 0
    for trial in failed:
        assert (tmp_path / "out" / "records" / f"trial_{trial}.html").exists()
        assert f'"records/trial_{trial}.html"' in report


def test_records_of_another_flight_are_flown_again(flown, run, tmp_path):
    shutil.copytree(flown[0] / "out", tmp_path / "out")
    shutil.copy(flown[0] / "tiny.yaml", tmp_path)
    record = tmp_path / "out" / "records" / "figure_4-planned.db"
    own = record.read_bytes()
    shutil.copy(tmp_path / "out" / "records" / "case_1_wind_4-planned.db", record)
    assert record.read_bytes() != own
    assert run("study", "run", "tiny.yaml", "--out", "out", cwd=tmp_path).returncode == 0
    with sqlite3.connect(record) as db:
        (scenario,) = db.execute("SELECT value FROM meta WHERE key = 'scenario_yaml'").fetchone()
    assert "motion: line" in scenario


def test_what_is_no_study_is_refused_in_a_sentence(flown, run, tmp_path):
    with pytest.raises(StudyError, match="study.json: it cannot be read"):
        Study(str(tmp_path))
    (tmp_path / "study.json").write_text("[")
    with pytest.raises(StudyError, match="not a study's plan"):
        Study(str(tmp_path))
    done = run("study", "run", "tiny.yaml", "--out", "nothing", "--report-only", cwd=flown[0])
    assert done.returncode == 2 and "nothing/study.db is missing" in done.stderr


def test_mistakes_in_a_study_file_are_named(run, tmp_path):
    path = tmp_path / "mine.yaml"
    for written, sentence in (
        (TINY.replace("reference: planned", "reference: other"), "reference must be one of the methods, not other"),
        (TINY.replace("seed: 3", "sed: 3"), "mine.yaml:4: unknown key sed"),
        (TINY.replace("pad.motion: line", "pad.motion: lin"), "study mine, planned in figure_4: "),
    ):
        path.write_text(written)
        done = run("study", "run", str(path), "--out", str(tmp_path / "out"))
        assert done.returncode == 2 and sentence in done.stderr and done.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()
