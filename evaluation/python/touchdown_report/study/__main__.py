# SPDX-License-Identifier: BSD-3-Clause
"""Command line of the report: python3 -m touchdown_report.study FOLDER."""
import sys

from touchdown_report.record import RecordError
from touchdown_report.study.data import Study, StudyError
from touchdown_report.study.report import write_report


def main(arguments):
    """Command line; returns the exit status."""
    if len(arguments) != 1:
        print("usage: python3 -m touchdown_report.study FOLDER", file=sys.stderr)
        return 2
    try:
        write_report(Study(arguments[0]))
    except (StudyError, RecordError, OSError) as error:
        print(f"touchdown_report: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
