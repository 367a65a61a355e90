// SPDX-License-Identifier: BSD-3-Clause
// The page: reads its flights, builds the picture, moves time.
import { Vector3 } from "three";
import "uplot/dist/uPlot.min.css";
import "./signs.css";
import { BLACK, BLUE, FLIGHTS, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION } from "./colours.js";
import { Flight } from "./flight.js";
import { DASH, resizeLines } from "./lines.js";
import { KnownMap } from "./map.js";
import { Pad } from "./pad.js";
import { Panel, outcomeWords } from "./panel.js";
import { Flown, Plans } from "./plans.js";
import { Plots } from "./plots.js";
import { makeStage, shineOn } from "./stage.js";
import { Timeline } from "./timeline.js";
import { unpack } from "./unpack.js";
import { Vehicle } from "./vehicle.js";
import { VIEWS, Views } from "./views.js";
import { Prior, makeGoal, makeNarrow, makeWorld, makeZones } from "./world.js";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const CLICK = 9; // a plan is taken within so many pixels

const at = (id) => document.getElementById(id);

function say(sentence) {
  at("message").textContent = sentence;
  at("message").hidden = false;
}

/** Everything of one flight that is in the picture. */
class Shown {
  constructor(flight, scene) {
    this.flight = flight;
    const colour = FLIGHTS[flight.number];
    this.vehicle = new Vehicle(flight, colour);
    this.pad = new Pad(flight);
    this.map = new KnownMap(flight);
    this.plans = new Plans(flight);
    const { samples } = flight.document;
    this.flown = new Flown(samples.vehicle, colour, 3);
    this.reference = new Flown(samples.reference, GREEN, 1.5, DASH);
    this.track = new Flown(samples.pad, BLACK, 1.5, DASH);
    this.zones = makeZones(flight.document.zones);
    this.prior = new Prior(flight.document.prior, flight.document.map);
    this.goal = makeGoal();
    this.narrow = makeNarrow(flight.document.result.no_way);
    for (const part of [this.vehicle, this.pad, this.map, this.plans, this.flown, this.reference, this.track]) scene.add(part.object);
    scene.add(this.zones, this.prior.object, this.goal, this.narrow);
    this.label = at("labels").appendChild(Object.assign(document.createElement("div"), { className: "label" }));
    this.label.style.setProperty("--colour", colour);
    this.on = { reference: true, zones: true, prior: true, flown: true, track: true };
  }

  /** `selected`: with its map, its plans, what it believes. `drawsPad`: no other flight has drawn the same. */
  update(t, selected, drawsPad, onBoard) {
    const { flight, on } = this;
    const row = flight.row(t), step = flight.stepAt(t);
    this.vehicle.update(t, selected && onBoard);
    this.pad.update(t, step, selected, drawsPad);
    this.flown.update(row, on.flown);
    this.track.update(row, on.track && drawsPad && !flight.goal);
    this.reference.update(row, selected && on.reference);
    this.zones.visible = selected && on.zones;
    this.prior.object.visible = selected && on.prior;
    this.prior.update(flight.askedAt(t));
    this.goal.visible = Boolean(flight.goal);
    this.narrow.visible = selected && t >= flight.document.result.no_way?.since_s;
    flight.aimAt(t, this.goal.position);
    this.plans.object.visible = selected;
    if (selected) this.plans.update(step);
    this.map.update(flight.askedAt(t), this.vehicle.body.position.z, selected);
  }
}

class Replay {
  constructor(documents) {
    this.flights = documents.map((document, number) => new Flight(document, number));
    this.begin = Math.min(...this.flights.map((flight) => flight.begin));
    this.end = Math.max(...this.flights.map((flight) => flight.end));
    this.t = this.begin;
    this.playing = false;
    this.speed = 1;
    this.selected = 0;
    this.makePicture();
    this.makeControls();
    this.resize();
    this.seek(this.begin);
    this.draw(); // the vehicle is then where a view begins
    this.look("follow");
    this.play(true);
    this.open();
    window.addEventListener("hashchange", () => this.open());
  }

  /** What an address may ask for: #t=3.2&step=17&view=top. A time that is asked for stands still. */
  open() {
    const asked = new URLSearchParams(location.hash.slice(1));
    const number = (name) => (asked.has(name) && Number.isFinite(Number(asked.get(name))) ? Number(asked.get(name)) : null);
    const step = number("step"), t = number("t");
    if (step !== null || t !== null) this.play(false);
    if (step !== null) this.choose(step);
    if (t !== null) this.seek(t);
    this.draw();
    this.look(VIEWS.includes(asked.get("view")) ? asked.get("view") : this.views.name);
  }

  get shown() {
    return this.all[this.selected];
  }
  get flight() {
    return this.flights[this.selected];
  }

  makePicture() {
    const canvas = at("picture");
    Object.assign(this, makeStage(canvas));
    const begin = this.flights[0].vehicleAt(this.begin, new Vector3());
    // Of two worlds that of the flight is drawn that is looked at.
    const [one, other] = this.flights.map((flight) => JSON.stringify(flight.document.obstacles));
    this.differ = other !== undefined && one !== other;
    this.worlds = (this.differ ? this.flights : this.flights.slice(0, 1)).map((flight) => makeWorld(flight.document.obstacles, begin));
    this.scene.add(...this.worlds);
    this.all = this.flights.map((flight) => new Shown(flight, this.scene));
    this.views = new Views(canvas, this.flights);
    this.views.controls.addEventListener("change", () => (this.stale = true));
    canvas.addEventListener("pointerdown", (event) => (this.pressed = [event.clientX, event.clientY]));
    canvas.addEventListener("pointerup", (event) => this.click(event));
  }

  makeControls() {
    const heading = this.flights.map((flight) => `${flight.document.scenario}, planner ${flight.document.planner}: ${outcomeWords(flight)}`).join("   |   ");
    at("heading").textContent = this.differ ? `In different worlds: ${heading}` : heading;
    document.title = heading;
    at("slider").min = this.begin;
    at("slider").max = this.end;
    at("slider").addEventListener("input", () => this.seek(Number(at("slider").value)));
    at("play").addEventListener("click", () => this.play(!this.playing));
    at("speed").append(...SPEEDS.map((speed) => new Option(`${speed} ×`, speed, speed === 1, speed === 1)));
    at("speed").addEventListener("change", () => (this.speed = Number(at("speed").value)));
    // A list that keeps the focus takes the keys.
    for (const list of ["speed", "view", "which"]) at(list).addEventListener("change", () => at(list).blur());
    at("view").append(...VIEWS.map((view, i) => new Option(`${i + 1}  ${view}`, view)));
    at("view").addEventListener("change", () => this.look(at("view").value));
    at("which").hidden = this.flights.length < 2;
    at("which").append(...this.flights.map((flight, i) => new Option(`${i + 1}  ${flight.document.name}`, i)));
    at("which").addEventListener("change", () => this.select(Number(at("which").value)));
    this.timeline = new Timeline(at("marks"), at("tip"), this.flights, this.begin, this.end, (t, step, flight) => {
      if (flight !== this.selected) this.select(flight);
      if (step === undefined) this.seek(t);
      else this.choose(step);
    });
    this.plots = new Plots(at("plots"), this.flights, this.begin, this.end, (t) => this.seek(t));
    this.panel = new Panel({ now: at("now"), step: at("step"), layers: at("layers"), flight: at("about") }, this.layers());
    this.panel.choose(this.flight);
    document.addEventListener("keydown", (event) => this.key(event));
    window.addEventListener("resize", () => this.resize());
  }

  /** What can be switched on and off: a name, a key, what it looks like. */
  layers() {
    const any = (has) => this.flights.some(has);
    const each = (act) => (on) => {
      for (const shown of this.all) act(shown, on);
      this.stale = true;
    };
    const plan = (name) => each((shown, on) => {
      shown.plans.show[name] = on;
      shown.plans.touch();
    });
    return [
      { name: "occupied cells", key: "o", colour: "#A6652B", mark: "box", on: true, set: each((shown, on) => { shown.map.showOccupied = on; shown.map.touch(); }) },
      { name: "free, unknown at the vehicle's height", key: "u", colour: SKY, mark: "box", on: false, set: each((shown, on) => { shown.map.layer.visible = on; shown.map.touch(); }) },
      { name: "prior map", key: "m", colour: "#8C7BB5", mark: "box", on: true, there: any((f) => Object.keys(f.document.prior).length > 0), set: each((shown, on) => (shown.on.prior = on)) },
      { name: "zones of terms", key: "z", colour: GREEN, mark: "box", on: true, there: any((f) => f.document.zones.length > 0), set: each((shown, on) => (shown.on.zones = on)) },
      { name: "all plans until now", key: "a", colour: SKY, on: true, set: plan("all") },
      { name: "plan of the step", key: "l", colour: BLACK, on: true, set: plan("plan") },
      { name: "its stop", key: "s", colour: VERMILLION, mark: "dash", on: true, set: plan("stop") },
      { name: "rejected paths", key: "w", colour: GREY, mark: "dash", on: true, set: plan("lost") },
      { name: "guide paths", key: "g", colour: GREEN, mark: "dot", on: true, set: plan("guides") },
      { name: "place to look from", key: "j", colour: PURPLE, mark: "cross", on: true, there: any((f) => f.steps.some(({ look }) => look)), set: plan("look") },
      { name: "half-spaces at obstacles", key: "i", colour: ORANGE, on: true, set: plan("pairs") },
      { name: "flown path", key: "f", colour: BLUE, on: true, set: each((shown, on) => (shown.on.flown = on)) },
      { name: "reference", key: "r", colour: GREEN, mark: "dash", on: true, set: each((shown, on) => (shown.on.reference = on)) },
      { name: "estimated pad, 3 σ", key: "b", colour: BLUE, on: true, set: each((shown, on) => (shown.pad.show.believed = on)) },
      { name: "deck, not an obstacle", key: "d", colour: ORANGE, mark: "dash", on: true, set: each((shown, on) => (shown.pad.show.deck = on)) },
      { name: "predicted pad", key: "e", colour: PURPLE, mark: "dash", on: true, set: each((shown, on) => (shown.pad.show.predicted = on)) },
      { name: "path of the pad", key: "k", colour: BLACK, mark: "dash", on: true, set: each((shown, on) => (shown.on.track = on)) },
      { name: "own position, estimated", key: "y", colour: BLACK, mark: "cross", on: true, there: any((f) => f.estimates), set: each((shown, on) => (shown.vehicle.show.belief = on)) },
      { name: "cameras", key: "c", colour: SKY, on: true, set: each((shown, on) => (shown.vehicle.show.cameras = on)) },
      { name: "thrust of the rotors", key: "t", colour: ORANGE, on: true, set: each((shown, on) => (shown.vehicle.show.thrusts = on)) },
      { name: "wind at the vehicle", key: "v", colour: GREEN, on: true, there: any(({ document: { samples: { air } } }) => [air.vx, air.vy, air.vz].some((axis) => axis.some((x) => x !== 0))), set: each((shown, on) => (shown.vehicle.show.wind = on)) },
    ];
  }

  seek(t) {
    this.t = Math.min(Math.max(t, this.begin), this.end);
    at("slider").value = this.t;
    this.stale = true;
  }

  play(on) {
    this.playing = on;
    if (on && this.t >= this.end) this.seek(this.begin);
    at("play").firstChild.className = on ? "sign pause" : "sign play";
    at("play").title = on ? "Pause (space)" : "Play (space)";
    this.before = undefined;
  }

  look(view) {
    at("view").value = view;
    this.views.choose(view, this.shown.vehicle);
    this.stale = true;
  }

  select(number) {
    this.selected = number;
    at("which").value = number;
    this.panel.choose(this.flight);
    this.look(this.views.name);
  }

  /** To the time from which on the answer of a step is flown. */
  choose(step) {
    if (this.flight.steps[step]) this.seek(this.flight.stepTimes[step]);
  }

  click(event) {
    if (!this.pressed || Math.hypot(event.clientX - this.pressed[0], event.clientY - this.pressed[1]) > 4) return;
    const box = at("picture").getBoundingClientRect();
    const current = this.flight.stepAt(this.t);
    if (current < 0) return;
    const step = this.shown.plans.near(event.clientX - box.left, event.clientY - box.top, CLICK, current, this.views.camera, box.width, box.height);
    if (step >= 0) {
      this.play(false);
      this.choose(step);
    }
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || ["INPUT", "SELECT"].includes(event.target.tagName) && event.target.type !== "checkbox" && event.target.type !== "range") return;
    const { key } = event;
    if (key === " " && ["BUTTON", "SUMMARY"].includes(event.target.tagName)) return;
    const step = this.flight.stepAt(this.t);
    const to = (next) => {
      this.play(false);
      this.choose(Math.min(Math.max(next, 0), this.flight.steps.length - 1));
    };
    const acts = {
      " ": () => this.play(!this.playing),
      ArrowRight: () => (event.shiftKey ? this.seek(this.t + 1) : to(step + 1)),
      ArrowLeft: () => (event.shiftKey ? this.seek(this.t - 1) : to(step - 1)),
      ArrowUp: () => this.faster(1),
      ArrowDown: () => this.faster(-1),
      Home: () => this.seek(this.begin),
      End: () => this.seek(this.end),
      n: () => this.seek(this.timeline.markFrom(this.t, true)),
      p: () => this.seek(this.timeline.markFrom(this.t, false)),
      x: () => this.select((this.selected + 1) % this.flights.length),
      Escape: () => (at("help").hidden = true),
      "0": () => { this.look("orbit"); this.views.reset(); },
      "?": () => (at("help").hidden = !at("help").hidden),
    };
    const view = VIEWS[Number(key) - 1];
    if (view) this.look(view);
    else if (acts[key]) acts[key]();
    else {
      const layer = [...at("layers").querySelectorAll("label")].find((label) => label.querySelector("kbd").textContent === key);
      if (!layer) return;
      layer.querySelector("input").click();
    }
    event.preventDefault();
  }

  faster(by) {
    const i = Math.min(Math.max(SPEEDS.indexOf(this.speed) + by, 0), SPEEDS.length - 1);
    this.speed = SPEEDS[i];
    at("speed").value = this.speed;
  }

  resize() {
    const box = at("stage").getBoundingClientRect();
    this.renderer.setPixelRatio(window.devicePixelRatio || 1);
    this.renderer.setSize(box.width, box.height, false);
    resizeLines(box.width, box.height);
    this.size = [box.width, box.height];
    this.timeline.resize();
    this.plots.resize();
    this.stale = true;
  }

  /** Called by the browser for every frame; draws only what has changed. */
  frame(now) {
    if (this.playing) {
      if (this.before !== undefined) this.seek(this.t + (this.speed * (now - this.before)) / 1000);
      this.before = now;
      if (this.t >= this.end) this.play(false);
    }
    if (!this.stale) return;
    this.stale = false;
    this.draw();
  }

  draw() {
    const { t } = this;
    const [first] = this.flights;
    if (this.differ) this.worlds.forEach((world, i) => (world.visible = i === this.selected));
    this.all.forEach((shown, i) => {
      // Where both have the same pad it is drawn once.
      const drawsPad = i === 0 || shown.flight.padAt(t).distanceTo(first.padAt(t)) > 1e-3;
      shown.update(t, i === this.selected, drawsPad, this.views.onBoard);
    });
    const body = this.shown.vehicle.body.position;
    shineOn(this.sun, body);
    this.views.update(this.shown.vehicle, this.size[0] / this.size[1]);
    this.renderer.render(this.scene, this.views.camera);
    this.drawLabels();
    this.plots.update(t);
    at("time").textContent = `${t.toFixed(2)} s`;
    this.panel.update(this.flight, t, this.flight.stepAt(t));
  }

  drawLabels() {
    const p = new Vector3();
    this.all.forEach((shown, i) => {
      shown.label.hidden = this.flights.length < 2 || this.views.onBoard;
      if (shown.label.hidden) return;
      p.copy(shown.vehicle.body.position).add(new Vector3(0, 0, 0.35)).project(this.views.camera);
      shown.label.hidden = p.z > 1;
      shown.label.textContent = `${i + 1}: planner ${shown.flight.document.planner}${this.t > shown.flight.end + 1e-6 ? ", ended" : ""}`;
      shown.label.style.transform = `translate(${((p.x + 1) / 2) * this.size[0]}px, ${((1 - p.y) / 2) * this.size[1]}px) translate(-50%, -100%)`;
    });
  }
}

async function begin() {
  const packed = [...document.querySelectorAll("script.flight")].map((script) => script.textContent);
  if (packed.length === 0 || !at("complete")) {
    throw new Error("This page is damaged: a part of it is missing. Write it again with `touchdown replay`.");
  }
  const documents = await Promise.all(packed.map(unpack));
  // For scripts and the browser's console: replay.seek(3.2), replay.choose(17), replay.look("top").
  const replay = (window.replay = new Replay(documents));
  const frame = (now) => {
    try {
      replay.frame(now);
    } catch (error) {
      say(`This page cannot show its flight: ${error.message}.`);
      throw error;
    }
    requestAnimationFrame(frame);
  };
  frame(performance.now());
  at("message").hidden = true;
  document.body.classList.add("ready");
}

document.addEventListener("DOMContentLoaded", () => begin().catch((error) => say(error.message)));
