// SPDX-License-Identifier: BSD-3-Clause
// The pad: what drives, its predicted way, where it will be met, and what a flight believes of it.
import { CanvasTexture, Group, SRGBColorSpace } from "three";
import { BLUE, PURPLE } from "../colours.js";
import { DASH, Strokes, Way } from "../lines.js";
import { ellipse, makeCarrier, makeSheet, square } from "../pad.js";

const THICKNESS = 0.04, GAP = 0.05, LIFT = 0.015; // of the deck, below the body, of lines over the deck [m]
const STROKES = 5; // one in so many predicted places has a stroke

/** A landing mark: a ring, an H, and what is in front. */
function markTexture() {
  const canvas = document.createElement("canvas"), n = (canvas.width = canvas.height = 256);
  const pen = canvas.getContext("2d");
  pen.fillStyle = "#F8F8F6";
  pen.fillRect(0, 0, n, n);
  pen.strokeStyle = pen.fillStyle = "#20242A";
  pen.lineWidth = 12;
  pen.beginPath();
  pen.arc(n / 2, n / 2, 96, 0, 2 * Math.PI);
  pen.stroke();
  // The texture's right is the pad's front.
  pen.fillRect(84, 80, 88, 22);
  pen.fillRect(84, 154, 88, 22);
  pen.fillRect(117, 96, 22, 64);
  pen.fillStyle = "#E69F00";
  pen.beginPath();
  pen.moveTo(250, 128);
  pen.lineTo(228, 108);
  pen.lineTo(228, 148);
  pen.fill();
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = 8;
  return texture;
}

export class Deck {
  constructor(side) {
    this.side = side;
    this.half = side / 2;
    this.mark = markTexture();
    this.height = null;
    this.carrier = new Group();
    this.met = new Way(PURPLE, 2);
    this.way = new Way(PURPLE, 2.5, DASH);
    this.strokes = new Strokes(PURPLE, 1.5);
    this.driven = new Way("#000000", 1.5, DASH);
    this.believed = new Way(BLUE, 2);
    this.spread = new Way(BLUE, 1.5);
    this.predicted = new Group();
    this.predicted.add(this.met.object, this.way.object, this.strokes.object);
    this.object = new Group();
    for (const part of [this.driven, this.believed, this.spread]) this.object.add(part.object);
    this.object.add(this.carrier, this.predicted);
  }

  set([x, y, z], yaw) {
    if (z !== this.height) this.build(z);
    this.carrier.position.set(x, y, z);
    this.carrier.rotation.z = yaw;
  }

  build(height) {
    this.height = height;
    const body = [0.84 * this.half, 0.7 * this.half];
    for (const old of this.carrier.children) old.geometry?.dispose();
    this.carrier.clear();
    this.carrier.add(makeCarrier({ half_size: this.half, thickness: THICKNESS, ground_gap: GAP, body }, height), makeSheet(this.side * 0.96, this.mark));
  }

  /** Where it will be: [{ p, yaw }]; the last is where a plan meets it, if it does. */
  predict(places, meets) {
    const points = places.flatMap(({ p }) => [p[0], p[1], p[2] + LIFT]);
    this.way.set(points);
    const ends = [];
    for (let i = 0; i + 2 < points.length; i += 3 * STROKES) ends.push(points[i], points[i + 1], points[i + 2], points[i], points[i + 1], points[i + 2] + 0.12);
    this.strokes.set(ends);
    const last = places.at(-1);
    this.met.set(last && meets ? placed(square(this.half, LIFT), last.p, last.yaw) : null);
  }

  believe(belief) {
    this.believed.set(belief ? placed(square(this.half, LIFT), belief.p, belief.yaw) : null);
    const variance = belief ? belief.sigma ** 2 : 0;
    this.spread.set(belief ? placed(ellipse(variance, 0, variance, 2 * LIFT), belief.p, 0) : null);
  }

  drive(points) {
    this.driven.set(points);
  }
}

/** Points about the origin, turned and moved. */
function placed(points, [x, y, z], yaw) {
  const c = Math.cos(yaw), s = Math.sin(yaw);
  return points.map((_, i) => {
    const k = i - (i % 3);
    if (i % 3 === 0) return x + c * points[k] - s * points[k + 1];
    return i % 3 === 1 ? y + s * points[k] + c * points[k + 1] : z + points[k + 2];
  });
}
