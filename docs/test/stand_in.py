#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs in place of the programs that a document calls; the name of the call selects the program.

The program itself, and programs made from docs/examples, run in a short form: the same sub-command
and options, with less work. A command that cannot run inside a test is only checked. Exit status: 0, or 2 with a
sentence where the document is wrong."""
import json
import os
import re
import resource
import signal
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("TOUCHDOWN_BUILD", ""))

# Options that say how much work there is: never more than this ...
SHORT = {"--trials": 1, "--problems": 1, "--scenes": 1, "--flights": 1, "--poses": 1, "--repeats": 1, "--starts": 1}
# ... which these sub-commands are given where the document leaves them to their default.
GIVEN = {"sweep": ["--trials"], "compare": ["--problems", "--repeats"],
         "compare --problem-set": ["--starts"], "study replan": ["--scenes"],
         "study pad": ["--trials"], "study hostile": ["--flights"], "study tags": ["--poses"]}  # fmt: skip
# Simulated seconds of each flight: most single ones land in that time, many of a kind need not. `study
# pad` draws nothing of shorter ones.
SECONDS = {"land": 15, "fly": 15, "profile": 15, "sweep": 2, "study pad": 6, "study hostile": 3}
# These fly the first trial of their quick form.
STUDIES = ("study paper", "study solvers", "study ablation", "study run")
# A command that needs more than this in its short form needs a rule here.
CPU_SECONDS = int(os.environ.get("TOUCHDOWN_CPU_SECONDS", "20"))
OUTPUTS = ("--record", "--plot", "--video", "--save-map", "--db", "--picture", "--trace", "--frames", "--out",
           "--html", "--mcap")  # fmt: skip
WHICH = ("none", "failures", "all")


class Wrong(Exception):
    """The document is wrong: one sentence."""


def shortened(arguments):
    """The arguments of the program in their short form."""
    words = 2 if arguments[:1] == ["study"] else 1
    command = " ".join(arguments[:words])
    if "--problem-set" in arguments:
        command += " --problem-set"
    short = []
    for before, word in zip([""] + arguments, arguments):
        if before in SHORT and word.isdigit():
            word = str(min(int(word), SHORT[before]))
        if before == "--trials" and "--shard" in arguments:  # each part has one
            word = arguments[arguments.index("--shard") + 1].split("/")[1]
        if before == "--backends" and word == "all":
            word = "banded,lbfgs"
        if before == "--pin":
            word = str(min(os.sched_getaffinity(0)))
        short.append(word)
    if "--help" in short:
        return short
    flights = "--parts" in short and "flights" in short[short.index("--parts") + 1]
    for option in GIVEN.get(command, []):
        if option not in short and not flights:
            short += [option, str(SHORT[option])]
    if flights:  # of one kind
        short += [] if "--flights" in short else ["--flights", str(SHORT["--flights"])]
        short += [] if "--kinds" in short else ["--kinds", "A"]
    if command in STUDIES:
        short += [word for word in ("--quick", "--shard", "1/500") if word not in arguments]
    if command in SECONDS and "--from" not in short:
        seconds = 1 if {"sensing=rendered", "--video"} & set(short) else SECONDS[command]
        short += ["--set", f"timeout={seconds}"]
    return short


def short_record(program, record):
    """Replaces the record for a video by one of a second."""
    if not Path(record).exists():
        raise Wrong(f"there is no record {record}")
    flight = ["land", "open", "--set", "timeout=1", "--record", "short.db"]
    subprocess.run([program, *flight], capture_output=True, check=False)
    return "short.db"


def run_program(program, arguments):
    short = shortened(arguments)
    if short[:1] == ["replay"] and "--video" in short:
        short[1] = short_record(program, short[1])
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [program, *short],
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS + 5)),
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    log({"arguments": arguments, "short": short, "status": done.returncode, "cpu_s": round(cpu, 2)})
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        raise Wrong(f"takes more than {CPU_SECONDS} s of CPU time as `{' '.join(short)}`: "
                    "docs/test/stand_in.py needs a rule that makes it shorter")  # fmt: skip
    if done.returncode not in (0, 1):  # 1: it ran and fell short, as short forms may
        raise Wrong(f"ends with status {done.returncode}: {done.stderr.strip()}")
    for option, value in zip(short, short[1:]):
        which = option == "--record" and value in WHICH  # of campaigns: no file
        if option in OUTPUTS and not which and not Path(value).exists():
            raise Wrong(f"writes no {value}: {done.stderr.strip()}")


def look_at_script(name, arguments):
    """./demo.sh, ./deb.sh and ./test.sh install and build. What demo.sh flies runs before every document."""
    script = ROOT / name
    if not os.access(script, os.X_OK):
        raise Wrong(f"{name} is no program at the top of the repository")
    for word in arguments if name != "python.sh" else []:  # whose word is a folder
        if not re.search(rf"^  {re.escape(word)}\)", script.read_text(), re.M):
            raise Wrong(f"{name} knows no {word}")
    if subprocess.run(["/bin/bash", "-n", script], check=False).returncode != 0:
        raise Wrong(f"{name} is not valid bash")


def look_at_cmake(arguments):
    """Configures, builds, installs: each takes minutes, and the tests run in what they leave. The
    test evaluation.consumer installs, and builds what is in docs/examples."""
    text = " ".join(arguments)
    if preset := re.search(r"--preset[ =](\S+)", text):
        presets = json.loads((ROOT / "CMakePresets.json").read_text())
        if preset[1] not in [p["name"] for p in presets["configurePresets"] if not p.get("hidden")]:
            raise Wrong(f"CMakePresets.json has no preset {preset[1]}")
    elif source := re.search(r"-S (\S+)", text):
        if not (ROOT / source[1] / "CMakeLists.txt").exists():
            raise Wrong(f"{source[1]} has no CMakeLists.txt")
    elif not re.match(r"--(build|install) build/\S+", text):
        raise Wrong("there is no rule for this use of cmake in docs/test/stand_in.py")
    known = (ROOT / "CMakeLists.txt").read_text()
    for option in re.findall(r"-D(TOUCHDOWN_\w+)", text):
        if not re.search(rf"(option|set)\({option} ", known):
            raise Wrong(f"CMakeLists.txt has no option {option}")


def look_at_apt(arguments):
    """It installs the package that ./deb.sh leaves; `./test.sh bare` does."""
    if arguments != ["install", "./build/touchdown_*.deb"]:
        raise Wrong("there is no rule for this use of apt in docs/test/stand_in.py")


def look_at_docker(arguments):
    """The image is that of the Dockerfile, whose lines `./test.sh bare` executes. The program runs what the document
    runs in it."""
    if arguments[:1] == ["run"] and "touchdown" in arguments:
        run_program(os.environ["TOUCHDOWN_PROGRAM"], arguments[arguments.index("touchdown") + 1 :])
    elif arguments != ["build", "-t", "touchdown", "."] or not (ROOT / "Dockerfile").exists():
        raise Wrong("there is no rule for this use of docker in docs/test/stand_in.py")


def look_at_test_program(program, arguments):
    """Test programs are asked whether they have such tests; CTest runs those."""
    program = BUILD / Path(*Path(program).parts[2:])
    listed = subprocess.run(
        [program, *arguments, "--gtest_list_tests"], capture_output=True, text=True, check=False
    )
    if listed.returncode != 0 or "\n  " not in listed.stdout:
        raise Wrong("no test has such a name")


def run_python(arguments):
    """The Python of an environment that has the package: the build's. Notebooks are executed by tests of their own."""
    if arguments[:1] == ["notebooks/render.py"]:
        if missing := [word for word in arguments[:2] if not (ROOT / word).exists()]:
            raise Wrong(f"there is no {missing[0]}")
        return
    path = os.pathsep.join([str(BUILD / "python"), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        ["/usr/bin/python3", *arguments], env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise Wrong(f"ends with status {done.returncode}: {done.stderr.strip()}")


def log(entry):
    entry["line"] = int(os.environ.get("DOCUMENT_LINE", 0))
    with open(os.environ["DOCUMENT_LOG"], "a", encoding="utf-8") as file:
        file.write(json.dumps(entry) + "\n")


def main(called, arguments):
    name = Path(called).name
    try:
        if name == "touchdown" and "lowest_height" in " ".join(arguments):
            # docs/examples/in_tree_term, as if it were in the tree.
            run_program(BUILD / "consumer" / "consumer" / "in_tree_term", arguments)
        elif name == "touchdown":
            run_program(os.environ["TOUCHDOWN_PROGRAM"], arguments)
        elif name.startswith("own_") or name in ("go_to_goal", "onboard"):
            run_program(BUILD / "consumer" / name / name, arguments)
        elif name == "python":
            run_python(arguments)
        elif name.endswith(".sh"):
            look_at_script(name, arguments)
        elif name == "cmake":
            look_at_cmake(arguments)
        elif name == "apt":
            look_at_apt(arguments)
        elif name == "docker":
            look_at_docker(arguments)
        elif name.endswith("_test"):
            look_at_test_program(called, arguments)
        else:
            raise Wrong("there is no rule for this program in docs/test/stand_in.py")
    except Wrong as wrong:
        log({"arguments": arguments, "wrong": str(wrong)})
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[0], sys.argv[1:]))
