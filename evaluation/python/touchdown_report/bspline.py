# SPDX-License-Identifier: BSD-3-Clause
"""Uniform cubic B-splines as the planner stores them: control points and a knot interval."""
import numpy as np

# Rows: coefficients of 1, u, u^2, u^3 for the four control points of a segment, times 6.
_BASIS = np.array(
    [[1.0, 4.0, 1.0, 0.0], [-3.0, 0.0, 3.0, 0.0], [3.0, -6.0, 3.0, 0.0], [-1.0, 3.0, -3.0, 1.0]]
) / 6.0


def sample(control_points, per_segment=8):
    """Points on the curve, shape (segments * per_segment + 1, 3), both ends included."""
    q = np.asarray(control_points, dtype=float)
    if q.ndim != 2 or len(q) < 4:
        raise ValueError("a cubic B-spline needs at least 4 control points")
    u = np.arange(per_segment) / per_segment
    powers = np.stack([np.ones_like(u), u, u**2, u**3], axis=1)
    pieces = [powers @ _BASIS @ q[i : i + 4] for i in range(len(q) - 3)]
    end = (q[-3] + 4.0 * q[-2] + q[-1]) / 6.0
    return np.vstack(pieces + [end[None, :]])


def derivative_norms(control_points, interval, per_segment=16):
    """Time from the start, speed and acceleration along the curve, each of shape
    (segments * per_segment + 1,)."""
    q = np.asarray(control_points, dtype=float)
    velocity = np.diff(q, axis=0) / interval
    acceleration = np.diff(velocity, axis=0) / interval
    s = np.arange((len(q) - 3) * per_segment + 1) / per_segment
    i = np.minimum(s.astype(int), len(q) - 4)
    u = (s - i)[:, None]
    # The velocity is a quadratic B-spline of its own control points, the acceleration is linear.
    v = (
        0.5 * (1.0 - u) ** 2 * velocity[i]
        + (0.5 + u - u**2) * velocity[i + 1]
        + 0.5 * u**2 * velocity[i + 2]
    )
    a = (1.0 - u) * acceleration[i] + u * acceleration[i + 1]
    return s * interval, np.linalg.norm(v, axis=1), np.linalg.norm(a, axis=1)
