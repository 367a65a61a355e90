// SPDX-License-Identifier: BSD-3-Clause
// The line of time: modes as a band, marks for what happened, a handle for now.
import { BLACK, GREEN, MODES, ORANGE, PURPLE, VERMILLION } from "./colours.js";

const KINDS = {
  stop: { colour: VERMILLION, shape: "square", words: "a stored stop begins" },
  spent: { colour: PURPLE, shape: "square", words: "no new plan: its budget was spent" },
  late: { colour: ORANGE, shape: "tick", words: "a step that took longer than its latency" },
  mode: { colour: BLACK, shape: "triangle", words: "mode" },
  descent: { colour: PURPLE, shape: "triangle", words: "descent" },
  no_way: { colour: VERMILLION, shape: "diamond", words: "no way" },
  own_state: { colour: PURPLE, shape: "diamond", words: "own state" },
  contact: { colour: GREEN, shape: "diamond", words: "first contact" },
  outcome: { colour: BLACK, shape: "diamond", words: "outcome" },
};

/** All that happened in a flight, in time's order: {t, kind, text, step}. */
export function marksOf(flight) {
  // The gate opens and closes with every tag that is seen: the panel tells of it.
  const events = flight.document.events.filter(({ kind }) => kind !== "gate");
  const marks = events.map(({ t, kind, text }) => ({ t, kind, text: kind === "descent" ? (text === "none" ? "descent: goes on" : descentWords(text)) : `${KINDS[kind]?.words ?? kind}: ${text}` }));
  flight.steps.forEach((step, i) => {
    if (step.stops && !flight.steps[i - 1]?.stops) marks.push({ t: Math.max(step.t_stop ?? step.t, step.t), kind: "stop", text: `step ${i}: ${KINDS.stop.words}`, step: i });
    if (step.reason === "budget_spent") marks.push({ t: step.t_start, kind: "spent", text: `step ${i}: ${KINDS.spent.words}`, step: i });
    if (step.wall_ms > step.latency_ms) marks.push({ t: step.t, kind: "late", text: `step ${i}: took ${step.wall_ms.toFixed(1)} ms, its latency is ${step.latency_ms} ms`, step: i });
  });
  return marks.sort((a, b) => a.t - b.t);
}

export function descentWords(text) {
  return {
    none: "–",
    gate: "descent waits: the landing condition fails",
    above: "waits above the pad for the landing condition",
    look: "no progress: flies to where it sees what its way needs",
    corridor: "descent waits: too far from the pad for this height",
    lag: "descent waits: the vehicle is higher than commanded",
  }[text] ?? `descent: ${text}`;
}

export function gateWords(text) {
  return {
    open: "holds",
    own_state: "fails: the own state is too uncertain",
    no_pad: "fails: the pad was not found yet",
    tags_unseen: "fails: no tag is seen, and contact is too late to go without one",
    pad_uncertain: "fails: the pad is not known well enough",
    gust: "fails: the wind tilts the vehicle too far",
  }[text] ?? text;
}

function draw(pen, mark, x, y) {
  const { colour, shape } = KINDS[mark.kind] ?? KINDS.mode;
  pen.fillStyle = colour;
  pen.beginPath();
  if (shape === "square") pen.rect(x - 3.5, y - 3.5, 7, 7);
  else if (shape === "tick") pen.rect(x - 1, y - 5, 2, 10);
  else if (shape === "diamond") {
    pen.moveTo(x, y - 5.5);
    pen.lineTo(x + 5, y);
    pen.lineTo(x, y + 5.5);
    pen.lineTo(x - 5, y);
  } else {
    pen.moveTo(x - 4.5, y - 4);
    pen.lineTo(x + 4.5, y - 4);
    pen.lineTo(x, y + 4.5);
  }
  pen.fill();
}

export class Timeline {
  /** `go(t, step, flight)` is called where it is clicked on; without a mark there, without a step. */
  constructor(canvas, tip, flights, begin, end, go) {
    Object.assign(this, { canvas, tip, flights, begin, end });
    this.marks = flights.map(marksOf);
    canvas.addEventListener("mousemove", (event) => this.hover(event));
    canvas.addEventListener("mouseleave", () => (tip.hidden = true));
    canvas.addEventListener("click", (event) => {
      const { x, flight, marks } = this.near(event);
      const [mark] = marks.sort((a, b) => Math.abs(this.x(a.t) - x) - Math.abs(this.x(b.t) - x));
      if (mark) go(mark.t, mark.step, flight);
      else go(this.begin + (x / this.width) * (this.end - this.begin), undefined, flight);
    });
  }

  x(t) {
    return ((t - this.begin) / Math.max(this.end - this.begin, 1e-6)) * this.width;
  }

  resize() {
    const ratio = window.devicePixelRatio || 1;
    this.width = this.canvas.clientWidth;
    this.canvas.width = this.width * ratio;
    this.canvas.height = this.canvas.clientHeight * ratio;
    const pen = this.canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    const each = this.canvas.clientHeight / this.flights.length;
    this.flights.forEach((flight, i) => this.drawFlight(pen, flight, this.marks[i], i * each, each));
  }

  drawFlight(pen, flight, marks, top, height) {
    const { names, of } = flight.modes;
    for (let from = 0, i = 1; i <= of.length; ++i) {
      if (i < of.length && of[i] === of[from]) continue;
      const a = this.x(flight.times[from]), b = this.x(flight.times[Math.min(i, of.length - 1)]);
      pen.globalAlpha = 0.3;
      pen.fillStyle = MODES[names[of[from]]] ?? BLACK;
      pen.fillRect(a, top + 1, Math.max(b - a, 1), height - 2);
      pen.globalAlpha = 1;
      pen.fillStyle = "#333";
      pen.font = "10px system-ui, sans-serif";
      const words = names[of[from]].replace("_", " ");
      if (pen.measureText(words).width < b - a - 8) pen.fillText(words, a + 4, top + height - 4);
      from = i;
    }
    for (const mark of marks) draw(pen, mark, this.x(mark.t), top + 7);
  }

  /** Where the mouse is: its place, the flight whose band that is, the marks there. */
  near(event) {
    const box = this.canvas.getBoundingClientRect();
    const x = event.clientX - box.left, y = (event.clientY - box.top) / box.height;
    const flight = Math.min(Math.max(Math.floor(y * this.flights.length), 0), this.flights.length - 1);
    return { x, flight, marks: this.marks[flight].filter((mark) => Math.abs(this.x(mark.t) - x) < 6) };
  }

  hover(event) {
    const { x, marks } = this.near(event);
    this.tip.hidden = marks.length === 0;
    this.tip.textContent = marks.slice(0, 6).map((mark) => `${mark.t.toFixed(2)} s  ${mark.text}`).join("\n");
    this.tip.style.left = `${Math.min(Math.max(x - 20, 0), Math.max(this.width - 320, 0))}px`;
  }

  /** The next mark of any flight beyond t, or the last before it. */
  markFrom(t, forward) {
    const times = this.marks.flat().map((mark) => mark.t);
    return forward ? Math.min(...times.filter((x) => x > t + 1e-3), this.end) : Math.max(...times.filter((x) => x < t - 1e-3), this.begin);
  }
}
