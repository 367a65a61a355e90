// SPDX-License-Identifier: BSD-3-Clause
// An empty scene with sky and sun, and what renders it.
import { Color, DirectionalLight, Fog, HemisphereLight, Scene, WebGLRenderer } from "three";

const SKY_COLOUR = "#EDF2F6";

export function makeStage(canvas) {
  const renderer = new WebGLRenderer({ canvas, antialias: true });
  renderer.shadowMap.enabled = true;
  const scene = new Scene();
  scene.background = new Color(SKY_COLOUR);
  scene.fog = new Fog(SKY_COLOUR, 60, 180);
  scene.add(new HemisphereLight("#FFFFFF", "#B9B4A8", 2.2));
  const sun = new DirectionalLight("#FFFFFF", 2.0);
  sun.castShadow = true;
  sun.shadow.mapSize.set(2048, 2048);
  Object.assign(sun.shadow.camera, { left: -14, right: 14, top: 14, bottom: -14, near: 1, far: 60 });
  scene.add(sun, sun.target);
  return { renderer, scene, sun };
}

/** Shadows are drawn around this place. */
export function shineOn(sun, place) {
  sun.target.position.copy(place);
  sun.position.copy(place).add({ x: 6, y: -10, z: 18 });
}
