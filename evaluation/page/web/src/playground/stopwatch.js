// SPDX-License-Identifier: BSD-3-Clause
// The time of a step: a hundred equal ones of each backend, some at a time while nothing else is to do.
import { copy } from "./scene.js";

const STEPS = 100, BLOCK = 10;
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
    this.rows = this.backends.map((backend) => ({ backend, mean_ms: 0, steps: 0 }));
    this.show(this.rows);
    const run = (this.run = { scene: copy(scene) });
    this.waiting = setTimeout(() => this.next(run), REST);
  }

  next(run) {
    if (run !== this.run) return;
    // In turns: what slows the machine down slows both.
    const row = this.rows.reduce((a, b) => (b.steps < a.steps ? b : a));
    if (row.steps >= STEPS) return;
    const block = row.steps === 0 ? 1 : Math.min(BLOCK, STEPS - row.steps, Math.max(1, Math.floor(PATIENCE / Math.max(row.mean_ms, 0.01))));
    let answer;
    try {
      answer = this.ask({ do: "time", scene: { ...run.scene, backend: row.backend }, steps: block });
    } catch {
      return; // what is wrong with the scene stands in the headline
    }
    row.mean_ms = (row.mean_ms * row.steps + answer.mean_ms * answer.steps) / (row.steps + answer.steps);
    row.steps += answer.steps;
    Object.assign(row, { iterations: answer.iterations, cost: answer.cost, status: answer.status });
    this.show(this.rows);
    const later = window.requestIdleCallback ?? ((act) => setTimeout(act, 1));
    later(() => this.next(run), { timeout: 200 });
  }
}
