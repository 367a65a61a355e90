// SPDX-License-Identifier: BSD-3-Clause
// The scene that is planned in, and what a hand can do to it. Plain data: the module reads it, a link holds it.
// An object of it is named by { kind, index }: kind is start, pad, wall or pillar.

const THICKNESS = 0.4, SHORTEST = 0.05, LOWEST = 0.2, HIGHEST = 8; // of walls and pillars [m]; a wall is so much longer than thick
const THIN = 0.1, THICK = 3; // radius of a pillar [m]
/** What hands and sliders reach; the module allows more. */
export const RANGES = {
  "start.z": [0.5, 8], "pad.speed": [0, 3], "pad.heading_deg": [-180, 180], "pad.turn_rate": [-1, 1], "pad.height": [0.1, 1.5], "pad.seed": [0, 99],
  "limits.speed": [0.5, 8], "limits.acceleration": [1, 15], "limits.tilt_deg": [5, 60], seed: [0, 99],
};
export const MOST = 80; // walls and pillars in one scene
/** From the middle of the deck to the tip of the pad's arrow: this, and so many metres for each m/s. */
export const ARROW = 1.1, ARROW_SPEED = 1.5;

const clamp = (x, [low, high]) => Math.min(Math.max(x, low), high);
const rounded = (x, digits = 2) => Number(x.toFixed(digits));
const degrees = (y, x) => rounded((Math.atan2(y, x) * 180) / Math.PI, 1);
const listOf = { wall: "walls", pillar: "pillars" };

export const same = (a, b) => a?.kind === b?.kind && a?.index === b?.index;

export function objectsOf(scene) {
  const named = (kind) => scene[listOf[kind]].map((_, index) => ({ kind, index }));
  return [{ kind: "start" }, { kind: "pad" }, ...named("wall"), ...named("pillar")];
}

export function nameOf({ kind, index }) {
  return index === undefined ? kind : `${kind} ${index + 1}`;
}

export function partOf(scene, { kind, index }) {
  return index === undefined ? scene[kind] : scene[listOf[kind]]?.[index];
}

/** Its middle on the ground; of the start its place. */
export function placeOf(scene, object) {
  const part = partOf(scene, object);
  switch (object.kind) {
    case "start":
      return [...part];
    case "pad":
      return [...part.p, part.height];
    case "wall":
      return [part.center[0], part.center[1], 0];
    default:
      return [...part.p, 0];
  }
}

export function moveTo(scene, object, x, y) {
  const part = partOf(scene, object);
  const place = object.kind === "start" ? part : object.kind === "wall" ? part.center : part.p;
  place[0] = rounded(x);
  place[1] = rounded(y);
}

export function setHeight(scene, object, z) {
  const part = partOf(scene, object), height = rounded(clamp(z, object.kind === "start" ? RANGES["start.z"] : [LOWEST, HIGHEST]));
  if (object.kind === "start") part[2] = height;
  else if (object.kind === "wall") {
    // It stands on the ground.
    part.size[2] = height;
    part.center[2] = rounded(height / 2, 3);
  } else part.height = height;
}

export function heightOf(scene, object) {
  const part = partOf(scene, object);
  return object.kind === "start" ? part[2] : object.kind === "wall" ? part.center[2] + part.size[2] / 2 : part.height;
}

/** Which of its sides a wall is long along, 0 or 1, and the direction of that side [rad]. */
function longSide({ size, yaw_deg }) {
  const side = size[1] > size[0] ? 1 : 0;
  return { side, angle: ((yaw_deg + 90 * side) * Math.PI) / 180 };
}

/** The middles of a wall's two short sides. */
export function wallEnds(wall) {
  const { side, angle } = longSide(wall), { center, size } = wall;
  const x = (Math.cos(angle) * size[side]) / 2, y = (Math.sin(angle) * size[side]) / 2;
  return [[center[0] - x, center[1] - y], [center[0] + x, center[1] + y]];
}

/** The other end stays where it is. The long side stays the long one. */
export function setWallEnd(scene, { index }, end, x, y) {
  const wall = scene.walls[index], kept = wallEnds(wall)[1 - end], { side } = longSide(wall);
  const sign = end === 1 ? 1 : -1, along = [sign * (x - kept[0]), sign * (y - kept[1])];
  const length = Math.hypot(...along);
  if (length <= wall.size[1 - side] + SHORTEST) return;
  wall.size[side] = rounded(length);
  wall.yaw_deg = rounded(degrees(along[1], along[0]) - 90 * side, 1);
  wall.center[0] = rounded((kept[0] + x) / 2, 3);
  wall.center[1] = rounded((kept[1] + y) / 2, 3);
}

export function setRadius(scene, { index }, radius) {
  scene.pillars[index].radius = rounded(clamp(radius, [THIN, THICK]));
}

/** To where the tip of the pad's arrow is drawn: its direction, and its length is the speed. */
export function aimPad(scene, x, y) {
  const { pad } = scene, along = [x - pad.p[0], y - pad.p[1]];
  pad.heading_deg = degrees(along[1], along[0]);
  if (moves(pad)) pad.speed = rounded(clamp((Math.hypot(...along) - ARROW) / ARROW_SPEED, RANGES["pad.speed"]));
}

export const moves = (pad) => pad.motion !== "static";

export function tipOf(pad) {
  const length = ARROW + (moves(pad) ? ARROW_SPEED * pad.speed : 0), heading = (pad.heading_deg * Math.PI) / 180;
  return [pad.p[0] + length * Math.cos(heading), pad.p[1] + length * Math.sin(heading)];
}

/** The new object; null where there are as many as may be. */
export function add(scene, kind, x, y, yaw_deg = 0) {
  if (scene.walls.length + scene.pillars.length >= MOST) return null;
  const place = [rounded(x), rounded(y)];
  if (kind === "wall") scene.walls.push({ center: [...place, 1.5], size: [3, THICKNESS, 3], yaw_deg });
  else scene.pillars.push({ p: place, radius: 0.4, height: 3 });
  return { kind, index: scene[listOf[kind]].length - 1 };
}

/** Whether there was something that may go: start and pad stay. */
export function remove(scene, object) {
  if (!object || object.index === undefined || !partOf(scene, object)) return false;
  scene[listOf[object.kind]].splice(object.index, 1);
  return true;
}

export const copy = (scene) => JSON.parse(JSON.stringify(scene));

/** The value at a path as "limits.speed", and another one put there. */
export const valueAt = (scene, path) => path.split(".").reduce((part, name) => part?.[name], scene);

export function setValue(scene, path, value) {
  const names = path.split("."), last = names.pop();
  names.reduce((part, name) => part[name], scene)[last] = value;
}
