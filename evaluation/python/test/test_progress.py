# SPDX-License-Identifier: BSD-3-Clause
"""How far a sweep is: one line that is written over on a terminal, a few lines in a log."""
import os
import pty
import subprocess

SWEEP = ("sweep", "open", "--trials", "3", "--set", "timeout=1", "--jobs", "1")
LAST = "touchdown: 3 of 3 trials, 0 succeeded and 3 failed"


def test_a_terminal_has_one_line_that_is_written_over(program):
    reading, terminal = pty.openpty()
    with subprocess.Popen(
        [program, *SWEEP],
        stdout=subprocess.DEVNULL,
        stderr=terminal,
        env={**os.environ, "TERM": "xterm"},
    ) as process:
        os.close(terminal)
        written = b""
        try:
            while piece := os.read(reading, 4096):
                written += piece
        except OSError:  # the program has closed its end
            pass
        os.close(reading)
    assert process.returncode == 0
    assert written.endswith(b"\r\n") and written.count(b"\n") == 1
    before, *lines = written.decode().removesuffix("\r\n").split("\r\x1b[K")
    assert before == "" and 1 <= len(lines) <= 3
    assert all(line.startswith("touchdown: ") for line in lines)
    assert lines[-1].startswith(LAST)


def test_a_log_has_a_line_at_the_end(run):
    done = run(*SWEEP)
    assert done.returncode == 0
    lines = done.stderr.splitlines()  # of a slow machine there are some before
    assert lines[-1].startswith(LAST)
    assert all(line.startswith("touchdown: ") for line in lines) and len(lines) <= 3
    assert "\r" not in done.stderr and "\x1b" not in done.stderr
