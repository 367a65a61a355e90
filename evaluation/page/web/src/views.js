// SPDX-License-Identifier: BSD-3-Clause
// From where it is looked at: free, along with the vehicle, from above, through the vehicle's own cameras.
import { Box3, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

export const VIEWS = ["orbit", "follow", "top", "depth camera", "downward camera"];
const FOV = 50;

/** What holds the ways of vehicles and pads, and where the first vehicle's leads. */
function wayOf(flights) {
  const box = new Box3(), p = new Vector3();
  for (const { document } of flights) {
    for (const table of [document.samples.vehicle, document.samples.pad]) {
      for (let i = 0; i < table.t.length; i += 10) box.expandByPoint(p.set(table.px[i], table.py[i], table.pz[i]));
    }
  }
  const [first] = flights;
  return { box, along: first.vehicleAt(first.end, new Vector3()).sub(first.vehicleAt(first.begin)).setZ(0) };
}

export class Views {
  constructor(canvas, flights) {
    this.camera = new PerspectiveCamera(FOV, 1, 0.05, 500);
    this.camera.up.set(0, 0, 1); // the controls look at it here, once
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.maxPolarAngle = Math.PI / 2 - 0.01;
    this.name = "orbit";
    this.last = new Vector3();
    this.home = wayOf(flights);
    this.reset();
  }

  /** All of the ways flown and driven are in the picture, seen across the way to the pad. */
  reset() {
    const { box, along } = this.home;
    const middle = box.getCenter(new Vector3()), radius = Math.max(box.getSize(new Vector3()).length() / 2, 3);
    const across = along.length() > 0.1 ? new Vector3(along.y, -along.x, 0).normalize() : new Vector3(0, -1, 0);
    this.controls.target.copy(middle);
    this.camera.fov = FOV;
    this.camera.position.copy(middle).addScaledVector(across, 1.75 * radius).add(new Vector3(0, 0, 1.5 * radius));
    this.controls.update();
  }

  choose(name, vehicle) {
    const body = vehicle.body.position;
    const wasOnBoard = this.onBoard;
    this.name = name;
    this.camera.fov = FOV;
    if (name === "orbit" && wasOnBoard) this.reset();
    if (name === "follow") {
      const back = new Vector3(-1, 0, 0).applyQuaternion(vehicle.body.quaternion).setZ(0).normalize();
      this.controls.target.copy(body);
      this.camera.position.copy(body).addScaledVector(back, 3.5).add(new Vector3(0, 0, 4));
    }
    if (name === "top") {
      this.controls.target.copy(body).setZ(0);
      this.camera.position.copy(body).add(new Vector3(0, -0.01, 16));
    }
    this.last.copy(body);
    this.controls.enabled = !this.onBoard;
  }

  get onBoard() {
    return this.name.endsWith("camera");
  }

  update(vehicle, aspect) {
    this.camera.aspect = aspect;
    if (this.onBoard) {
      const { slope } = vehicle.cameraPose(this.name.split(" ")[0], this.camera.position, this.camera.quaternion);
      // All of the image is in the picture, whose sides are others.
      this.camera.fov = (2 * Math.atan(Math.max(slope[1], slope[0] / aspect)) * 180) / Math.PI;
    } else {
      if (this.name !== "orbit") {
        const moved = vehicle.body.position.clone().sub(this.last);
        this.camera.position.add(moved);
        this.controls.target.add(moved);
        this.last.copy(vehicle.body.position);
      }
      this.controls.update();
    }
    this.camera.updateProjectionMatrix();
  }
}
