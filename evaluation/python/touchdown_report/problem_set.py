# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a comparison on a set of known problems (docs/compare.md).

It shows the performance profile (Dolan and Moré, 2002) and the distribution of the time of the right solves.

    /usr/bin/python3 -m touchdown_report.problem_set SET.db OUT.png
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from touchdown_report import command_line, compare, database  # noqa: E402
from touchdown_report.style import STYLE, made_with, sign  # noqa: E402

SUPPORTED_VERSION = "2"


class ProblemSetError(Exception):
    """The file is no comparison on a set of problems; the message is one sentence."""


class ProblemSet:
    """One file: `manifest` (dict), `backends` in order, `count` of solves that each could have made, and `times`.
    `times` is {backend: {(problem, start): ms}}, infinite where the solve was not right."""

    def __init__(self, path):
        database.read(
            path, "problem set", "manifest", SUPPORTED_VERSION, ProblemSetError, self._read
        )

    def _read(self, db, manifest):
        self.manifest = manifest
        asked = db.execute(
            "SELECT problem, backend, start, CASE verdict WHEN 'right' THEN time_cpu_ms END "
            "FROM solve ORDER BY rowid"
        ).fetchall()
        refused = [name for name, in db.execute("SELECT backend FROM refusal ORDER BY rowid")]
        self.backends = list(dict.fromkeys([row[1] for row in asked] + refused))
        self.times = {name: {} for name in self.backends}
        for problem, backend, start, ms in asked:
            self.times[backend][(problem, start)] = np.inf if ms is None else ms
        problems = db.execute("SELECT COUNT(*) FROM problem").fetchone()[0]
        self.count = problems * int(manifest["starts"])


def headline(manifest):
    judged = "an optimum that is known" if manifest["published"] == "1" else "the best that any backend found"
    return (
        f"problem set {manifest['problem_set']}, {manifest['starts']} starts each, "
        f"seed {manifest['seed']}",
        f"right: converged, and within 1e-6 of {judged}  ·  {made_with(manifest)}",
    )


def draw(problem_set, path):
    times, count = problem_set.times, problem_set.count
    runs = {name: len(solves) for name, solves in times.items()}
    styles = compare.looks(problem_set.backends)
    with plt.rc_context(STYLE):
        figure, (left, right) = plt.subplots(1, 2, figsize=(11.0, 4.5), layout="constrained")
        compare.draw_steps(left, compare.profile(times, count), styles, runs, count)
        left.set_title("performance profile")
        left.set_xlabel("time / fastest backend's time from the same start")
        left.set_ylabel("fraction of solves that were right")
        compare.draw_steps(right, compare.ecdf(times, count), styles, runs, count)
        right.set_title("time, the check of the claim included")
        right.set_xlabel("thread CPU time [ms]")
        right.legend(**compare.LEGEND)
        sign(figure, *headline(problem_set.manifest))
        figure.savefig(path, dpi=150)
        plt.close(figure)


def main(arguments):
    """Command line; returns the exit status."""
    return command_line.run(
        arguments,
        "touchdown_report.problem_set SET OUT.png",
        lambda source, picture: draw(ProblemSet(source), picture),
        (ProblemSetError,),
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
