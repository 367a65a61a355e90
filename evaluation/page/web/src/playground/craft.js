// SPDX-License-Identifier: BSD-3-Clause
// A quadrotor to look at: the planner knows it as a ball, its hull.
import {
  BoxGeometry, CircleGeometry, CylinderGeometry, DoubleSide, Group, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial,
  MeshStandardMaterial, Quaternion, SphereGeometry, TorusGeometry, Vector3,
} from "three";
import { BLUE, ORANGE, SKY } from "../colours.js";
import { frustumOf } from "../vehicle.js";

const ROTOR = 0.115, ARM = 0.17; // radius, and from the middle to its axis [m]

const looks = (color) => new MeshStandardMaterial({ color, roughness: 0.5, metalness: 0.15 });

function makeBody(footDepth) {
  const body = new Group();
  const dark = looks("#2B3038"), front = looks(ORANGE);
  const place = (mesh, x, y, z) => {
    mesh.position.set(x, y, z);
    mesh.castShadow = true;
    body.add(mesh);
    return mesh;
  };
  place(new Mesh(new SphereGeometry(1, 24, 16).scale(0.11, 0.08, 0.045), dark), 0, 0, 0);
  place(new Mesh(new SphereGeometry(0.022, 16, 12), front), 0.1, 0, 0);
  const disc = new MeshBasicMaterial({ color: BLUE, transparent: true, opacity: 0.3, side: DoubleSide, depthWrite: false });
  for (const [sx, sy] of [[1, 1], [-1, 1], [-1, -1], [1, -1]]) {
    const x = (sx * ARM) / Math.SQRT2, y = (sy * ARM) / Math.SQRT2;
    const arm = place(new Mesh(new BoxGeometry(ARM, 0.022, 0.018), dark), x / 2, y / 2, 0);
    arm.rotation.z = Math.atan2(y, x);
    place(new Mesh(new CylinderGeometry(0.018, 0.022, 0.05, 16).rotateX(Math.PI / 2), dark), x, y, 0.012);
    // Which way it faces is told by the rotors in front, too.
    place(new Mesh(new TorusGeometry(ROTOR, 0.006, 8, 40), sx > 0 ? front : dark), x, y, 0.04);
    place(new Mesh(new CircleGeometry(ROTOR, 32), disc), x, y, 0.04).castShadow = false;
    const foot = place(new Mesh(new CylinderGeometry(0.007, 0.007, footDepth, 8).rotateX(Math.PI / 2), dark), 0.6 * x, 0.6 * y, -footDepth / 2);
    foot.castShadow = true;
  }
  return body;
}

/** The depth camera looks ahead: its z is the body's x, its x the body's -y. */
const AHEAD = new Quaternion().setFromRotationMatrix(
  new Matrix4().makeBasis(new Vector3(0, -1, 0), new Vector3(0, 0, -1), new Vector3(1, 0, 0)),
);

export class Craft {
  constructor({ hull_radius, foot_depth, camera }) {
    this.body = makeBody(foot_depth);
    const slope = Math.tan((camera.fov_x_deg * Math.PI) / 360);
    this.hull = new Mesh(new SphereGeometry(hull_radius, 32, 20), new MeshLambertMaterial({ color: SKY, transparent: true, opacity: 0.22, depthWrite: false }));
    this.cone = frustumOf({
      name: "depth", slope: [slope, slope / camera.aspect], range: camera.range, p: [0, 0, 0], q: AHEAD.toArray(),
    });
    // Its visibility is that of the layer; the group's is that of the moment.
    this.sight = new Group();
    this.sight.add(this.cone);
    this.object = new Group();
    this.body.add(this.sight);
    this.object.add(this.body, this.hull);
  }

  /** `q`: w x y z. */
  set(p, q = [1, 0, 0, 0]) {
    this.object.position.set(...p);
    this.body.quaternion.set(q[1], q[2], q[3], q[0]);
  }

  /** Whether what the camera sees matters now. */
  looks(on) {
    this.sight.visible = on;
  }
}
