// SPDX-License-Identifier: BSD-3-Clause
// A scene in an address, behind its #: JSON, deflated, in letters that addresses may hold.
import { bytesOf, deflate, inflate } from "../packed.js";
import { MOST_BYTES } from "./module.js";

const DAMAGED = "The link is damaged or holds no scene.";

export async function linkOf(scene) {
  const bytes = await deflate(JSON.stringify(scene));
  return btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** No more of it than a question may have: a short link can hold a very long text. */
async function textOf(bytes) {
  const reader = inflate(bytes, "deflate").body.getReader(), decoder = new TextDecoder();
  let text = "", size = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return text + decoder.decode();
    size += value.length;
    if (size > MOST_BYTES) {
      reader.cancel();
      throw new Error(DAMAGED);
    }
    text += decoder.decode(value, { stream: true });
  }
}

const has = (names) => (part) => names.every((name) => part?.[name] !== undefined);

/** What may not be left out. The module looks at all the rest. */
function isScene(scene) {
  return scene?.constructor === Object &&
    [scene.walls ?? []].flat().every(has(["center", "size", "yaw_deg"])) && [scene.pillars ?? []].flat().every(has(["p", "radius", "height"]));
}

/** Of what stands behind the # of an address. */
export async function sceneOf(link) {
  let scene;
  try {
    scene = JSON.parse(await textOf(bytesOf(link.replaceAll("-", "+").replaceAll("_", "/"))));
  } catch {
    throw new Error(DAMAGED);
  }
  if (!isScene(scene)) throw new Error(DAMAGED);
  return scene;
}
