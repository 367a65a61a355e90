// SPDX-License-Identifier: BSD-3-Clause
// What is drawn: a legend whose rows can be switched where that helps.
import { BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION } from "../colours.js";
import { element } from "../dom.js";

export function fillLegend(root, picture, changed) {
  const { answer, craft, cells } = picture;
  const part = (name) => ({ on: answer.show[name], set: (on) => (answer.show[name] = on) });
  const object = (shown) => ({ on: shown.visible, set: (on) => (shown.visible = on) });
  const rows = [
    { name: "plan, until its stop", colour: BLACK },
    { name: "the rest of it", colour: BLACK, mark: "thin" },
    { name: "stop", colour: VERMILLION, mark: "dash", help: "Certified and stored with the plan. Flown if no newer plan comes in time" },
    { name: "pad, predicted", colour: PURPLE, mark: "dash", help: "A mark every half second. The outline is the pad at contact" },
    { name: "flown path", colour: BLUE },
    { name: "guide paths", colour: GREEN, mark: "dot", help: "Paths around obstacles that a search found. They say which side of an obstacle is free", ...part("guides") },
    { name: "half-spaces", colour: ORANGE, help: "A point on an obstacle and the direction away from it, {p, v}. Each holds for one control point", ...part("pairs") },
    { name: "rounds of an attempt", colour: GREY, mark: "dash", ...part("rounds") },
    { name: "hull along the plan", colour: SKY, mark: "box", help: "The ball around the vehicle at every tilt", ...part("tube") },
    { name: "seen obstacles", colour: "#A6652B", mark: "box", help: "Occupied cells of the map, as the camera saw them", ...object(cells) },
    { name: "depth camera", colour: SKY, ...object(craft.cone) },
    { name: "cell to be seen next", colour: PURPLE, mark: "cross", help: "The next stop needs this cell, and it was not seen yet" },
  ];
  root.append(...rows.map(({ name, colour, mark = "", help = "", on, set }) => {
    const swatch = element("span", { className: `swatch ${mark}` });
    swatch.style.setProperty("--colour", colour);
    const label = element("label", { title: help, className: set ? "" : "fixed" });
    if (set) {
      const box = element("input", { type: "checkbox", checked: on });
      box.addEventListener("change", () => {
        set(box.checked);
        changed();
      });
      label.append(box);
    }
    label.append(swatch, name);
    return label;
  }));
}
