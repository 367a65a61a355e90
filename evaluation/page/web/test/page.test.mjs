// SPDX-License-Identifier: BSD-3-Clause
// The page in a browser: Debian's Chromium, driven by puppeteer. Flies, writes pages, looks at them.
//   TOUCHDOWN_PROGRAM=.../touchdown node --test test/
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { launch } from "./chromium.mjs";

const program = process.env.TOUCHDOWN_PROGRAM;
const folder = mkdtempSync(join(tmpdir(), "touchdown-page-"));
const file = (name) => join(folder, name);
let browser;

function run(...words) {
  return execFileSync(program, words, { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });
}

/** A flight that may fail: its exit status is then 1. */
function fly(record, ...words) {
  try {
    run("land", "straight_turn", "--record", file(record), ...words);
  } catch (error) {
    assert.equal(error.status, 1, error.message);
  }
}

/** Opens a page; what it says on the console, or fails to load, is kept in `said`. */
async function open(name) {
  const page = await browser.newPage();
  page.said = [];
  page.on("console", (message) => page.said.push(message.text()));
  page.on("pageerror", (error) => page.said.push(error.message));
  page.on("requestfailed", (request) => page.said.push(request.url()));
  page.on("request", (request) => /^(file|data|blob):/.test(request.url()) || page.said.push(request.url()));
  await page.setViewport({ width: 1100, height: 760 });
  await page.goto(`file://${file(name)}`);
  return page;
}

/** Opened, and stopped. */
async function ready(name) {
  const page = await open(name);
  await page.waitForSelector("body.ready", { timeout: 60000 });
  await page.evaluate(() => replay.play(false));
  return page;
}

/** How many pixels of the picture are near a colour, and how many colours there are, coarsely. */
async function look(page, colour = [0, 0, 0]) {
  return page.evaluate((wanted) => {
    replay.draw();
    const canvas = document.createElement("canvas"), source = document.getElementById("picture");
    [canvas.width, canvas.height] = [source.width, source.height];
    const pen = canvas.getContext("2d");
    pen.drawImage(source, 0, 0);
    const { data } = pen.getImageData(0, 0, canvas.width, canvas.height);
    const colours = new Set();
    let near = 0, sum = 0;
    for (let i = 0; i < data.length; i += 4) {
      colours.add((data[i] >> 4) * 256 + (data[i + 1] >> 4) * 16 + (data[i + 2] >> 4));
      near += Math.hypot(data[i] - wanted[0], data[i + 1] - wanted[1], data[i + 2] - wanted[2]) < 40;
      sum = (Math.imul(sum, 31) + data[i] + 3 * data[i + 1] + 7 * data[i + 2]) | 0;
    }
    return { colours: colours.size, near, sum };
  }, colour);
}

const position = (page, number = 0) => page.evaluate((n) => replay.all[n].vehicle.body.position.toArray(), number);

async function slide(page, t) {
  await page.evaluate((to) => {
    const slider = document.getElementById("slider");
    slider.value = to;
    slider.dispatchEvent(new Event("input"));
    replay.draw();
  }, t);
}

before(async () => {
  assert.ok(program, "TOUCHDOWN_PROGRAM names the program");
  browser = await launch();
  run("land", "open", "--html", file("unkept.html"), "--set", "timeout=30");
  fly("ours.db", "--html", file("land.html"), "--set", "timeout=5", "--set", "wind.mean=2");
  fly("ego.db", "--planner", "ego", "--set", "timeout=4");
  run("replay", file("ours.db"), "--html", file("one.html"));
  run("replay", file("ours.db"), "--html", file("two.html"), "--beside", file("ego.db"));
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

describe("a page of one flight", () => {
  let page;
  before(async () => (page = await ready("one.html")));
  after(() => page.close());

  test("says nothing on the console and asks for nothing outside", () => assert.deepEqual(page.said, []));

  test("shows a picture", async () => {
    const seen = await look(page);
    assert.ok(seen.colours > 60, `${seen.colours} colours`);
  });

  test("moves the vehicle with the slider to where the record has it", async () => {
    const sample = await page.evaluate(() => {
      const { t, px, py, pz } = replay.flight.document.samples.vehicle;
      return [t[150], px[150], py[150], pz[150]];
    });
    await slide(page, 0);  // a page plays at once: on a busy machine it has come far before `ready` stops it
    const at_first = await position(page), before = await look(page);
    await slide(page, sample[0]);
    const moved = await position(page), after = await look(page);
    for (let k = 0; k < 3; ++k) assert.ok(Math.abs(moved[k] - sample[k + 1]) < 1e-3);
    assert.ok(Math.hypot(...moved.map((x, k) => x - at_first[k])) > 1);
    assert.notEqual(before.sum, after.sum);
    assert.equal(await page.$eval("#time", (time) => time.textContent), `${sample[0].toFixed(2)} s`);
  });

  for (const view of ["orbit", "follow"]) {
    test(`explains the plan that is clicked on, as \`plan --from\` does: ${view}`, async () => {
      await slide(page, 2.5);
      await page.evaluate((name) => replay.look(name), view);
      // A place on a plan, between two of the points that it is drawn by.
      const place = await page.evaluate(() => {
        replay.draw();
        const { all } = replay.shown.plans, curve = all.curves[replay.flight.stepAt(replay.t)];
        const { camera } = replay.views, p = camera.position.clone(), box = document.getElementById("picture").getBoundingClientRect();
        for (let i = 6; i < curve.length - 3; i += 3) {
          p.set((curve[i] + curve[i + 3]) / 2, (curve[i + 1] + curve[i + 4]) / 2, (curve[i + 2] + curve[i + 5]) / 2).project(camera);
          const at = [box.left + ((p.x + 1) / 2) * box.width, box.top + ((1 - p.y) / 2) * box.height];
          if (Math.abs(p.x) < 0.8 && Math.abs(p.y) < 0.8 && p.z < 1) return at;
        }
      });
      await page.mouse.click(...place);
      await page.evaluate(() => replay.draw());
      const number = (await page.$eval(".step-title", (element) => element.textContent)).match(/^Step (\d+) of \d+$/)[1];
      assert.ok(Math.abs((await page.evaluate((n) => replay.flight.steps[n].t_start - replay.t, number))) < 1e-6);
      const words = await page.$eval("#words", (element) => element.textContent);
      const untimed = (text) => text.split("\n").filter((line) => line && !line.includes("thread CPU time") && !line.startsWith("replanning step"));
      const command = await page.$eval(".command code", (element) => element.textContent);
      assert.equal(command, `touchdown plan --from ${file("ours.db")}:${number}`);
      assert.ok(await page.$eval(".command", (element) => element.checkVisibility()));
      const asked = run("plan", "--from", `${file("ours.db")}:${number}`);
      assert.deepEqual(untimed(words), untimed(asked));
      assert.ok(untimed(words).length > 8);
      await page.evaluate(() => replay.look("orbit"));
    });
  }

  test("is moved by keys", async () => {
    await slide(page, 1);
    await page.focus("#picture");
    await page.keyboard.press("ArrowRight");
    const step = await page.evaluate(() => replay.flight.stepAt(replay.t));
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.evaluate(() => replay.flight.stepAt(replay.t)), step + 1);
    await page.keyboard.press("3");
    assert.equal(await page.$eval("#view", (view) => view.value), "top");
    const above = await look(page);
    await page.keyboard.press("4");
    assert.notEqual((await look(page)).sum, above.sum);
    const from = await page.evaluate(() => replay.t);
    await page.keyboard.press("Space");
    await page.waitForFunction((t) => replay.t > t + 0.05, {}, from);
    await page.keyboard.press("Space");
    await page.keyboard.press("1");
  });

  test("shows and hides its layers", async () => {
    await slide(page, 2);
    const brown = [110, 66, 28];
    const shown = await look(page, brown);
    await page.click("#layer-occupied-cells");
    const hidden = await look(page, brown);
    assert.ok(shown.near > 10 * (hidden.near + 1), `${shown.near} and ${hidden.near} pixels`);
    await page.click("#layer-occupied-cells");
    assert.equal((await look(page, brown)).sum, shown.sum);
    // Each that is in the picture goes and comes back; the others at least leave it as it was.
    const keys = await page.$$eval("#layers kbd", (found) => found.map((kbd) => kbd.textContent));
    assert.ok(new Set(keys).size === keys.length && keys.length >= 17, keys.join());
    const changed = [];
    for (const key of keys) {
      await page.keyboard.press(key);
      if ((await look(page)).sum !== shown.sum) changed.push(key);
      await page.keyboard.press(key);
      assert.equal((await look(page)).sum, shown.sum, `after ${key}`);
    }
    for (const key of "oualifbdectvk") assert.ok(changed.includes(key), `${key} is not among ${changed}`);
    assert.deepEqual(page.said, []);
  });

  test("goes to a mark that is clicked on, and explains its step", async () => {
    const mark = await page.evaluate(() => {
      const box = document.getElementById("marks").getBoundingClientRect();
      const stop = replay.timeline.marks[0].find((m) => m.kind === "mode");
      return { t: stop.t, x: box.left + replay.timeline.x(stop.t), y: box.top + 6 };
    });
    await page.mouse.move(mark.x, mark.y);
    assert.match(await page.$eval("#tip", (tip) => tip.textContent), /mode: tracking/);
    await page.mouse.click(mark.x, mark.y);
    assert.ok(Math.abs((await page.evaluate(() => replay.t)) - mark.t) < 1e-6);
    const stop = await page.evaluate(() => {
      const box = document.getElementById("marks").getBoundingClientRect();
      const found = replay.timeline.marks[0].find((m) => m.kind === "stop");
      return { step: found.step, x: box.left + replay.timeline.x(found.t), y: box.top + 6 };
    });
    await page.mouse.click(stop.x, stop.y);
    await page.evaluate(() => replay.draw());
    assert.match(await page.$eval(".step-title", (element) => element.textContent), new RegExp(`^Step ${stop.step} of`));
    assert.match(await page.$eval(".step-summary", (element) => element.textContent), /a stored stop is flown/);
  });

  test("tells what is flown, and until when, and why the mode began", async () => {
    const asked = await page.evaluate(() => {
      const i = replay.flight.steps.findIndex((step) => step.stops && step.t_stop < replay.flight.stepTimes[replay.flight.steps.indexOf(step) + 1]);
      const step = replay.flight.steps[i];
      replay.seek(Math.max(step.t_stop, step.t_start) + 1e-3);
      replay.draw();
      const { q, h, t0 } = step.stop;
      return { end: t0 + (q.length / 3 - 3) * h, now: document.getElementById("now").textContent };
    });
    assert.ok(asked.now.includes(`a stored stop, until ${asked.end.toFixed(2)} s`), asked.now);
    assert.match(asked.now, /tracking since [\d.]+ s: the pad is known well enough \(pad_converged\)/);
  });

  test("opens where its address says", async () => {
    const other = await browser.newPage();
    await other.goto(`file://${file("one.html")}#step=9&view=top`);
    await other.waitForSelector("body.ready", { timeout: 60000 });
    await other.evaluate(() => replay.draw());
    assert.match(await other.$eval(".step-title", (element) => element.textContent), /^Step 9 of \d+$/);
    assert.equal(await other.$eval("#view", (view) => view.value), "top");
    assert.equal(await other.evaluate(() => replay.playing), false);
    // From above the world's x is to the right and its y upwards.
    const [x, y] = await other.evaluate(() => {
      const { camera } = replay.views, p = replay.all[0].vehicle.body.position;
      const seen = (dx, dy) => p.clone().set(p.x + dx, p.y + dy, p.z).project(camera);
      const [o, along, across] = [seen(0, 0), seen(1, 0), seen(0, 1)];
      return [[along.x - o.x, along.y - o.y], [across.x - o.x, across.y - o.y]];
    });
    assert.ok(x[0] > 0.02 && Math.abs(x[1]) < 0.3 * x[0], `${x}`);
    assert.ok(y[1] > 0.02 && Math.abs(y[0]) < 0.3 * y[1], `${y}`);
    // And so it does where the address of an open page is changed.
    await other.evaluate(() => { replay.play(true); location.hash = "#step=12"; });
    await other.waitForFunction(() => document.querySelector(".step-title").textContent.startsWith("Step 12 of"), { timeout: 5000 });
    assert.deepEqual(await other.evaluate(() => [replay.playing, replay.t, document.getElementById("view").value]), [false, await other.evaluate(() => replay.flight.stepTimes[12]), "top"]);
    await other.close();
  });

  test("opens behind the vehicle, which is in the middle, and plays", async () => {
    const other = await open("one.html");
    await other.waitForSelector("body.ready", { timeout: 60000 });
    await other.waitForFunction(() => replay.t > replay.begin, { timeout: 60000 });
    const [x, y, wide] = await other.evaluate(() => {
      replay.draw();
      const { camera } = replay.views, { vehicle } = replay.all[0], middle = vehicle.body.position;
      const seen = middle.clone().project(camera), { elements } = camera.matrixWorld;
      const beside = middle.clone().set(middle.x + 0.3 * elements[0], middle.y + 0.3 * elements[1], middle.z + 0.3 * elements[2]).project(camera);
      return [seen.x, seen.y, (beside.x - seen.x) * replay.size[0]];
    });
    assert.ok(Math.abs(x) < 0.2 && Math.abs(y) < 0.3 && wide > 30, `${[x, y]}, ${wide} pixels wide`);
    await other.close();
  });

  test("has plots with a cursor at the time", async () => {
    await slide(page, 2.5);
    const places = await page.$$eval(".now", (lines) => lines.map((line) => line.style.transform));
    assert.equal(places.length, 6);
    await slide(page, 4);
    const later = await page.$$eval(".now", (lines) => lines.map((line) => line.style.transform));
    places.forEach((place, i) => assert.notEqual(place, later[i]));
    const [beside, above] = await page.$$eval(".plot:first-child .u-value", (values) => values.slice(-2).map((value) => Number(value.textContent)));
    const now = await page.$eval("#now", (element) => element.textContent.match(/horizontally to the pad([\d.]+) mfeet above the deck(-?[\d.]+) m/).slice(1).map(Number));
    assert.ok(Math.abs(beside - now[0]) < 0.05 && Math.abs(above - now[1]) < 0.05, `${[beside, above]} is not ${now}`);
  });

  test("has plots with all their values, also before and after the mouse is there, and with figures at their axes", async () => {
    const other = await ready("one.html");
    const values = () => other.$$eval(".plot", (plots) => plots.map((plot) => [...plot.querySelectorAll(".u-value")].slice(1).map((value) => value.textContent)));
    await other.evaluate(() => replay.seek(replay.begin));
    await other.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
    for (const plot of [0, 1, 5]) assert.ok((await values())[plot].every((value) => /^-?[\d.e-]+$/.test(value)), `${(await values())[plot]}`);
    await slide(other, 2.5);
    const before = await values();
    assert.ok(before.flat().length > 15 && before.flat().every((value) => /^-?[\d.e-]+$/.test(value)), `${before}`);
    const box = await other.$eval(".u-over", (over) => { const { left, top, width, height } = over.getBoundingClientRect(); return { left, top, width, height }; });
    await other.mouse.move(box.left + 0.9 * box.width, box.top + box.height / 2);
    assert.notDeepEqual(await values(), before);
    await other.mouse.move(300, 300);
    assert.deepEqual(await values(), before);
    const hidden = await other.$$eval(".u-legend", (legends) => legends.filter(({ scrollHeight, clientHeight }) => scrollHeight > clientHeight).length);
    assert.equal(hidden, 0);
    const figures = await other.evaluate(() => replay.plots.plots.map(({ plot }) => plot.axes.map((axis) => axis._values.filter(Boolean).length)));
    assert.ok(figures.flat().every((count) => count >= 3), `${figures}`);
    await other.close();
  });
});

test("the error of tracking ends at contact", async () => {
  const page = await ready("unkept.html");
  const [contact, times, errors] = await page.evaluate(() => {
    const { data, series } = replay.plots.plots[1].plot;
    return [replay.flight.eventAt("contact", replay.end).t, data[0], data[series.findIndex(({ label }) => label === "of tracking")]];
  });
  const kept = times.filter((t, i) => typeof errors[i] === "number");
  assert.ok(kept.length > 100 && Math.max(...kept) < contact && contact - Math.max(...kept) < 0.1, `${Math.max(...kept)} s, contact at ${contact} s`);
  assert.ok(Math.max(...times) > contact + 0.5);
  const told = async (t) => { await slide(page, t); return page.$eval("#now", (now) => now.textContent.match(/tracking error(.*?)estimate/)[1]); };
  assert.match(await told(contact - 0.1), /^\d\.\d\d m$/);
  assert.equal(await told(contact + 0.1), "–");
  await page.close();
});

test("a drag in a plot is a closer look in all of them, a double click the whole again", async () => {
  const page = await ready("one.html");
  const ranges = () => page.evaluate(() => replay.plots.plots.map(({ plot }) => [plot.scales.x.min, plot.scales.x.max]));
  const whole = await ranges();
  const box = await page.$eval(".u-over", (over) => { const { left, top, width, height } = over.getBoundingClientRect(); return { left, top, width, height }; });
  const y = box.top + box.height / 2;
  await page.mouse.move(box.left + 0.3 * box.width, y);
  await page.mouse.down();
  await page.mouse.move(box.left + 0.6 * box.width, y, { steps: 4 });
  await page.mouse.up();
  for (const [low, high] of await ranges()) assert.ok(high - low < 0.5 * (whole[0][1] - whole[0][0]), `${[low, high]}`);
  await page.mouse.click(box.left + 0.5 * box.width, y, { count: 2 });
  assert.deepEqual(await ranges(), whole);
  await page.close();
});

test("`land --html` writes the same page as `replay --html`", async () => {
  const page = await ready("land.html");
  assert.deepEqual(page.said, []);
  await slide(page, 3);
  const other = await ready("one.html");
  await slide(other, 3);
  assert.deepEqual(await position(page), await position(other));
  await page.close();
  await other.close();
});

test("a flight without a record says how to have one", async () => {
  const page = await ready("unkept.html");
  await slide(page, 1);
  assert.match(await page.$eval(".command", (element) => element.innerText), /^fly it with --record/);
  await page.close();
});

test("two flights fly on one clock, each with its own words", async () => {
  const page = await ready("two.html");
  assert.deepEqual(page.said, []);
  await slide(page, 2);
  const ours = await position(page, 0), theirs = await position(page, 1);
  assert.ok(Math.hypot(...ours.map((x, k) => x - theirs[k])) > 0.2);
  const labels = await page.$$eval(".label:not([hidden])", (found) => found.map((label) => label.textContent));
  assert.deepEqual(labels, ["1: planner landing", "2: planner ego"]);
  const ends = await page.evaluate(() => replay.flights.map((flight) => flight.end));
  const shorter = ends.indexOf(Math.min(...ends));
  await slide(page, Math.max(...ends));
  const after = await page.$$eval(".label", (found) => found.map((label) => label.textContent.endsWith(", ended")));
  assert.deepEqual(after, ends.map((_, i) => i === shorter));
  await slide(page, 2);
  const words = await page.$eval("#words", (element) => element.textContent);
  await page.select("#which", "1");
  await page.evaluate(() => replay.draw());
  assert.notEqual(await page.$eval("#words", (element) => element.textContent), words);
  assert.equal(await page.$eval(".command", (element) => element.checkVisibility()), false);
  // And back: all of the first is there again.
  const before = await page.evaluate(() => { replay.select(0); replay.draw(); return 0; }).then(() => look(page));
  await page.focus("#picture");
  await page.keyboard.press("x");
  assert.notEqual((await look(page)).sum, before.sum);
  await page.keyboard.press("x");
  assert.equal((await look(page)).sum, before.sum);
  assert.ok(await page.evaluate(() => replay.shown.pad.predicted.visible && replay.shown.pad.believed.visible));
  await page.close();
});

test("a flight to a goal is told without a pad, an estimated own state with its error", async () => {
  run("fly", "goal", "--record", file("goal.db"), "--html", file("goal.html"), "--set", "own_state=estimated");
  const page = await ready("goal.html");
  await slide(page, 2);
  assert.deepEqual(page.said, []);
  assert.match(await page.$eval("#now", (element) => element.textContent), /horizontally to the goal/);
  assert.doesNotMatch(await page.$eval("#now", (element) => element.textContent), /the pad|NaN|undefined/);
  assert.deepEqual(await page.evaluate(() => [replay.shown.goal.visible, replay.shown.pad.true.visible, replay.shown.vehicle.belief.object.visible]), [true, false, true]);
  const reached = await page.evaluate(() => { replay.seek(replay.end); replay.draw(); return replay.shown.goal.position.distanceTo(replay.shown.vehicle.body.position); });
  assert.ok(reached < 0.5, `${reached} m`);
  await page.close();
});

test("a flight to a goal beside a landing has its own words", async () => {
  run("replay", file("goal.db"), "--beside", file("ours.db"), "--html", file("mixed.html"));
  const page = await ready("mixed.html");
  const now = async () => { await page.evaluate(() => replay.draw()); return page.$eval("#now", (element) => element.textContent); };
  assert.match(await now(), /horizontally to the goal/);
  await page.evaluate(() => replay.select(1));
  assert.match(await now(), /feet above the deck.*estimate of the pad/);
  await page.evaluate(() => replay.select(0));
  assert.match(await now(), /horizontally to the goal/);
  assert.deepEqual(page.said, []);
  await page.close();
});

describe("a page that is damaged", () => {
  const whole = () => readFileSync(file("one.html"), "utf8");
  const at = (text, share) => Math.floor(text.indexOf('class="flight"') + share * (text.length - text.indexOf('class="flight"')));
  const damages = {
    "its end is missing": (text) => text.slice(0, at(text, 0.5)),
    "its flights are missing": (text) => text.slice(0, text.indexOf('<script type="text/plain"')),
    "a letter is another": (text) => text.slice(0, at(text, 0.6)) + (text[at(text, 0.6)] === "A" ? "B" : "A") + text.slice(at(text, 0.6) + 1),
    "it holds something else": (text) => text.replace(/class="flight">[^<]*/, 'class="flight">Zm9yZWlnbg=='),
  };
  for (const [name, damage] of Object.entries(damages)) {
    test(`says so in a sentence: ${name}`, async () => {
      writeFileSync(file("damaged.html"), damage(whole()));
      const page = await open("damaged.html");
      await page.waitForFunction(() => document.getElementById("message").textContent.startsWith("This page is damaged"), { timeout: 20000 });
      assert.equal(await page.$eval("#message", (message) => message.hidden), false);
      assert.match(await page.$eval("#message", (message) => message.textContent), /Write it again with `touchdown replay`\.$/);
      assert.equal(await page.$("body.ready"), null);
      assert.deepEqual(page.said, []);
      await page.close();
    });
  }
});
