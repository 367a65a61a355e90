// SPDX-License-Identifier: BSD-3-Clause
// The pad with its printed sheet where it truly is; where it is believed to be, how well, and where it is predicted.
import { BoxGeometry, CanvasTexture, Group, Mesh, MeshLambertMaterial, PlaneGeometry, SRGBColorSpace } from "three";
import { BLUE, ORANGE, PURPLE } from "./colours.js";
import { DASH, Strokes, Way } from "./lines.js";

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

/** The deck and what carries it, without a sheet; its origin is the middle of the deck's face. */
export function makeCarrier(pad, deckHeight) {
  const group = new Group();
  const white = new MeshLambertMaterial({ color: "#F8F8F6" }), dark = new MeshLambertMaterial({ color: "#4A4F57" });
  const deck = new Mesh(new BoxGeometry(2 * pad.half_size, 2 * pad.half_size, pad.thickness), white);
  deck.position.z = -pad.thickness / 2;
  const height = Math.max(deckHeight - pad.thickness - pad.ground_gap, 0.02);
  const body = new Mesh(new BoxGeometry(2 * pad.body[0], 2 * pad.body[1], height), dark);
  body.position.z = -pad.thickness - height / 2;
  deck.castShadow = body.castShadow = deck.receiveShadow = true;
  group.add(deck, body);
  return group;
}

/** A printed sheet that lies on the deck. */
export function makeSheet(side, texture) {
  const sheet = new Mesh(
    new PlaneGeometry(side, side),
    new MeshLambertMaterial({ map: texture, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 }),
  );
  sheet.position.z = 0.001;
  sheet.receiveShadow = true;
  return sheet;
}

function makePad(pad, deckHeight) {
  const group = makeCarrier(pad, deckHeight);
  group.add(makeSheet(pad.sheet.side, sheetTexture(pad.sheet)));
  const plate = pad.sheet.side / 2 - pad.plate_from; // from there to the sheet's front edge
  if (plate > 1e-3) {
    const cover = new Mesh(new BoxGeometry(plate, pad.sheet.side, 0.004), new MeshLambertMaterial({ color: "#6B6F76" }));
    cover.position.set(pad.plate_from + plate / 2, 0, 0.004);
    group.add(cover);
  }
  return group;
}

export function square(half, z) {
  return [half, half, z, -half, half, z, -half, -half, z, half, -half, z, half, half, z];
}

/** A square grown by a distance: round at its corners. */
function grownSquare(half, by, z) {
  const points = [];
  for (let corner = 0; corner < 4; ++corner) {
    const x = corner === 0 || corner === 3 ? half : -half, y = corner < 2 ? half : -half;
    for (let i = 0; i <= 6; ++i) {
      const angle = ((corner + i / 6) * Math.PI) / 2;
      points.push(x + by * Math.cos(angle), y + by * Math.sin(angle), z);
    }
  }
  points.push(points[0], points[1], z);
  return points;
}

/** The ellipse of a covariance in the plane, about the origin. */
export function ellipse(xx, xy, yy, z) {
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
    this.exempt = new Way(ORANGE, 2, DASH);
    this.exemptBelow = new Way(ORANGE, 2, DASH);
    this.edges = new Strokes(ORANGE, 1.2, DASH);
    this.ellipse = new Way(BLUE, 2);
    this.prediction = new Way(PURPLE, 2.5, DASH);
    this.knots = new Strokes(PURPLE, 1.5);
    this.believed = new Group();
    this.believed.add(this.outline.object, this.cross.object);
    this.deck = new Group();
    this.deck.add(this.exempt.object, this.exemptBelow.object, this.edges.object);
    this.spread = new Group();
    this.spread.add(this.ellipse.object);
    this.predicted = new Group();
    this.predicted.add(this.prediction.object, this.knots.object);
    this.object = new Group();
    this.object.add(this.true, this.believed, this.deck, this.spread, this.predicted);
    this.outline.set(square(flight.document.pad.half_size, LIFT));
    this.cross.set([-0.1, 0, LIFT, 0.1, 0, LIFT, 0, -0.1, LIFT, 0, 0.1, LIFT]);
    this.show = { believed: true, deck: true, predicted: true };
    this.step = -1;
  }

  /** `selected`: with what is believed of it. `draws`: the pad itself. */
  update(t, step, selected, draws) {
    const { samples } = this.flight.document;
    this.flight.padAt(t, this.true.position);
    this.true.visible = draws && !this.flight.goal;
    const row = this.flight.padRow(samples.pad, t);
    if (row >= 0) this.true.rotation.z = samples.pad.yaw[row];
    const known = selected && !this.flight.goal && this.flight.placeAt(samples.pad_believed, t, this.believed.position);
    this.believed.visible = this.spread.visible = known && this.show.believed;
    this.deck.visible = known && this.show.deck;
    this.predicted.visible = selected && !this.flight.goal && this.show.predicted;
    if (known) this.drawBelief(this.flight.padRow(samples.pad_believed, t));
    if (selected && step !== this.step) this.predict(step);
  }

  drawBelief(i) {
    const { samples, pad } = this.flight.document;
    const { yaw, cov_xx, cov_xy, cov_yy } = samples.pad_believed;
    this.believed.rotation.z = this.deck.rotation.z = yaw[i];
    this.deck.position.copy(this.believed.position);
    this.spread.position.copy(this.believed.position);
    this.ellipse.set(ellipse(cov_xx[i], cov_xy[i], cov_yy[i], 2 * LIFT));
    // All below the deck belongs to it, down to the ground.
    const grown = this.flight.deckDoubt(i), ground = 0.01 - this.believed.position.z, { half_size: half } = pad;
    this.exempt.set(grownSquare(half, grown, LIFT));
    this.exemptBelow.set(grownSquare(half, grown, ground));
    const out = half + grown * Math.SQRT1_2;
    const ends = [];
    for (const [x, y] of [[out, out], [-out, out], [-out, -out], [out, -out]]) ends.push(x, y, LIFT, x, y, ground);
    this.edges.set(ends);
    // In doubt it is drawn thin.
    const width = grown > pad.sure ? 1 : 2.2;
    for (const line of [this.exempt, this.exemptBelow, this.edges]) line.object.material.linewidth = width;
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
