// SPDX-License-Identifier: BSD-3-Clause
// The module against the program that is made from the same sources: the same scenes, the same answers.
// TOUCHDOWN_MODULE and TOUCHDOWN_PLAYGROUND name the two.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { after, test } from "node:test";

import { loadModule, startProgram } from "./module.mjs";

const path = process.env.TOUCHDOWN_MODULE;
const ask = await loadModule(path);
const program = startProgram(process.env.TOUCHDOWN_PLAYGROUND);
after(() => program.end());

const SEEDS = Array.from({ length: 20 }, (_, i) => i + 1);
// Two libraries of mathematics differ in the last digits; a solve makes more of that.
const NEAR_M = 1e-4;

function farthest(a, b) {
  assert.equal(a.control_points.length, b.control_points.length);
  let most = Math.abs(a.h - b.h);
  a.control_points.forEach((p, i) => p.forEach((x, k) => (most = Math.max(most, Math.abs(x - b.control_points[i][k])))));
  return most;
}

test("scenes, drawn and first, are the program's", async () => {
  const about = ask({ do: "about" });
  assert.deepEqual(about, await program.ask({ do: "about" }));
  for (const seed of SEEDS) {
    assert.deepEqual(ask({ do: "random", seed }), await program.ask({ do: "random", seed }));
  }
});

test("plans are the program's", async () => {
  const scenes = [ask({ do: "about" }).scene, ...SEEDS.map((seed) => ask({ do: "random", seed }))];
  for (const base of scenes) {
    for (const change of [{}, { backend: "lbfgs" }, { ways: 1, arrival: "fixed" }, { known: "camera" }]) {
      const scene = { ...base, ...change };
      const here = ask({ do: "plan", scene });
      const there = await program.ask({ do: "plan", scene });
      const what = JSON.stringify(scene);
      assert.equal(here.status, there.status, what);
      assert.equal(here.reason, there.reason, what);
      assert.equal(here.passed, there.passed, what);
      assert.equal(here.attempts.length, there.attempts.length, what);
      if (scene.backend === "lbfgs") {
        // Its way to the optimum is long and turns on last digits: another round's curve may come of it.
        assert.ok(Math.abs(here.cost / there.cost - 1) < 0.02, what);
      } else {
        assert.ok(farthest(here.pair.curve, there.pair.curve) < NEAR_M, what);
      }
    }
  }
});

test("a flight ends as the program's does", async () => {
  for (const seed of SEEDS.slice(0, 6)) {
    const scene = { ...ask({ do: "random", seed }), known: "camera" };
    const fly = async (put) => {
      let report = await put({ do: "fly", scene });
      while (!report.outcome) report = await put({ do: "step", seconds: 1.0 });
      return report;
    };
    const here = await fly(async (question) => ask(question));
    const there = await fly(program.ask);
    assert.equal(here.outcome.name, there.outcome.name, `seed ${seed}`);
    assert.ok(Math.abs(here.t - there.t) < 1.0, `seed ${seed}: ${here.t} s and ${there.t} s`);
  }
});

test("mistakes are answered, and exceptions end nothing", () => {
  assert.match(ask({ do: "plan", scene: { pad: { speed: 99 } } }).error, /scene\.pad\.speed is 99; allowed is \[0, 10\]/);
  assert.match(ask({ do: "dance" }).error, /one of about/);
  assert.equal(ask({ do: "plan", scene: ask({ do: "about" }).scene }).status, "planned");
});

test("a step takes little longer than the program's", async () => {
  const ratios = [];
  for (const seed of SEEDS) {
    const question = { do: "time", scene: ask({ do: "random", seed }), steps: 50 };
    const there = await program.ask(question);
    ratios.push(ask(question).mean_ms / there.mean_ms);
  }
  ratios.sort((a, b) => a - b);
  console.log(`module over program: median ${ratios[10].toFixed(2)}, largest ${ratios.at(-1).toFixed(2)}`);
  assert.ok(ratios[10] < 3.0, `median ${ratios[10]}`);
});

test("the module is small", () => {
  const bytes = statSync(path.replace(/\.js$/, ".wasm")).size;
  console.log(`${bytes} bytes`);
  assert.ok(bytes < 2e6);
});
