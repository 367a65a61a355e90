# SPDX-License-Identifier: BSD-3-Clause
"""The program `touchdown`: where it and the shipped files are, and running it."""
import json as _json
import os
import re
import shutil
import signal
import subprocess
import sys
import warnings
from contextlib import suppress
from pathlib import Path
from typing import Any, Callable, List, NoReturn, Optional, Sequence, Tuple, Union

from touchdown import _touchdown
from touchdown._touchdown import BadInput

PACKAGE = Path(__file__).resolve().parent
Word = Union[str, int, float, "os.PathLike[str]"]

_PREFIX = "touchdown: "
_PROGRESS = re.compile(
    r"(?:[^:]*: )?\d+(?: of \d+)? [a-z ]+(?:, |$)|(?:all )?\d+(?: of \d+)? trials were flown before"
)
_WATCH_S = 0.5  # from one look at a running program to the next
_END_S = 5.0  # an interrupted program ends at once, or it is killed


class ProgramFailed(RuntimeError):
    """The program ended without success. The message is its own sentence.

    status   its exit status: 1 fell short, 128 and the number of a signal
    output   what it had printed on stdout
    """

    def __init__(self, sentence: str, status: int, output: str = ""):
        super().__init__(sentence)
        self.status = status
        self.output = output


def _prefix() -> Optional[Path]:
    """Of PREFIX/lib/pythonX.Y/site-packages/touchdown, or dist-packages, PREFIX."""
    if PACKAGE.parent.name in ("site-packages", "dist-packages"):
        return PACKAGE.parents[3]
    return None


def _can_run(path: Path) -> bool:
    return path.is_file() and os.access(path, os.X_OK)


def _is_script(path: Path) -> bool:
    """As the command of an installed package, which calls the package again."""
    with open(path, "rb") as file:
        return file.read(2) == b"#!"


def program_path() -> Path:
    """Where the program is.

    The value of TOUCHDOWN_PROGRAM, if it is set. Else the first that exists: in the package, in the prefix or the
    build tree that the package is in, on PATH. Raises FileNotFoundError.
    """
    named = os.environ.get("TOUCHDOWN_PROGRAM")
    if named:
        if _can_run(Path(named)):
            return Path(named).resolve()
        raise FileNotFoundError(f"{named}, the value of TOUCHDOWN_PROGRAM, is no program.")
    places = [PACKAGE, _prefix(), PACKAGE.parents[1]]
    found = [place / "bin" / "touchdown" for place in places if place]
    on_path = shutil.which("touchdown")
    if on_path:
        found.append(Path(on_path))
    for path in found:
        if _can_run(path) and not _is_script(path):
            return path.resolve()
    raise FileNotFoundError(
        "There is no program `touchdown`: build it, put it on PATH, or set TOUCHDOWN_PROGRAM."
    )


def share_path() -> Optional[Path]:
    """The folder of scenarios, studies and data: of the package, or the prefix or build tree that it is in."""
    for place in (PACKAGE, _prefix(), PACKAGE.parents[1]):
        if place and (place / "share" / "touchdown").is_dir():
            return place / "share" / "touchdown"
    return None


def use_share() -> None:
    """The module finds shipped files where the package's are."""
    share = share_path()
    if share is not None and hasattr(_touchdown, "_use_share"):
        _touchdown._use_share(str(share))


def is_progress(line: str) -> bool:
    """A line of the program's stderr that says how far it is."""
    return _PROGRESS.match(line) is not None


def _end(process: "subprocess.Popen[bytes]") -> None:
    """Ends the program with all that it started, and waits for it."""
    try:
        os.killpg(process.pid, signal.SIGTERM)
        process.communicate(timeout=_END_S)
    except (ProcessLookupError, subprocess.TimeoutExpired):
        pass
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def run_words(
    words: Sequence[Word], watch: Optional[Callable[[str], None]] = None
) -> Tuple[int, str, List[str]]:
    """Runs the program; returns its exit status, stdout and the lines of stderr.

    `watch` is called now and then with what stderr holds by then. Whatever is raised meanwhile, Ctrl-C too, ends the
    program. It runs in a process group of its own, so that only this function ends it.
    """
    command = [str(program_path()), *(os.fspath(w) if isinstance(w, os.PathLike) else str(w) for w in words)]
    with subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    ) as process:
        try:
            while True:
                try:
                    out, said = process.communicate(timeout=_WATCH_S if watch else None)
                    break
                except subprocess.TimeoutExpired as so_far:
                    if watch:
                        watch((so_far.stderr or b"").decode(errors="replace"))
        except BaseException:
            _end(process)
            raise
    lines = [line[len(_PREFIX) :] if line.startswith(_PREFIX) else line for line in said.decode().splitlines()]
    return process.returncode, out.decode(), lines


def _why(status: int, out: str, lines: List[str]) -> str:
    if lines and (status == 2 or not is_progress(lines[-1])):
        return lines[-1]
    if status < 0:
        return f"The program was ended by {signal.Signals(-status).name}."
    if out and not out.startswith(("{", "[")):
        return out.splitlines()[0]
    return f"The program ended with status {status}."


def check(status: int, out: str, lines: List[str]) -> None:
    """Raises what the exit status stands for. Other messages become warnings at the caller's caller."""
    if status == 2:
        raise BadInput(_why(status, out, lines))
    if status != 0:
        raise ProgramFailed(_why(status, out, lines), status, out)
    for line in lines:
        if not is_progress(line):
            warnings.warn(line, stacklevel=3)


def run_program(*arguments: Word, json: bool = False) -> Any:
    """Runs `touchdown` with these arguments, without a shell; returns what it printed.

    With `json` --json is added, and the document is returned. Raises BadInput where the program refuses its input.
    Raises ProgramFailed where it ends with another status than 0, also after a flight that did not land.
    """
    done = run_words([*arguments, "--json"] if json else arguments)
    check(*done)
    return _json.loads(done[1]) if json else done[1]


def main() -> NoReturn:
    """The command `touchdown` of an installed package: becomes the program."""
    try:
        path = program_path()
    except FileNotFoundError as problem:
        sys.exit(f"{_PREFIX}{problem}")
    os.execv(path, [str(path), *sys.argv[1:]])
