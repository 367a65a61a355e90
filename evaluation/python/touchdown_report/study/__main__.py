# SPDX-License-Identifier: BSD-3-Clause
"""Command line of the report: python3 -m touchdown_report.study FOLDER, or --check: can it be written?"""
import importlib.util
import sys

NEEDED = {
    "matplotlib": "python3-matplotlib",
    "numpy": "python3-numpy",
    "pandas": "python3-pandas",
    "scipy": "python3-scipy",
    "statsmodels": "python3-statsmodels",
}


def missing_packages():
    """Debian packages that the report needs and this Python lacks."""
    return [package for module, package in NEEDED.items() if importlib.util.find_spec(module) is None]


def main(arguments):
    """Command line; returns the exit status."""
    if len(arguments) != 1:
        print("usage: python3 -m touchdown_report.study FOLDER|--check", file=sys.stderr)
        return 2
    missing = missing_packages()
    if missing:
        print(f"touchdown_report: install {' '.join(missing)} for this report", file=sys.stderr)
        return 2
    if arguments[0] == "--check":
        return 0
    from touchdown_report.record import RecordError
    from touchdown_report.study.data import Study, StudyError
    from touchdown_report.study.report import write_report

    try:
        write_report(Study(arguments[0]))
    except (StudyError, RecordError, OSError) as error:
        print(f"touchdown_report: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
