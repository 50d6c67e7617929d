// SPDX-License-Identifier: MIT
// Half sections of vessels, [r, y] in m: looked up, rounded where glass would be, and turned into surfaces of revolution.
import {BufferGeometry, Float32BufferAttribute} from './three.module.js';

export const GLASS_SAMPLES = 48;
const AROUND = 72;
const SHARP = Math.PI / 5;      // rad: a corner that turns further has an edge
const ROUNDING = 0.0022;        // m, of the edges of drawn glass

// The largest r at a height, or 0 outside.
export function radiusAt(section, y) {
  let found = 0;
  for (let k = 0; k + 1 < section.length; ++k) {
    const [[r0, y0], [r1, y1]] = [section[k], section[k + 1]];
    if (y < Math.min(y0, y1) || y > Math.max(y0, y1)) continue;
    found = Math.max(found, y0 === y1 ? Math.max(r0, r1) : r0 + (r1 - r0) * (y - y0) / (y1 - y0));
  }
  return found;
}

// Without the lid that closes a mouth.
export function open(section) {
  const last = section[section.length - 1];
  return last[0] < 1e-6 && section.length > 2 && last[1] > section[0][1] + 1e-6 ? section.slice(0, -1) : section;
}

// Radii at equal steps from the bottom to the top.
export function sample(section, count) {
  const low = section[0][1], high = section[section.length - 1][1];
  const samples = new Float32Array(count);
  const nudge = (high - low) * 1e-5;  // just above a flat floor, just below a flat lid
  for (let k = 0; k < count; ++k) samples[k] = radiusAt(section, Math.max(low + nudge, Math.min(high - nudge, low + (high - low) * k / (count - 1))));
  return {samples, low, high, height: high - low};
}

function turnAt(a, b, c) {
  const d = Math.atan2(c[1] - b[1], c[0] - b[0]) - Math.atan2(b[1] - a[1], b[0] - a[0]);
  return Math.abs(Math.atan2(Math.sin(d), Math.cos(d)));
}

// Sharp corners become arcs.
export function rounded(section, radius = ROUNDING) {
  const result = [section[0]];
  for (let k = 1; k + 1 < section.length; ++k) {
    const [a, b, c] = [section[k - 1], section[k], section[k + 1]];
    const turn = turnAt(a, b, c);
    if (turn < SHARP) {
      result.push(b);
      continue;
    }
    const before = Math.hypot(a[0] - b[0], a[1] - b[1]), after = Math.hypot(c[0] - b[0], c[1] - b[1]);
    const back = Math.min(radius * Math.tan(turn / 2), before * 0.49, after * 0.49);
    const start = b.map((v, i) => v + (a[i] - v) * back / before), end = b.map((v, i) => v + (c[i] - v) * back / after);
    for (let i = 0; i <= 6; ++i) {  // a parabola with these ends and this corner
      const t = i / 6;
      result.push(b.map((v, j) => (1 - t) * (1 - t) * start[j] + 2 * t * (1 - t) * v + t * t * end[j]));
    }
  }
  result.push(section[section.length - 1]);
  return result;
}

// Around the y axis. Normals point to the right of the section's way (outwards when it goes up the outside), or to its left.
export function revolve(section, toLeft = false) {
  const way = toLeft ? -1 : 1;
  const points = [];  // r, y, normal's r and y
  const normals = section.slice(1).map((b, k) => {
    const a = section[k], length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    return [way * (b[1] - a[1]) / length, -way * (b[0] - a[0]) / length];
  });
  section.forEach(([r, y], k) => {
    const before = normals[k - 1], after = normals[k];
    if (before && after && turnAt(section[k - 1], section[k], section[k + 1]) > SHARP) {
      points.push([r, y, ...before], [r, y, ...after]);
    } else {
      const sum = [0, 1].map((i) => (before ? before[i] : 0) + (after ? after[i] : 0));
      const length = Math.hypot(...sum) || 1;
      points.push([r, y, sum[0] / length, sum[1] / length]);
    }
  });
  const position = [], normal = [], index = [];
  for (let i = 0; i <= AROUND; ++i) {
    const c = Math.cos(2 * Math.PI * i / AROUND), s = Math.sin(2 * Math.PI * i / AROUND);
    for (const [r, y, nr, ny] of points) {
      position.push(r * c, y, r * s);
      normal.push(nr * c, ny, nr * s);
    }
  }
  const rows = points.length;
  for (let i = 0; i < AROUND; ++i) {
    for (let k = 0; k + 1 < rows; ++k) {
      const a = i * rows + k, b = a + rows;
      if (toLeft) index.push(a, b, a + 1, a + 1, b, b + 1);
      else index.push(a, a + 1, b, a + 1, b + 1, b);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(position, 3));
  geometry.setAttribute('normal', new Float32BufferAttribute(normal, 3));
  geometry.setIndex(index);
  return geometry;
}
