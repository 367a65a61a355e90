// SPDX-License-Identifier: BSD-3-Clause
// The map as the vehicle knew it: a window of cells that moves along, changed step by step.
import { BoxGeometry, DataTexture, DoubleSide, Group, InstancedMesh, Mesh, MeshBasicMaterial, MeshLambertMaterial, NearestFilter, PlaneGeometry } from "three";

const UNKNOWN = 0, FREE = 1, OCCUPIED = 2;
const EVERY = 50; // steps between kept windows
// What the layer at one height looks like: red, green, blue, opacity of 255.
const LOOKS = { [UNKNOWN]: [90, 90, 95, 90], [FREE]: [86, 180, 233, 70], [OCCUPIED]: [60, 30, 0, 230] };

const wrap = (i, n) => ((i % n) + n) % n;

/** The states of the window's cells at a step. A cell has its place by its index modulo the window's size. */
export class KnownCells {
  constructor(map) {
    this.map = map;
    this.size = map.size;
    this.states = new Uint8Array(map.size[0] * map.size[1] * map.size[2]);
    this.origin = [0, 0, 0];
    this.step = -1;
    this.kept = new Map();
  }

  slot(x, y, z) {
    const [nx, ny, nz] = this.size;
    return wrap(x, nx) + nx * (wrap(y, ny) + ny * wrap(z, nz));
  }

  at(x, y, z) {
    return this.states[this.slot(x, y, z)];
  }

  seek(step) {
    if (step === this.step) return;
    const kept = Math.floor(step / EVERY) * EVERY;
    if (step < this.step || this.step < kept) {
      const from = this.kept.get(kept);
      if (from) {
        this.states.set(from.states);
        this.origin = from.origin;
        this.step = kept;
      } else if (step < this.step) {
        this.states.fill(UNKNOWN);
        this.origin = [0, 0, 0];
        this.step = -1;
      }
    }
    while (this.step < step) this.advance();
  }

  advance() {
    const change = this.map.steps[++this.step];
    if (this.step > 0) this.forget(change.origin);
    this.origin = change.origin;
    const { runs } = change;
    for (let i = 0; i < runs.length; i += 5) {
      for (let k = 0; k < runs[i + 3]; ++k) this.states[this.slot(runs[i] + k, runs[i + 1], runs[i + 2])] = runs[i + 4];
    }
    if (this.step % EVERY === 0 && !this.kept.has(this.step)) {
      this.kept.set(this.step, { states: this.states.slice(), origin: this.origin });
    }
  }

  /** What leaves the window is unknown where it comes in again. */
  forget(next) {
    const [nx, ny, nz] = this.size;
    for (let axis = 0; axis < 3; ++axis) {
      const moved = next[axis] - this.origin[axis], n = this.size[axis];
      const first = moved > 0 ? this.origin[axis] : next[axis] + n;
      for (let i = 0; i < Math.min(Math.abs(moved), n); ++i) {
        const at = wrap(first + i, n);
        if (axis === 0) for (let j = at; j < this.states.length; j += nx) this.states[j] = UNKNOWN;
        if (axis === 1) for (let k = 0; k < nz; ++k) this.states.fill(UNKNOWN, nx * (at + ny * k), nx * (at + 1 + ny * k));
        if (axis === 2) this.states.fill(UNKNOWN, nx * ny * at, nx * ny * (at + 1));
      }
    }
  }
}

export class KnownMap {
  constructor(flight) {
    this.cells = new KnownCells(flight.document.map);
    this.resolution = flight.document.map.resolution;
    this.occupied = null;
    this.layer = this.makeLayer();
    this.object = new Group();
    this.object.add(this.layer);
    this.showOccupied = true;
    this.height = null; // of the layer [cell]
    this.drawn = -1;
  }

  makeLayer() {
    const [nx, ny] = this.cells.size;
    this.pixels = new Uint8Array(4 * nx * ny);
    this.texture = new DataTexture(this.pixels, nx, ny);
    this.texture.magFilter = this.texture.minFilter = NearestFilter;
    const material = new MeshBasicMaterial({ map: this.texture, transparent: true, side: DoubleSide, depthWrite: false });
    return new Mesh(new PlaneGeometry(nx * this.resolution, ny * this.resolution), material);
  }

  /** `z`: height of the layer [m]. */
  update(step, z, shown) {
    this.object.visible = shown && step >= 0;
    if (!this.object.visible) return;
    const height = Math.floor(z / this.resolution);
    const moved = step !== this.drawn;
    this.cells.seek(step);
    this.drawn = step;
    if (moved && this.showOccupied) this.drawOccupied();
    if (this.occupied) this.occupied.visible = this.showOccupied;
    if ((moved || height !== this.height) && this.layer.visible) this.drawLayer(height);
  }

  /** Redraw whatever was switched on. */
  touch() {
    this.drawn = -1;
    this.height = null;
  }

  drawOccupied() {
    const { states, size: [nx, ny], origin: [ox, oy, oz], size } = this.cells;
    const found = [];
    // Millions of cells, thousands of them occupied: places are worked out for these alone.
    for (let i = states.indexOf(OCCUPIED); i >= 0; i = states.indexOf(OCCUPIED, i + 1)) {
      const x = ox + wrap((i % nx) - ox, nx), y = oy + wrap((Math.floor(i / nx) % ny) - oy, ny), z = oz + wrap(Math.floor(i / (nx * ny)) - oz, size[2]);
      if (this.isSeen(x, y, z)) found.push(x, y, z);
    }
    const count = found.length / 3;
    if (!this.occupied || this.occupied.instanceMatrix.count < count) this.grow(count);
    const matrices = this.occupied.instanceMatrix.array, r = this.resolution;
    for (let i = 0; i < count; ++i) {
      matrices[16 * i + 12] = (found[3 * i] + 0.5) * r;
      matrices[16 * i + 13] = (found[3 * i + 1] + 0.5) * r;
      matrices[16 * i + 14] = (found[3 * i + 2] + 0.5) * r;
    }
    this.occupied.count = count;
    this.occupied.instanceMatrix.needsUpdate = true;
  }

  /** Not wholly among others. */
  isSeen(x, y, z) {
    const { cells } = this;
    return cells.at(x - 1, y, z) !== OCCUPIED || cells.at(x + 1, y, z) !== OCCUPIED || cells.at(x, y - 1, z) !== OCCUPIED ||
      cells.at(x, y + 1, z) !== OCCUPIED || cells.at(x, y, z - 1) !== OCCUPIED || cells.at(x, y, z + 1) !== OCCUPIED;
  }

  grow(count) {
    const room = Math.max(1024, 2 * count);
    const old = this.occupied;
    const edge = this.resolution * 0.96;
    this.occupied = new InstancedMesh(new BoxGeometry(edge, edge, edge), old?.material ?? new MeshLambertMaterial({ color: "#A6652B" }), room);
    const matrices = this.occupied.instanceMatrix.array;
    for (let i = 0; i < room; ++i) matrices[16 * i] = matrices[16 * i + 5] = matrices[16 * i + 10] = matrices[16 * i + 15] = 1;
    this.occupied.frustumCulled = false;
    this.object.add(this.occupied);
    if (old) {
      this.object.remove(old);
      old.geometry.dispose();
      old.dispose();
    }
  }

  drawLayer(height) {
    this.height = height;
    const { cells } = this, [nx, ny, nz] = cells.size, [ox, oy, oz] = cells.origin, r = this.resolution;
    const z = Math.min(Math.max(height, oz), oz + nz - 1);
    for (let j = 0; j < ny; ++j) {
      for (let i = 0; i < nx; ++i) this.pixels.set(LOOKS[cells.at(ox + i, oy + j, z)], 4 * (i + nx * j));
    }
    this.texture.needsUpdate = true;
    this.layer.position.set((ox + nx / 2) * r, (oy + ny / 2) * r, (z + 0.5) * r);
  }
}
