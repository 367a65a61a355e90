// SPDX-License-Identifier: BSD-3-Clause
// What came out, beside the picture.
import { element } from "../dom.js";
import { endOf } from "../spline.js";
import { curveOf } from "./answer.js";
import { checksOf, eventWords, headlineOf, lengthOf, plain, rowOf, speedWords } from "./words.js";

const at = (id) => document.getElementById(id);
const COLOURS = { banded: "#0072B2", lbfgs: "#E69F00" };
const classOf = ({ ok }) => (ok === null ? "unasked" : ok ? "yes" : "no");
const COLUMNS = [
  ["arrival", "arrival", "When this attempt meets the pad"],
  ["end", "time is", "Free: the solver may move the time of arrival. Fixed: it may not"],
  ["segments", "segm.", "Segments: pieces of the spline"],
  ["rounds", "rounds", "A round is one solve. Where its curve hits an obstacle, half-spaces are added, and the next round solves again"],
  ["pairs", "half-sp.", "Half-space {p, v}: a point on an obstacle's surface and the direction away from it. It holds for one control point"],
  ["iterations", "iter.", "Iterations of the solver, in all rounds"],
  ["reason", "outcome", "Why the attempt was not taken"],
];

export class Panel {
  /** `choose(i)`: the attempt whose rounds are to be drawn, or null. */
  constructor(about, choose) {
    Object.assign(this, { about, choose });
    const tabs = [at("tab-plan"), at("tab-settings")];
    for (const tab of tabs) {
      tab.addEventListener("click", () => this.open(tab.id));
      tab.addEventListener("keydown", ({ key }) => {
        if (key !== "ArrowLeft" && key !== "ArrowRight") return;
        const other = tabs[1 - tabs.indexOf(tab)];
        this.open(other.id);
        other.focus();
      });
    }
  }

  open(id) {
    for (const tab of ["tab-plan", "tab-settings"]) {
      at(tab).setAttribute("aria-selected", tab === id);
      at(tab).tabIndex = tab === id ? 0 : -1;
      at(tab.slice(4)).hidden = tab !== id;
    }
  }

  headline({ tone, title, text }) {
    at("headline").className = tone;
    at("headline").children[0].textContent = title;
    at("headline").children[1].textContent = text;
  }

  /** A question that the module refused. */
  refuse(sentence) {
    this.headline({ tone: "bad", title: sentence, text: "" });
    at("figures").replaceChildren();
    at("checks").replaceChildren();
    at("attempts").replaceChildren();
  }

  /** `chosen`: the attempt whose rounds are told of, or null. */
  show(answer, scene, chosen) {
    this.headline(headlineOf(answer));
    const curve = answer.pair?.curve && curveOf(answer.pair.curve);
    const figures = [
      ["path", curve ? lengthOf(curve).toFixed(1) : "–", "m", "Length of the curve"],
      ["time", curve ? (endOf(curve) - curve.t0).toFixed(2) : "–", "s", "From now to the curve's end"],
      ["half-spaces", answer.pairs ?? "–", "", COLUMNS[4][2]],
      ["solves", answer.solves ?? "–", "", "How often the solver ran in this step"],
    ];
    at("figures").replaceChildren(
      ...figures.map(([name, value, unit, title]) => element("div", { title }, element("dt", { textContent: name }), element("dd", {}, String(value), element("small", { textContent: unit && ` ${unit}` })))),
    );
    at("checks").replaceChildren(...(answer.certificate ? checksOf(answer.certificate, { ...scene.limits, body_rate: this.about.body_rate }) : []).map((check) =>
      element("li", { title: check.help, className: classOf(check) },
        element("span", { className: "tick", role: "img", ariaLabel: check.ok === null ? "not asked" : check.ok ? "holds" : "does not hold" }, element("i", { className: `sign ${classOf(check)}` })),
        element("span", { textContent: check.name }), element("span", { className: "figure", textContent: check.figure }))));
    this.attempts(answer.attempts, chosen);
  }

  attempts(attempts, chosen) {
    if (!attempts) return at("attempts").replaceChildren(element("p", { className: "about", textContent: "Pause the flight: its newest step is solved again and explained here." }));
    const body = element("tbody", {}, ...attempts.map((attempt, i) => {
      const row = rowOf(attempt);
      const line = element("tr", { tabIndex: 0, ariaSelected: i === chosen, title: "Show its rounds in the picture" }, ...COLUMNS.map(([name]) => element("td", { textContent: row[name] })));
      const act = () => this.choose(i === chosen ? null : i);
      line.addEventListener("click", act);
      line.addEventListener("keydown", (event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        event.stopPropagation();
        act();
        at("attempts").querySelectorAll("tbody tr")[i].focus();
      });
      return line;
    }));
    const head = element("thead", {}, element("tr", {}, ...COLUMNS.map(([, textContent, title]) => element("th", { textContent, title }))));
    const words = attempts.length === 0 ? "Nothing was solved: the answer was known before a solve." : chosen === null ? "Click on a row: its rounds, and their curves in grey." : "Its rounds, whose curves are drawn in grey:";
    at("attempts").replaceChildren(...(attempts.length ? [element("table", {}, head, body)] : []), element("p", { className: "about why", textContent: words }), ...(attempts[chosen] ? [this.rounds(attempts[chosen])] : []));
  }

  rounds({ rounds, best }) {
    const names = ["round", "path", "half-sp.", "iter.", "cost", "solver", ""];
    const rows = rounds.map((round, i) => [i + 1, round.guide + 1, round.pairs.length, round.iterations, round.cost.toPrecision(5), plain(round.status), i === best ? "taken" : ""]);
    return element("table", { className: "rounds" },
      element("thead", {}, element("tr", {}, ...names.map((textContent) => element("th", { textContent, title: textContent === "path" ? "Which of the guide paths around the first obstacle" : "" })))),
      element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map((textContent) => element("td", { textContent }))))));
  }

  /** `rows`: { backend, least_ms, steps, iterations, cost } as far as they are known; `slow`: no more will come. */
  times(rows, slow) {
    const known = rows.filter(({ steps }) => steps > 0), most = Math.max(...known.map(({ least_ms }) => least_ms), 1e-9);
    const lines = rows.map(({ backend, least_ms, steps }) => {
      const bar = element("i");
      bar.style.cssText = `--colour: ${COLOURS[backend]}; width: ${steps > 0 ? (100 * least_ms) / most : 0}%`;
      return element("div", { className: "row" }, element("code", { textContent: backend }), element("div", { className: "bar" }, bar), element("b", { textContent: steps > 0 ? `${least_ms.toFixed(least_ms < 10 ? 2 : 1)} ms` : slow ? "–" : "…" }));
    });
    const words = slow ? "Not measured: this scene's steps take too long." : known.length > 0 ? speedWords(...rows) : "Measured as soon as the scene is at rest.";
    at("times").replaceChildren(...lines, element("p", { className: "about", textContent: words }));
  }

  flight(flight) {
    at("flight").hidden = !flight;
    if (!flight) return;
    const { state } = flight;
    const speed = Math.hypot(...state.v);
    at("mode").replaceChildren(element("b", { textContent: plain(state.mode) }), element("br"),
      element("span", { className: "about", textContent: `${speed.toFixed(1)} m/s; hull to the nearest obstacle ${state.clearance === null ? "–" : `${state.clearance.toFixed(2)} m`}, least so far ${state.least_clearance === null ? "–" : `${state.least_clearance.toFixed(2)} m`}` }));
    if (at("events").childElementCount === flight.events.length) return;
    at("events").replaceChildren(...flight.events.map(({ t, text }) => element("li", {}, element("span", { textContent: `${t.toFixed(2)} s` }), element("span", { textContent: eventWords(text) }))));
    at("events").scrollTop = 1e6;
  }
}
