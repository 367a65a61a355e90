// SPDX-License-Identifier: BSD-3-Clause
// What a replanning step answered, in the picture.
import { CircleGeometry, DoubleSide, Group, InstancedMesh, Mesh, MeshBasicMaterial, MeshLambertMaterial, Object3D, SphereGeometry, CatmullRomCurve3, TubeGeometry, Vector3 } from "three";
import { BLACK, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION } from "../colours.js";
import { DASH, DOT, Strokes, Way, pieces } from "../lines.js";
import { endOf, sample } from "../spline.js";

const DISC = 0.17, ARROW = 0.4, CROSS = 0.14; // radius of a pair's disc, length of its arrow, half a marker [m]

/** A curve of the module as spline.js has it. */
export const curveOf = ({ t0, h, control_points }) => ({ t0, h, q: control_points.flat() });

/** The pairs of the round that an attempt took, or of its last one. */
export function roundOf(attempt) {
  return attempt?.rounds[attempt.best ?? attempt.rounds.length - 1];
}

/** Discs in the planes of half-spaces, with an arrow to the side that is free. */
class Pairs {
  constructor() {
    const material = new MeshBasicMaterial({ color: ORANGE, transparent: true, opacity: 0.35, side: DoubleSide, depthWrite: false });
    this.discs = new InstancedMesh(new CircleGeometry(DISC, 24), material, 512);
    this.discs.frustumCulled = false;
    this.arrows = new Strokes(ORANGE, 2);
    this.object = new Group();
    this.object.add(this.discs, this.arrows.object);
  }
  set(pairs) {
    const ends = [], disc = new Object3D();
    this.discs.count = Math.min(pairs.length, 512);
    pairs.slice(0, 512).forEach(({ p, v }, i) => {
      disc.position.set(...p);
      disc.lookAt(p[0] + v[0], p[1] + v[1], p[2] + v[2]);
      disc.updateMatrix();
      this.discs.setMatrixAt(i, disc.matrix);
      ends.push(...p, ...p.map((x, k) => x + ARROW * v[k]));
    });
    this.discs.instanceMatrix.needsUpdate = true;
    this.arrows.set(ends);
  }
}

export class Answer {
  constructor(hullRadius) {
    this.hullRadius = hullRadius;
    this.committed = new Way(BLACK, 5.5);
    this.rest = new Way(BLACK, 2.5);
    this.stop = new Way(VERMILLION, 3.5, DASH);
    this.guides = new Strokes(GREEN, 2.5, DOT);
    this.rounds = new Strokes(GREY, 2, DASH);
    this.unseen = new Strokes(PURPLE, 2.5);
    this.pairs = new Pairs();
    this.tube = new Mesh(undefined, new MeshLambertMaterial({ color: SKY, transparent: true, opacity: 0.16, depthWrite: false }));
    this.stopEnd = new Mesh(new SphereGeometry(0.07, 16, 12), new MeshBasicMaterial({ color: VERMILLION }));
    this.plan = new Group();
    this.plan.add(this.committed.object, this.rest.object, this.unseen.object);
    this.stopped = new Group();
    this.stopped.add(this.stop.object, this.stopEnd);
    this.object = new Group();
    this.object.add(this.plan, this.stopped, this.guides.object, this.rounds.object, this.pairs.object, this.tube);
    this.show = { guides: true, pairs: false, rounds: true, tube: true };
    this.set(null, null);
  }

  /** Without an answer nothing is drawn. `attempt`: whose rounds are shown, or null. */
  set(answer, attempt) {
    const pair = answer?.pair, curve = pair?.curve && curveOf(pair.curve);
    const until = curve && Math.min(pair.t_stop ?? endOf(curve), endOf(curve));
    // A plan without a certificate is drawn thin: it is not flown.
    const from = curve?.t0 ?? 0, flown = curve && until > from + 1e-6;
    this.committed.set(flown ? sample(curve, from, until) : null);
    this.rest.set(curve && until < endOf(curve) - 1e-6 ? sample(curve, until, endOf(curve)) : null);
    const stop = pair?.stop && curveOf(pair.stop);
    const stopPoints = stop && sample(stop);
    this.stop.set(stopPoints ?? null);
    this.stopEnd.visible = Boolean(stop);
    if (stop) this.stopEnd.position.set(...stopPoints.slice(-3));
    const guides = [];
    if (this.show.guides) for (const path of answer?.guide_paths ?? []) pieces(path.flat(), guides);
    this.guides.set(guides);
    const rounds = [];
    if (this.show.rounds) for (const round of attempt?.rounds ?? []) if (round !== attempt.rounds[attempt.best]) pieces(sample(curveOf(round.curve)), rounds);
    this.rounds.set(rounds);
    const shown = attempt ?? answer?.attempts?.at(-1);
    this.pairs.object.visible = this.show.pairs;
    this.pairs.set(this.show.pairs ? (roundOf(shown)?.pairs ?? []) : []);
    this.drawTube(this.show.tube && flown ? curve : null);
    this.drawUnseen(answer?.unseen_W);
  }

  drawTube(curve) {
    this.tube.visible = Boolean(curve);
    if (!curve) return;
    const points = sample(curve, curve.t0, endOf(curve), 2), places = [];
    for (let i = 0; i < points.length; i += 3) places.push(new Vector3(points[i], points[i + 1], points[i + 2]));
    this.tube.geometry.dispose();
    this.tube.geometry = new TubeGeometry(new CatmullRomCurve3(places), Math.min(4 * places.length, 160), this.hullRadius, 14);
  }

  drawUnseen(place) {
    const ends = [];
    if (place) {
      for (let axis = 0; axis < 3; ++axis) {
        for (const side of [-CROSS, CROSS]) ends.push(...place.map((x, k) => (k === axis ? x + side : x)));
      }
    }
    this.unseen.set(ends);
  }
}
