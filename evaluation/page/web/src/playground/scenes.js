// SPDX-License-Identifier: BSD-3-Clause
// Scenes to begin with, each from the module's own first one. `shows`: the attempt whose rounds are shown.
import { copy } from "./scene.js";

const wall = (x, y, length, yaw_deg = 0, height = 3, thickness = 0.4) => ({ center: [x, y, height / 2], size: [length, thickness, height], yaw_deg });
const pillar = (x, y, radius = 0.35, height = 4) => ({ p: [x, y], radius, height });

/** Trunks on a grid that is pushed about, always the same. */
function trunks() {
  const made = [];
  for (let i = 0; i < 5; ++i) {
    for (let k = 0; k < 4; ++k) {
      const n = 4 * i + k;
      made.push(pillar(2.4 + 1.9 * i + 0.5 * Math.sin(12.9 * n), -3.6 + 2.3 * k + 0.7 * Math.sin(78.2 * n) + (i % 2), 0.15 + 0.1 * Math.abs(Math.sin(3.7 * n)), 4.5));
    }
  }
  return made.map(({ p, radius, height }) => pillar(...p.map((x) => Number(x.toFixed(2))), Number(radius.toFixed(2)), height));
}

const still = { motion: "static", speed: 0, heading_deg: 0 };

export const SCENES = [
  { name: "the first one", make: (scene) => scene },
  { name: "both sides tried", shows: 0, make: (scene) => Object.assign(scene, { start: [0, 0, 1.5], ways: 2, walls: [wall(4, 0.1, 2, 90)], pillars: [], pad: { ...scene.pad, ...still, p: [8, 0] } }) },
  { name: "unknown until seen", make: (scene) => Object.assign(scene, { start: [0, 0, 1.5], known: "camera", walls: [wall(4.5, -0.6, 4, 90), wall(7.5, 1.6, 4, 90)], pillars: [], pad: { ...scene.pad, motion: "line", p: [9, 0], speed: 0.4, heading_deg: 0 } }) },
  { name: "dead end", make: (scene) => Object.assign(scene, { start: [0, 0, 1.5], known: "camera", walls: [wall(5, 0, 5, 90, 6), wall(3.2, 2.5, 3.6, 0, 6), wall(3.2, -2.5, 3.6, 0, 6)], pillars: [], pad: { ...scene.pad, motion: "line", speed: 0.3, heading_deg: 90, p: [9, -1] } }) },
  { name: "no way in: it stops", make: (scene) => Object.assign(scene, { start: [0, 0, 1.5], known: "camera", walls: [wall(6.5, 0, 4, 90, 2), wall(10.5, 0, 4, 90, 2), wall(8.5, 2, 4.4, 0, 2), wall(8.5, -2, 4.4, 0, 2), { center: [8.5, 0, 2.1], size: [4.4, 4.4, 0.2], yaw_deg: 0 }], pillars: [], pad: { ...scene.pad, ...still, p: [8.5, 0] } }) },
  { name: "forest", make: (scene) => Object.assign(scene, { start: [0, 0, 1.5], known: "camera", walls: [], pillars: trunks(), pad: { ...scene.pad, motion: "line", p: [10.5, -2], speed: 0.5, heading_deg: 60 } }) },
  { name: "pad in a wall", make: (scene) => Object.assign(scene, { start: [0, 0, 1.5], known: "all", walls: [wall(7, 0, 4, 90)], pillars: [], pad: { ...scene.pad, ...still, p: [7, 0] } }) },
  { name: "start in an obstacle", make: (scene) => Object.assign(scene, { start: [0, 0, 1.5], known: "all", walls: [], pillars: [pillar(0.1, 0, 0.6)], pad: { ...scene.pad, ...still, p: [7, 0] } }) },
];

export const sceneOfMenu = (index, first) => SCENES[index].make(copy(first));
