#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Would the tests notice? Changes one operator of the code that must be right, builds and runs the tests of its
library, and says which changes nobody noticed.

    .ci/mutants.py [--count N] [--seed S] [--only FILE] [--list]

Works on a copy of the last commit in build/mutants, with a build of its own; goes on where it was interrupted.
The draw is random and repeats with the seed. Exit status 1 if less than nine of ten are noticed."""
import argparse
import json
import random
import re
import resource
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PLACE = ROOT / "build" / "mutants"
SOURCE, BUILD = PLACE / "src", PLACE / "build"
ENOUGH = 0.9
# Code that must be right, and its tests.
FILES = {
    "planning/certify/certificate.cc": "planning_test",
    "planning/certify/curve_check.cc": "planning_test",
    "planning/spline/boundary_lift.cc": "planning_test",
    "solvers/banded/banded_newton.cc": "solvers_test",
    "solvers/banded/banded_interior_point.cc": "solvers_test",
    "solvers/banded/banded_solver.cc": "solvers_test",
    "solvers/linear/bordered_cholesky.cc": "solvers_test",
    "control/mission/landing_state_machine.cc": "control_test",
    "control/mission/landing_conditions.cc": "control_test",
    "control/mission/landing_transitions.cc": "control_test",
    "estimation/pad/pad_filter.cc": "estimation_test",
}
# An operator between blanks, as clang-format writes it, and its replacement. No numbers, because another value of a
# tuned constant may be right, too.
SWAPS = [
    (r" < ", " >= "), (r" <= ", " > "), (r" > ", " <= "), (r" >= ", " < "), (r" == ", " != "), (r" != ", " == "),
    (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "), (r" && ", " || "), (r" \|\| ", " && "),
    (r" \+= ", " -= "), (r" -= ", " += "), (r"std::max\(", "std::min("), (r"std::min\(", "std::max("),
    (r"\btrue\b", "false"), (r"\bfalse\b", "true"), (r"if \(!", "if ("), (r"return !", "return "),
    (r"\bcontinue;", "break;"),
]  # fmt: skip
TIMEOUT_S = 300  # of a test run: a change that hangs it is noticed
MEMORY = 8 << 30  # of a test run [bytes]


def mutants_of(name, text):
    """(file, line number, offset in the file, old, new) of every change."""
    found, offset = [], 0
    for number, line in enumerate(text.splitlines(keepends=True), 1):
        code = line.split("//")[0]
        plain = code.strip() and not re.match(r"\s*(#|template|constexpr|namespace|using)", code)
        for pattern, new in SWAPS if plain else []:
            for match in re.finditer(pattern, code):
                if '"' not in code:
                    found.append((name, number, offset + match.start(), match.group(), new))
        offset += len(line)
    return found


def draw(count, seed, only):
    """From each file as many as its share of all changes, and at least two."""
    chosen, pools = [], {}
    for name in FILES:
        if only in (None, name):
            pools[name] = mutants_of(name, (SOURCE / name).read_text(encoding="utf-8"))
    total = sum(len(pool) for pool in pools.values())
    for name, pool in pools.items():
        size = min(len(pool), max(2, round(count * len(pool) / total)))
        chosen += random.Random(f"{seed} {name}").sample(pool, size)
    return chosen


def prepare():
    """The copy, and the file that keeps what was found in this commit."""
    commit = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=True)
    PLACE.mkdir(parents=True, exist_ok=True)
    if not SOURCE.exists():
        subprocess.run(["git", "clone", "-q", str(ROOT), str(SOURCE)], check=True)
    subprocess.run(["git", "fetch", "-q", str(ROOT), commit.stdout.strip()], cwd=SOURCE, check=True)
    subprocess.run(["git", "checkout", "-q", "-f", commit.stdout.strip()], cwd=SOURCE, check=True)
    subprocess.run(
        ["cmake", "-S", SOURCE, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
         "-DCMAKE_CXX_FLAGS_RELEASE=-O1", "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache", "-DTOUCHDOWN_BUILD_TESTS=ON",
         "-DTOUCHDOWN_WERROR=OFF"],
        check=True, stdout=subprocess.DEVNULL,
    )  # fmt: skip
    return PLACE / f"results_{commit.stdout[:12]}.jsonl"


def build(target):
    return subprocess.run(["cmake", "--build", BUILD, "--target", target, "-j2"], capture_output=True, check=False)


def limit_memory():
    """Limits the memory, because an endless loop may allocate without end."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def passes(target):
    program = next(BUILD.glob(f"*/{target}"))
    try:
        done = subprocess.run(
            [program, "--gtest_brief=1", "--gtest_fail_fast"],
            capture_output=True, timeout=TIMEOUT_S, cwd=program.parent, check=False, preexec_fn=limit_memory,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0


def ask(mutant):
    name, _, offset, old, new = mutant
    path, target = SOURCE / name, FILES[name]
    text = path.read_text(encoding="utf-8")
    path.write_text(text[:offset] + new + text[offset + len(old) :], encoding="utf-8")
    try:
        if build(target).returncode != 0:
            return "not compiled"
        return "survived" if passes(target) else "killed"
    finally:
        path.write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=FILES)
    parser.add_argument("--list", action="store_true", help="say what would be changed")
    given = parser.parse_args()
    results = prepare()
    chosen = draw(given.count, given.seed, given.only)
    known = {}
    if results.exists():
        for line in results.read_text(encoding="utf-8").splitlines():
            row = json.loads(line)
            known[tuple(row["mutant"])] = row["end"]
    if not given.list:
        for target in sorted({FILES[mutant[0]] for mutant in chosen}):
            if build(target).returncode != 0 or not passes(target):
                sys.exit(f"{target}: it fails without any change.")
    counts, survivors = {}, []
    for index, mutant in enumerate(chosen):
        name, number, offset, old, new = mutant
        line = (SOURCE / name).read_text(encoding="utf-8").splitlines()[number - 1].strip()
        where = f"{name}:{number}: {old.strip()} -> {new.strip()}   {line}"
        if given.list:
            print(where)
            continue
        key = (name, number, offset, old, new)
        begin = time.monotonic()
        if key not in known:
            known[key] = ask(mutant)
            with results.open("a", encoding="utf-8") as stream:
                stream.write(json.dumps({"mutant": key, "end": known[key]}) + "\n")
        end = known[key]
        counts.setdefault(name, {}).setdefault(end, 0)
        counts[name][end] += 1
        if end == "survived":
            survivors.append(where)
        print(f"{index + 1} of {len(chosen)}, {time.monotonic() - begin:.0f} s: {end}: {where}", flush=True)
    if given.list:
        return
    killed = sum(c.get("killed", 0) for c in counts.values())
    asked = killed + len(survivors)
    for name, ends in counts.items():
        print(f"{name}: {ends.get('killed', 0)} of {ends.get('killed', 0) + ends.get('survived', 0)} noticed")
    print(f"{killed} of {asked} = {100 * killed / max(1, asked):.1f} % noticed; survivors:")
    print("\n".join(f"  {where}" for where in survivors) or "  none")
    if asked < 0.5 * len(chosen):
        sys.exit("Most changes do not compile: too few were asked.")
    sys.exit(0 if killed >= ENOUGH * asked else 1)


if __name__ == "__main__":
    main()
