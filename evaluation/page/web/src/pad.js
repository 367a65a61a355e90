// SPDX-License-Identifier: BSD-3-Clause
// The pad with its printed sheet where it truly is; where it is believed to be, how well, and where it is foretold.
import { BoxGeometry, CanvasTexture, Group, Mesh, MeshLambertMaterial, PlaneGeometry, SRGBColorSpace } from "three";
import { BLUE, ORANGE, PURPLE } from "./colours.js";
import { Strokes, Way } from "./lines.js";

const SIGMAS = 3; // of the drawn ellipse, as the map and the mission count
const LIFT = 0.012; // above the deck, so that lines are seen [m]

function sheetTexture(sheet) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = sheet.texels;
  const pen = canvas.getContext("2d");
  pen.fillStyle = "#fff";
  pen.fillRect(0, 0, sheet.texels, sheet.texels);
  pen.fillStyle = "#000";
  sheet.rows.forEach((runs, v) => {
    let u = 0;
    runs.forEach((count, i) => {
      if (i % 2 === 1) pen.fillRect(u, v, count, 1);
      u += count;
    });
  });
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = 8;
  return texture;
}

function makePad(pad, deckHeight) {
  const group = new Group();
  const white = new MeshLambertMaterial({ color: "#F8F8F6" }), dark = new MeshLambertMaterial({ color: "#4A4F57" });
  const deck = new Mesh(new BoxGeometry(2 * pad.half_size, 2 * pad.half_size, pad.thickness), white);
  deck.position.z = -pad.thickness / 2;
  const height = Math.max(deckHeight - pad.thickness - pad.ground_gap, 0.02);
  const body = new Mesh(new BoxGeometry(2 * pad.body[0], 2 * pad.body[1], height), dark);
  body.position.z = -pad.thickness - height / 2;
  const sheet = new Mesh(
    new PlaneGeometry(pad.sheet.side, pad.sheet.side),
    new MeshLambertMaterial({ map: sheetTexture(pad.sheet), polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 }),
  );
  sheet.position.z = 0.001;
  deck.castShadow = body.castShadow = true;
  deck.receiveShadow = sheet.receiveShadow = true;
  group.add(deck, body, sheet);
  return group;
}

function square(half, z) {
  return [half, half, z, -half, half, z, -half, -half, z, half, -half, z, half, half, z];
}

/** The ellipse of a covariance in the plane, about the origin. */
function ellipse(xx, xy, yy, z) {
  const middle = (xx + yy) / 2, spread = Math.hypot((xx - yy) / 2, xy);
  const a = SIGMAS * Math.sqrt(Math.max(middle + spread, 0)), b = SIGMAS * Math.sqrt(Math.max(middle - spread, 0));
  const angle = 0.5 * Math.atan2(2 * xy, xx - yy);
  const points = [];
  for (let i = 0; i <= 48; ++i) {
    const u = (2 * Math.PI * i) / 48;
    const x = a * Math.cos(u), y = b * Math.sin(u);
    points.push(x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle), z);
  }
  return points;
}

export class Pad {
  constructor(flight) {
    this.flight = flight;
    const samples = flight.document.samples;
    this.true = makePad(flight.document.pad, samples.pad.pz[0] ?? 0);
    this.outline = new Way(BLUE, 2.5);
    this.cross = new Strokes(BLUE, 2.5);
    this.exempt = new Way(ORANGE, 2, { dashed: true, dashSize: 0.08, gapSize: 0.06 });
    this.ellipse = new Way(BLUE, 2);
    this.prediction = new Way(PURPLE, 2.5, { dashed: true, dashSize: 0.12, gapSize: 0.08 });
    this.knots = new Strokes(PURPLE, 1.5);
    this.believed = new Group();
    this.believed.add(this.outline.object, this.cross.object);
    this.deck = new Group();
    this.deck.add(this.exempt.object);
    this.spread = new Group();
    this.spread.add(this.ellipse.object);
    this.foretold = new Group();
    this.foretold.add(this.prediction.object, this.knots.object);
    this.object = new Group();
    this.object.add(this.true, this.believed, this.deck, this.spread, this.foretold);
    this.step = -1;
  }

  update(t, step) {
    const { samples, pad } = this.flight.document;
    this.flight.padAt(t, this.true.position);
    const row = this.flight.padRow(samples.pad, t);
    if (row >= 0) this.true.rotation.z = samples.pad.yaw[row];
    const known = this.flight.placeAt(samples.pad_believed, t, this.believed.position);
    this.believed.visible = this.deck.visible = this.spread.visible = known;
    if (known) {
      const i = this.flight.padRow(samples.pad_believed, t);
      const { yaw, cov_xx, cov_xy, cov_yy } = samples.pad_believed;
      this.believed.rotation.z = this.deck.rotation.z = yaw[i];
      this.deck.position.copy(this.believed.position);
      this.spread.position.copy(this.believed.position);
      this.outline.set(square(pad.half_size, LIFT));
      this.cross.set([-0.1, 0, LIFT, 0.1, 0, LIFT, 0, -0.1, LIFT, 0, 0.1, LIFT]);
      const grown = pad.sigmas * Math.sqrt(Math.max(cov_xx[i] + cov_yy[i], 0));
      this.exempt.set(square(pad.half_size + grown, LIFT));
      this.ellipse.set(ellipse(cov_xx[i], cov_xy[i], cov_yy[i], 2 * LIFT));
    }
    if (step !== this.step) this.predict(step);
  }

  predict(step) {
    this.step = step;
    const points = step >= 0 ? (this.flight.steps[step].pad ?? []) : [];
    const lifted = points.map((x, i) => (i % 3 === 2 ? x + LIFT : x));
    this.prediction.set(lifted.length >= 6 ? lifted : null);
    // A stroke every half second tells how fast.
    const ends = [];
    for (let i = 0; i + 2 < lifted.length; i += 15) ends.push(lifted[i], lifted[i + 1], lifted[i + 2], lifted[i], lifted[i + 1], lifted[i + 2] + 0.12);
    this.knots.set(ends);
  }
}
