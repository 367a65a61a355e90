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


def sign(figure, title, provenance):
    """Writes the title above a picture, and what it was made with below."""
    figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold")
    figure.supxlabel(provenance, x=0.01, ha="left", fontsize=7.5, color="#555555")


def made_with(manifest):
    """The machine and the build of a result file's `manifest`."""
    return (
        f"{manifest['cpu']}  ·  build {manifest['build_type']}, revision {manifest['revision']}  ·  "
        f"load {float(manifest['load_before']):.1f} to {float(manifest['load_after']):.1f}"
    )
