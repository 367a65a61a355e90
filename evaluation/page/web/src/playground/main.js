// SPDX-License-Identifier: BSD-3-Clause
// The planner in a page: a scene that can be changed by hand, a plan for it at once, a flight.
import "../signs.css";
import { Flight } from "./flight.js";
import { Hand } from "./hand.js";
import { Handles } from "./handles.js";
import { fillLegend } from "./layers.js";
import { linkOf, sceneOf } from "./link.js";
import { loadPlanner } from "./module.js";
import { Panel } from "./panel.js";
import { Picture } from "./picture.js";
import { add, completed, copy, heightOf, moveTo, nameOf, objectsOf, partOf, placeOf, remove, same, setHeight } from "./scene.js";
import { SCENES, sceneOfMenu } from "./scenes.js";
import { Settings } from "./settings.js";
import { Stopwatch } from "./stopwatch.js";
import { outcomeOf } from "./words.js";

const VIEWS = [["orbit", "Around"], ["top", "From above"], ["follow", "Behind"]];
const LINKED = 250; // the address follows so long after a change [ms]
const STEP = 0.1; // of an arrow key [m]
const UNDONE = 100; // changes that can be taken back

const at = (id) => document.getElementById(id);

function say(sentence) {
  at("message").textContent = sentence;
  at("message").hidden = false;
}

class Playground {
  constructor(ask) {
    this.ask = ask;
    this.about = ask({ do: "about" });
    this.first = this.about.scene;
    at("version").textContent = this.about.version;
    this.scene = copy(this.first);
    this.answer = null;
    this.attempt = null;
    this.flight = null;
    this.hover = this.selected = null;
    this.past = [];
    this.picture = new Picture(at("picture"), this.about);
    this.picture.look.controls.addEventListener("change", () => (this.stale = true));
    this.handles = new Handles(at("handles"), this.picture, this);
    this.hand = new Hand(at("stage"), this.picture, this);
    this.panel = new Panel(this.about, (attempt) => this.chooseAttempt(attempt));
    this.settings = new Settings(at("settings"), this.about, (rests) => this.changedSetting(rests));
    this.stopwatch = new Stopwatch(ask, this.about.backends, (...measured) => this.panel.times(...measured));
    fillLegend(at("legend"), this.picture, () => { this.picture.answered = undefined; this.redraw(); });
    this.makeControls();
    this.picture.resize();
  }

  makeControls() {
    at("scenes").append(new Option("choose …", "", true, true), ...SCENES.map(({ name }, i) => new Option(name, i)));
    at("scenes").options[0].disabled = true;
    const acts = {
      another: () => this.random(), copy: () => this.copyLink(), keys: () => this.help(), "add-wall": () => this.put("wall"), "add-pillar": () => this.put("pillar"),
      delete: () => this.deleteChosen(), undo: () => this.undo(), fly: () => this.fly(), one: () => this.one(), reset: () => this.land(),
      again: () => { this.land(); this.fly(); }, back: () => this.land(),
    };
    for (const [id, act] of Object.entries(acts)) at(id).addEventListener("click", act);
    at("scenes").addEventListener("change", () => {
      const number = Number(at("scenes").value);
      this.open(sceneOfMenu(number, this.first), SCENES[number].shows);
    });
    at("chosen").addEventListener("change", () => this.chooses(objectsOf(this.scene)[at("chosen").selectedIndex - 1] ?? null));
    at("knows").addEventListener("change", () => { this.scene.known = at("knows").value; this.changedSetting(true); });
    at("speed").addEventListener("change", () => this.flight && (this.flight.speed = Number(at("speed").value)));
    // A list that keeps the focus takes the keys.
    for (const list of ["scenes", "speed", "knows"]) at(list).addEventListener("change", () => at(list).blur());
    at("views").append(...VIEWS.map(([name, text], i) => {
      const button = Object.assign(document.createElement("button"), { textContent: text, title: `${text} (${i + 1})` });
      button.dataset.name = name;
      button.addEventListener("click", () => this.look(name));
      return button;
    }));
    document.addEventListener("keydown", (event) => this.key(event));
    window.addEventListener("resize", () => { this.picture.resize(); this.redraw(); });
    window.addEventListener("hashchange", () => this.follow());
  }

  // What the hand and the handles ask and tell.

  /** Which objects can be moved now: in a flight the obstacles alone. */
  get mayMove() {
    return this.flight ? ["wall", "pillar"] : ["start", "pad", "wall", "pillar"];
  }

  hovers(object) {
    if (same(object, this.hover)) return;
    this.hover = object;
    at("picture").classList.toggle("over", Boolean(object));
    this.hint();
    this.redraw();
  }

  chooses(object) {
    this.selected = object;
    this.hover = null;
    this.listObjects();
    this.hint();
    this.redraw();
  }

  changed() {
    if (this.flight?.over) this.land();
    at("picture").classList.add("held");
    this.edited = true;
    this.redraw();
  }

  /** A change is complete: it can be taken back, and linked to. */
  done() {
    if (this.flight?.over) this.land();
    at("picture").classList.remove("held");
    this.edited = true;
    this.remember();
    this.redraw();
  }

  hint() {
    const object = this.hover ?? this.selected, words = {
      start: "the quadrotor: drag; shift-drag or its handle: up and down", pad: "the pad: drag; its arrow is heading and speed", wall: "a wall: drag; its ends, its height", pillar: "a pillar: drag; its radius, its height",
    };
    at("hint").textContent = object ? words[object.kind] : this.flight || this.touched ? "" : "Drag the quadrotor, the pad, the walls, the pillars";
  }

  // The scene.

  /**
   * Another scene as a whole, seen as a whole. One that the module refuses changes nothing.
   * `attempt`: whose rounds are shown; `what` the sentence names.
   */
  open(scene, attempt = null, what = "scene") {
    const whole = completed(scene, this.first);
    let answer;
    try {
      answer = this.ask({ do: "plan", scene: whole });
    } catch (error) {
      return this.refuse(what, error.message);
    }
    this.land();
    this.scene = whole;
    this.selected = this.hover = null;
    this.attempt = attempt;
    this.remember();
    this.take(answer);
    this.frameScene();
  }

  refuse(what, sentence) {
    this.panel.headline({ tone: "bad", title: `This ${what} cannot be opened.`, text: sentence });
  }

  /** All of it is in the picture. */
  frameScene() {
    this.picture.frame(this.scene, this.answer);
    this.markView();
    this.redraw();
  }

  random() {
    this.seed = (this.seed ?? Math.floor(Math.random() * 1e6)) + 1;
    at("scenes").value = "";
    this.open(this.ask({ do: "random", seed: this.seed }));
  }

  /** Of what stands now. */
  remember() {
    const now = JSON.stringify(this.scene);
    if (this.past.at(-1) !== now) this.past.push(now);
    if (this.past.length > UNDONE) this.past.shift();
    at("undo").disabled = this.past.length < 2;
    this.touched = this.past.length > 1;
    this.listObjects();
    this.hint();
    clearTimeout(this.linking);
    this.linking = setTimeout(() => this.link(), LINKED);
  }

  undo() {
    if (this.past.length < 2) return;
    this.past.pop();
    this.scene = JSON.parse(this.past.at(-1));
    if (this.selected && !partOf(this.scene, this.selected)) this.selected = null;
    this.land();
    this.done();
  }

  async link() {
    this.linking = null;
    this.linked = await linkOf(this.scene);
    history.replaceState(null, "", `#${this.linked}`);
  }

  /** To the scene that the address holds. Where it holds none, the scene stays, and the address gets it. */
  async follow() {
    const link = location.hash.slice(1);
    if (link === this.linked) return;
    this.linked = link;
    let scene = this.first;
    try {
      if (link !== "") scene = await sceneOf(link);
    } catch (error) {
      this.refuse("link", error.message);
      return this.remember();
    }
    this.open(scene, null, "link");
    this.remember();
  }

  async copyLink() {
    await this.link();
    let copied = true;
    try {
      await navigator.clipboard.writeText(location.href);
    } catch {
      copied = false; // the browser does not let a page write there
    }
    at("copy").textContent = copied ? "Copied" : "See the address bar";
    setTimeout(() => (at("copy").textContent = "Copy link"), 1800);
  }

  listObjects() {
    const objects = objectsOf(this.scene);
    at("chosen").replaceChildren(new Option("choose …"), ...objects.map((object) => new Option(object.kind === "start" ? "quadrotor" : nameOf(object))));
    at("chosen").selectedIndex = objects.findIndex((object) => same(object, this.selected)) + 1;
    at("delete").disabled = this.selected?.index === undefined;
  }

  /** In the middle of the way that is drawn, or where it is said. */
  put(kind, x, y) {
    const points = this.flight?.ahead(2) ?? this.middle();
    const object = add(this.scene, kind, x ?? points.x, y ?? points.y, points.yaw + 90);
    if (!object) return;
    this.selected = object;
    this.done();
  }

  middle() {
    const points = this.answer?.pair?.curve.control_points ?? [this.scene.start, placeOf(this.scene, { kind: "pad" })];
    const i = Math.floor((points.length - 1) / 2), [a, b] = [points[i], points[i + 1]];
    return { x: (a[0] + b[0]) / 2, y: (a[1] + b[1]) / 2, yaw: Math.round((Math.atan2(b[1] - a[1], b[0] - a[0]) * 180) / Math.PI) };
  }

  deleteChosen() {
    if (!remove(this.scene, this.selected)) return;
    this.selected = this.hover = null;
    this.done();
  }

  changedSetting(rests) {
    this.land();
    this.edited = true;
    if (rests) this.remember();
    this.redraw();
  }

  // The plan.

  plan() {
    let answer = null;
    try {
      answer = this.ask({ do: "plan", scene: this.scene });
    } catch (error) {
      this.panel.refuse(error.message);
    }
    this.take(answer);
  }

  /** The plan of the scene as it stands; null where the module refused. */
  take(answer) {
    this.edited = false;
    this.stopwatch.stop();
    this.answer = answer;
    if (this.attempt !== null && !this.answer?.attempts[this.attempt]) this.attempt = null;
    if (this.answer) this.panel.show(this.answer, this.scene, this.attempt);
    at("timing").hidden = !this.answer?.pair;
    if (this.answer?.pair) this.stopwatch.begin(this.scene);
    this.settings.show(this.scene);
    at("knows").value = this.scene.known;
  }

  /** What is drawn and told of: the plan, or the flight's newest one. */
  get shown() {
    return this.flight ? this.flight.answer : this.answer;
  }

  chooseAttempt(attempt) {
    this.attempt = attempt;
    this.panel.show(this.shown, this.scene, attempt);
    if (this.flight?.over) this.showOutcome();
    this.redraw();
  }

  // The flight.

  fly() {
    if (this.flight && !this.flight.over) return this.flight.play(!this.flight.playing);
    this.depart(true);
  }

  /** From the start. */
  depart(playing) {
    this.stopwatch.stop();
    this.attempt = null;
    if (this.selected?.index === undefined) this.selected = null;
    this.picture.beginTrail();
    try {
      new Flight(this, Number(at("speed").value));
    } catch (error) {
      return this.panel.refuse(error.message);
    }
    this.panel.open("tab-plan");
    this.flight.play(playing);
    this.hint();
  }

  one() {
    if (!this.flight || this.flight.over) this.depart(false);
    else this.flight.play(false);
    this.step(STEP);
    this.flight?.explain();
  }

  /** Flies on for so long [s]. */
  step(seconds) {
    this.flight?.step(seconds);
    this.redraw();
  }

  /** Ends the flight: back to the start, and to planning. */
  land() {
    if (!this.flight) return;
    this.flight = null;
    this.attempt = null;
    this.picture.beginTrail();
    this.picture.deck.believe(null);
    this.panel.flight(null);
    at("banner").hidden = true;
    at("time").textContent = "0.0 s";
    this.showPlaying();
    if (this.picture.look.name === "follow") this.look("orbit");
    this.edited = true;
    this.hint();
    this.redraw();
  }

  showPlaying() {
    const { flight } = this;
    at("fly").children[0].className = flight?.playing ? "sign pause" : "sign play";
    at("fly").children[1].textContent = !flight ? "Fly it" : flight.over ? "Fly again" : flight.playing ? "Pause" : "Go on";
    at("reset").disabled = !flight;
    at("timing").hidden = Boolean(flight);
  }

  showOutcome() {
    const { tone, title, text } = outcomeOf(this.flight.state.outcome);
    at("banner").hidden = false;
    at("banner").className = tone;
    at("banner").children[0].textContent = title;
    at("banner").children[1].textContent = text;
    this.panel.headline({ tone, title, text });
    this.hint();
  }

  // View and keys.

  look(name) {
    this.picture.look.choose(name, { position: this.picture.craft.object.position, quaternion: this.picture.craft.body.quaternion });
    this.markView();
    this.redraw();
  }

  markView() {
    for (const button of at("views").children) button.setAttribute("aria-pressed", button.dataset.name === this.picture.look.name);
  }

  help(shown = at("help").hidden) {
    at("help").hidden = !shown;
    at("keys").setAttribute("aria-expanded", shown);
  }

  key(event) {
    const { key, target } = event;
    if ((event.ctrlKey || event.metaKey) && key.toLowerCase() === "z" && target.type !== "number") {
      event.preventDefault();
      return this.undo();
    }
    if (event.ctrlKey || event.metaKey || event.altKey || ["SELECT", "TEXTAREA"].includes(target.tagName) || (target.tagName === "INPUT" && target.type !== "checkbox")) return;
    if (key === " " && ["BUTTON", "SUMMARY", "INPUT"].includes(target.tagName)) return;
    const acts = {
      " ": () => this.fly(), ".": () => this.one(), Escape: () => (at("help").hidden ? this.land() : this.help(false)), "?": () => this.help(), Delete: () => this.deleteChosen(), Backspace: () => this.deleteChosen(),
      w: () => this.put("wall"), p: () => this.put("pillar"), r: () => this.random(), 0: () => { this.frameScene(); this.redraw(); },
      ArrowLeft: () => this.nudge(-STEP, 0), ArrowRight: () => this.nudge(STEP, 0), ArrowUp: () => this.nudge(0, STEP), ArrowDown: () => this.nudge(0, -STEP),
      PageUp: () => this.lift(STEP), PageDown: () => this.lift(-STEP),
    };
    const view = VIEWS[Number(key) - 1]?.[0];
    if (!view && !acts[key]) return;
    if ((key.startsWith("Arrow") || key.startsWith("Page")) && (!this.selected || target.closest("aside"))) return;
    if (view) this.look(view);
    else acts[key]();
    event.preventDefault();
  }

  nudge(dx, dy) {
    const [x, y] = placeOf(this.scene, this.selected);
    moveTo(this.scene, this.selected, x + dx, y + dy);
    this.done();
  }

  lift(dz) {
    if (this.selected.kind === "pad") return;
    setHeight(this.scene, this.selected, heightOf(this.scene, this.selected) + dz);
    this.done();
  }

  // Frames.

  redraw() {
    this.stale = true;
  }

  /** Called by the browser for every frame; draws only what has changed, and plans at most once. */
  frame(now) {
    if (this.flight?.playing) {
      this.flight.advance(now);
      this.stale = true;
    }
    if (!this.stale) return;
    this.stale = false;
    this.draw();
  }

  draw() {
    if (this.edited) {
      if (this.flight) this.flight.move();
      else this.plan();
      this.edited = false;
    }
    const { picture, flight } = this, shown = flight?.state.outcome?.name === "landed" ? null : this.shown;
    picture.setObstacles(this.scene);
    if (flight) flight.place();
    else picture.setStart(this.scene);
    picture.craft.looks(flight ? !flight.over : this.scene.known === "camera");
    picture.highlight(this.hover, this.selected);
    picture.setAnswer(shown, this.attempt === null ? null : shown?.attempts?.[this.attempt]);
    picture.draw();
    const marked = this.hover ?? this.selected;
    this.handles.show(this.scene, marked && this.mayMove.includes(marked.kind) ? marked : null);
  }
}

async function begin() {
  const ask = await loadPlanner();
  // For scripts and the browser's console: touchdown.open(scene), touchdown.fly(), touchdown.step(0.1), touchdown.look("top").
  const playground = (window.touchdown = new Playground(ask));
  // Whatever the link holds, there is a scene.
  playground.plan();
  playground.frameScene();
  await playground.follow();
  playground.frame(performance.now());
  performance.mark("first plan");
  playground.first_plan_ms = performance.now();
  at("message").hidden = true;
  document.body.classList.add("ready");
  const frame = (now) => {
    try {
      playground.frame(now);
    } catch (error) {
      say(`This page cannot go on: ${error.message}.`);
      throw error;
    }
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

document.addEventListener("DOMContentLoaded", () => begin().catch((error) => say(error.message)));
