// SPDX-License-Identifier: BSD-3-Clause
// The time of a step: a hundred equal ones of each backend, some at a time while nothing else is to do.
import { copy } from "./scene.js";

const STEPS = 100, BLOCK = 10, WARM = 3;
const PATIENCE = 60; // a block takes no longer than about this [ms]
const REST = 500; // the scene has to rest so long before [ms]

export class Stopwatch {
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
    this.rows = this.backends.map((backend) => ({ backend, expected_ms: 0, mean_ms: 0, steps: 0 }));
    this.show(this.rows);
    const run = (this.run = { scene: copy(scene) });
    this.waiting = setTimeout(() => this.next(run), REST);
  }

  next(run) {
    if (run !== this.run) return;
    // In turns: what slows the machine down slows both.
    const row = this.rows.reduce((a, b) => (b.expected_ms === 0 || b.steps < a.steps ? b : a));
    if (row.steps >= STEPS) return;
    const block = row.expected_ms === 0 ? WARM : Math.min(BLOCK, STEPS - row.steps, Math.max(1, Math.floor(PATIENCE / row.expected_ms)));
    let answer;
    try {
      answer = this.ask({ do: "time", scene: { ...run.scene, backend: row.backend }, steps: block });
    } catch {
      return; // what is wrong with the scene stands in the headline
    }
    // The first one only tells how long it takes: browsers make code fast after they have run it for a while.
    if (row.expected_ms > 0) {
      row.mean_ms = (row.mean_ms * row.steps + answer.mean_ms * answer.steps) / (row.steps + answer.steps);
      row.steps += answer.steps;
    }
    Object.assign(row, { expected_ms: Math.max(answer.mean_ms, 0.01), iterations: answer.iterations, cost: answer.cost });
    this.show(this.rows);
    const later = window.requestIdleCallback ?? ((act) => setTimeout(act, 1));
    later(() => this.next(run), { timeout: 200 });
  }
}
