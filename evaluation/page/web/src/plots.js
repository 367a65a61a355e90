// SPDX-License-Identifier: BSD-3-Clause
// Figures over time, under one cursor. Of two flights the second is dashed.
import uPlot from "uplot";
import { indexAt } from "./flight.js";
import { BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION } from "./colours.js";

const SECOND = " (2)";
const AXIS = { font: "10px sans-serif", grid: { stroke: "#eee" } };
const distance = (a, b, i) => Math.hypot(a.px[i] - b.px[i], a.py[i] - b.py[i], a.pz[i] - b.pz[i]);

/** What is plotted of a flight: [title, unit, [times, [name, colour, values] ...]]. */
function figuresOf(flight) {
  const { samples, pad, vehicle: model } = flight.document;
  const { vehicle, believed, reference, pad: truth, pad_believed } = samples;
  const each = (of) => vehicle.t.map((_, i) => of(i));
  const aims = vehicle.t.map((t) => flight.aimAt(t));
  const steps = flight.steps;
  const of_steps = (value) => steps.map(value);
  const stages = Object.keys(steps.find((step) => step.stages)?.stages ?? {}).filter((stage) => stage !== "total");
  const stageColours = [PURPLE, GREEN, ORANGE, SKY, BLUE, BLACK];
  return [
    [flight.goal ? "To the goal" : "To the pad", "m", [
      [vehicle.t, [
        ["horizontal", BLUE, each((i) => Math.hypot(vehicle.px[i] - aims[i].x, vehicle.py[i] - aims[i].y))],
        flight.goal ? ["above", VERMILLION, each((i) => vehicle.pz[i] - aims[i].z)] : ["feet above", VERMILLION, each((i) => vehicle.pz[i] - aims[i].z - model.foot_depth)],
      ]],
    ]],
    ["Errors", "m", [
      [vehicle.t, [
        ["of tracking", BLUE, each((i) => (vehicle.t[i] < flight.contact ? distance(reference, vehicle, i) : null))],
        ["of own place", GREEN, each((i) => distance(believed, vehicle, i))],
        ...(flight.goal ? [] : [["of the pad", VERMILLION, each((i) => {
          const b = flight.padRow(pad_believed, vehicle.t[i]);
          return b < 0 ? null : Math.hypot(pad_believed.px[b] - truth.px[i], pad_believed.py[b] - truth.py[i]);
        })]]),
      ]],
    ]],
    ["Clearance", "m", [
      [vehicle.t, samples.clearance.length ? [["of the hull, true", BLUE, samples.clearance]] : []],
      [flight.stepTimes, [["of the plan", ORANGE, of_steps((step) => (step.earlier ? null : step.clearance))]]],
    ]],
    ["Step", "ms", [
      [flight.stepTimes, [
        ["in flight", BLACK, of_steps((step) => step.wall_ms)],
        ...stages.map((stage, k) => [stage, stageColours[k % stageColours.length], of_steps((step) => step.stages?.[stage] ?? null)]),
      ]],
    ]],
    ["Work", "", [
      [flight.stepTimes, [
        ["solves", BLUE, of_steps((step) => step.solves)],
        ["iterations / 10", ORANGE, of_steps((step) => step.iterations / 10)],
        ["% of the budget / 10", VERMILLION, of_steps((step) => (10 * step.work) / Math.max(flight.document.max_work, 1))],
      ]],
    ]],
    ["Speed", "m/s", [
      [vehicle.t, [
        ["of the vehicle", BLUE, each((i) => Math.hypot(vehicle.vx[i], vehicle.vy[i], vehicle.vz[i]))],
        ...(flight.goal ? [] : [["of the pad", PURPLE, each((i) => Math.hypot(truth.vx[i], truth.vy[i]))]]),
        ["of the air", GREEN, each((i) => Math.hypot(samples.air.vx[i], samples.air.vy[i], samples.air.vz[i]))],
      ]],
    ]],
  ];
}

/** The newest value up to an index: between the times of a series there is nothing in the joined list. */
function newest(plot, series, index) {
  const values = plot.data[series];
  let i = index;
  while (i >= 0 && values[i] === undefined) --i;
  return i < 0 || values[i] === null ? "–" : Number(values[i].toPrecision(3)).toString();
}

/** uPlot wants one list of times for all series: they are joined. `now()`: the time whose values stand where no mouse is. */
function tableOf(figures, begin, end, now) {
  const tables = [[[begin, end]]], series = [{}];
  figures.forEach((parts, number) => {
    for (const [times, list] of parts) {
      if (times.length === 0 || list.length === 0) continue;
      tables.push([times, ...list.map(([, , values]) => values)]);
      for (const [name, colour] of list) {
        series.push({ label: number > 0 ? name + SECOND : name, stroke: colour, width: 1.4, spanGaps: false, value: (plot, value, series, index) => newest(plot, series, index ?? indexAt(plot.data[0], now())), points: { show: false }, dash: number > 0 ? [5, 4] : undefined });
      }
    }
  });
  return { data: uPlot.join(tables), series };
}

export class Plots {
  constructor(holder, flights, begin, end, seek) {
    this.plots = [];
    this.t = begin;
    const all = flights.map(figuresOf);
    all[0].forEach(([title, unit], k) => {
      const box = document.createElement("div");
      box.className = "plot";
      holder.append(box);
      const { data, series } = tableOf(all.map((figures) => figures[k][2]), begin, end, () => this.t);
      const plot = new uPlot({
        width: 200, height: 150, series,
        title: unit ? `${title} [${unit}]` : title,
        scales: { x: { time: false, range: (u, low, high) => [low, high] }, y: { range: (u, low, high) => [Math.min(low ?? 0, 0), Math.max(high ?? 1, 1e-3) * 1.05] } },
        axes: [
          { ...AXIS, size: 24, space: 28, values: (u, times) => times.map((time) => `${Number(time.toFixed(3))} s`) },
          { ...AXIS, size: 38, space: 16 },
        ],
        cursor: { sync: { key: "replay", scales: ["x", null] }, drag: { x: true, y: false, dist: 6 }, points: { size: 5 } },
      }, data, box);
      // One legend for both: the second is dashed.
      for (const row of plot.root.querySelectorAll(".u-legend .u-series")) {
        if (row.textContent.includes(SECOND)) row.remove();
      }
      const now = document.createElement("div");
      now.className = "now";
      plot.over.append(now);
      // A drag is a closer look, a double click the whole again.
      let pressed = 0;
      plot.over.addEventListener("mousedown", (event) => (pressed = event.clientX));
      plot.over.addEventListener("click", (event) => Math.abs(event.clientX - pressed) < 6 && seek(plot.posToVal(event.offsetX, "x")));
      this.plots.push({ plot, now, box });
    });
  }

  resize() {
    for (const { plot, box } of this.plots) {
      const words = plot.root.querySelector(".u-title").offsetHeight + plot.root.querySelector(".u-legend").offsetHeight;
      plot.setSize({ width: Math.max(box.clientWidth, 120), height: Math.max(box.clientHeight - words, 60) });
    }
  }

  update(t) {
    this.t = t;
    for (const { plot, now } of this.plots) {
      now.style.transform = `translateX(${plot.valToPos(t, "x")}px)`;
      plot.setLegend();
    }
  }
}
