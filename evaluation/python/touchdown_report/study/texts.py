# SPDX-License-Identifier: BSD-3-Clause
"""Figures as the report writes them."""
import numpy as np


def number(value, digits=2):
    """A figure with so many decimals; a dash where there is none."""
    if value is None or not np.isfinite(value):
        return "∞" if value is not None and value == np.inf else "–"
    return f"{value:.{digits}f}"


def interval(estimate, digits=2):
    """'1.23 [1.20, 1.31]'."""
    if not np.isfinite(estimate.value):
        return number(estimate.value, digits)
    text = number(estimate.value, digits)
    if np.isfinite(estimate.lo) or np.isfinite(estimate.hi):
        text += f" [{number(estimate.lo, digits)}, {number(estimate.hi, digits)}]"
    return text


def of(successes, estimate):
    """'97 of 100 [91.5, 99.4] %'."""
    return f"{successes} of {estimate.n} [{100 * estimate.lo:.1f}, {100 * estimate.hi:.1f}] %"


def p_value(p):
    if p is None or not np.isfinite(p):
        return "–"
    return "< 0.0001" if p < 1e-4 else f"{p:.4f}"


def percent(share, digits=1):
    return f"{100 * share:.{digits}f} %" if np.isfinite(share) else "–"


def duration(seconds):
    minutes = seconds / 60.0
    return f"{minutes:.0f} min" if minutes >= 10 else f"{minutes:.1f} min"
