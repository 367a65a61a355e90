# SPDX-License-Identifier: BSD-3-Clause
"""The command line that every picture of this package has: a result file and the picture's path."""

import sys


def run(arguments, usage, draw, errors):
    """draw(result file, picture); returns the exit status, 2 for bad usage or one of `errors`."""
    if len(arguments) != 2:
        print(f"usage: python3 -m {usage}", file=sys.stderr)
        return 2
    try:
        draw(*arguments)
    except (*errors, OSError, ValueError) as error:
        print(f"touchdown_report: {error}", file=sys.stderr)
        return 2
    return 0
