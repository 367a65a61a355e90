// SPDX-License-Identifier: BSD-3-Clause
// Lines that are wider than one pixel, and arrows.
import { ArrowHelper, Color, Vector2, Vector3 } from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";

const size = new Vector2(1, 1);
const materials = [];

/** To be told when the picture has another size. */
export function resizeLines(width, height) {
  size.set(width, height);
  for (const material of materials) material.resolution.copy(size);
}

function materialOf(colour, width, options) {
  const material = new LineMaterial({ color: new Color(colour), linewidth: width, ...options });
  material.resolution.copy(size);
  if (options.opacity !== undefined) material.transparent = true;
  materials.push(material);
  return material;
}

/** How kinds of lines are told apart beside their colour: dash and gap [m]. */
export const DASH = { dashed: true, dashSize: 0.2, gapSize: 0.12 }, DOT = { dashed: true, dashSize: 0.05, gapSize: 0.07 };

/** A line along points (x y z x y z ...) that can be given others. */
export class Way {
  constructor(colour, width, options = {}) {
    this.object = new Line2(new LineGeometry(), materialOf(colour, width, options));
    this.object.frustumCulled = false;
    this.object.visible = false;
  }
  set(points) {
    this.object.visible = points !== null && points.length >= 6;
    if (!this.object.visible) return;
    this.object.geometry.dispose();
    this.object.geometry = new LineGeometry();
    this.object.geometry.setPositions(points);
    if (this.object.material.dashed) this.object.computeLineDistances();
  }
  /** Of the points that it has, only the first so many. */
  first(count) {
    this.object.visible = count >= 2;
    this.object.geometry.instanceCount = Math.max(count - 1, 0);
  }
}

/** Separate lines from point to point: pairs of ends. */
export class Strokes {
  constructor(colour, width, options = {}) {
    this.object = new LineSegments2(new LineSegmentsGeometry(), materialOf(colour, width, options));
    this.object.frustumCulled = false;
    this.object.visible = false;
  }
  set(ends) {
    this.object.visible = ends.length >= 6;
    if (!this.object.visible) return;
    this.object.geometry.dispose();
    this.object.geometry = new LineSegmentsGeometry();
    this.object.geometry.setPositions(ends);
    if (this.object.material.dashed) this.object.computeLineDistances();
  }
}

/** The pieces of a line, as ends of strokes. */
export function pieces(points, ends = []) {
  for (let i = 0; i + 5 < points.length; i += 3) {
    for (let k = 0; k < 6; ++k) ends.push(points[i + k]);
  }
  return ends;
}

const direction = new Vector3();

export class Arrow {
  constructor(colour) {
    this.object = new ArrowHelper(new Vector3(0, 0, 1), new Vector3(), 1, colour, 0.12, 0.08);
    this.object.visible = false;
  }
  /** From a place along a vector; `scale` metres of picture a unit. */
  set(origin, vector, scale) {
    const length = vector.length() * scale;
    this.object.visible = length > 0.02;
    if (!this.object.visible) return;
    this.object.position.copy(origin);
    this.object.setDirection(direction.copy(vector).normalize());
    this.object.setLength(length, Math.min(0.12, 0.4 * length), Math.min(0.08, 0.3 * length));
  }
}
