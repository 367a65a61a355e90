// SPDX-License-Identifier: BSD-3-Clause
// The parts of the page that need no browser.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readFileSync, readdirSync } from "node:fs";
import { deflateSync } from "node:zlib";
import { KnownCells } from "../src/map.js";
import { Flight, indexAt } from "../src/flight.js";
import { distanceToPiece } from "../src/plans.js";
import { Prior } from "../src/world.js";
import { endOf, positionAt, sample } from "../src/spline.js";
import { unpack } from "../src/unpack.js";
import { Quaternion, Vector3 } from "three";

const near = (a, b, error = 1e-9) => assert.ok(Math.abs(a - b) <= error, `${a} is not ${b}`);

/** A stream of numbers in [0, 1), always the same. */
function randomStream(seed) {
  return () => ((seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32);
}

test("a spline goes through its knots' points and a straight one moves evenly", () => {
  const q = [];
  for (let i = 0; i < 7; ++i) q.push(i, i * i, -2 * i);
  const curve = { t0: 3, h: 0.5, q };
  assert.equal(endOf(curve), 5);
  const p = [0, 0, 0];
  for (let k = 0; k <= 4; ++k) {
    positionAt(curve, 3 + 0.5 * k, p);
    for (let axis = 0; axis < 3; ++axis) near(p[axis], (q[3 * k + axis] + 4 * q[3 * k + 3 + axis] + q[3 * k + 6 + axis]) / 6);
  }
  positionAt(curve, 3.8, p);
  near(p[0], 1 + 0.8 / 0.5);
  positionAt(curve, 99, p);
  near(p[0], 5);
  const points = sample(curve, 3, 5, 4);
  assert.equal(points.length, 3 * 17);
  near(points[0], 1);
  near(points[3 * 16], 5);
});

test("no letter of the pages needs a special font", () => {
  const folder = new URL("../src/", import.meta.url);
  for (const name of readdirSync(folder, { recursive: true }).filter((name) => /\.(js|css|html)$/.test(name))) {
    // Latin and Greek letters and their punctuation; arrows, dingbats and emoji are drawn.
    const rare = readFileSync(new URL(name, folder), "utf8").match(/[^\0-\u03ff\u2010-\u203a]/u);
    assert.equal(rare, null, `${name}: ${rare?.[0]}`);
  }
});

test("the window's cells are those of a map without a window, in whatever order steps are sought", () => {
  const random = randomStream(7);
  const whole = (n) => Math.floor(random() * n);
  const size = [8, 6, 4], steps = [];
  let origin = [0, 0, 0];
  // A map that remembers cells by name and forgets what the window leaves.
  const known = [], cells = new Map();
  for (let step = 0; step < 160; ++step) {
    if (step > 0 && whole(2) === 0) origin = origin.map((o) => o + whole(5) - 2);
    if (step === 70) origin = origin.map((o) => o + 100);
    const inside = ([x, y, z]) => [x, y, z].every((c, axis) => c >= origin[axis] && c < origin[axis] + size[axis]);
    for (const name of [...cells.keys()]) if (!inside(name.split(",").map(Number))) cells.delete(name);
    const runs = [];
    for (let run = 0; run < 6; ++run) {
      const count = 1 + whole(3), first = [origin[0] + whole(size[0] - count + 1), origin[1] + whole(size[1]), origin[2] + whole(size[2])];
      const state = whole(3);
      runs.push(...first, count, state);
      for (let k = 0; k < count; ++k) cells.set([first[0] + k, first[1], first[2]].join(), state);
    }
    steps.push({ origin, runs });
    known.push(new Map(cells));
  }
  const map = new KnownCells({ size, steps, resolution: 0.1 });
  for (const step of [3, 4, 80, 79, 20, 159, 158, 0, 101, 51, 50, 49, 150]) {
    map.seek(step);
    const [ox, oy, oz] = steps[step].origin;
    for (let x = ox; x < ox + size[0]; ++x) for (let y = oy; y < oy + size[1]; ++y) for (let z = oz; z < oz + size[2]; ++z) {
      assert.equal(map.at(x, y, z), known[step].get([x, y, z].join()) ?? 0, `step ${step}, cell ${[x, y, z]}`);
    }
  }
});

test("states between samples are interpolated, before and after them kept", () => {
  const half = Math.SQRT1_2;
  const vehicle = { t: [0, 1, 2], px: [0, 2, 2], py: [0, 0, 4], pz: [1, 1, 1], qw: [1, half, half], qx: [0, 0, 0], qy: [0, 0, 0], qz: [0, half, half] };
  const flight = new Flight({ steps: [{ t: 0.5, t_start: 0.6 }, { t: 1.5, t_start: 1.6 }], vehicle: { rotors: [] }, events: [{ t: 1, kind: "mode", text: "landing" }], samples: { vehicle, rotor: {}, mode: { names: ["a", "b"], of: [0, 1, 1] } } }, 0);
  const p = new Vector3(), q = new Quaternion();
  assert.ok(flight.placeAt(vehicle, 0.25, p));
  near(p.x, 0.5);
  flight.placeAt(vehicle, 9, p);
  near(p.y, 4);
  assert.equal(flight.placeAt({ t: [5], px: [0], py: [0], pz: [0] }, 4, p), false);
  flight.attitudeAt(0.5, q);
  near(2 * Math.acos(q.w), Math.PI / 4, 1e-6);
  // An answer is flown from its start on; what is known of the map is as old as the question.
  assert.equal(flight.stepAt(0.55), -1);
  assert.equal(flight.stepAt(0.6), 0);
  assert.equal(flight.askedAt(0.4), -1);
  assert.equal(flight.askedAt(0.55), 0);
  assert.equal(flight.askedAt(1.5), 1);
  assert.equal(flight.stepAt(7), 1);
  assert.equal(flight.modeAt(0.9), "a");
  assert.equal(flight.eventAt("mode", 0.9), undefined);
  assert.equal(flight.eventAt("mode", 1).text, "landing");
  assert.equal(indexAt([1, 2, 3], 0), 0);
});

test("a place is near a line also between its points", () => {
  near(distanceToPiece(5, 3, [0, 0], [10, 0]), 3);
  near(distanceToPiece(13, 4, [0, 0], [10, 0]), 5);
  near(distanceToPiece(3, 4, [0, 0], [0, 0]), 5);
});

test("what turned out of a prior is shown from the step on in which it did", () => {
  const steps = [{ runs: [0, 0, 0, 4, 2] }, { runs: [1, 0, 0, 2, 1] }, { runs: [3, 0, 0, 1, 1, 9, 0, 0, 1, 2] }];
  const prior = new Prior({ occupied: [0, 0, 0, 4], gone: [1, 0, 0, 1, 2, 0, 0, 1, 3, 0, 0, 1], new: [9, 0, 0, 1] }, { steps, resolution: 0.1 });
  const counts = () => prior.turned.map(({ mesh }) => mesh.count);
  prior.update(0);
  assert.deepEqual(counts(), [0, 0]);
  prior.update(1);
  assert.deepEqual(counts(), [2, 0]);
  prior.update(2);
  assert.deepEqual(counts(), [3, 1]);
  prior.update(0);
  assert.deepEqual(counts(), [0, 0]);
});

test("what is no flight is told in a sentence", async () => {
  const pack = (document) => deflateSync(JSON.stringify(document)).toString("base64");
  assert.equal((await unpack(pack({ format: "touchdown flight", version: 1, name: "ß" }))).name, "ß");
  await assert.rejects(unpack(pack({ format: "touchdown flight", version: 0 })), /no flight that its own program can show/);
  await assert.rejects(unpack(pack([])), /no flight/);
  const whole = pack({ format: "touchdown flight", version: 1, name: "x".repeat(999) });
  for (const damaged of ["", "%%%", whole.slice(0, 40), whole.slice(0, 20) + "AAAA" + whole.slice(24)]) {
    await assert.rejects(unpack(damaged), /This page is damaged/);
  }
});
