# SPDX-License-Identifier: BSD-3-Clause
"""How the pictures of this package look."""

STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "axes.edgecolor": "#BBBBBB",
    "axes.titlesize": 10,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.grid": True,
    "grid.color": "#EEEEEE",
    "axes.axisbelow": True,
}
