// SPDX-License-Identifier: MIT
// Surfaces from meshes: smooth where neighbors lie almost in one plane, with an edge where they do not.
import {BufferAttribute, BufferGeometry} from './three.module.js';

const CREASE = Math.cos(35 * Math.PI / 180);

// `places`: x, y, z of each vertex; `corners`: three vertices of each triangle.
export function creased(places, corners) {
  const triangles = corners.length / 3, ways = new Float32Array(corners.length);  // of each triangle, as long as twice its area
  const around = Array.from({length: places.length / 3}, () => []);
  for (let t = 0; t < triangles; ++t) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * corners[3 * t + k]);
    for (let i = 0; i < 3; ++i) {
      const [j, k] = [(i + 1) % 3, (i + 2) % 3];
      ways[3 * t + i] = (places[b + j] - places[a + j]) * (places[c + k] - places[a + k]) - (places[b + k] - places[a + k]) * (places[c + j] - places[a + j]);
    }
    for (let k = 0; k < 3; ++k) around[corners[3 * t + k]].push(t);
  }
  const length = (t) => Math.hypot(ways[3 * t], ways[3 * t + 1], ways[3 * t + 2]) || 1;
  const position = new Float32Array(9 * triangles), normal = new Float32Array(9 * triangles);
  for (let t = 0; t < triangles; ++t) {
    for (let k = 0; k < 3; ++k) {
      const vertex = corners[3 * t + k], sum = [0, 0, 0];
      for (const other of around[vertex]) {
        const along = [0, 1, 2].reduce((total, i) => total + ways[3 * t + i] * ways[3 * other + i], 0) / length(t) / length(other);
        if (along >= CREASE) for (let i = 0; i < 3; ++i) sum[i] += ways[3 * other + i];
      }
      const size = Math.hypot(...sum) || 1;
      for (let i = 0; i < 3; ++i) {
        position[9 * t + 3 * k + i] = places[3 * vertex + i];
        normal[9 * t + 3 * k + i] = sum[i] / size;
      }
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(position, 3));
  geometry.setAttribute('normal', new BufferAttribute(normal, 3));
  return geometry;
}
