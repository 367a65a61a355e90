// SPDX-License-Identifier: BSD-3-Clause
// All that is in the picture, and what is under the pointer.
import { Group, MeshLambertMaterial, Plane, Raycaster, Vector2, Vector3 } from "three";
import { BLUE, GREY } from "../colours.js";
import { DASH, Way, resizeLines } from "../lines.js";
import { makeStage, shineOn } from "../stage.js";
import { makeGround, makeObstacle, obstacleMaterials } from "../world.js";
import { Answer } from "./answer.js";
import { Craft } from "./craft.js";
import { Deck } from "./deck.js";
import { Look } from "./look.js";
import { heightOf, objectsOf, placeOf, same, wallEnds } from "./scene.js";
import { Seen } from "./seen.js";

const CELL = 0.1; // edge of the map's cells [m]
const NEAR = 26; // the vehicle is small: it is taken within so many pixels
const TRAIL = 4000; // points of the flown path that are kept

const chosen = new MeshLambertMaterial({ color: "#7FB2D6", transparent: true, opacity: 0.65 });
const hovered = new MeshLambertMaterial({ color: "#B9C4C4", transparent: true, opacity: 0.65 });

/** A wall or a pillar as world.js has it. */
function obstacleOf(kind, part) {
  if (kind === "wall") return { kind: "box", centre: part.center, size: part.size, yaw: (part.yaw_deg * Math.PI) / 180 };
  return { kind: "cylinder", centre: [...part.p, part.height / 2], size: [2 * part.radius, 2 * part.radius, part.height] };
}

export class Picture {
  constructor(canvas, about) {
    Object.assign(this, makeStage(canvas));
    this.canvas = canvas;
    this.look = new Look(canvas);
    this.craft = new Craft(about);
    this.deck = new Deck(about.deck_size);
    this.answer = new Answer(about.hull_radius);
    this.seen = new Seen(CELL);
    this.cells = new Group();
    this.cells.add(this.seen.object);
    this.trail = new Way(BLUE, 3.5);
    this.plumb = new Way(GREY, 1.5, DASH);
    this.obstacles = [];
    this.materials = obstacleMaterials();
    this.scene.add(makeGround(new Vector3()));
    for (const part of [this.craft, this.deck, this.answer, this.trail, this.plumb]) this.scene.add(part.object);
    this.scene.add(this.cells);
    this.raycaster = new Raycaster();
    this.flown = [];
    this.driven = [];
  }

  get camera() {
    return this.look.camera;
  }

  /** Walls and pillars; of those that have not changed nothing is made anew. */
  setObstacles(scene) {
    const wanted = [...scene.walls.map((part, index) => ({ kind: "wall", index, part })), ...scene.pillars.map((part, index) => ({ kind: "pillar", index, part }))];
    wanted.forEach(({ kind, index, part }, i) => {
      const text = kind + JSON.stringify(part), old = this.obstacles[i];
      if (old?.text !== text) {
        if (old) this.dispose(old);
        const mesh = makeObstacle(obstacleOf(kind, part), this.materials, true);
        this.scene.add(mesh);
        this.obstacles[i] = { text, mesh };
      }
      this.obstacles[i].object = { kind, index };
    });
    this.obstacles.splice(wanted.length).forEach((old) => this.dispose(old));
  }

  dispose({ mesh }) {
    mesh.removeFromParent();
    mesh.geometry.dispose();
    mesh.children[0]?.geometry.dispose();
  }

  setStart(scene) {
    this.setCraft(scene.start);
    const [x, y, z] = placeOf(scene, { kind: "pad" });
    this.deck.set([x, y, z], (scene.pad.heading_deg * Math.PI) / 180);
  }

  /** What is drawn of an answer, and of the attempt that is chosen; made anew only where either is another. */
  setAnswer(answer, attempt) {
    if (this.answered?.answer === answer && this.answered.attempt === attempt) return;
    this.answered = { answer, attempt };
    this.answer.set(answer, attempt);
    this.deck.predict(answer?.pad ?? [], Boolean(answer?.certificate?.endpoint_required && answer.passed));
  }

  setCraft(p, q) {
    this.craft.set(p, q);
    this.plumb.set([p[0], p[1], p[2], p[0], p[1], 0.01]);
  }

  highlight(hover, selected) {
    for (const { mesh, object } of this.obstacles) mesh.material = same(object, selected) ? chosen : same(object, hover) ? hovered : this.materials.faces;
  }

  beginTrail() {
    this.flown = [];
    this.driven = [];
    this.trail.set(null);
    this.deck.drive(null);
    this.seen.clear();
  }

  addTrail(p, pad) {
    const far = (list, q) => list.length < 3 || Math.hypot(list.at(-3) - q[0], list.at(-2) - q[1], list.at(-1) - q[2]) > 0.04;
    if (far(this.flown, p)) {
      this.flown.push(...p);
      if (this.flown.length > 3 * TRAIL) this.flown.splice(0, 3);
      this.trail.set(this.flown);
    }
    if (far(this.driven, pad)) {
      this.driven.push(pad[0], pad[1], pad[2] + 0.01);
      this.deck.drive(this.driven);
    }
  }

  frame(scene, answer) {
    const half = this.deck.half, pads = [placeOf(scene, { kind: "pad" }), ...(answer?.pad ?? []).map(({ p }) => p)];
    const around = ([x, y, z], by) => [[-by, -by], [-by, by], [by, -by], [by, by]].map(([dx, dy]) => [x + dx, y + dy, z]);
    const places = [...around(scene.start, 0.5), ...pads.flatMap((p) => around(p, half)), ...(answer?.pair?.curve.control_points ?? [])];
    for (const object of objectsOf(scene).slice(2)) {
      const top = heightOf(scene, object), feet = object.kind === "wall" ? wallEnds(scene.walls[object.index]) : [placeOf(scene, object)];
      for (const [x, y] of feet) places.push([x, y, 0], [x, y, top]);
    }
    this.look.frame(places);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    this.size = [width, height];
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setSize(width, height, false);
    resizeLines(width, height);
    this.look.resize(width / height);
  }

  draw() {
    this.look.update(this.craft.object.position);
    shineOn(this.sun, this.craft.object.position);
    this.renderer.render(this.scene, this.camera);
  }

  /** Pixels in the picture of a place; null behind the eye. */
  pixelOf(place) {
    const p = new Vector3(...place).project(this.camera);
    return p.z > 1 ? null : [((p.x + 1) / 2) * this.size[0], ((1 - p.y) / 2) * this.size[1]];
  }

  aim(event) {
    const box = this.canvas.getBoundingClientRect();
    this.camera.updateMatrixWorld();
    const x = event.clientX - box.left, y = event.clientY - box.top;
    this.raycaster.setFromCamera(new Vector2((2 * x) / box.width - 1, 1 - (2 * y) / box.height), this.camera);
    return [x, y];
  }

  /** What is under the pointer and where it was hit: { object, point }, or null. `only` has the kinds that may be taken. */
  pick(event, only) {
    const [x, y] = this.aim(event);
    const { position } = this.craft.object, at = this.pixelOf(position.toArray());
    if (only.includes("start") && at && Math.hypot(at[0] - x, at[1] - y) < NEAR) return { object: { kind: "start" }, point: position.clone() };
    const found = [];
    const test = (mesh, object) => {
      if (!only.includes(object.kind)) return;
      const [hit] = this.raycaster.intersectObject(mesh, true).filter(({ object: { isMesh } }) => isMesh);
      if (hit) found.push({ object, point: hit.point, distance: hit.distance });
    };
    for (const { mesh, object } of this.obstacles) test(mesh, object);
    test(this.deck.carrier, { kind: "pad" });
    return found.sort((a, b) => a.distance - b.distance)[0] ?? null;
  }

  /** Where the pointer's ray meets the level plane at z; null where it does not. */
  onLevel(event, z) {
    this.aim(event);
    return this.raycaster.ray.intersectPlane(new Plane(new Vector3(0, 0, 1), -z), new Vector3());
  }

  /** The height at which the pointer's ray passes a vertical line, seen from the eye. */
  onVertical(event, [x, y]) {
    this.aim(event);
    const normal = this.camera.position.clone().sub({ x, y, z: 0 }).setZ(0);
    // From straight above a vertical line is a point.
    if (normal.length() < 1e-3) return null;
    normal.normalize();
    const plane = new Plane(normal, -(normal.x * x + normal.y * y));
    return this.raycaster.ray.intersectPlane(plane, new Vector3())?.z ?? null;
  }
}
