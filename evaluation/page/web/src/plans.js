// SPDX-License-Identifier: BSD-3-Clause
// Plans as they were made: all up to now, thin; the one at hand with its stop, rejected paths, guide paths and half-spaces.
import { BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, Vector3 } from "three";
import { BLACK, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION } from "./colours.js";
import { DASH, DOT, Strokes, Way, pieces } from "./lines.js";
import { sample } from "./spline.js";

const ARROW = 0.3; // of a pair [m]
const EYE = 0.2; // of a place to look from, from its middle [m]

/** The edges of an octahedron. */
function octahedron([x, y, z], size) {
  const ring = [[size, 0], [0, size], [-size, 0], [0, -size]], ends = [];
  ring.forEach(([dx, dy], i) => {
    const [nx, ny] = ring[(i + 1) % 4];
    ends.push(x + dx, y + dy, z, x + nx, y + ny, z);
    for (const dz of [size, -size]) ends.push(x + dx, y + dy, z, x, y, z + dz);
  });
  return ends;
}

/** The curves of all new plans, in the order in which they were made; some are drawn by how many are past. */
class AllPlans {
  constructor(steps) {
    this.curves = steps.map((step) => (step.status === "planned" ? sample(step.curve) : null));
    this.upTo = [];
    const ends = [];
    for (const curve of this.curves) {
      if (curve) pieces(curve, ends);
      this.upTo.push(ends.length / 3);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(ends), 3));
    this.object = new LineSegments(geometry, new LineBasicMaterial({ color: SKY, transparent: true, opacity: 0.35 }));
    this.object.frustumCulled = false;
  }
  update(step) {
    this.object.geometry.setDrawRange(0, step >= 0 ? this.upTo[step] : 0);
  }
}

export class Plans {
  constructor(flight) {
    this.flight = flight;
    this.all = new AllPlans(flight.steps);
    this.curve = new Way(BLACK, 3);
    this.stop = new Way(VERMILLION, 3.5, DASH);
    this.lost = new Strokes(GREY, 2, DASH);
    this.guides = new Strokes(GREEN, 2.5, DOT);
    this.pairs = new Strokes(ORANGE, 2);
    this.unseen = new Strokes(PURPLE, 2.5);
    this.look = new Strokes(PURPLE, 2.5);
    this.object = new Group();
    for (const part of [this.all, this.curve, this.stop, this.lost, this.guides, this.pairs, this.unseen, this.look]) this.object.add(part.object);
    this.step = null;
    this.show = { all: true, plan: true, stop: true, lost: true, guides: true, pairs: true, look: true };
  }

  update(step) {
    this.all.update(step);
    this.all.object.visible = this.show.all;
    if (step === this.step) return;
    this.step = step;
    this.draw(step >= 0 ? this.flight.steps[step] : null);
  }

  touch() {
    this.step = null;
  }

  draw(step) {
    const { show } = this;
    this.curve.set(step && show.plan ? sample(step.curve) : null);
    this.stop.set(step?.stop && show.stop ? sample(step.stop) : null);
    const lost = [];
    if (step && show.lost) for (const q of step.lost ?? []) pieces(sample({ q, h: 1, t0: 0 }), lost);
    this.lost.set(lost);
    const guides = [];
    if (step && show.guides) for (const path of step.guides) pieces(path, guides);
    this.guides.set(guides);
    const pairs = [];
    if (step && show.pairs) {
      const p = step.pairs ?? [];
      for (let i = 0; i + 5 < p.length; i += 6) {
        pairs.push(p[i], p[i + 1], p[i + 2], p[i] + ARROW * p[i + 3], p[i + 1] + ARROW * p[i + 4], p[i + 2] + ARROW * p[i + 5]);
      }
    }
    this.pairs.set(pairs);
    const unseen = [];
    if (step?.unseen && show.plan) {
      const [x, y, z] = step.unseen, d = 0.12;
      unseen.push(x - d, y, z, x + d, y, z, x, y - d, z, x, y + d, z, x, y, z - d, x, y, z + d);
    }
    this.unseen.set(unseen);
    this.look.set(step?.look && show.look ? octahedron(step.look, EYE) : []);
  }

  /** The newest of the drawn plans, up to `current`, that is within `reach` pixels of a place in the picture; -1: none. */
  near(x, y, reach, current, camera, width, height) {
    const p = new Vector3();
    for (let step = current; step >= 0; --step) {
      const curve = step === current && this.show.plan ? sample(this.flight.steps[step].curve) : this.show.all ? this.all.curves[step] : null;
      let last = null;
      for (let i = 0; curve && i < curve.length; i += 3) {
        p.set(curve[i], curve[i + 1], curve[i + 2]).project(camera);
        const place = p.z > 1 ? null : [((p.x + 1) / 2) * width, ((1 - p.y) / 2) * height];
        if (place && last && distanceToPiece(x, y, last, place) < reach) return step;
        last = place;
      }
    }
    return -1;
  }
}

export function distanceToPiece(x, y, [ax, ay], [bx, by]) {
  const dx = bx - ax, dy = by - ay, length2 = dx * dx + dy * dy;
  const s = length2 > 0 ? Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / length2, 0), 1) : 0;
  return Math.hypot(x - ax - s * dx, y - ay - s * dy);
}

/** Reference, flown path, path of the pad until now, of samples: all of it is on the card, some is drawn. */
export class Flown {
  constructor(table, colour, width, options) {
    this.way = new Way(colour, width, options);
    this.object = this.way.object;
    const points = [];
    for (let i = 0; i < table.t.length; ++i) points.push(table.px[i], table.py[i], table.pz[i]);
    this.way.set(points);
  }
  update(row, shown) {
    this.way.first(shown ? row + 1 : 0);
  }
}
