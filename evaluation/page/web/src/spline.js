// SPDX-License-Identifier: BSD-3-Clause
// Uniform cubic B-splines as the planner stores them: control points q (x y z x y z ...), knot interval h, start t0.

export function endOf(curve) {
  return curve.t0 + (curve.q.length / 3 - 3) * curve.h;
}

/** The position at time t, which is clamped to the curve, into out[at ...]. */
export function positionAt(curve, t, out, at = 0) {
  const segments = curve.q.length / 3 - 3;
  const s = Math.min(Math.max((t - curve.t0) / curve.h, 0), segments);
  const i = Math.min(Math.floor(s), segments - 1), u = s - i;
  const u2 = u * u, u3 = u2 * u;
  const b0 = (1 - 3 * u + 3 * u2 - u3) / 6, b1 = (4 - 6 * u2 + 3 * u3) / 6;
  const b2 = (1 + 3 * u + 3 * u2 - 3 * u3) / 6, b3 = u3 / 6;
  for (let k = 0; k < 3; ++k) {
    const j = 3 * i + k;
    out[at + k] = b0 * curve.q[j] + b1 * curve.q[j + 3] + b2 * curve.q[j + 6] + b3 * curve.q[j + 9];
  }
}

/** Points on the curve from t_from to t_to, both ends included: x y z x y z ... */
export function sample(curve, from = curve.t0, to = endOf(curve), perSegment = 4) {
  const pieces = Math.max(1, Math.ceil((perSegment * (to - from)) / curve.h));
  const points = new Float32Array(3 * (pieces + 1));
  for (let i = 0; i <= pieces; ++i) positionAt(curve, from + ((to - from) * i) / pieces, points, 3 * i);
  return points;
}
