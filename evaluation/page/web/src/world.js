// SPDX-License-Identifier: BSD-3-Clause
// What stands still: ground, obstacles, zones of cost terms, and the prior map.
import {
  BoxGeometry, BufferAttribute, BufferGeometry, CanvasTexture, Color, CylinderGeometry, EdgesGeometry, Group, InstancedMesh,
  LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, PlaneGeometry, RepeatWrapping, SphereGeometry,
  SRGBColorSpace,
} from "three";
import { GREEN, PURPLE, VERMILLION, YELLOW } from "./colours.js";

const BUILDING = "#C4BAAA", EDGE = "#7A7368", GROUND = "#F0F2EE", GRID = "#C3CAC2";
const EXTENT = 400; // of the ground, a whole and even number [m]
const MOST_EDGES = 800; // obstacles whose edges are drawn

function geometryOf(obstacle) {
  const [x, y, z] = obstacle.size;
  switch (obstacle.kind) {
    case "box":
      return new BoxGeometry(x, y, z);
    case "sphere":
      return new SphereGeometry(x / 2, 24, 16);
    case "cylinder":
      return new CylinderGeometry(x / 2, x / 2, z, 32).rotateX(Math.PI / 2);
    default:
      return surfaceOf(obstacle.surface);
  }
}

export function surfaceOf({ corners, triangles }) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(corners), 3));
  geometry.setIndex(new BufferAttribute(new Uint32Array(triangles), 1));
  const flat = geometry.toNonIndexed();
  flat.computeVertexNormals();
  return flat;
}

/** A square of one metre with lines around it, over and over. */
function gridTexture() {
  const texels = 128;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = texels;
  const pen = canvas.getContext("2d");
  pen.fillStyle = GROUND;
  pen.fillRect(0, 0, texels, texels);
  pen.fillStyle = GRID;
  pen.fillRect(0, 0, texels, 2);
  pen.fillRect(0, 0, 2, texels);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.repeat.set(EXTENT, EXTENT);
  texture.anisotropy = 8;
  return texture;
}

/** A plane with a line at every metre. */
export function makeGround(middle) {
  const ground = new Mesh(new PlaneGeometry(EXTENT, EXTENT), new MeshLambertMaterial({ map: gridTexture() }));
  ground.position.set(Math.round(middle.x), Math.round(middle.y), -0.005);
  ground.receiveShadow = true;
  return ground;
}

export function obstacleMaterials() {
  return { faces: new MeshLambertMaterial({ color: BUILDING, transparent: true, opacity: 0.55 }), edges: new LineBasicMaterial({ color: EDGE }) };
}

/** `drawsEdges`: of boxes. */
export function makeObstacle(obstacle, { faces, edges }, drawsEdges) {
  const geometry = geometryOf(obstacle);
  const mesh = new Mesh(geometry, faces);
  if (obstacle.kind !== "mesh") {
    mesh.position.set(...obstacle.centre);
    mesh.rotation.z = obstacle.yaw ?? 0;
  }
  mesh.castShadow = mesh.receiveShadow = true;
  if (obstacle.kind === "box" && drawsEdges) mesh.add(new LineSegments(new EdgesGeometry(geometry), edges));
  return mesh;
}

/** Ground and obstacles. */
export function makeWorld(obstacles, middle) {
  const group = new Group();
  group.add(makeGround(middle));
  const materials = obstacleMaterials();
  for (const obstacle of obstacles) group.add(makeObstacle(obstacle, materials, obstacles.length <= MOST_EDGES));
  return group;
}

/** Where cost terms act: green wire, filled a little. */
export function makeZones(zones) {
  const group = new Group();
  for (const zone of zones) {
    const geometry = geometryOf({ ...zone, kind: zone.shape });
    const mesh = new Mesh(geometry, new MeshBasicMaterial({ color: GREEN, transparent: true, opacity: 0.12, depthWrite: false }));
    mesh.position.set(...zone.centre);
    mesh.add(new LineSegments(new EdgesGeometry(geometry, 30), new LineBasicMaterial({ color: GREEN })));
    mesh.userData.name = zone.term;
    group.add(mesh);
  }
  return group;
}

const PRIOR = { occupied: ["#8C7BB5", 0.25], gone: [YELLOW, 0.5], new: [PURPLE, 0.6] };
const FREE = 1, OCCUPIED = 2; // states of map_change

const keyOf = (x, y, z) => (x + 8192) + 16384 * ((y + 8192) + 16384 * (z + 8192));

/** The step in which each of these cells first had the state; those that never had one are not in it. */
function firstSteps(cubes, state, steps) {
  const wanted = new Map();
  for (let i = 0; i < cubes.length; i += 4) wanted.set(keyOf(cubes[i], cubes[i + 1], cubes[i + 2]), Infinity);
  steps.forEach(({ runs }, step) => {
    for (let i = 0; i < runs.length; i += 5) {
      if (runs[i + 4] !== state) continue;
      for (let k = 0; k < runs[i + 3]; ++k) {
        const key = keyOf(runs[i] + k, runs[i + 1], runs[i + 2]);
        if (wanted.get(key) === Infinity) wanted.set(key, step);
      }
    }
  });
  return wanted;
}

/** Cubes of the prior map: what it holds occupied; from when it was seen on, what of it is free, and what is occupied that it
 * holds free. */
export class Prior {
  constructor(prior, map) {
    this.object = new Group();
    this.turned = [];
    for (const [state, cubes] of Object.entries(prior)) {
      const places = [];
      for (let i = 0; i < cubes.length; i += 4) places.push(cubes.slice(i, i + 4));
      let steps = null;
      if (state !== "occupied") {
        const first = firstSteps(cubes, state === "gone" ? FREE : OCCUPIED, map.steps);
        const when = ([x, y, z]) => first.get(keyOf(x, y, z));
        places.sort((a, b) => when(a) - when(b) || 0);
        steps = places.map(when);
      }
      const mesh = this.cubes(places, state, map.resolution);
      if (steps) this.turned.push({ mesh, steps });
      this.object.add(mesh);
    }
  }

  cubes(places, state, resolution) {
    const [colour, opacity] = PRIOR[state];
    const material = new MeshLambertMaterial({ color: new Color(colour), transparent: true, opacity, depthWrite: state === "new" });
    const mesh = new InstancedMesh(new BoxGeometry(1, 1, 1), material, places.length);
    const matrix = new Matrix4();
    const grown = state === "occupied" ? 1 : 1.06; // what turned out is around what was held
    places.forEach(([x, y, z, side], i) => {
      const edge = side * resolution * grown;
      matrix.makeScale(edge, edge, edge);
      matrix.setPosition((x + side / 2) * resolution, (y + side / 2) * resolution, (z + side / 2) * resolution);
      mesh.setMatrixAt(i, matrix);
    });
    mesh.frustumCulled = false;
    return mesh;
  }

  update(step) {
    for (const { mesh, steps } of this.turned) {
      let count = 0;
      while (count < steps.length && steps[count] <= step) ++count;
      mesh.count = count;
    }
  }
}

/** The narrowest place of the widest way, as a ball of that width, of a vehicle that knows no way; nothing of another. */
export function makeNarrow(no_way) {
  const narrow = new Group();
  if (!no_way?.narrowest) return narrow;
  const { position_m, width_m } = no_way.narrowest;
  const ball = new Mesh(new SphereGeometry(width_m / 2, 24, 16), new MeshLambertMaterial({ color: VERMILLION, transparent: true, opacity: 0.6 }));
  ball.position.set(...position_m);
  return narrow.add(ball);
}

/** Where a flight of the task go_to leads. */
export function makeGoal() {
  const goal = new Mesh(new SphereGeometry(0.2, 24, 16), new MeshLambertMaterial({ color: GREEN }));
  goal.castShadow = true;
  return goal;
}
