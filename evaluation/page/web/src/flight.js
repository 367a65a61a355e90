// SPDX-License-Identifier: BSD-3-Clause
// One flight's document, asked by time.
import { Quaternion, Vector3 } from "three";

/** The last index whose value is at most t; at least 0. */
export function indexAt(times, t) {
  let low = 0, high = times.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle;
  }
  return low;
}

const from = new Quaternion(), to = new Quaternion();

export class Flight {
  constructor(document, number) {
    this.document = document;
    this.number = number;
    this.steps = document.steps;
    this.times = document.samples.vehicle.t;
    this.askedTimes = this.steps.map((step) => step.t);
    this.stepTimes = this.steps.map((step) => step.t_start);
    this.goal = document.goal;
    this.modes = document.samples.mode;
    this.rotors = document.vehicle.rotors.map((_, i) => document.samples.rotor["thrust" + i]);
  }

  get begin() {
    return this.times.length ? this.times[0] : 0;
  }
  get end() {
    return this.times.length ? this.times[this.times.length - 1] : 0;
  }

  /** The replanning step whose answer is flown at t, which was asked for a little earlier; -1 before the first. */
  stepAt(t) {
    return this.stepTimes.length && t >= this.stepTimes[0] - 1e-6 ? indexAt(this.stepTimes, t + 1e-6) : -1;
  }

  /** The step that was the last to be asked for at t: the map is known as it was then. */
  askedAt(t) {
    return this.askedTimes.length && t >= this.askedTimes[0] - 1e-6 ? indexAt(this.askedTimes, t + 1e-6) : -1;
  }

  /** Where the flight leads: the pad, or the goal of the task go_to. */
  aimAt(t, out = new Vector3()) {
    if (!this.goal) return this.padAt(t, out);
    const { p, v } = this.goal;
    return out.set(p[0] + t * v[0], p[1] + t * v[1], p[2] + t * v[2]);
  }

  /** The own state is estimated: what is believed is not what is true. */
  get estimates() {
    return this.document.own_estimated;
  }

  /** A place of a table of samples (px, py, pz) between its rows; false where there is none yet. */
  placeAt(table, t, out) {
    const times = table.t;
    if (times.length === 0 || t < times[0] - 1e-6) return false;
    const i = indexAt(times, t), j = Math.min(i + 1, times.length - 1);
    const share = j > i ? Math.min(Math.max((t - times[i]) / (times[j] - times[i]), 0), 1) : 0;
    const mix = (column) => column[i] + share * (column[j] - column[i]);
    out.set(mix(table.px), mix(table.py), mix(table.pz));
    return true;
  }

  attitudeAt(t, out) {
    const { t: times, qw, qx, qy, qz } = this.document.samples.vehicle;
    const i = indexAt(times, t), j = Math.min(i + 1, times.length - 1);
    from.set(qx[i], qy[i], qz[i], qw[i]).normalize();
    to.set(qx[j], qy[j], qz[j], qw[j]).normalize();
    const share = j > i ? Math.min(Math.max((t - times[i]) / (times[j] - times[i]), 0), 1) : 0;
    return out.slerpQuaternions(from, to, share);
  }

  /** The row of samples at t, of those that have one every time. */
  row(t) {
    return indexAt(this.times, t);
  }

  modeAt(t) {
    return this.modes.names[this.modes.of[this.row(t)]] ?? "";
  }

  /** When feet first touch the deck; infinity: never. From then on the deck carries the vehicle, and no reference is tracked. */
  get contact() {
    return this.document.events.find(({ kind }) => kind === "contact")?.t ?? Infinity;
  }

  /** The newest event of a kind at t; undefined: none yet. */
  eventAt(kind, t) {
    let newest;
    for (const event of this.document.events) {
      if (event.kind === kind && event.t <= t + 1e-6) newest = event;
    }
    return newest;
  }

  vehicleAt(t, out = new Vector3()) {
    this.placeAt(this.document.samples.vehicle, t, out);
    return out;
  }
  padAt(t, out = new Vector3()) {
    this.placeAt(this.document.samples.pad, t, out);
    return out;
  }
  /** How far around the deck, as it is believed in a row, returns are taken for its own [m]. */
  deckDoubt(row) {
    const { cov_xx, cov_yy } = this.document.samples.pad_believed;
    return this.document.pad.sigmas * Math.sqrt(Math.max(cov_xx[row] + cov_yy[row], 0));
  }
  /** Of a table of the pad: the row at t; -1 before the first. */
  padRow(table, t) {
    return table.t.length && t >= table.t[0] - 1e-6 ? indexAt(table.t, t) : -1;
  }
}
