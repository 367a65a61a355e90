// SPDX-License-Identifier: BSD-3-Clause
// From where the scene is looked at: around it, from above, behind the vehicle.
import { Box3, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const FOV = 40;
const LOOKS = { orbit: [-0.5, -1, 0.85], top: [0, -0.0005, 1] }; // from the middle to the eye

export class Look {
  constructor(canvas) {
    this.camera = new PerspectiveCamera(FOV, 1, 0.05, 400);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = Math.PI / 2 - 0.02;
    this.controls.minDistance = 1;
    this.controls.maxDistance = 120;
    this.name = "orbit";
    this.last = new Vector3();
    this.box = new Box3();
  }

  /** All of these places are in the picture. */
  frame(places) {
    this.box.makeEmpty();
    for (const place of places) this.box.expandByPoint(new Vector3(...place));
    this.choose(this.name === "follow" ? "orbit" : this.name, null);
  }

  choose(name, body) {
    this.name = name;
    if (name === "follow") {
      const back = new Vector3(-1, 0, 0).applyQuaternion(body.quaternion).setZ(0).normalize();
      this.last.copy(body.position);
      this.controls.target.copy(body.position);
      this.camera.position.copy(body.position).addScaledVector(back, 4).add(new Vector3(0, 0, 1.7));
    } else {
      const middle = this.box.getCenter(new Vector3()), along = new Vector3(...LOOKS[name]).normalize();
      this.controls.target.copy(middle);
      this.camera.position.copy(middle).add(along);
      this.camera.lookAt(middle);
      this.camera.position.addScaledVector(along, this.distance(middle));
    }
    this.controls.update();
  }

  /** At which every corner of the box is within the picture. */
  distance(middle) {
    const { min, max } = this.box, half = Math.tan((FOV * Math.PI) / 360) * 0.86, corner = new Vector3();
    const turned = this.camera.quaternion.clone().invert();
    let most = 3;
    for (let i = 0; i < 8; ++i) {
      corner.set(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z).sub(middle).applyQuaternion(turned);
      most = Math.max(most, corner.z + Math.abs(corner.y) / half, corner.z + Math.abs(corner.x) / (half * this.camera.aspect));
    }
    return most;
  }

  resize(aspect) {
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
  }

  /** In the view `follow` the eye goes along with the vehicle. */
  update(place) {
    if (this.name !== "follow") return;
    const moved = place.clone().sub(this.last);
    this.camera.position.add(moved);
    this.controls.target.add(moved);
    this.last.copy(place);
    this.controls.update();
  }
}
