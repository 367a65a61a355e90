// SPDX-License-Identifier: BSD-3-Clause
// The words beside the picture: how it stands now, the step at hand, the layers, the flight.
import { element } from "./dom.js";
import { REASONS } from "./reasons.js";
import { endOf } from "./spline.js";
import { descentWords, gateWords } from "./timeline.js";

const metres = (x) => (x == null || Number.isNaN(x) ? "–" : `${x.toFixed(2)} m`);

const NOW = ["mode", "flown", "landing condition", "descent"], NOW_THEN = ["speed", "clearance", "tracking error"];

/** Rows of names and values, kept and filled again. */
class Table {
  constructor(names) {
    this.cells = names.map(() => element("td"));
    this.object = element("table", {}, ...names.map((name, i) => element("tr", {}, element("th", { textContent: name }), this.cells[i])));
  }
  set(values) {
    values.forEach((value, i) => {
      if (this.cells[i].textContent !== value) this.cells[i].textContent = value;
    });
  }
}

function reasonOf(event, leadsTo) {
  if (!event) return "";
  const reason = event.text.match(/\((.*)\)/)?.[1];
  return ` since ${event.t.toFixed(2)} s${reason ? `: ${(REASONS[reason] ?? "").replace("pad", leadsTo)} (${reason})` : ""}`;
}

/** What is flown at t: the plan, or the stop that takes over from it, and until when. */
function flownWords(flight, t) {
  const step = flight.steps[flight.stepAt(t)];
  if (!step) return "the hover at the start";
  const stops = step.stop && step.t_stop != null && t >= step.t_stop;
  const end = endOf(stops ? step.stop : step.curve);
  const left = end - t;
  return `${stops ? "a stored stop" : step.status === "planned" ? "the step's plan" : "what was committed before"}, until ${end.toFixed(2)} s${left > 0 ? `, ${left.toFixed(2)} s more` : ": past its end"}`;
}

export function outcomeWords(flight) {
  const { result } = flight.document;
  const what = String(result.outcome ?? "").replaceAll("_", " ");
  const after = `${(result.time_to_land_s ?? result.simulated_s ?? 0).toFixed(2)} s`;
  return result.detail ? `${what} after ${after}: ${result.detail}` : `${what} after ${after}`;
}

/** How many steps ended how, and for which reasons there was no new plan; the first of each. */
function reasonsOf(flight) {
  const found = new Map();
  flight.steps.forEach(({ status, reason }, i) => {
    const words = (reason && reason !== "none" ? `${status}: ${reason}` : status).replaceAll("_", " ");
    found.set(words, [...(found.get(words) ?? []), i]);
  });
  if (found.size === 0) return ["The planner was never asked for a plan."];
  return [...found].map(([words, steps]) => `${steps.length} steps ${words} (${steps.slice(0, 8).join(", ")}${steps.length > 8 ? ", …" : ""})`);
}

export class Panel {
  constructor({ now, step, layers: list, flight: about }, layers) {
    this.place = now;
    this.title = element("div", { className: "step-title" });
    this.summary = element("p", { className: "step-summary" });
    this.command = element("code");
    this.copy = element("button", { textContent: "copy", title: "Copy the command that solves this step again" });
    this.copy.addEventListener("click", () => navigator.clipboard?.writeText(this.command.textContent));
    this.asked = element("div", { className: "command" }, this.command, this.copy);
    this.words = element("pre", { id: "words" });
    step.append(this.title, this.summary, this.asked, this.words);
    this.layers = list;
    this.about = about;
    for (const layer of layers) this.addLayer(layer);
    this.shown = null;
  }

  addLayer({ name, key, colour, mark, on, set, there = true }) {
    if (!there) return;
    const box = element("input", { type: "checkbox", checked: on, id: `layer-${name.replaceAll(" ", "-")}` });
    box.addEventListener("change", () => {
      set(box.checked);
      box.blur();
    });
    const swatch = element("span", { className: `swatch ${mark ?? "line"}` });
    swatch.style.setProperty("--colour", colour);
    this.layers.append(element("label", {}, box, swatch, name, element("kbd", { textContent: key ?? "" })));
    set(on);
  }

  /** Whose words are shown. */
  choose(flight) {
    const rows = flight.goal ? [...NOW.slice(0, 2), "progress", "own state", "horizontally to the goal", "above the goal", ...NOW_THEN, "wind here"] : [...NOW, "own state", "horizontally to the pad", "feet above the deck", ...NOW_THEN, "estimate of the pad", "wind here"];
    this.now = new Table(rows);
    this.place.replaceChildren(this.now.object);
    const { document: d } = flight;
    const result = { ...d.result };
    this.about.replaceChildren(
      element("p", { textContent: outcomeWords(flight) }),
      element("p", { textContent: `${d.scenario}, planner ${d.planner}, backend ${d.backend}, seed ${d.seed}; touchdown ${d.build.touchdown_version}, ${d.build.revision.slice(0, 12)}, ${d.build.build_type}` }),
      ...reasonsOf(flight).map((text) => element("p", { textContent: text })),
      element("details", {}, element("summary", { textContent: "result" }), element("pre", { textContent: JSON.stringify(result, null, 1) })),
      element("details", {}, element("summary", { textContent: "scenario" }), element("pre", { textContent: d.scenario_yaml })),
    );
  }

  update(flight, t, step) {
    this.fillNow(flight, t);
    const key = `${flight.number}:${step}`;
    if (key === this.shown) return;
    this.shown = key;
    this.fillStep(flight, step);
  }

  fillNow(flight, t) {
    const { samples, vehicle: model, pad } = flight.document;
    const { vehicle, pad_believed, reference, air } = samples;
    const i = flight.row(t), b = flight.padRow(pad_believed, t);
    const aim = flight.aimAt(t), above = vehicle.pz[i] - aim.z - (flight.goal ? 0 : model.foot_depth);
    const gate = flight.eventAt("gate", t);
    const closed = (flight.eventAt("no_way", t)?.text ?? "over") !== "over";
    const progress = closed ? "no way is known" : descentWords(flight.eventAt("descent", t)?.text ?? "none");
    const wind = Math.hypot(air.vx[i], air.vy[i], air.vz[i]);
    const ended = t > flight.end + 1e-6 ? `ended at ${flight.end.toFixed(2)} s; then: ` : "";
    const mode = ended + flight.modeAt(t).replace("_", " ") + reasonOf(flight.eventAt("mode", t), flight.goal ? "goal" : "pad");
    const place = [
      flight.estimates ? `estimated, ${flight.eventAt("own_state", t)?.text ?? "good"}` : "given",
      metres(Math.hypot(vehicle.px[i] - aim.x, vehicle.py[i] - aim.y)),
      metres(above),
      `${Math.hypot(vehicle.vx[i], vehicle.vy[i], vehicle.vz[i]).toFixed(2)} m/s`,
      samples.clearance.length ? metres(samples.clearance[i]) : "no obstacles",
      metres(vehicle.t[i] < flight.contact ? Math.hypot(reference.px[i] - vehicle.px[i], reference.py[i] - vehicle.py[i], reference.pz[i] - vehicle.pz[i]) : null),
    ];
    const blows = wind < 0.005 ? "none" : `${wind.toFixed(1)} m/s`;
    if (flight.goal) {
      this.now.set([mode, flownWords(flight, t), progress, ...place, blows]);
      return;
    }
    const doubt = b < 0 ? 0 : flight.deckDoubt(b);
    this.now.set([
      mode,
      flownWords(flight, t),
      gateWords(gate?.text ?? "no_pad") + (gate ? `, since ${gate.t.toFixed(2)} s` : ""),
      progress,
      ...place,
      b < 0 ? "not yet" : `${Math.hypot(pad_believed.px[b] - aim.x, pad_believed.py[b] - aim.y).toFixed(2)} m off, 1 σ ${(doubt / pad.sigmas).toFixed(2)} m${doubt > pad.sure ? "; too uncertain to tell its cells from obstacles" : ""}`,
      blows,
    ]);
  }

  fillStep(flight, number) {
    const step = flight.steps[number];
    this.asked.hidden = !step?.stages;
    if (!step) {
      this.title.textContent = "No step yet";
      this.summary.textContent = this.words.textContent = "";
      return;
    }
    this.title.textContent = `Step ${number} of ${flight.steps.length}`;
    const pieces = [`At ${step.t.toFixed(2)} s: ${step.status.replaceAll("_", " ")}`];
    if (step.reason && step.reason !== "none") pieces.push(`no new plan: ${step.reason.replaceAll("_", " ")}`);
    if (step.stops) pieces.push("a stored stop is flown");
    pieces.push(step.solves > 0 ? `${step.solves} solves, the last of ${step.iterations} iterations` : "nothing was solved");
    if (step.work > 0) pieces.push(`${step.work} of ${flight.document.max_work} units of work${step.reason === "budget_spent" ? ", too little left for the next" : ""}`);
    pieces.push(`${step.wall_ms.toFixed(2)} ms in flight${step.wall_ms > step.latency_ms ? `, later than its latency of ${step.latency_ms} ms` : ""}`);
    if (step.same === false) pieces.push("this build gives another answer to this step: stop, rejected paths, half-spaces, stages and text are of that answer");
    this.summary.textContent = pieces.join("; ") + ".";
    const { kept, name } = flight.document;
    this.command.textContent = kept ? `touchdown plan --from ${quoted(name)}:${number}` : "fly it with --record F.db to ask it again";
    this.copy.hidden = !kept;
    this.words.textContent = step.words ?? "";
  }
}

/** As a shell takes it for one word. */
function quoted(path) {
  return /^[\w@%+=:,./-]+$/.test(path) ? path : `'${path.replaceAll("'", "'\\''")}'`;
}
