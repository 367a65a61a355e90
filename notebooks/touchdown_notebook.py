# SPDX-License-Identifier: BSD-3-Clause
"""What the notebooks share: running the program, reading its result files without the package touchdown, and
pictures that hold several of them together. Pictures of one result file are touchdown_report's."""
import importlib.util
import io
import json
import os
import shlex
import shutil
import sqlite3
import subprocess
import sys
import threading
from contextlib import closing
from pathlib import Path

import pandas as pd
from IPython.display import Image, Pretty, display

ROOT = Path(__file__).resolve().parent.parent
# Searched after the installed packages: the package touchdown of a build in this clone, and
# touchdown_report.
sys.path += [str(ROOT / "build" / preset / "python") for preset in ("release", "native")]
sys.path.append(str(ROOT / "evaluation" / "python"))

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.patches import Circle  # noqa: E402

from touchdown_report import compare, landing  # noqa: E402
from touchdown_report.record import Record  # noqa: E402
from touchdown_report.study import statistics  # noqa: E402
from touchdown_report.style import STYLE  # noqa: E402

# Okabe and Ito's palette, as in touchdown_report.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999"]
STAGES = ["look", "predict", "search", "pairs", "solve", "check", "certificate", "other"]


class CommandFailed(Exception):
    """A command ended with another status than those allowed."""


# Running commands


def program():
    """Path of the program: TOUCHDOWN_PROGRAM, else in the installed package, in a build in this clone, on PATH."""
    named = os.environ.get("TOUCHDOWN_PROGRAM")
    built = [ROOT / "build" / preset / "bin" / "touchdown" for preset in ("release", "native")]
    package = importlib.util.find_spec("touchdown")
    own = [Path(package.origin).parent / "bin" / "touchdown"] if package else []
    for path in [named] if named else [*own, *built, shutil.which("touchdown")]:
        if path and os.access(path, os.X_OK):
            return Path(path).resolve()
    raise FileNotFoundError(
        f"{named}, the value of TOUCHDOWN_PROGRAM, is no program."
        if named
        else "There is no program `touchdown` yet: run ./demo.sh or ./python.sh once, or set TOUCHDOWN_PROGRAM."
    )


def start(name):
    """Makes the notebook's own folder, where everything that it writes goes, and changes to it.
    Result files of an earlier run are removed, because a study is never overwritten."""
    os.environ["TOUCHDOWN_PROGRAM"] = str(program())  # a relative path would be lost on the way
    folder = Path(os.environ.get("TOUCHDOWN_NOTEBOOK_OUT") or ROOT / "out" / "notebooks") / name
    folder.mkdir(parents=True, exist_ok=True)
    for result in folder.rglob("*.db"):
        result.unlink()
    os.chdir(folder)


def run(command, allowed=(0,), quiet=False):
    """Runs a command line, shows its progress while it lasts, and prints what it printed, unless
    `quiet`. The word `touchdown` stands for the program. With --json the document is returned instead.
    Raises CommandFailed with the last line of stderr where the exit status is not an `allowed` one."""
    words = shlex.split(command)
    if words[0] == "touchdown":
        words[0] = str(program())
    line = display(Pretty(f"$ {command}"), display_id=True)
    errors = []
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        # stdout in a thread of its own: a full pipe there would stop the program.
        printed = []
        reader = threading.Thread(target=lambda: printed.append(process.stdout.read()))
        reader.start()
        for error in process.stderr:
            errors.append(error.rstrip())
            show_line(line, f"$ {command}\n{errors[-1]}")
        reader.join()
    show_line(line, f"$ {command}")
    if process.returncode not in allowed:
        why = errors[-1] if errors else printed[0].strip()
        raise CommandFailed(f"`{command}` ended with status {process.returncode}: {why}")
    if "--json" in words:
        return json.loads(printed[0])
    if not quiet:
        print(printed[0], end="")
    return None


def show_line(line, text):
    """Replaces what is shown; outside of a notebook there is no such place."""
    if line is not None:
        line.update(Pretty(text))


# Reading result files


def table(path, query):
    """Rows of a result file (docs/record.md) as a DataFrame."""
    if not Path(path).is_file():
        raise FileNotFoundError(f"{path}: there is no such file.")
    with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as db:
        return pd.read_sql_query(query, db)


def flight(path):
    """The vehicle's true way until first contact: t, x, y, z and the distance to the pad's centre."""
    record = Record(str(path))
    end = record.contact_index() + 1
    way = pd.DataFrame(record.vehicle[:end, :4], columns=["t", "x", "y", "z"])
    offset = record.vehicle[:end, 1:4] - record.pad[:end, 1:4]
    return way.assign(to_pad=np.hypot(offset[:, 0], offset[:, 1]), above_pad=offset[:, 2])


def stage_times(profile):
    """CPU time [ms] of every stage of every replanning step of a profile (`touchdown.read`), the median of its passes.
    A row is a step, with t_now [s]. The columns are the stages, total, and other: the rest of total."""
    rows = profile["stage"].merge(profile["replan"][["run", "replan", "t_now"]], on=["run", "replan"])
    times = rows.pivot_table("cpu_ms", ["replan", "t_now"], "stage", "median").reset_index("t_now")
    return times.assign(other=times.total - times[STAGES[:-1]].sum(axis=1))


def rate(successes, trials):
    """'k of n, 95 % [lo, hi] %', by Clopper and Pearson."""
    of = statistics.rate(successes, trials)
    return f"{successes} of {trials}, 95 % [{100 * of.lo:.0f}, {100 * of.hi:.0f}] %"


# Pictures


def picture(path, width=1000):
    """A picture file in the notebook, `width` pixels wide."""
    return Image(filename=str(path), width=width)


def show(figure, width=None):
    """A matplotlib figure in the notebook. touchdown_report draws without a screen, so that the
    figure is not shown by itself."""
    image = io.BytesIO()
    figure.savefig(image, format="png", dpi=130)
    plt.close(figure)
    return Image(data=image.getvalue(), width=width or int(90 * figure.get_figwidth()))


def flights_figure(records, zones=()):
    """Several flights {label: record} of one world from above and in height over time. `zones` are circles
    (x, y, radius) of ground that a flight should keep away from."""
    with plt.rc_context(STYLE):
        figure, (plan, height) = plt.subplots(
            1, 2, figsize=(12.0, 5.0), width_ratios=[1.7, 1.0], layout="constrained"
        )
        first = Record(str(next(iter(records.values()))))
        landing.draw_obstacles(plan, first.obstacles, side=False)
        for x, y, radius in zones:
            plan.add_patch(Circle((x, y), radius, fc="#D55E00", ec="#D55E00", alpha=0.15, zorder=1))
        seen = []
        for (label, path), colour in zip(records.items(), COLOURS):
            record, way = Record(str(path)), flight(path)
            pad = record.pad[: len(way), 1:3]
            seen += [pad, way[["x", "y"]].to_numpy()]
            plan.plot(*pad.T, color=landing.PAD_COLOUR, lw=1.0, ls=(0, (4, 2)))
            plan.plot(way.x, way.y, color=colour, lw=2.0, label=label)
            mark = "*" if record.result["landed"] else "X"
            plan.plot(way.x.iloc[-1], way.y.iloc[-1], mark, ms=12, mfc=colour, mec="white", zorder=5)
            height.plot(way.t, way.above_pad, color=colour, lw=1.8, label=label)
        (left, low), (right, high) = np.vstack(seen).min(axis=0), np.vstack(seen).max(axis=0)
        plan.set(xlim=(left - 2.0, right + 2.0), ylim=(low - 2.0, high + 2.0))
        plan.set_aspect("equal", adjustable="datalim")
        plan.set(xlabel="x [m]", ylabel="y [m]", title="plan view, the pad's way dashed")
        height.set(xlabel="time [s]", ylabel="height over the pad [m]", title="height", ylim=(0, None))
        plan.legend(frameon=False)
        return figure


def stages_figure(times, deadline_ms):
    """What stage_times says: every step's stages over the flight, and quantiles by stage."""
    with plt.rc_context(STYLE):
        figure, (steps, spread) = plt.subplots(1, 2, figsize=(12.0, 4.2), layout="constrained")
        bottom = np.zeros(len(times))
        for stage, colour in zip(STAGES, COLOURS):
            steps.bar(times.t_now, times[stage], 0.08, bottom=bottom, color=colour, label=stage)
            bottom += times[stage].to_numpy()
        steps.set(xlabel="time of flight [s]", ylabel="thread CPU time [ms]", title="every step")
        steps.legend(frameon=False, fontsize=8)
        rows = [*STAGES, "total"]
        for share, mark in ((0.5, "o"), (0.95, "s"), (0.99, "D"), (1.0, "|")):
            values = [max(times[stage].quantile(share), 1e-3) for stage in rows]
            label = "largest" if share == 1.0 else f"{100 * share:.0f} %"
            spread.plot(values, rows, mark, ls="none", label=label)
        spread.axvline(deadline_ms, color="#555555", lw=1.0, ls="--", label="deadline")
        spread.invert_yaxis()
        spread.set(xscale="log", xlabel="thread CPU time [ms], less than 1 µs drawn at 1 µs")
        spread.set_title("quantiles by stage")
        spread.legend(frameon=False, fontsize=8)
        return figure


def distributions_figure(samples, label):
    """Distribution functions of {name: values} on a logarithmic axis."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(7.0, 4.0), layout="constrained")
        for (name, values), colour in zip(samples.items(), COLOURS):
            axes.step(*compare.steps(values, len(values)), where="post", color=colour, label=name)
        axes.set(xscale="log", xlabel=label, ylabel="fraction of steps", ylim=(0, 1.02))
        axes.legend(frameon=False)
        return figure
