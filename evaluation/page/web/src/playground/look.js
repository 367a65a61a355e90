// SPDX-License-Identifier: BSD-3-Clause
// From where the scene is looked at: around it, from above, behind the vehicle.
import { Box3, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const FOV = 40;
const WIDE = 0.92, HIGH = 0.76, NEAREST = 4; // shares of the picture that are filled: buttons lie over some of it; distance [m]
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
    this.places = [new Vector3()];
  }

  /** All of these places are in the picture. */
  frame(places) {
    this.places = places.map((place) => new Vector3(...place));
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
      this.controls.target.copy(new Box3().setFromPoints(this.places).getCenter(new Vector3()));
      this.camera.position.copy(this.controls.target).addScaledVector(new Vector3(...LOOKS[name]).normalize(), 20);
      this.camera.lookAt(this.controls.target);
      for (let i = 0; i < 4; ++i) this.fit();
    }
    this.controls.update();
  }

  /** Moves the eye sideways until the places are in the middle of the picture, and on until they fill it. */
  fit() {
    const { camera, controls: { target } } = this;
    camera.updateMatrixWorld();
    const seen = new Box3().setFromPoints(this.places.map((place) => place.clone().project(camera)));
    const middle = seen.getCenter(new Vector3()), half = seen.getSize(new Vector3()).multiplyScalar(0.5);
    const distance = camera.position.distanceTo(target), high = distance * Math.tan((FOV * Math.PI) / 360);
    const shift = new Vector3(middle.x * high * camera.aspect, middle.y * high, 0).applyQuaternion(camera.quaternion);
    target.add(shift);
    camera.position.add(shift);
    const wanted = Math.max(distance * Math.max(half.x / WIDE, half.y / HIGH), NEAREST);
    camera.position.copy(target).add(new Vector3(0, 0, wanted).applyQuaternion(camera.quaternion));
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
