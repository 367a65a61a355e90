// SPDX-License-Identifier: BSD-3-Clause
// Handles of the object at hand: buttons over the picture, for mouse, touch and keys.
import { element } from "../dom.js";
import { aimPad, heightOf, moves, partOf, placeOf, setHeight, setRadius, setWallEnd, tipOf, wallEnds } from "./scene.js";

const STEP = 0.1; // of an arrow key [m]
const SIGNS = ["height", "aim"]; // the others are plain
const ABOVE = 0.45; // a handle of the height is so far above [m]

/** What can be drawn at an object: { name, label, place, level(x, y) or vertical(z) }. */
export function handlesOf(scene, object, side) {
  const part = partOf(scene, object), [x, y] = placeOf(scene, object), top = heightOf(scene, object);
  const height = {
    name: "height", label: "height", place: [x, y, top + ABOVE],
    vertical: (z) => setHeight(scene, object, z - ABOVE),
  };
  switch (object.kind) {
    case "start":
      return [height];
    case "pad":
      return [{
        name: "aim", label: moves(part) ? "heading and speed of the pad" : "heading of the pad", place: [...tipOf(part), part.height],
        level: (px, py) => aimPad(scene, px, py),
      }];
    case "wall":
      return [
        ...wallEnds(part).map(([ex, ey], end) => ({
          name: `end ${end + 1}`, label: "end of the wall", place: [ex, ey, 0.02], level: (px, py) => setWallEnd(scene, object, end, px, py),
        })),
        height,
      ];
    default:
      return [
        { name: "radius", label: "radius", place: [x + side[0] * part.radius, y + side[1] * part.radius, 0.02], level: (px, py) => setRadius(scene, object, Math.hypot(px - x, py - y)) },
        height,
      ];
  }
}

export class Handles {
  /** `owner` is told after each step of a drag, changed(), and after its end, done(). */
  constructor(layer, picture, owner) {
    Object.assign(this, { layer, picture, owner });
    this.buttons = new Map();
    this.dragged = null;
  }

  /** Of one object of the scene, or none. */
  show(scene, object) {
    this.scene = scene;
    this.object = object;
    this.place();
  }

  list() {
    if (!this.object || !partOf(this.scene, this.object)) return [];
    const right = this.picture.camera.matrixWorld.elements, length = Math.hypot(right[0], right[1]) || 1;
    return handlesOf(this.scene, this.object, [right[0] / length, right[1] / length]);
  }

  place() {
    const list = this.list(), wanted = new Set(list.map(({ name }) => name));
    for (const [name, button] of this.buttons) button.hidden = !wanted.has(name);
    for (const handle of list) {
      const button = this.buttons.get(handle.name) ?? this.make(handle.name), at = this.picture.pixelOf(handle.place);
      const steep = handle.vertical && this.picture.look.name === "top";
      button.hidden = !at || steep;
      if (button.hidden) continue;
      button.title = handle.label;
      button.setAttribute("aria-label", `${handle.label}: drag, or arrow keys`);
      button.style.transform = `translate(${at[0]}px, ${at[1]}px) translate(-50%, -50%)${handle.name === "aim" ? ` rotate(${this.turned(handle.place)}deg)` : ""}`;
    }
  }

  /** The direction of the pad's arrow on the screen. */
  turned(place) {
    const from = this.picture.pixelOf(placeOf(this.scene, this.object)), to = this.picture.pixelOf(place);
    return from && to ? (Math.atan2(to[1] - from[1], to[0] - from[0]) * 180) / Math.PI : 0;
  }

  make(name) {
    const button = document.createElement("button");
    button.type = "button";
    const [kind] = name.split(" ");
    button.className = `handle ${kind}`;
    if (SIGNS.includes(kind)) button.append(element("i", { className: `sign ${kind}` }));
    const find = () => this.list().find((handle) => handle.name === name);
    button.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      button.setPointerCapture(event.pointerId);
      this.dragged = name;
      event.stopPropagation();
    });
    button.addEventListener("pointermove", (event) => {
      if (this.dragged !== name) return;
      const handle = find();
      if (handle.vertical) {
        const z = this.picture.onVertical(event, handle.place);
        if (z !== null) handle.vertical(z);
      } else {
        const point = this.picture.onLevel(event, handle.place[2]);
        if (point) handle.level(point.x, point.y);
      }
      this.owner.changed();
    });
    const end = () => {
      if (this.dragged !== name) return;
      this.dragged = null;
      this.owner.done();
    };
    for (const type of ["pointerup", "pointercancel", "lostpointercapture"]) button.addEventListener(type, end);
    button.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key], handle = find();
      if (!step || !handle) return;
      if (handle.vertical) handle.vertical(handle.place[2] + STEP * (step[0] + step[1]));
      else handle.level(handle.place[0] + STEP * step[0], handle.place[1] + STEP * step[1]);
      event.preventDefault();
      event.stopPropagation();
      this.owner.changed();
      this.owner.done();
    });
    this.layer.append(button);
    this.buttons.set(name, button);
    return button;
  }
}
