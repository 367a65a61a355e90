// SPDX-License-Identifier: BSD-3-Clause
// The words beside the picture: how it stands now, the step at hand, the layers, the flight.
import { descentWords } from "./timeline.js";

const metres = (x) => (x == null || Number.isNaN(x) ? "–" : `${x.toFixed(2)} m`);

function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

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

function reasonOf(event) {
  return event ? ` since ${event.t.toFixed(2)} s${event.text.includes("(") ? `, ${event.text.slice(event.text.indexOf("("))}` : ""}` : "";
}

export function outcomeWords(flight) {
  const { result } = flight.document;
  const what = String(result.outcome ?? "").replaceAll("_", " ");
  const after = `${(result.time_to_land_s ?? result.simulated_s ?? 0).toFixed(2)} s`;
  return result.detail ? `${what} after ${after}: ${result.detail}` : `${what} after ${after}`;
}

export class Panel {
  constructor({ now, step, layers, flight: about }, choices) {
    this.now = new Table(["mode", "gate", "own state", "beside the pad", "feet above the deck", "speed", "clearance", "off its reference", "pad believed", "wind here"]);
    now.append(this.now.object);
    this.title = element("div", { className: "step-title" });
    this.summary = element("p", { className: "step-summary" });
    this.command = element("code");
    this.copy = element("button", { textContent: "copy", title: "Copy the command that solves this step again" });
    this.copy.addEventListener("click", () => navigator.clipboard?.writeText(this.command.textContent));
    this.asked = element("div", { className: "command" }, this.command, this.copy);
    this.words = element("pre", { id: "words" });
    this.release = element("button", { textContent: "go on with time", id: "release" });
    this.release.addEventListener("click", () => choices.release());
    step.append(this.title, this.release, this.summary, this.asked, this.words);
    this.layers = layers;
    this.about = about;
    for (const layer of choices.layers) this.addLayer(layer);
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

  about_(flight) {
    const { document: d } = flight;
    const result = { ...d.result };
    this.about.replaceChildren(
      element("p", { textContent: outcomeWords(flight) }),
      element("p", { textContent: `${d.scenario}, planner ${d.planner}, backend ${d.backend}, seed ${d.seed}; touchdown ${d.build.touchdown_version}, ${d.build.revision.slice(0, 12)}, ${d.build.build_type}` }),
      element("details", {}, element("summary", { textContent: "result" }), element("pre", { textContent: JSON.stringify(result, null, 1) })),
      element("details", {}, element("summary", { textContent: "scenario" }), element("pre", { textContent: d.scenario_yaml })),
    );
  }

  update(flight, t, current, chosen) {
    this.fillNow(flight, t);
    const step = chosen ?? current;
    const key = `${flight.number}:${step}:${chosen != null}`;
    if (key === this.shown) return;
    this.shown = key;
    this.fillStep(flight, step, chosen != null);
  }

  fillNow(flight, t) {
    const { samples, vehicle: model } = flight.document;
    const { vehicle, pad, pad_believed, reference, air } = samples;
    const i = flight.row(t), b = flight.padRow(pad_believed, t);
    const descent = flight.eventAt("descent", t)?.text ?? "none";
    const sigma = b >= 0 ? Math.sqrt(Math.max(pad_believed.cov_xx[b] + pad_believed.cov_yy[b], 0)) : null;
    const wind = Math.hypot(air.vx[i], air.vy[i], air.vz[i]);
    this.now.set([
      flight.modeAt(t).replace("_", " ") + reasonOf(flight.eventAt("mode", t)),
      descent === "none" ? "nothing keeps a descent" : descentWords(descent),
      flight.eventAt("own_state", t)?.text ?? "given",
      metres(Math.hypot(vehicle.px[i] - pad.px[i], vehicle.py[i] - pad.py[i])),
      metres(vehicle.pz[i] - pad.pz[i] - model.foot_depth),
      `${Math.hypot(vehicle.vx[i], vehicle.vy[i], vehicle.vz[i]).toFixed(2)} m/s`,
      samples.clearance.length ? metres(samples.clearance[i]) : "no obstacles",
      metres(Math.hypot(reference.px[i] - vehicle.px[i], reference.py[i] - vehicle.py[i], reference.pz[i] - vehicle.pz[i])),
      b < 0 ? "not yet" : `${Math.hypot(pad_believed.px[b] - pad.px[i], pad_believed.py[b] - pad.py[i]).toFixed(2)} m off, 1 σ ${sigma.toFixed(2)} m`,
      wind < 0.005 ? "none" : `${wind.toFixed(1)} m/s`,
    ]);
  }

  fillStep(flight, number, chosen) {
    const step = flight.steps[number];
    this.release.hidden = !chosen;
    this.asked.hidden = !step?.stages;
    if (!step) {
      this.title.textContent = "No step yet";
      this.summary.textContent = this.words.textContent = "";
      return;
    }
    this.title.textContent = `Step ${number} of ${flight.steps.length}${chosen ? " (chosen)" : ""}`;
    const pieces = [`At ${step.t.toFixed(2)} s: ${step.status.replaceAll("_", " ")}`];
    if (step.reason && step.reason !== "none") pieces.push(`no new plan: ${step.reason.replaceAll("_", " ")}`);
    if (step.stops) pieces.push("a stored stop is flown");
    pieces.push(`${step.solves} solves, ${step.iterations} iterations`);
    if (step.work > 0) pieces.push(`${step.work} of ${flight.document.max_work} units of work${step.work >= flight.document.max_work ? " (spent)" : ""}`);
    pieces.push(`${step.wall_ms.toFixed(2)} ms in flight${step.wall_ms > step.latency_ms ? `, later than its latency of ${step.latency_ms} ms` : ""}`);
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
