// SPDX-License-Identifier: BSD-3-Clause
// What stands still: ground, obstacles, zones of cost terms, and the prior map.
import {
  BoxGeometry, BufferAttribute, BufferGeometry, CanvasTexture, Color, CylinderGeometry, EdgesGeometry, Group, InstancedMesh,
  LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, PlaneGeometry, RepeatWrapping, SphereGeometry,
  SRGBColorSpace,
} from "three";
import { GREEN, PURPLE, YELLOW } from "./colours.js";

const BUILDING = "#CFC6B8", EDGE = "#7A7368", GROUND = "#F0F2EE", GRID = "#C3CAC2";
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

/** Ground and obstacles. */
export function makeWorld(obstacles, middle) {
  const group = new Group();
  const ground = new Mesh(new PlaneGeometry(EXTENT, EXTENT), new MeshLambertMaterial({ map: gridTexture() }));
  ground.position.set(Math.round(middle.x), Math.round(middle.y), -0.005);
  ground.receiveShadow = true;
  group.add(ground);
  const material = new MeshLambertMaterial({ color: BUILDING, transparent: true, opacity: 0.55 });
  const edges = new LineBasicMaterial({ color: EDGE });
  for (const obstacle of obstacles) {
    const geometry = geometryOf(obstacle);
    const mesh = new Mesh(geometry, material);
    if (obstacle.kind !== "mesh") {
      mesh.position.set(...obstacle.centre);
      mesh.rotation.z = obstacle.yaw ?? 0;
    }
    mesh.castShadow = mesh.receiveShadow = true;
    if (obstacle.kind === "box" && obstacles.length <= MOST_EDGES) mesh.add(new LineSegments(new EdgesGeometry(geometry), edges));
    group.add(mesh);
  }
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

const PRIOR = { occupied: ["#8C7BB5", 0.25], gone: [YELLOW, 0.7], new: [PURPLE, 0.7] };

/** Cubes of the prior map: occupied, seen free after all, and free in it but seen occupied. */
export function makePrior(prior, resolution) {
  const group = new Group();
  const matrix = new Matrix4();
  for (const [state, cubes] of Object.entries(prior)) {
    const [colour, opacity] = PRIOR[state];
    const material = new MeshLambertMaterial({ color: new Color(colour), transparent: true, opacity, depthWrite: opacity > 0.5 });
    const count = cubes.length / 4;
    const mesh = new InstancedMesh(new BoxGeometry(1, 1, 1), material, count);
    for (let i = 0; i < count; ++i) {
      const [x, y, z, side] = cubes.slice(4 * i, 4 * i + 4);
      const edge = side * resolution;
      matrix.makeScale(edge, edge, edge);
      matrix.setPosition((x + side / 2) * resolution, (y + side / 2) * resolution, (z + side / 2) * resolution);
      mesh.setMatrixAt(i, matrix);
    }
    mesh.frustumCulled = false;
    group.add(mesh);
  }
  return group;
}
