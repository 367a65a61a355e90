// SPDX-License-Identifier: BSD-3-Clause
// The parts of the planner in a page that need neither a browser nor the module.
import assert from "node:assert/strict";
import { test } from "node:test";
import { curveOf, roundOf } from "../src/playground/answer.js";
import { handlesOf } from "../src/playground/handles.js";
import { linkOf, sceneOf } from "../src/playground/link.js";
import { MOST_BYTES, plannerOf } from "../src/playground/module.js";
import { ARROW, ARROW_SPEED, MOST, RANGES, add, aimPad, completed, copy, heightOf, moveTo, objectsOf, placeOf, rangeOf, remove, setHeight, setRadius, setValue, setWallEnd, tipOf, valueAt, wallEnds } from "../src/playground/scene.js";
import { SCENES, sceneOfMenu } from "../src/playground/scenes.js";
import { CellList } from "../src/playground/seen.js";
import { Stopwatch } from "../src/playground/stopwatch.js";
import { checksOf, eventWords, headlineOf, lengthOf, outcomeOf, rowOf, speedWords } from "../src/playground/words.js";

const near = (a, b, error = 1e-9) => assert.ok(Math.abs(a - b) <= error, `${a} is not ${b}`);

const scene = () => ({
  start: [0, 0, 1.5],
  pad: { motion: "line", p: [8, 1], heading_deg: 0, speed: 0.5, turn_rate: 0.15, height: 0.3, seed: 1 },
  walls: [{ center: [4, 0, 1.5], size: [3, 0.4, 3], yaw_deg: 90 }],
  pillars: [{ p: [2, 2], radius: 0.4, height: 3 }],
  limits: { speed: 3, acceleration: 6, tilt_deg: 35 },
  arrival: "free", ways: 2, backend: "banded", known: "camera", terms: {}, seed: 1,
});

test("a link gives back its scene exactly, in letters that addresses hold", async () => {
  for (const [i] of SCENES.entries()) {
    const wanted = sceneOfMenu(i, scene());
    const link = await linkOf(wanted);
    assert.match(link, /^[\w-]+$/);
    assert.deepEqual(await sceneOf(link), wanted);
  }
  const odd = { ...scene(), start: [-1 / 3, 1e-17, 2.000000000000001] };
  assert.deepEqual(await sceneOf(await linkOf(odd)), odd);
});

test("a mangled link is told in a sentence", async () => {
  const link = await linkOf(scene());
  const damages = ["%%%", "x", link.slice(0, -9), `${link.slice(0, 20)}AAAA${link.slice(24)}`, await linkOf(null), await linkOf([]), await linkOf("scene"), await linkOf(7)];
  damages.push(await linkOf({ ...scene(), walls: [{ center: [0, 0, 1], size: [1, 1, 1] }] }));
  damages.push(await linkOf({ ...scene(), walls: "ab" }));
  damages.push(await linkOf({ ...scene(), pillars: [null] }));
  for (const damaged of damages) await assert.rejects(sceneOf(damaged), /^Error: The link is damaged or holds no scene\.$/);
});

test("what a scene leaves out is as in the first one; what it has is as it stands, right or wrong", () => {
  assert.deepEqual(completed({ start: [1, 2, 3], pad: { speed: 1 }, limits: { speed: 2 } }, scene()), { ...scene(), start: [1, 2, 3], pad: { ...scene().pad, speed: 1 }, limits: { ...scene().limits, speed: 2 } });
  for (const wrong of [null, [], 5, "ab"]) assert.deepEqual(completed({ pad: wrong, terms: wrong }, scene()), { ...scene(), pad: wrong, terms: wrong });
});

test("a link is not inflated beyond what a question may have", async () => {
  for (const large of [{ ...scene(), backend: "x".repeat(2e6) }, { ...scene(), pillars: Array(100000).fill({ p: [1, 2], radius: 0.4, height: 3 }) }]) {
    const link = await linkOf(large);
    assert.ok(link.length < 20000, `${link.length} letters`);
    await assert.rejects(sceneOf(link), /^Error: The link is damaged or holds no scene\./);
  }
});

/** A module that answers as `act` does, and knows which of its places are taken. */
function fakeModule(act) {
  const heap = new Map();
  let next = 8;
  return {
    heap,
    lengthBytesUTF8: (text) => Buffer.byteLength(text),
    _malloc: (size) => (heap.set(next, size), next++),
    _free: (place) => assert.ok(heap.delete(place)),
    stringToUTF8(text, place, size) {
      assert.ok(size > Buffer.byteLength(text) && size <= heap.get(place));
      this.text = text;
    },
    ccall(name, result, types, [place]) {
      assert.ok(heap.has(place));
      return JSON.stringify(act(JSON.parse(this.text)));
    },
  };
}

test("a question lies on the module's heap, and not after it; one of more than 1 MB is not asked", async () => {
  const module = fakeModule(({ wrong }) => (wrong ? { error: "It is wrong." } : { right: true }));
  const ask = await plannerOf(async () => module);
  assert.deepEqual(ask({ text: "é" }), { right: true });
  assert.throws(() => ask({ wrong: true }), /^Error: It is wrong\.$/);
  module.text = null;
  assert.throws(() => ask({ text: "é".repeat(MOST_BYTES / 2) }), /^Error: The scene is too large: its text is longer than 1 MB\.$/);
  assert.equal(module.text, null);
  assert.equal(module.heap.size, 0);
});

test("a module that breaks off is replaced by another", async () => {
  for (const broken of [new WebAssembly.RuntimeError("unreachable"), new RangeError("Maximum call stack size exceeded")]) {
    const made = [];
    const ask = await plannerOf(async () => made[made.push(fakeModule(({ breaks }) => { if (breaks) throw broken; return { by: made.length }; })) - 1]);
    assert.deepEqual(ask({}), { by: 1 });
    assert.throws(() => ask({ breaks: true }), /^Error: The planner broke off and is started anew\./);
    assert.throws(() => ask({}), /^Error: The planner broke off and is started anew\./);
    await new Promise((done) => setTimeout(done));
    assert.deepEqual(ask({}), { by: 2 });
    assert.equal(made[0].heap.size, 0);
  }
});

test("objects are moved, and nothing else is", () => {
  for (const object of objectsOf(scene())) {
    const moved = scene();
    moveTo(moved, object, 1.234, -5.678);
    const [x, y] = placeOf(moved, object);
    assert.deepEqual([x, y], [1.23, -5.68]);
    const [was_x, was_y] = placeOf(scene(), object);
    moveTo(moved, object, was_x, was_y);
    assert.deepEqual(moved, scene());
  }
});

test("nothing is moved farther away, and no wall made longer, than the module takes", () => {
  for (const object of objectsOf(scene())) {
    const moved = scene();
    moveTo(moved, object, 101, -1e9);
    assert.deepEqual(placeOf(moved, object).slice(0, 2), [100, -100]);
  }
  const { walls, walls: [wall] } = scene(), kept = wallEnds(wall)[0];
  setWallEnd({ walls }, { index: 0 }, 1, kept[0] + 300, kept[1] + 400);
  assert.equal(wall.size[0], 30);
  near(wallEnds(wall)[0][0], kept[0], 0.03);
  near(wallEnds(wall)[0][1], kept[1], 0.03);
  Object.assign(wall, { center: [100, 0, 1.5], yaw_deg: 0 });
  setWallEnd({ walls }, { index: 0 }, 0, 90, 0);
  near(wall.center[0], 100);
  setWallEnd({ walls }, { index: 0 }, 1, 1e6, 0);
  assert.ok(wall.center[0] <= 100 && wallEnds(wall)[1][0] <= 115);
});

test("heights stay within their range; a wall stands on the ground", () => {
  const changed = scene();
  setHeight(changed, { kind: "wall", index: 0 }, 2);
  assert.deepEqual(changed.walls[0], { center: [4, 0, 1], size: [3, 0.4, 2], yaw_deg: 90 });
  setHeight(changed, { kind: "start" }, -4);
  assert.equal(changed.start[2], RANGES["start.z"][0]);
  setHeight(changed, { kind: "pillar", index: 0 }, 99);
  assert.equal(heightOf(changed, { kind: "pillar", index: 0 }), 8);
});

test("a wall's end is drawn while the other stays, whichever of its sides is the long one", () => {
  for (const wall of [{ center: [4, 0, 1.5], size: [3, 0.4, 3], yaw_deg: 90 }, { center: [4, 0, 1.5], size: [0.4, 3, 3], yaw_deg: 0 }]) {
    for (const end of [0, 1]) {
      const changed = { ...scene(), walls: [copy(wall)] }, kept = wallEnds(wall)[1 - end];
      setWallEnd(changed, { index: 0 }, end, kept[0] + 3, kept[1] + 4);
      const ends = wallEnds(changed.walls[0]);
      near(ends[1 - end][0], kept[0], 0.01);
      near(ends[1 - end][1], kept[1], 0.01);
      near(ends[end][0], kept[0] + 3, 0.01);
      near(ends[end][1], kept[1] + 4, 0.01);
      assert.equal(Math.min(...changed.walls[0].size.slice(0, 2)), 0.4);
      const before = copy(changed);
      setWallEnd(changed, { index: 0 }, end, kept[0] + 0.1, kept[1]);
      assert.deepEqual(changed, before, "it stays longer than thick");
    }
  }
});

test("the pad's arrow is its heading and its speed, and a pad that stands has no speed to draw", () => {
  const changed = scene();
  aimPad(changed, 8, 1 + ARROW + ARROW_SPEED * 1.2);
  assert.equal(changed.pad.heading_deg, 90);
  near(changed.pad.speed, 1.2);
  const tip = tipOf(changed.pad);
  near(tip[0], 8);
  near(tip[1], 1 + ARROW + ARROW_SPEED * 1.2);
  aimPad(changed, 8, 99);
  assert.equal(changed.pad.speed, RANGES["pad.speed"][1]);
  aimPad(changed, 8.1, 1);
  assert.equal(changed.pad.speed, 0.05);
  changed.pad.motion = "static";
  changed.pad.speed = 0.7;
  aimPad(changed, 8, -9);
  assert.equal(changed.pad.speed, 0.7);
  assert.equal(changed.pad.heading_deg, -90);
  near(tipOf(changed.pad)[1], 1 - ARROW);
});

test("walls and pillars are added and go; start and pad stay; there is an end to it", () => {
  const changed = scene();
  assert.deepEqual(add(changed, "pillar", 5, 6), { kind: "pillar", index: 1 });
  assert.deepEqual(add(changed, "wall", 1, 2, 30), { kind: "wall", index: 1 });
  assert.equal(changed.walls[1].yaw_deg, 30);
  setRadius(changed, { index: 1 }, 99);
  assert.equal(changed.pillars[1].radius, 3);
  assert.ok(remove(changed, { kind: "pillar", index: 0 }));
  assert.deepEqual(changed.pillars[0].p, [5, 6]);
  for (const object of [null, { kind: "start" }, { kind: "pad" }, { kind: "wall", index: 7 }]) assert.equal(remove(changed, object), false);
  for (let i = 0; i < 2 * MOST; ++i) for (const kind of ["wall", "pillar"]) add(changed, kind, i, 0);
  assert.deepEqual([changed.walls.length, changed.pillars.length], [80, 80]);
  changed.pillars.pop();
  add(changed, "pillar", 1e4, -1e4);
  assert.deepEqual(changed.pillars.at(-1).p, [100, -100]);
});

test("every object has handles whose places are what they set", () => {
  for (const object of objectsOf(scene())) {
    const unchanged = scene(), handles = handlesOf(unchanged, object, [1, 0]);
    assert.ok(handles.length > 0);
    for (const handle of handles) {
      if (handle.vertical) handle.vertical(handle.place[2]);
      else handle.level(handle.place[0], handle.place[1]);
      assert.deepEqual(unchanged, scene(), `${object.kind}: ${handle.name}`);
    }
  }
});

test("a pad is set to nothing that its motion refuses", () => {
  const rates = { static: [0, 0.5], line: [0, 0.5], circle: [-0.05, -0.5, 0.5], straight_turn: [0.05, 0.5], figure_eight: [-0.05, -0.5, 0.5], stop_and_go: [0, 0.5], reversing: [0, 0.5], random: [0.05, 0.5] };
  for (const [motion, wanted] of Object.entries(rates)) {
    const changed = scene(), left = motion === "circle" || motion === "figure_eight";
    Object.assign(changed.pad, { speed: 0, turn_rate: -0.01 });
    setValue(changed, "pad.motion", motion);
    const found = [changed.pad.turn_rate];
    for (const rate of left ? [-0.5, 0.5] : [0.5]) {
      setValue(changed, "pad.turn_rate", rate);
      found.push(changed.pad.turn_rate);
    }
    assert.deepEqual(found, wanted, motion);
    assert.equal(changed.pad.speed, motion === "static" ? 0 : 0.05);
    setValue(changed, "pad.turn_rate", 0);
    assert.equal(changed.pad.turn_rate, left ? 0.05 : wanted[0], motion);
    assert.deepEqual(rangeOf("pad.turn_rate", changed), [left ? -1 : wanted[0], 1]);
    assert.deepEqual(rangeOf("pad.speed", changed), [motion === "static" ? 0 : 0.05, 3]);
  }
});

test("values are found and put by their paths", () => {
  const changed = scene();
  setValue(changed, "limits.speed", 4);
  setValue(changed, "seed", 9);
  assert.deepEqual([valueAt(changed, "limits.speed"), changed.seed, valueAt(changed, "nothing.here")], [4, 9, undefined]);
});

test("scenes of the menu leave the first one as it was, and differ", () => {
  const first = scene(), texts = SCENES.map((_, i) => JSON.stringify(sceneOfMenu(i, first)));
  assert.deepEqual(first, scene());
  assert.equal(new Set(texts).size, SCENES.length);
});

/** Measures with steps that take so many milliseconds after so many before them, on a clock that only they move. */
async function measure(t, takes) {
  let now = 0, slow = null, before = 0;
  const asked = [];
  t.mock.timers.enable({ apis: ["setTimeout"] });
  t.mock.method(performance, "now", () => now);
  const ask = ({ scene: { backend }, steps }) => {
    asked.push({ backend, steps });
    const mean_ms = takes(before);
    before += steps;
    now += steps * mean_ms;
    return { steps, mean_ms, iterations: 1, cost: 1 };
  };
  const stopwatch = new Stopwatch(ask, ["banded", "lbfgs"], (rows, given_up) => (slow = given_up));
  stopwatch.begin(scene());
  for (let i = 0; i < 500; ++i) t.mock.timers.tick(500);
  return { asked, slow, rows: stopwatch.rows };
}

test("the stopwatch measures the backends by turns, and the fastest steps count", async (t) => {
  const { asked, slow, rows } = await measure(t, (before) => (before < 50 ? 8 : 1));
  const counted = asked.filter(({ steps }) => steps !== 3).map(({ backend }) => backend);
  assert.ok(counted.every((backend, i) => i === 0 || backend !== counted[i - 1]), counted.join());
  assert.deepEqual([slow, rows.map(({ steps, least_ms }) => [steps, least_ms])], [false, [[100, 1], [100, 1]]]);
});

test("times are compared only between plans of equal cost, and the steps are counted", () => {
  const row = (backend, least_ms, cost, steps = 100) => ({ backend, least_ms, cost, steps, iterations: 4 });
  assert.match(speedWords(row("banded", 0.5, 576.88), row("lbfgs", 0.65, 581.1)), /^banded is 1\.3 times as fast at equal cost, 576\.9 and 581\.1; .*; of 100 equal steps each, the fastest count\.$/);
  assert.match(speedWords(row("banded", 0.7, 500), row("lbfgs", 0.5, 501)), /^lbfgs is 1\.4 times as fast at equal cost/);
  assert.equal(speedWords(row("banded", 0.7, 500), row("lbfgs", 0.5, 501, 50)), "Being measured: 100 and 50 steps of 100.");
  assert.match(speedWords(row("banded", 0.5, 500), row("lbfgs", 0.51, 499)), /^Both are as fast at equal cost/);
  const other = speedWords(row("banded", 0.5, 763.92), row("lbfgs", 0.65, 790.79));
  assert.match(other, /^Not to be compared: the plan of lbfgs costs 3\.5 % more/);
  assert.doesNotMatch(other, /fast at|times/);
  assert.match(speedWords(row("banded", 0.5, 0), row("lbfgs", 0.65, 0)), /^Nothing had to be solved/);
});

test("the stopwatch gives up where a block takes more than a second, and says so", async (t) => {
  const { asked, slow } = await measure(t, () => 400);
  assert.deepEqual([asked, slow], [[{ backend: "banded", steps: 3 }], true]);
});

test("cells come and go in any order", () => {
  const list = new CellList(), known = new Set();
  let seed = 5;
  const whole = (n) => Math.floor(((seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32) * n);
  for (let step = 0; step < 400; ++step) {
    const change = { added: [], removed: [] };
    for (const name of ["removed", "added"]) {
      for (let i = whole(6); i > 0; --i) {
        const cell = [whole(4), whole(4), whole(2)];
        change[name].push(...cell.map((x) => x / 10 + 0.05));
        known[name === "added" ? "add" : "delete"](cell.join());
      }
    }
    list.change(change);
    const held = [];
    for (let i = 0; i < list.places.length; i += 3) held.push(list.places.slice(i, i + 3).map((x) => Math.round(10 * x - 0.5)).join());
    assert.equal(held.length, list.size);
    assert.deepEqual(held.sort(), [...known].sort(), `step ${step}`);
  }
});

const line = (t0, length) => ({ t0, h: 0.5, control_points: Array.from({ length: 7 }, (_, i) => [((i - 1) * length) / 4, 0, 1]) });
const certificate = {
  passed: true, start_met: true, endpoint_met: true, endpoint_required: true, endpoint_position_residual_m: 2e-17, endpoint_velocity_residual_mps: 0, speed_bound_mps: 2.5, acceleration_bound_mps2: 4, body_rate_bound_radps: 1,
  earlier: false, limits_kept: true, recovering: false, clear: true, clearance_m: 0.37, escaping: false, stops_in_observed_space: true,
};

test("what came out is told in words", () => {
  const answer = { status: "planned", reason: "none", sentences: ["A new plan is flown."], passed: true, pair: { curve: line(3, 6), t_stop: 3.4, stop: line(3.4, 1) } };
  near(lengthOf(curveOf(answer.pair.curve)), 6, 1e-6);
  assert.deepEqual(headlineOf(answer), { tone: "good", title: "Planned: contact in 2.00 s.", text: "If no newer plan comes, the vehicle stops from 0.40 s on. That stop is certified, too." });
  assert.match(headlineOf({ ...answer, pair: { ...answer.pair, t_stop: null, stop: null } }).text, /needs no stop/);
  const held = { status: "holding", reason: "goal_blocked", sentences: ["It stays.", "The end is blocked."], passed: true, pair: { curve: line(0, 0) } };
  assert.deepEqual(headlineOf(held), { tone: "warn", title: "The end is blocked.", text: "It stays." });
  assert.equal(headlineOf({ ...held, status: "unsafe", passed: false }).tone, "bad");
  assert.equal(eventWords("landing (arriving)"), "landing: contact is near and the landing condition holds");
  assert.equal(eventWords("feet touch the deck"), "feet touch the deck");
  assert.deepEqual(outcomeOf({ name: "landed", sentence: "Well." }), { tone: "good", title: "Landed.", text: "Well." });
  assert.equal(outcomeOf({ name: "touched", sentence: "" }).tone, "bad");
});

test("each check of a certificate is told by its own figure", () => {
  const limits = { speed: 3, acceleration: 6, body_rate: 5 }, oks = (change) => checksOf({ ...certificate, ...change }, limits).map(({ ok }) => ok);
  assert.deepEqual(oks({}), [true, true, true, true]);
  assert.deepEqual(oks({ endpoint_met: false }), [false, true, true, true]);
  assert.deepEqual(oks({ start_met: false }), [false, true, true, true, true]);
  assert.deepEqual(oks({ endpoint_required: false }), [null, true, true, true]);
  assert.deepEqual(oks({ limits_kept: false }), [true, false, true, true]);
  assert.deepEqual(oks({ clear: false }), [true, true, false, true]);
  assert.deepEqual(oks({ clear: false, escaping: true }), [true, true, true, true]);
  assert.deepEqual(oks({ stops_in_observed_space: false }), [true, true, true, false]);
  const [, speeds, clearance] = checksOf(certificate, limits);
  assert.match(speeds.figure, /2\.50 of 3 m\/s, 4\.00 of 6 m\/s², turns at 1\.0 of 5 rad\/s/);
  assert.match(clearance.figure, /0\.37 m/);
  const words = checksOf({ ...certificate, earlier: true, speed_bound_mps: null, clearance_m: null }, limits).map(({ figure }) => figure).join();
  assert.doesNotMatch(words, /NaN|null|undefined/);
});

test("all ticks are there exactly where the certificate passed", () => {
  const names = ["start_met", "endpoint_met", "endpoint_required", "limits_kept", "clear", "escaping", "stops_in_observed_space"];
  for (let bits = 0; bits < 2 ** names.length; ++bits) {
    const c = { ...certificate, ...Object.fromEntries(names.map((name, i) => [name, Boolean(bits & (1 << i))])) };
    // What the module calls met where nothing is required, and passed.
    c.endpoint_met ||= !c.endpoint_required;
    c.passed = c.start_met && c.endpoint_met && c.limits_kept && (c.clear || c.escaping) && c.stops_in_observed_space;
    assert.equal(checksOf(c, { speed: 3, acceleration: 6, body_rate: 4 }).every(({ ok }) => ok !== false), c.passed, JSON.stringify(c));
  }
});

test("a scene that is refused has a headline and no curve", () => {
  const refused = { status: "refused", reason: "start_in_obstacle", sentences: ["The start is in an obstacle."], passed: false, pair: null, certificate: null, attempts: [] };
  assert.deepEqual(headlineOf(refused), { tone: "bad", title: "The start is in an obstacle.", text: "" });
});

test("an attempt is told by the round that it took", () => {
  const round = (pairs, iterations) => ({ pairs: Array(pairs).fill({}), iterations });
  const attempt = { duration_s: 4.25, arrival: "free", segments: 9, best: 1, reason: "none", rounds: [round(0, 7), round(3, 4), round(5, 2)] };
  assert.equal(roundOf(attempt), attempt.rounds[1]);
  assert.deepEqual(rowOf(attempt), { arrival: "4.25 s", end: "free", segments: 9, rounds: 3, pairs: 3, iterations: 13, reason: "taken" });
  assert.equal(roundOf({ ...attempt, best: null }), attempt.rounds[2]);
  assert.equal(rowOf({ ...attempt, best: null, rounds: [], reason: "search_failed" }).reason, "search failed");
});
