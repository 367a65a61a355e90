// SPDX-License-Identifier: BSD-3-Clause
// The planner in a page, in a browser: Debian's Chromium, driven by puppeteer, WebGL in software.
//   TOUCHDOWN_PLAYGROUND=.../playground.html node --test test/playground.test.mjs
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { after, before, beforeEach, describe, test } from "node:test";
import { linkOf, sceneOf } from "../src/playground/link.js";
import { SCENES } from "../src/playground/scenes.js";
import { launch } from "./chromium.mjs";

const file = process.env.TOUCHDOWN_PLAYGROUND;
const MOST_BYTES = 2e6, LONGEST_MS = 3000;
let browser, page;

/** Opens the page; what it says on the console, or asks for outside, is kept in `said`. */
async function open(link = "", size = { width: 1200, height: 800 }) {
  const opened = await browser.newPage();
  opened.said = [];
  opened.on("console", (message) => opened.said.push(message.text()));
  opened.on("pageerror", (error) => opened.said.push(error.message));
  opened.on("request", (request) => /^(file|data|blob):/.test(request.url()) || opened.said.push(request.url()));
  await opened.setViewport(size);
  await opened.goto(`file://${file}${link && `#${link}`}`);
  await opened.waitForSelector("body.ready", { timeout: 60000 });
  return opened;
}

/** Does something with another page, which is closed whatever comes of it: one that stays in front stops the first. */
async function within(link, act, size) {
  const other = await open(link, size);
  try {
    await act(other);
  } finally {
    await other.close();
  }
}

const sceneNow = (on = page) => on.evaluate(() => JSON.parse(JSON.stringify(touchdown.scene)));
const planNow = (on = page) => on.evaluate(() => touchdown.answer && JSON.stringify(touchdown.answer.pair.curve));
const text = (selector, on = page) => on.$eval(selector, (element) => element.textContent);
const drawn = (on = page) => on.evaluate(() => touchdown.draw());

/** Where a place of the scene is on the page. */
function pixelOf(place) {
  return page.evaluate((p) => {
    touchdown.draw();
    const box = document.getElementById("picture").getBoundingClientRect(), [x, y] = touchdown.picture.pixelOf(p);
    return [box.left + x, box.top + y];
  }, place);
}

async function drag(from, by) {
  await page.mouse.move(...from);
  await page.mouse.down();
  await page.mouse.move(from[0] + by[0], from[1] + by[1], { steps: 4 });
  await page.mouse.up();
  await drawn();
}

/** The middle of a handle that is shown. */
const handle = (name) => page.$eval(`.handle.${name}:not([hidden])`, (button) => {
  const box = button.getBoundingClientRect();
  return [box.left + box.width / 2, box.top + box.height / 2];
});

const choose = (name) => page.evaluate((number) => {
  const list = document.getElementById("scenes");
  list.value = number;
  list.dispatchEvent(new Event("change"));
  touchdown.draw();
}, SCENES.findIndex((scene) => scene.name === name));

before(async () => {
  assert.ok(file, "TOUCHDOWN_PLAYGROUND names the page");
  browser = await launch();
  page = await open();
});
beforeEach(() => page.evaluate(() => {
  touchdown.open(touchdown.first);
  touchdown.draw();
}));
after(() => browser?.close());

test("is one file of at most 2 MB", () => assert.ok(statSync(file).size <= MOST_BYTES, `${statSync(file).size} bytes`));

test("shows its first plan within 3 s, says nothing on the console and asks for nothing outside", async (t) => {
  const times = [];
  for (let i = 0; i < 3; ++i) {
    await within("", async (other) => {
      const [mark] = await other.evaluate(() => performance.getEntriesByName("first plan").map(({ startTime }) => startTime));
      times.push(mark);
      assert.deepEqual(other.said, []);
      assert.match(await text("#headline h2", other), /^Planned: contact in \d\.\d\d s\.$/);
    }, { width: 1400, height: 900 });
  }
  times.sort((a, b) => a - b);
  t.diagnostic(`first plan after ${times.map((ms) => ms.toFixed(0))} ms, ${statSync(file).size} bytes`);
  assert.ok(times[1] < LONGEST_MS, `${times} ms`);
});

test("draws what it planned", async () => {
  const look = () => page.evaluate(() => {
    touchdown.draw();
    const source = document.getElementById("picture"), canvas = Object.assign(document.createElement("canvas"), { width: source.width, height: source.height });
    const pen = canvas.getContext("2d");
    pen.drawImage(source, 0, 0);
    const { data } = pen.getImageData(0, 0, canvas.width, canvas.height), colours = new Set();
    let dark = 0;
    for (let i = 0; i < data.length; i += 4) {
      colours.add((data[i] >> 4) * 256 + (data[i + 1] >> 4) * 16 + (data[i + 2] >> 4));
      dark += data[i] + data[i + 1] + data[i + 2] < 240;
    }
    return { colours: colours.size, dark };
  });
  const shown = await look();
  assert.ok(shown.colours > 60, `${shown.colours} colours`);
  await page.evaluate(() => (touchdown.picture.answer.plan.visible = false));
  const hidden = await look();
  await page.evaluate(() => (touchdown.picture.answer.plan.visible = true));
  assert.ok(shown.dark > hidden.dark + 200, `${shown.dark} and ${hidden.dark} pixels`);
});

describe("a hand", () => {
  test("drags a wall, and the plan bends while it does", async () => {
    const before = await sceneNow(), plan = await planNow();
    const [x, y, z] = before.walls[0].center;
    const from = await pixelOf([x, y, z]);
    await page.mouse.move(...from);
    await page.mouse.down();
    const plans = [];
    for (const step of [20, 40, 60]) {
      await page.mouse.move(from[0] + step, from[1] + step / 2);
      await drawn();
      plans.push(await planNow());
    }
    await page.mouse.up();
    assert.equal(new Set([plan, ...plans]).size, 4);
    const after = await sceneNow();
    assert.ok(Math.hypot(after.walls[0].center[0] - x, after.walls[0].center[1] - y) > 0.3);
    assert.deepEqual({ ...after, walls: [] }, { ...before, walls: [] });
    // And back.
    await page.keyboard.down("Control");
    await page.keyboard.press("z");
    await page.keyboard.up("Control");
    await drawn();
    assert.deepEqual(await sceneNow(), before);
    assert.equal(await planNow(), plan);
  });

  test("drags the quadrotor over the ground, and up", async () => {
    const { start } = await sceneNow();
    await drag(await pixelOf(start), [30, 10]);
    const moved = (await sceneNow()).start;
    assert.ok(Math.hypot(moved[0] - start[0], moved[1] - start[1]) > 0.1);
    assert.equal(moved[2], start[2]);
    await drag(await handle("height"), [0, -40]);
    const lifted = (await sceneNow()).start;
    assert.deepEqual(lifted.slice(0, 2), moved.slice(0, 2));
    assert.ok(lifted[2] > start[2] + 0.3);
    await page.keyboard.down("Shift");
    await drag(await pixelOf(lifted), [0, 30]);
    await page.keyboard.up("Shift");
    assert.ok((await sceneNow()).start[2] < lifted[2] - 0.1);
  });

  test("aims the pad by its arrow", async () => {
    const { pad } = await sceneNow();
    const at = await pixelOf([...pad.p, pad.height]);
    await page.mouse.click(...at);
    await drawn();
    const tip = await handle("aim");
    await drag(tip, [2 * (at[0] - tip[0]), 2 * (at[1] - tip[1])]);
    const aimed = (await sceneNow()).pad;
    assert.ok(Math.cos(((aimed.heading_deg - pad.heading_deg) * Math.PI) / 180) < -0.5, `${pad.heading_deg} and ${aimed.heading_deg}`);
    assert.deepEqual({ ...aimed, heading_deg: 0, speed: 0 }, { ...pad, heading_deg: 0, speed: 0 });
  });

  test("draws at the end of a wall and at the radius of a pillar, from above", async () => {
    await page.evaluate(() => touchdown.look("top"));
    const { walls: [wall], pillars: [pillar] } = await sceneNow();
    await page.mouse.click(...(await pixelOf([wall.center[0], wall.center[1], 2 * wall.center[2]])));
    await drawn();
    await drag(await handle("end"), [0, 25]);
    const { walls: [drawnWall] } = await sceneNow();
    assert.notDeepEqual(drawnWall.size, wall.size);
    await page.mouse.click(...(await pixelOf([...pillar.p, pillar.height])));
    await drawn();
    await drag(await handle("radius"), [25, 0]);
    assert.ok((await sceneNow()).pillars[0].radius > pillar.radius + 0.1);
  });

  test("turns the view on empty ground, and the scene stays", async () => {
    const before = await sceneNow(), eye = await page.evaluate(() => touchdown.picture.camera.position.toArray());
    await page.mouse.move(700, 740);
    await page.mouse.down();
    await page.mouse.move(640, 700, { steps: 3 });
    await page.mouse.up();
    assert.deepEqual(await sceneNow(), before);
    assert.notDeepEqual(await page.evaluate(() => touchdown.picture.camera.position.toArray()), eye);
  });

  test("puts a pillar where the ground is clicked on twice", async () => {
    const { pillars } = await sceneNow();
    await page.mouse.click(...(await pixelOf([-2, -3, 0])), { count: 2 });
    const added = (await sceneNow()).pillars;
    assert.equal(added.length, pillars.length + 1);
    assert.ok(Math.hypot(added.at(-1).p[0] + 2, added.at(-1).p[1] + 3) < 0.1, `${added.at(-1).p}`);
  });

  test("drags by touch as well", async () => {
    const { start } = await sceneNow(), [x, y] = await pixelOf(start);
    await page.touchscreen.touchStart(x, y);
    await page.touchscreen.touchMove(x + 15, y + 6);
    await page.touchscreen.touchMove(x + 30, y + 12);
    await page.touchscreen.touchEnd();
    await drawn();
    const moved = (await sceneNow()).start;
    assert.ok(Math.hypot(moved[0] - start[0], moved[1] - start[1]) > 0.1);
  });
});

test("walls and pillars are added in the way, moved by keys and deleted", async () => {
  const before = await sceneNow(), plan = await planNow();
  await page.click("#add-pillar");
  await drawn();
  assert.equal((await sceneNow()).pillars.length, before.pillars.length + 1);
  assert.notEqual(await planNow(), plan);
  await page.focus("#picture");
  const added = (await sceneNow()).pillars.at(-1).p;
  await page.keyboard.press("ArrowRight");
  assert.ok(Math.abs((await sceneNow()).pillars.at(-1).p[0] - added[0] - 0.1) < 1e-6);
  await page.keyboard.press("Delete");
  await page.keyboard.press("w");
  assert.equal((await sceneNow()).walls.length, before.walls.length + 1);
  await page.click("#delete");
  await drawn();
  assert.deepEqual(await sceneNow(), before);
  assert.equal(await planNow(), plan);
});

describe("a link", () => {
  test("follows a change, and restores the scene exactly", async () => {
    await page.evaluate(() => {
      touchdown.scene.start = [-5.25, 0.75, 1.8];
      touchdown.scene.terms = { arrival_time: 50 };
      touchdown.scene.pad.motion = "circle";
      touchdown.changedSetting(true);
    });
    await page.click("#add-wall");
    const wanted = await sceneNow();
    // The browser packs in its own way.
    await page.waitForFunction((scene) => touchdown.linked === location.hash.slice(1) && touchdown.past.at(-1) === scene && !touchdown.linking, { timeout: 5000 }, JSON.stringify(wanted));
    const link = (await page.evaluate(() => location.hash)).slice(1);
    assert.deepEqual(await sceneOf(link), wanted);
    const plan = await planNow();
    await within(link, async (other) => {
      assert.deepEqual(await sceneNow(other), wanted);
      assert.equal(await planNow(other), plan);
      assert.deepEqual(other.said, []);
    });
  });

  test("that is put into the address of an open page is followed", async () => {
    const wanted = { ...(await sceneNow()), start: [-4, 1, 2] };
    await page.evaluate((link) => { location.hash = link; }, await linkOf(wanted));
    await page.waitForFunction(() => touchdown.scene.start[0] === -4, { timeout: 5000 });
    assert.deepEqual(await sceneNow(), wanted);
  });

  test("that is mangled, or whose scene the planner refuses, gives a sentence and the first scene", async () => {
    const whole = await linkOf(await sceneNow());
    const refused = await linkOf({ ...(await sceneNow()), limits: { speed: 1e9 } });
    for (const [link, sentence] of [[whole.slice(0, -12), /damaged or holds no scene/], ["%E0%A4%A", /damaged or holds no scene/], [refused, /speed/]]) {
      await within(link, async (other) => {
        assert.equal(await text("#headline h2", other), "This link cannot be opened.");
        assert.match(await text("#headline p", other), sentence);
        assert.deepEqual(await sceneNow(other), await other.evaluate(() => touchdown.first));
        assert.deepEqual(other.said, []);
      });
    }
  });
});

test("a link that is refused changes nothing, and undo does not bring it back", async () => {
  await page.click("#add-pillar");
  await drawn();
  const scene = await sceneNow(), plan = await planNow(), past = await page.evaluate(() => touchdown.past.length);
  const part = (name, value) => ({ ...scene, [name]: { ...scene[name], ...value } });
  for (const wrong of [{ ...scene, seed: "a" }, part("limits", { speed: "3" }), part("pad", { turn_rate: [] }), { ...scene, terms: [1] }, { ...scene, pad: null }, { ...scene, walls: [null] }, { ...scene, start: [1, 2] }]) {
    await page.evaluate((link) => { document.querySelector("#headline h2").textContent = ""; location.hash = link; }, await linkOf(wrong));
    await page.waitForFunction(() => document.querySelector("#headline h2").textContent === "This link cannot be opened.", { timeout: 5000 });
    assert.match(await text("#headline p"), /\S/);
    assert.deepEqual([await sceneNow(), await planNow(), await page.evaluate(() => touchdown.past.length)], [scene, plan, past]);
  }
  // The address follows the scene that stands.
  await page.waitForFunction(() => !touchdown.linking && touchdown.linked === location.hash.slice(1), { timeout: 5000 });
  assert.deepEqual(await sceneOf((await page.evaluate(() => location.hash)).slice(1)), scene);
  await page.click("#undo");
  await drawn();
  assert.match(await text("#headline h2"), /^Planned/);
});

test("links that hold a very long text leave the planner whole", async () => {
  const first = await sceneNow();
  for (const large of [{ ...first, backend: "x".repeat(2e6) }, { ...first, pillars: Array(100000).fill({ p: [1.25, 2.5], radius: 0.4, height: 3 }) }]) {
    await within(await linkOf(large), async (other) => {
      assert.equal(await text("#headline h2", other), "This link cannot be opened.");
      assert.match(await other.evaluate((scene) => { try { return touchdown.ask({ do: "plan", scene }).status; } catch (error) { return error.message; } }, large), /^The scene is too large/);
      assert.equal(await other.evaluate(() => touchdown.ask({ do: "plan", scene: touchdown.first }).status), "planned");
      assert.deepEqual(other.said, []);
    });
  }
});

describe("an impossible scene ends in its reason's sentence", () => {
  for (const [name, sentence, pair] of [["pad in a wall", /^The end is inside an inflated obstacle/, true], ["start in an obstacle", /^The start is in an obstacle/, false]]) {
    test(name, async () => {
      await choose(name);
      assert.match(await text("#headline h2"), sentence);
      assert.doesNotMatch(await page.$eval("#headline", (element) => element.className), /good/);
      // Without a plan nothing is drawn, certified or timed.
      assert.equal(await page.evaluate(() => Boolean(touchdown.answer.pair)), pair);
      if (!pair) assert.deepEqual(await page.evaluate(() => ["committed", "rest", "stop"].map((name) => touchdown.picture.answer[name].object.visible)), [false, false, false]);
      assert.equal((await page.$$("#checks li")).length > 0, pair);
      assert.equal(await page.$eval("#timing", (section) => section.checkVisibility()), pair);
    });
  }
});

test("what the planner refuses is told in its own sentence, and the page goes on", async () => {
  await page.evaluate(() => {
    touchdown.scene.start = [1e6, 0, 1];
    touchdown.changedSetting(true);
    touchdown.draw();
  });
  assert.match(await text("#headline h2"), /scene\.start/);
  await page.evaluate(() => touchdown.undo());
  await drawn();
  assert.match(await text("#headline h2"), /^Planned/);
});

test("settings reach the planner", async () => {
  const set = (selector, value) => page.$eval(selector, (field, to) => {
    field.value = to;
    field.dispatchEvent(new Event("change"));
    touchdown.draw();
  }, value);
  await page.click("#tab-settings");
  const bound = () => page.evaluate(() => touchdown.answer.certificate.speed_bound_mps);
  assert.ok((await bound()) > 2);
  await set("#set-limits\\.speed", "1.5");
  assert.ok((await bound()) <= 1.5 + 1e-5);
  await set("#set-limits\\.speed", "-4");
  assert.equal((await sceneNow()).limits.speed, 1.5);
  const arrivals = () => page.evaluate(() => touchdown.answer.attempts.map(({ arrival }) => arrival));
  assert.ok((await arrivals()).includes("free"));
  await page.select("#set-arrival", "fixed");
  await drawn();
  assert.ok(!(await arrivals()).includes("free"));
  const plan = await planNow();
  await page.click("#term-tilt_limit");
  await drawn();
  assert.ok((await sceneNow()).terms.tilt_limit > 0);
  assert.ok((await page.evaluate(() => touchdown.answer.terms)).includes("tilt_limit"));
  await page.click("#term-tilt_limit");
  await drawn();
  assert.deepEqual((await sceneNow()).terms, {});
  assert.equal(await planNow(), plan);
  for (const reset of await page.$$("#settings legend button")) await reset.click();
  await drawn();
  assert.deepEqual(await sceneNow(), await page.evaluate(() => touchdown.first));
  await page.click("#tab-plan");
});

test("no motion of the pad is refused for the speed and the turn rate that sliders offer", async () => {
  const set = (path, value) => page.$eval(`#set-${path}`, (field, to) => {
    field[field.tagName === "SELECT" ? "selectedIndex" : "value"] = to;
    field.dispatchEvent(new Event("change"));
    touchdown.draw();
  }, value);
  for (let motion = 0; motion < (await page.evaluate(() => touchdown.about.motions.length)); ++motion) {
    await set("pad\\.motion", motion);
    for (const path of ["speed", "turn_rate"]) {
      for (const end of ["min", "max"]) {
        await set(`pad\\.${path}`, await page.$eval(`#set-pad\\.${path}`, (field, name) => field[name], end));
        assert.ok(await page.evaluate(() => touchdown.answer !== null), `${motion} ${path} ${end}: ${await text("#headline h2")}`);
      }
    }
  }
});

test("attempts show their rounds, half-spaces can be seen", async () => {
  await choose("both sides tried");
  const rounds = () => page.evaluate(() => touchdown.picture.answer.rounds.object.visible);
  assert.ok(await rounds());
  const ways = await page.$$eval(".rounds tbody tr td:nth-child(2)", (cells) => cells.map((cell) => cell.textContent));
  assert.deepEqual([...new Set(ways)], ["1", "2"]);
  await page.click("#attempts tbody tr");
  await drawn();
  assert.equal(await rounds(), false);
  const box = await page.evaluateHandle(() => [...document.querySelectorAll("#legend label")].find((label) => label.textContent === "half-spaces").firstChild);
  const pairs = () => page.evaluate(() => { touchdown.draw(); return touchdown.picture.answer.pairs.object.visible && touchdown.picture.answer.pairs.discs.count; });
  assert.equal(await pairs(), false);
  await box.click();
  assert.equal(await pairs(), await page.evaluate(() => touchdown.answer.pairs));
  await box.click();
});

test("the time of a step is measured over 100 equal steps of both solvers", async (t) => {
  await page.waitForFunction(() => /100 equal steps/.test(document.getElementById("times").textContent), { timeout: 60000 });
  const rows = await page.evaluate(() => touchdown.stopwatch.rows);
  t.diagnostic(rows.map(({ backend, least_ms }) => `${backend} ${least_ms.toFixed(3)} ms`).join(", "));
  assert.deepEqual(rows.map(({ backend, steps }) => [backend, steps]), [["banded", 100], ["lbfgs", 100]]);
  for (const { least_ms, cost } of rows) assert.ok(least_ms > 0 && least_ms < 100 && cost > 0);
});

test("where the stopwatch gives up, that is said", async () => {
  await page.evaluate(() => touchdown.stopwatch.show(touchdown.stopwatch.rows, true));
  assert.match(await text("#times"), /Not measured: /);
});

describe("a flight", () => {
  test("lands, and says so", async () => {
    await page.click("#one");
    assert.equal(await text("#time"), "0.1 s");
    assert.ok(await page.$eval("#flight", (section) => section.checkVisibility()));
    assert.ok((await page.$$("#attempts tbody tr")).length > 0, "the newest step is written down");
    await page.evaluate(() => { for (let i = 0; i < 300 && !touchdown.flight.over; ++i) touchdown.step(0.1); });
    assert.equal(await page.evaluate(() => touchdown.flight.state.outcome?.name), "landed");
    assert.ok(await page.$eval("#banner", (banner) => banner.checkVisibility()));
    assert.match(await text("#banner"), /^Landed\.It landed \d+ mm from the middle of the pad\./);
    assert.match(await text("#events"), /landing: contact is near and the landing condition holds.*feet touch the deck/);
    assert.ok(await page.evaluate(() => touchdown.flight.state.least_clearance) > 0);
    await page.click("#back");
    await drawn();
    assert.equal(await page.evaluate(() => touchdown.flight), null);
    assert.match(await text("#headline h2"), /^Planned/);
  });

  test("plays, pauses and is put back by keys", async () => {
    await page.focus("#picture");
    await page.keyboard.press("Space");
    await page.waitForFunction(() => touchdown.flight?.state.t > 0.3, { timeout: 20000 });
    assert.match(await text("#fly"), /Pause/);
    await page.keyboard.press("Space");
    const t = await page.evaluate(() => touchdown.flight.state.t);
    await new Promise((done) => setTimeout(done, 300));
    assert.equal(await page.evaluate(() => touchdown.flight.state.t), t);
    await page.keyboard.press("Escape");
    assert.equal(await page.evaluate(() => touchdown.flight), null);
  });

  test("sees obstacles as it comes near, and flies on among those that are moved", async () => {
    await choose("unknown until seen");
    await page.click("#one");
    await page.evaluate(() => { for (let i = 0; i < 8; ++i) touchdown.step(0.1); });
    const cells = () => page.evaluate(() => touchdown.picture.seen.cells.size);
    const seen = await cells();
    assert.ok(seen > 20, `${seen} cells`);
    const before = await page.evaluate(() => touchdown.flight.state.clearance);
    await page.evaluate(() => {
      touchdown.scene.walls = [];
      touchdown.changed();
      touchdown.done();
      touchdown.draw();
      touchdown.step(0.1);
    });
    assert.ok(Number.isFinite(before));
    assert.equal(await page.evaluate(() => touchdown.flight.state.clearance), null);
    await page.keyboard.press("w");
    await drawn();
    await page.evaluate(() => touchdown.step(0.1));
    assert.ok(Number.isFinite(await page.evaluate(() => touchdown.flight.state.clearance)));
    assert.ok(Math.abs((await page.evaluate(() => touchdown.flight.state.t)) - 1.1) < 0.01, "it goes on from where it was");
  });

  test("into which a wall is put where the vehicle is ends with its sentence", async () => {
    await page.click("#one");
    await page.evaluate(() => {
      const [x, y] = touchdown.flight.state.p;
      touchdown.scene.pillars.push({ p: [x, y], radius: 0.5, height: 3 });
      touchdown.done();
      touchdown.draw();
      for (let i = 0; i < 10 && !touchdown.flight.over; ++i) touchdown.step(0.1);
    });
    assert.match(await text("#banner"), /^It touched something\..*obstacle/);
    assert.match(await page.$eval("#banner", (banner) => banner.className), /bad/);
  });

  test("in which the planner refuses a change waits and says why, and the page goes on", async () => {
    await page.evaluate(() => { touchdown.fly(); touchdown.step(0.5); touchdown.scene.pillars[0].p = [101, 0]; touchdown.changed(); });
    await page.waitForFunction(() => /scene\.pillars\[0\]\.p/.test(document.querySelector("#headline h2").textContent), { timeout: 5000 });
    assert.equal(await page.evaluate(() => touchdown.flight.playing), false);
    assert.ok(await page.$eval("#message", (message) => message.hidden));
    await page.evaluate(() => { touchdown.scene.pillars[0].p = [100, 0]; touchdown.done(); touchdown.draw(); });
    const t = await page.evaluate(() => touchdown.flight.state.t);
    await page.evaluate(() => touchdown.step(0.1));
    assert.ok((await page.evaluate(() => touchdown.flight.state.t)) > t);
  });

  test("that cannot begin says why", async () => {
    await choose("start in an obstacle");
    await page.click("#fly");
    assert.match(await text("#banner"), /^It touched something\./);
    assert.equal(await page.evaluate(() => touchdown.flight.state.t), 0);
  });

  test("a change of a setting ends it", async () => {
    await page.click("#one");
    await page.evaluate(() => { touchdown.scene.limits.speed = 2; touchdown.changedSetting(true); touchdown.draw(); });
    assert.equal(await page.evaluate(() => touchdown.flight), null);
  });
});

test("random scenes are those of their seeds", async () => {
  await page.click("#another");
  const scene = await sceneNow();
  assert.deepEqual(await page.evaluate(() => ({ ...touchdown.first, ...touchdown.ask({ do: "random", seed: touchdown.seed }) })), scene);
  await page.click("#another");
  assert.notDeepEqual(await sceneNow(), scene);
});

test("every scene of the menu opens with a sentence and no error", async () => {
  for (const { name } of SCENES) {
    await choose(name);
    assert.match(await text("#headline h2"), /\.$/, name);
    assert.ok(await page.evaluate(() => touchdown.answer !== null), name);
  }
});

test("controls have names, and a narrow window shows them all", async () => {
  const unnamed = await page.$$eval("button:not([hidden]), select, input", (found) =>
    found.filter((control) => !(control.textContent.trim() || control.getAttribute("aria-label") || control.title || control.labels?.length)).map((control) => control.outerHTML));
  assert.deepEqual(unnamed, []);
  for (const size of [{ width: 390, height: 800 }, { width: 800, height: 1000 }]) {
    await within("", async (other) => {
      const wide = await other.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(wide <= size.width, `${wide} pixels`);
      const outside = await other.$$eval("header button, header select, #tools > *, #views > *, #flybar > *", (found) =>
        found.filter((control) => { const box = control.getBoundingClientRect(); return box.width > 0 && (box.left < 0 || box.right > innerWidth); }).map(({ id }) => id));
      assert.deepEqual(outside, [], JSON.stringify(size));
    }, size);
  }
});

test("nothing was said on the console in all of this", () => assert.deepEqual(page.said, []));
