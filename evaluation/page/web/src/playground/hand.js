// SPDX-License-Identifier: BSD-3-Clause
// Drags objects over the ground. It takes the pointer before the view is turned by it.
import { moveTo, placeOf, setHeight } from "./scene.js";

const STILL = 5; // a press that moves less is a click [pixels]

export class Hand {
  /** `owner` has scene, mayMove (kinds), and is told: hovers(object), chooses(object), changed(), done(), put(kind, x, y). */
  constructor(stage, picture, owner) {
    Object.assign(this, { stage, picture, owner });
    this.held = null;
    this.pressed = null;
    const canvas = picture.canvas;
    stage.addEventListener("pointerdown", (event) => event.target === canvas && this.press(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const type of ["pointerup", "pointercancel"]) canvas.addEventListener(type, (event) => this.release(event));
    canvas.addEventListener("pointerleave", () => !this.held && owner.hovers(null));
    canvas.addEventListener("dblclick", (event) => {
      if (picture.pick(event, owner.mayMove)) return;
      const point = picture.onLevel(event, 0);
      if (point) owner.put("pillar", point.x, point.y);
    });
  }

  press(event) {
    if (this.held) return event.stopPropagation();
    this.picture.canvas.focus({ preventScroll: true });
    this.pressed = [event.clientX, event.clientY];
    if (event.button !== 0) return;
    const hit = this.picture.pick(event, this.owner.mayMove);
    if (!hit) return;
    event.stopPropagation();
    this.picture.canvas.setPointerCapture(event.pointerId);
    const [x, y, z] = placeOf(this.owner.scene, hit.object);
    this.held = { object: hit.object, pointer: event.pointerId, level: hit.point.z, from: [x - hit.point.x, y - hit.point.y], lifted: null, z };
    this.owner.chooses(hit.object);
  }

  move(event) {
    if (!this.held) {
      if (event.buttons === 0) this.owner.hovers(this.picture.pick(event, this.owner.mayMove)?.object ?? null);
      return;
    }
    const { held } = this;
    if (event.pointerId !== held.pointer) return;
    if (held.object.kind === "start" && event.shiftKey) {
      const at = this.picture.onVertical(event, placeOf(this.owner.scene, held.object));
      if (at === null) return;
      // It goes on from the height that it has when the key is pressed.
      held.lifted ??= this.owner.scene.start[2] - at;
      setHeight(this.owner.scene, held.object, at + held.lifted);
      held.level = this.owner.scene.start[2];
    } else {
      held.lifted = null;
      const point = this.picture.onLevel(event, held.level);
      if (!point || point.distanceTo(this.picture.camera.position) > 150) return;
      moveTo(this.owner.scene, held.object, point.x + held.from[0], point.y + held.from[1]);
    }
    held.moved = true;
    this.owner.changed();
  }

  release(event) {
    if (this.held?.pointer === event.pointerId) {
      const { moved } = this.held;
      this.held = null;
      if (moved) this.owner.done();
    } else if (this.pressed && !this.held && Math.hypot(event.clientX - this.pressed[0], event.clientY - this.pressed[1]) < STILL) {
      this.owner.chooses(null);
    }
    this.pressed = null;
  }
}
