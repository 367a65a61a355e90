// SPDX-License-Identifier: BSD-3-Clause
// What can be set beside what can be dragged.
import { element } from "../dom.js";
import { rangeOf, setValue, valueAt } from "./scene.js";
import { plain } from "./words.js";

const OFFERED = 100; // weight of a term that is switched on and has none by default

/** What a term asks of the curve, in words; the module has its formula. */
const MEANINGS = {
  smoothness: "little acceleration and jerk",
  obstacle_pair: "control points stay on the free side of their half-spaces",
  speed_limit: "not faster than the limit",
  acceleration_limit: "no more acceleration than the limit",
  arrival_time: "be there soon",
  thrust_max: "no more thrust than the rotors have",
  thrust_min: "no less thrust than the rotors need",
  tilt_limit: "lean no more than the limit",
  approach_corridor: "come from above, in a cone over the pad",
  pad_visibility: "keep the pad in the downward camera's image",
  consistency: "stay near the plan before",
  keep_out: "stay out of a ball of 1 m around the origin",
};

const choice = (path, label, options, help) => ({ path, label, options, help });
const figure = (path, label, unit, step, help) => ({ path, label, unit, step, help });

function groupsOf(about) {
  return [
    { title: "Pad", fields: [
      choice("pad.motion", "motion", about.motions.map((name) => [name, plain(name)]), "How the pad drives. The planner knows it from its prediction only."),
      figure("pad.speed", "speed", "m/s", 0.05, "Of the pad along its path"),
      figure("pad.heading_deg", "heading", "°", 1, "Of the pad at the start; 0 is to the right"),
      figure("pad.turn_rate", "turn rate", "rad/s", 0.01, "Of motions that turn"),
      figure("pad.height", "deck height", "m", 0.01, "Of the deck above the ground"),
      figure("pad.seed", "seed", "", 1, "Of the motion `random`"),
    ] },
    { title: "Limits", fields: [
      figure("limits.speed", "speed", "m/s", 0.1, "Plans are never faster"),
      figure("limits.acceleration", "acceleration", "m/s²", 0.1, "Plans never accelerate more"),
      figure("limits.tilt_deg", "tilt", "°", 1, "Read by the term tilt_limit"),
    ] },
    { title: "Planner", fields: [
      choice("known", "knows", [["camera", "what its camera saw"], ["all", "every obstacle"]], "A depth camera that looks ahead and 6 m far, or everything"),
      choice("arrival", "arrival", [["free", "free: the solver chooses when"], ["fixed", "fixed: at a time that is tried"]], "Whether the time of contact is a variable of the solve"),
      choice("ways", "guide paths", [[1, "one"], [2, "two: both sides are tried"]], "A guide path leads around the first obstacle. Two are solved one after the other, and the cheaper plan is flown"),
      choice("backend", "solver", about.backends.map((name) => [name, name]), "Which solver makes the plan that is drawn"),
      figure("seed", "seed", "", 1, "Of the flight's noise"),
    ] },
  ];
}

export class Settings {
  /** `changed(rests)`: whether the change is complete, or a slider still moves. */
  constructor(root, about, changed) {
    Object.assign(this, { root, about, changed });
    this.scene = about.scene;
    this.updates = [];
    for (const group of groupsOf(about)) root.append(this.group(group));
    root.append(this.terms());
  }

  /** Shows the values of a scene, and changes it from now on. */
  show(scene) {
    this.scene = scene;
    for (const update of this.updates) update();
  }

  group({ title, fields }) {
    const reset = element("button", { type: "button", textContent: "reset", title: `The defaults of this group: ${title}` });
    reset.addEventListener("click", () => {
      for (const { path } of fields) setValue(this.scene, path, valueAt(this.about.scene, path));
      this.show(this.scene);
      this.changed(true);
    });
    return element("fieldset", {}, element("legend", {}, title, reset), ...fields.map((field) => (field.options ? this.choice(field) : this.figure(field))));
  }

  /** The row of a field, bold where it is not at its default. */
  row(path, label, help, id, ...inputs) {
    const row = element("div", { className: "field", title: help }, element("label", { htmlFor: id, textContent: label }), ...inputs);
    this.updates.push(() => row.classList.toggle("changed", valueAt(this.scene, path) !== valueAt(this.about.scene, path)));
    return row;
  }

  choice({ path, label, options, help }) {
    const id = `set-${path}`, list = element("select", { id });
    list.append(...options.map(([value, text]) => new Option(text, value)));
    list.addEventListener("change", () => {
      setValue(this.scene, path, options[list.selectedIndex][0]);
      this.show(this.scene);
      this.changed(true);
    });
    this.updates.push(() => (list.selectedIndex = options.findIndex(([value]) => value === valueAt(this.scene, path))));
    return this.row(path, label, help, id, list);
  }

  figure({ path, label, unit, step, help }) {
    const id = `set-${path}`;
    const slider = element("input", { type: "range", step, ariaLabel: label }), number = element("input", { type: "number", id, step: "any" });
    const set = (input, rests) => {
      const [min, max] = rangeOf(path, this.scene), value = Number(input.value);
      // While a figure is typed it may be none, or out of its range.
      const bad = input.value === "" || !Number.isFinite(value) || value < min || value > max;
      number.setCustomValidity(bad ? `${label}: ${min} to ${max} ${unit}` : "");
      if (bad) return rests && number.reportValidity();
      setValue(this.scene, path, value);
      this.show(this.scene);
      this.changed(rests);
    };
    slider.addEventListener("input", () => set(slider, false));
    slider.addEventListener("change", () => set(slider, true));
    number.addEventListener("change", () => set(number, true));
    this.updates.push(() => {
      const [min, max] = rangeOf(path, this.scene);
      for (const input of [slider, number]) Object.assign(input, { min, max });
      slider.value = valueAt(this.scene, path);
      if (document.activeElement !== number || number.validity.valid) number.value = Number(valueAt(this.scene, path).toFixed(3));
    });
    return this.row(path, label, help, id, slider, element("span", { className: "number" }, number, element("small", { textContent: unit })));
  }

  terms() {
    const reset = element("button", { type: "button", textContent: "reset", title: "The default weights of all terms" });
    reset.addEventListener("click", () => {
      this.scene.terms = {};
      this.show(this.scene);
      this.changed(true);
    });
    const intro = element("p", { className: "about", textContent: "The plan minimises the sum of these terms, each times its weight." });
    return element("fieldset", {}, element("legend", {}, "Terms", reset), intro, ...this.about.terms.map((term) => this.term(term)));
  }

  /** A term is on where its weight is not 0. Only what differs from the default is in the scene. */
  term({ name, help, weight, on }) {
    const byDefault = on ? weight : 0, offered = weight || OFFERED, id = `term-${name}`;
    const box = element("input", { type: "checkbox", id }), number = element("input", { type: "number", min: 0, step: "any", ariaLabel: `weight of ${plain(name)}` });
    const row = element("div", { className: "term" },
      element("div", { className: "line" }, element("label", {}, box, plain(name)), number), element("p", { className: "about" }, MEANINGS[name] ?? "", element("code", { textContent: help })));
    const now = () => this.scene.terms[name] ?? byDefault;
    const set = (value) => {
      if (value === byDefault) delete this.scene.terms[name];
      else this.scene.terms[name] = value;
      this.show(this.scene);
      this.changed(true);
    };
    box.addEventListener("change", () => set(box.checked ? offered : 0));
    number.addEventListener("change", () => {
      const value = Number(number.value);
      if (number.value === "" || !(value >= 0)) this.show(this.scene);
      else set(value);
    });
    number.title = `default: ${on ? weight : "off"}`;
    this.updates.push(() => {
      box.checked = now() !== 0;
      number.value = now();
      row.classList.toggle("changed", name in this.scene.terms);
    });
    return row;
  }
}
