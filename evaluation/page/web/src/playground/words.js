// SPDX-License-Identifier: BSD-3-Clause
// What came out, in words: the headline, the checks of the certificate, rows of attempts.
import { REASONS } from "../reasons.js";
import { endOf, sample } from "../spline.js";
import { curveOf, roundOf } from "./answer.js";

const BODY_RATE = 4; // that plans keep [rad/s]
const KEPT = 1e-9; // residual of an end that is met [m, m/s]

const seconds = (t) => `${t.toFixed(2)} s`;
export const plain = (name) => String(name ?? "").replaceAll("_", " ");
/** A figure that the module may not have: it sends null for what was not measured. */
const figure = (x, digits = 2) => (Number.isFinite(x) ? x.toFixed(digits) : "–");

export function lengthOf(curve) {
  const points = sample(curve);
  let sum = 0;
  for (let i = 3; i < points.length; i += 3) sum += Math.hypot(points[i] - points[i - 3], points[i + 1] - points[i - 2], points[i + 2] - points[i - 1]);
  return sum;
}

/** { tone, title, text } of a replanning step. */
export function headlineOf(answer) {
  const curve = answer.pair?.curve && curveOf(answer.pair.curve);
  if (answer.status === "planned" && curve) {
    const { t_stop, stop } = answer.pair, begin = curve.t0;
    const stops = stop && Number.isFinite(t_stop) && t_stop < endOf(curve);
    return {
      tone: "good",
      title: `Planned: contact in ${seconds(endOf(curve) - begin)}.`,
      text: stops ? `If no newer plan comes, it stops from ${seconds(t_stop - begin)} on: that stop is proven, too.` : "It is so near to contact that the landing is its own stop.",
    };
  }
  const [what, why] = [answer.sentences[0] ?? "", answer.sentences.at(-1) ?? ""];
  const safe = answer.passed || ["kept", "braking", "climbing", "escaping", "holding"].includes(answer.status);
  return { tone: safe ? "warn" : "bad", title: why, text: answer.sentences.length > 1 ? what : "" };
}

/** What was proven: { ok, name, figure, help }; `ok` is null where it was not asked. */
export function checksOf(c, limits) {
  const measured = !c.earlier;
  const checks = [
    {
      ok: c.endpoint_required ? c.endpoint_position_residual_m <= KEPT && c.endpoint_velocity_residual_mps <= KEPT : null,
      name: c.endpoint_required ? "ends at the pad, as fast as the pad" : "ends at rest",
      figure: c.endpoint_required ? `off by ${small(c.endpoint_position_residual_m)} m and ${small(c.endpoint_velocity_residual_mps)} m/s` : "no contact is asked of it",
      help: "Where the curve ends, against where the pad is predicted to be at that time",
    },
    {
      ok: c.limits_kept,
      name: c.recovering ? "returns to within the limits" : "keeps the limits everywhere",
      figure: measured
        ? `at most ${figure(c.speed_bound_mps)} of ${limits.speed} m/s, ${figure(c.acceleration_bound_mps2)} of ${limits.acceleration} m/s², turns at ${figure(c.body_rate_bound_radps, 1)} of ${BODY_RATE} rad/s`
        : "proven with an earlier step",
      help: "Bounds that hold for all of the curve, not only at sampled points",
    },
    {
      ok: c.clear || c.escaping,
      name: c.escaping ? "leaves the zone around an obstacle" : "clear of all that is known",
      figure: measured ? `its middle stays ${figure(c.clearance_m)} m off obstacles` : "proven with an earlier step",
      help: "Every cell of the map that the curve passes, grown by the clearance, is free of known obstacles",
    },
    {
      ok: c.stops_in_observed_space,
      name: "can stop in space that was seen free",
      figure: "the hull, with its margins, until rest",
      help: "What is flown until a newer plan takes over, and the stop stored with it, stay in cells that were seen to be free",
    },
  ];
  return checks;
}

const small = (x) => (Number.isFinite(x) ? (x < 1e-3 ? x.toExponential(0) : x.toFixed(3)) : "–");

/** One row of the table of attempts. */
export function rowOf(attempt) {
  const taken = roundOf(attempt);
  return {
    arrival: seconds(attempt.duration_s),
    end: attempt.arrival,
    segments: attempt.segments,
    rounds: attempt.rounds.length,
    pairs: taken?.pairs.length ?? 0,
    iterations: attempt.rounds.reduce((sum, { iterations }) => sum + iterations, 0),
    reason: attempt.reason === "none" ? "✓ taken" : plain(attempt.reason),
  };
}

/** "landing (arriving)" as a reader would say it. */
export function eventWords(text) {
  const [, mode, reason] = text.match(/^(\w+) \((\w+)\)$/) ?? [];
  return mode ? `${plain(mode)}: ${REASONS[reason] ?? plain(reason)}` : text;
}

const OUTCOMES = { landed: "Landed.", touched: "It touched something.", timeout: "It did not land in time." };

/** The same of a flight that is over. */
export function outcomeOf({ name, sentence }) {
  return { tone: name === "landed" ? "good" : "bad", title: OUTCOMES[name] ?? plain(name), text: sentence };
}
