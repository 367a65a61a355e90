// SPDX-License-Identifier: BSD-3-Clause
// The time of a step: a hundred equal ones of each backend, some at a time while nothing else is to do. The backends take
// turns and the fastest steps count: a browser makes code fast after it has run for a while, and does other things, too.
import { copy } from "./scene.js";

export const STEPS = 100;
const BLOCK = 10, FIRST = 3;
const PATIENCE = 60; // a block takes no longer than about this [ms]
const REST = 500; // the scene has to rest so long before [ms]
const TOO_LONG = 1000; // a block that takes longer is the last one: nothing else can be done meanwhile [ms]

export class Stopwatch {
  /** `show(rows, slow)`: what is known of each backend; whether it was given up. */
  constructor(ask, backends, show) {
    Object.assign(this, { ask, backends, show });
    this.stop();
  }

  stop() {
    clearTimeout(this.waiting);
    this.run = null;
  }

  begin(scene) {
    this.stop();
    this.rows = this.backends.map((backend) => ({ backend, expected_ms: 0, least_ms: Infinity, steps: 0 }));
    this.show(this.rows, false);
    const run = (this.run = { scene: copy(scene) });
    this.waiting = setTimeout(() => this.next(run), REST);
  }

  next(run) {
    if (run !== this.run) return;
    const row = this.rows.reduce((a, b) => (b.steps < a.steps ? b : a));
    if (row.steps === STEPS) return;
    const block = row.expected_ms === 0 ? FIRST : Math.min(BLOCK, STEPS - row.steps, Math.max(1, Math.floor(PATIENCE / row.expected_ms)));
    const begun = performance.now();
    let answer;
    try {
      answer = this.ask({ do: "time", scene: { ...run.scene, backend: row.backend }, steps: block });
    } catch {
      return; // what is wrong with the scene stands in the headline
    }
    // The first block only tells how long the others take.
    if (row.expected_ms > 0) {
      row.least_ms = Math.min(row.least_ms, answer.mean_ms);
      row.steps += answer.steps;
    }
    Object.assign(row, { expected_ms: Math.max(answer.mean_ms, 0.01), iterations: answer.iterations, cost: answer.cost });
    const slow = performance.now() - begun > TOO_LONG;
    this.show(this.rows, slow);
    if (slow) return;
    const later = globalThis.requestIdleCallback ?? ((act) => setTimeout(act, 1));
    later(() => this.next(run), { timeout: 200 });
  }
}
