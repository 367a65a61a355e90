// SPDX-License-Identifier: BSD-3-Clause
// What came out, in words: the headline, the checks of the certificate, rows of attempts.
import { REASONS } from "../reasons.js";
import { endOf, sample } from "../spline.js";
import { curveOf, roundOf } from "./answer.js";
import { STEPS } from "./stopwatch.js";

const EQUAL_COST = 0.01; // as a share: a solve ends within half of it of its optimum (solver.gap)
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
      text: stops ? `If no newer plan comes, the vehicle stops from ${seconds(t_stop - begin)} on. That stop is certified, too.` : "Contact is so near that the plan needs no stop.",
    };
  }
  const [what, why] = [answer.sentences[0] ?? "", answer.sentences.at(-1) ?? ""];
  const safe = answer.passed || ["kept", "braking", "climbing", "escaping", "holding"].includes(answer.status);
  return { tone: safe ? "warn" : "bad", title: why, text: answer.sentences.length > 1 ? what : "" };
}

/** What was proven: { ok, name, figure, help }; `ok` is null where it was not asked. `limits`: with body_rate. */
export function checksOf(c, limits) {
  const measured = !c.earlier;
  const checks = [
    {
      ok: c.endpoint_required ? c.endpoint_met : null,
      name: c.endpoint_required ? "ends at the pad, as fast as the pad" : "ends at rest",
      figure: c.endpoint_required ? `error ${small(c.endpoint_position_residual_m)} m and ${small(c.endpoint_velocity_residual_mps)} m/s` : "no contact was asked for",
      help: "Where the curve ends, against where the pad is predicted to be at that time. The small hook there turns into the pad's motion: seen from the pad it is a straight descent",
    },
    {
      ok: c.limits_kept,
      name: c.recovering ? "returns to the limits" : "keeps the limits everywhere",
      figure: measured
        ? `at most ${figure(c.speed_bound_mps)} of ${limits.speed} m/s, ${figure(c.acceleration_bound_mps2)} of ${limits.acceleration} m/s², turns at ${figure(c.body_rate_bound_radps, 1)} of ${limits.body_rate} rad/s`
        : "certified in an earlier step",
      help: "Bounds that hold for all of the curve, not only at sampled points",
    },
    {
      ok: c.clear || c.escaping,
      name: c.escaping ? "leaves the clearance of an obstacle" : "clear of all known obstacles",
      figure: measured ? `its centre stays ${figure(c.clearance_m)} m away from obstacles` : "certified in an earlier step",
      help: "Every cell of the map that the curve passes, grown by the clearance, is free of known obstacles",
    },
    {
      ok: c.stops_in_observed_space,
      name: "can stop in observed free space",
      figure: "the hull, with its margins, until rest",
      help: "The plan until its stop begins, and the stop, stay in cells that were seen to be free",
    },
  ];
  // Nearly always it does; only where it does not is there something to say.
  if (!c.start_met) checks.unshift({ ok: false, name: "does not start at the vehicle's state", figure: "its position or its velocity differs", help: "Where the curve starts, against the vehicle's state at that time" });
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
    reason: attempt.reason === "none" ? "taken" : plain(attempt.reason),
  };
}

/** What two rows of the stopwatch say together, once they are complete. Times compare only where the plans cost the same. */
export function speedWords(a, b) {
  if (Math.min(a.steps, b.steps) < STEPS) return `Being measured: ${a.steps} and ${b.steps} steps of ${STEPS}.`;
  const steps = `of ${STEPS} equal steps each, the fastest count`;
  if (!(a.cost > 0 && b.cost > 0)) return `Nothing had to be solved; ${steps}.`;
  const figures = `${a.cost.toPrecision(4)} and ${b.cost.toPrecision(4)}; ${a.iterations} and ${b.iterations} iterations in the last solve; ${steps}`;
  const more = b.cost / a.cost - 1;
  if (Math.abs(more) > EQUAL_COST) {
    return `Not to be compared: the plan of ${b.backend} costs ${(100 * Math.abs(more)).toFixed(1)} % ${more > 0 ? "more" : "less"}, ${figures}.`;
  }
  const ratio = b.least_ms / a.least_ms, [faster, times] = ratio > 1 ? [a, ratio] : [b, 1 / ratio];
  return `${times < 1.05 ? "Both are as fast" : `${faster.backend} is ${times.toFixed(1)} times as fast`} at equal cost, ${figures}.`;
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
