// SPDX-License-Identifier: BSD-3-Clause
// A scene in an address, behind its #: JSON, deflated, in letters that addresses may hold.
import { bytesOf, deflate, inflate } from "../packed.js";

const DAMAGED = "The link is damaged or holds no scene. This is the scene to begin with.";

export async function linkOf(scene) {
  const bytes = await deflate(JSON.stringify(scene));
  return btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

const areNumbers = (list, count) => Array.isArray(list) && list.length === count && list.every(Number.isFinite);

/** What this page draws without asking the module; the module looks at the rest, and at the ranges. */
function isScene(scene) {
  return areNumbers(scene?.start, 3) && areNumbers(scene.pad?.p, 2) && scene.limits && scene.terms &&
    ["heading_deg", "speed", "height"].every((name) => Number.isFinite(scene.pad[name])) &&
    Array.isArray(scene.walls) && scene.walls.every((wall) => areNumbers(wall?.center, 3) && areNumbers(wall.size, 3) && Number.isFinite(wall.yaw_deg)) &&
    Array.isArray(scene.pillars) && scene.pillars.every((pillar) => areNumbers(pillar?.p, 2) && Number.isFinite(pillar.radius) && Number.isFinite(pillar.height));
}

/** Of what stands behind the # of an address. */
export async function sceneOf(link) {
  let scene;
  try {
    scene = JSON.parse(await inflate(bytesOf(link.replaceAll("-", "+").replaceAll("_", "/")), "deflate").text());
  } catch {
    throw new Error(DAMAGED);
  }
  if (!isScene(scene)) throw new Error(DAMAGED);
  return scene;
}
