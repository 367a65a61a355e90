// SPDX-License-Identifier: BSD-3-Clause
// The vehicle from its own geoms, its rotors' thrusts, its cameras' frusta, the wind at it.
import {
  BoxGeometry, CapsuleGeometry, CircleGeometry, Color, CylinderGeometry, Group, Mesh, MeshBasicMaterial, MeshStandardMaterial,
  Quaternion, SphereGeometry, Vector3, DoubleSide,
} from "three";
import { BLACK, GREEN, ORANGE, PURPLE, SKY } from "./colours.js";
import { Arrow, Strokes, Way } from "./lines.js";
import { surfaceOf } from "./world.js";

const THRUST = 0.06; // length of a thrust's arrow [m/N], so that hover is about 0.2 m ...
const MOST_THRUST = 0.5; // ... and the greatest no more than [m]
const WIND = 0.25; // of the wind's [m per m/s]

function geometryOf(shape) {
  const [x, y, z] = shape.size;
  switch (shape.kind) {
    case "sphere":
      return new SphereGeometry(x, 16, 12);
    case "capsule":
      return new CapsuleGeometry(x, 2 * y, 6, 12).rotateX(Math.PI / 2);
    case "ellipsoid":
      return new SphereGeometry(1, 20, 14).scale(x, y, z);
    case "cylinder":
      return new CylinderGeometry(x, x, 2 * y, 28).rotateX(Math.PI / 2);
    case "box":
      return new BoxGeometry(2 * x, 2 * y, 2 * z);
    default:
      return surfaceOf(shape);
  }
}

function meshOf(shape) {
  const [r, g, b, a] = shape.rgba;
  const material = new MeshStandardMaterial({ color: new Color().setRGB(r, g, b, "srgb"), roughness: 0.6, metalness: 0.1 });
  if (a < 1) Object.assign(material, { transparent: true, opacity: a });
  const mesh = new Mesh(geometryOf(shape), material);
  mesh.position.set(...shape.p);
  mesh.quaternion.set(...shape.q);
  mesh.castShadow = true;
  return mesh;
}

/** A camera's pyramid, from its place out to its range. */
export function frustumOf(camera) {
  const [x, y] = camera.slope;
  // The range is along the ray: the corners are no farther than what is ahead.
  const far = camera.range / Math.hypot(1, x, y);
  const strokes = new Strokes(camera.name === "depth" ? SKY : PURPLE, 1.2, { opacity: 0.8 });
  const corners = [[-x, -y], [x, -y], [x, y], [-x, y]].map(([u, v]) => [u * far, v * far, far]);
  const ends = [];
  corners.forEach((corner, i) => ends.push(0, 0, 0, ...corner, ...corner, ...corners[(i + 1) % 4]));
  strokes.set(ends);
  const frustum = new Group();
  frustum.position.set(...camera.p);
  frustum.quaternion.set(...camera.q);
  frustum.add(strokes.object);
  return frustum;
}

export class Vehicle {
  constructor(flight, colour) {
    this.flight = flight;
    this.body = new Group();
    const { shapes, rotors, rotor_radius, cameras } = flight.document.vehicle;
    for (const shape of shapes) this.body.add(meshOf(shape));
    // The discs tell the flight: with two of them the colour is that of the flight's path.
    const disc = new MeshBasicMaterial({ color: colour, transparent: true, opacity: 0.35, side: DoubleSide, depthWrite: false });
    this.thrusts = rotors.map((rotor) => {
      if (!rotor.lifts) return null;
      const mesh = new Mesh(new CircleGeometry(rotor_radius, 32), disc);
      mesh.position.set(...rotor.p);
      const arrow = new Arrow(ORANGE);
      this.body.add(mesh, arrow.object);
      return arrow;
    });
    this.scale = Math.min(THRUST, MOST_THRUST / Math.max(...rotors.map((rotor) => (rotor.lifts ? rotor.max : 0)), 1e-6));
    this.frusta = new Group();
    for (const camera of cameras) this.frusta.add(frustumOf(camera));
    this.body.add(this.frusta);
    this.wind = new Arrow(GREEN);
    // Its estimated position, tied to the true one.
    this.belief = new Strokes(BLACK, 2);
    this.tie = new Way(BLACK, 1);
    this.object = new Group();
    this.object.add(this.body, this.wind.object, this.belief.object, this.tie.object);
    this.show = { thrusts: true, wind: true, cameras: true, belief: true };
  }

  /** `onBoard`: it is looked at from within, where its cameras do not see it. */
  update(t, onBoard) {
    const { flight } = this;
    this.body.visible = !onBoard;
    this.frusta.visible = this.show.cameras;
    flight.vehicleAt(t, this.body.position);
    flight.attitudeAt(t, this.body.quaternion);
    const row = flight.row(t);
    const { rotors } = flight.document.vehicle;
    this.thrusts.forEach((arrow, i) => {
      if (!arrow) return;
      arrow.set(new Vector3(...rotors[i].p), new Vector3(0, 0, this.show.thrusts ? (flight.rotors[i][row] ?? 0) : 0), this.scale);
    });
    const { vx, vy, vz } = flight.document.samples.air;
    const air = this.show.wind ? new Vector3(vx[row], vy[row], vz[row]) : new Vector3();
    this.drawBelief(t, onBoard);
    // It ends at the vehicle: that is where it blows.
    this.wind.set(this.body.position.clone().addScaledVector(air, -WIND).add(new Vector3(0, 0, 0.3)), air, WIND);
  }

  drawBelief(t, onBoard) {
    const { flight } = this, place = new Vector3();
    const shown = this.show.belief && !onBoard && flight.estimates && flight.placeAt(flight.document.samples.believed, t, place);
    if (!shown) {
      this.belief.set([]);
      this.tie.set(null);
      return;
    }
    const { x, y, z } = place, d = 0.3, p = this.body.position;
    this.belief.set([x - d, y, z, x + d, y, z, x, y - d, z, x, y + d, z, x, y, z - d, x, y, z + d]);
    this.tie.set([x, y, z, p.x, p.y, p.z]);
  }

  /** Where a camera is and looks: three's looks along -z with y up, ours along z with y down. */
  cameraPose(name, position, quaternion) {
    const camera = this.flight.document.vehicle.cameras.find((c) => c.name === name);
    position.set(...camera.p).applyQuaternion(this.body.quaternion).add(this.body.position);
    quaternion.copy(this.body.quaternion).multiply(new Quaternion(...camera.q)).multiply(new Quaternion(1, 0, 0, 0));
    return camera;
  }
}
