// SPDX-License-Identifier: BSD-3-Clause
// The occupied cells of the map, as they come and go.
import { BoxGeometry, InstancedMesh, Matrix4, MeshLambertMaterial } from "three";

const ROOM = 4096;

/** Cells by their centres, in a list without holes: the last one takes the place of one that goes. */
export class CellList {
  constructor() {
    this.places = [];
    this.slots = new Map();
  }
  static key = (x, y, z) => `${Math.round(100 * x)},${Math.round(100 * y)},${Math.round(100 * z)}`;
  get size() {
    return this.slots.size;
  }
  add(x, y, z) {
    const key = CellList.key(x, y, z);
    if (this.slots.has(key)) return;
    this.slots.set(key, this.slots.size);
    this.places.push(x, y, z);
  }
  remove(x, y, z) {
    const key = CellList.key(x, y, z), slot = this.slots.get(key);
    if (slot === undefined) return;
    this.slots.delete(key);
    const last = this.places.splice(-3);
    if (slot === this.slots.size) return;
    this.places.splice(3 * slot, 3, ...last);
    this.slots.set(CellList.key(...last), slot);
  }
  change({ added, removed }) {
    for (let i = 0; i + 2 < removed.length; i += 3) this.remove(removed[i], removed[i + 1], removed[i + 2]);
    for (let i = 0; i + 2 < added.length; i += 3) this.add(added[i], added[i + 1], added[i + 2]);
  }
}

export class Seen {
  constructor(resolution) {
    this.edge = 0.96 * resolution;
    this.clear();
    this.make(ROOM);
  }

  make(room) {
    this.object?.dispose();
    const parent = this.object?.parent, visible = this.object?.visible ?? true;
    this.object?.removeFromParent();
    this.object = new InstancedMesh(new BoxGeometry(this.edge, this.edge, this.edge), new MeshLambertMaterial({ color: "#A6652B" }), room);
    this.object.frustumCulled = false;
    this.object.count = 0;
    this.object.visible = visible;
    const matrix = new Matrix4();
    for (let i = 0; i < room; ++i) this.object.setMatrixAt(i, matrix);
    parent?.add(this.object);
  }

  clear() {
    this.cells = new CellList();
    if (this.object) this.object.count = 0;
  }

  change(change) {
    if (change.added.length + change.removed.length === 0) return;
    this.cells.change(change);
    const { places, size } = this.cells;
    if (size > this.object.instanceMatrix.count) this.make(2 * size);
    const matrices = this.object.instanceMatrix.array;
    for (let i = 0; i < size; ++i) {
      matrices[16 * i + 12] = places[3 * i];
      matrices[16 * i + 13] = places[3 * i + 1];
      matrices[16 * i + 14] = places[3 * i + 2];
    }
    this.object.count = size;
    this.object.instanceMatrix.needsUpdate = true;
  }
}
