# SPDX-License-Identifier: BSD-3-Clause
"""Where cost terms act: outlines with the term's name."""
from matplotlib.patches import Ellipse, Rectangle

COLOUR = "#CC79A7"


def draw(axes, zones, down):
    """`zones` are (term, shape, centre, size), seen from above (down=1) or from the south (down=2)."""
    for term, shape, centre, size in zones:
        x, y = centre[0], centre[down]
        width, height = size[0], size[down]
        look = {"facecolor": COLOUR, "edgecolor": COLOUR, "alpha": 0.25, "lw": 1.0, "zorder": 1.5}
        round_here = shape == "sphere" or (shape == "cylinder" and down == 1)
        if round_here:
            axes.add_patch(Ellipse((x, y), width, height, **look))
        else:
            axes.add_patch(Rectangle((x - width / 2, y - height / 2), width, height, **look))
        axes.annotate(term, (x, y), ha="center", va="center", fontsize=7, color=COLOUR)
