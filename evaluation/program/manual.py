#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the manual page of the program from what its --help says: manual.py PROGRAM VERSION PAGE.gz

Every command and its sub-commands are a section, every option a paragraph of it.
"""
import gzip
import subprocess
import sys

COLUMN = 30  # where the text of an entry begins: on its own line if its words are shorter, else on the next

BEFORE = r"""
.SH SYNOPSIS
.B touchdown
.I COMMAND
.RI [ OPTIONS ]
.SH DESCRIPTION
Touchdown plans landings of a quadrotor on a moving ground vehicle among obstacles that are not known at take-off, flies
them in a simulation and judges them.
A first landing, with a page that shows it in any browser:
.PP
.RS
touchdown land straight_turn \-\-html landing.html
.RE
.SH COMMANDS
"""
AFTER = r"""
.SH EXIT STATUS
.TP
0
It did what it was asked for: the vehicle landed.
.TP
1
It ran, and fell short of that.
.TP
2
An option or a file is wrong: one sentence says what.
.SH ENVIRONMENT
.TP
.B TOUCHDOWN_PYTHON
The Python that draws pictures and writes reports.
.SH FILES
.TP
.I /usr/share/touchdown/scenarios
The scenarios that come with the program: text files, to be copied and changed.
.SH SEE ALSO
The pages that begin with
.I docs/
are in
.IR /usr/share/doc/touchdown .
"""


def roff(text):
    text = text.replace("\\", r"\e").replace("-", r"\-")
    return r"\&" + text if text[:1] in (".", "'") else text


def help_of(program, words):
    return subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=True).stdout.splitlines()


def entries(lines):
    """The (section, words, text) of a help."""
    section, found = "", []
    for line, after in zip(lines, lines[1:] + [""]):
        if line and not line.startswith(" "):
            section = line.rstrip(":")
        elif line.startswith(" " * COLUMN):
            found[-1][2] += line.strip()
        elif line and after.startswith(" " * COLUMN):
            found.append([section, line.strip(), ""])
        elif line:
            found.append([section, line[:COLUMN].strip(), line[COLUMN:]])
    return found


def section_of(program, words):
    """The roff of one command, then of its sub-commands."""
    lines = help_of(program, words)
    usage = next(line for line in lines if line.startswith("Usage: ")).removeprefix("Usage: ")
    page = [f'.SS "{roff(usage)}"', f"{roff(lines[0])}."]
    commands = []
    for section, name, text in entries(lines):
        if section == "Subcommands":
            commands.append(name)
        elif not name.startswith("-h,"):
            page += [".TP", f".B {roff(name)}", roff(text)]
    if lines[-1].startswith("To read: "):
        page += [".PP", roff(lines[-1])]
    for name in commands:
        page += section_of(program, [*words, name])
    return page


def manual(program, version):
    lines = help_of(program, [])
    commands = [name for section, name, _ in entries(lines) if section == "Subcommands"]
    if "land" not in commands:
        sys.exit(f"manual.py: {program} --help is laid out in another way: these are its commands: {commands}")
    summary = lines[0][0].lower() + lines[0][1:].rstrip(".")
    page = [f'.TH TOUCHDOWN 1 "" "touchdown {version}" "User Commands"', ".SH NAME", rf"touchdown \- {roff(summary)}"]
    page += BEFORE.strip().splitlines()
    for name in commands:
        page += section_of(program, [name])
    return "\n".join(page + AFTER.strip().splitlines()) + "\n"


def main():
    program, version, path = sys.argv[1:]
    with open(path, "wb") as file:  # without a name and a time in it
        file.write(gzip.compress(manual(program, version).encode(), 9, mtime=0))


main()
