// SPDX-License-Identifier: MIT
// The hand's surface: balls about the joints, the rounded cones between them that touch both balls, and the skin of the palm over the
// balls in it. All of it is written once in terms of which balls a vertex belongs to; the shader gets where the balls are, so
// that a moving hand costs a few numbers a picture.
import {BufferGeometry, Float32BufferAttribute} from './three.module.js';

export const JOINTS = 24;
// Balls beyond the joints: both sides of the wrist and of the forearm's end, the web of the thumb and those between the fingers.
export const WRIST_THUMB = 24, WRIST_LITTLE = 25, ARM_THUMB = 26, ARM_LITTLE = 27, WEB = 28, WEBS = 29;
export const BALLS = 32;

const THUMB = 0;                                  // its metacarpal; the others' follow
const FINGERS = [4, 9, 14, 19];                   // index, middle, ring, little
const AROUND = 18, OVER = 4, PALM_STEPS = 5, ARM_STEPS = 6;      // facets of a cone around and over each end, steps of a flat piece
const CONE_START = 0, CONE_END = 1, FLAT = 2, FLAT_BACK = 3, ARM = 4;  // what the shader reads in `balls.w`

// Where a cone is seen: the fingers' bones, and the rim of the palm.
function edges(parents) {
  const inner = FINGERS.slice(1, 3);  // of their metacarpals the palm's skin is all that is seen
  const bones = parents.map((parent, joint) => [parent, joint]).filter(([parent]) => parent >= 0 && !inner.includes(parent));
  const forks = [0, 1, 2].flatMap((f) => [[FINGERS[f] + 1, WEBS + f], [WEBS + f, FINGERS[f + 1] + 1]]);
  return [...bones, ...forks, [WRIST_THUMB, WRIST_LITTLE], [WRIST_THUMB, THUMB], [WRIST_LITTLE, FINGERS[3]],
    [WRIST_THUMB, FINGERS[0]], [THUMB, FINGERS[0]], [THUMB, WEB], [THUMB + 1, WEB]];
}

// The skin of the palm, as triangles of balls, all the same way round.
export function flats() {
  const pieces = [];
  for (let f = 0; f < 3; ++f) {
    const [a, b] = [FINGERS[f], FINGERS[f + 1]];
    pieces.push([a, a + 1, b], [b, a + 1, b + 1], [a + 1, WEBS + f, b + 1]);
  }
  pieces.push([WRIST_THUMB, THUMB, FINGERS[0]], [WRIST_THUMB, FINGERS[0], FINGERS[1]], [WRIST_THUMB, FINGERS[1], WRIST_LITTLE],
    [WRIST_LITTLE, FINGERS[1], FINGERS[2]], [WRIST_LITTLE, FINGERS[2], FINGERS[3]], [THUMB, WEB, FINGERS[0]], [THUMB, THUMB + 1, WEB]);
  return pieces;
}

// `position`: of a cone the turn about it as (cos, sin) and how far over its end, 0 to 1; of a flat piece the shares of its three balls; of the
// forearm, which is one piece so that it can fade without showing its inside, the turn and how far along.
function surface(parents) {
  const position = [], balls = [], index = [];
  const grid = (first, rows, columns) => {
    for (let row = 0; row + 1 < rows; ++row) {
      for (let k = 0; k + 1 < columns; ++k) {
        const a = first + row * columns + k, b = a + columns;
        index.push(a, a + 1, b, a + 1, b + 1, b);
      }
    }
  };
  for (const [a, b] of edges(parents)) {
    const first = balls.length / 4;
    for (let row = 0; row < 2 * (OVER + 1); ++row) {
      const end = row > OVER ? CONE_END : CONE_START;
      for (let k = 0; k <= AROUND; ++k) {
        const turn = 2 * Math.PI * k / AROUND;
        position.push(Math.cos(turn), Math.sin(turn), (row % (OVER + 1)) / OVER);
        balls.push(a, b, 0, end);
      }
    }
    grid(first, 2 * (OVER + 1), AROUND + 1);
  }
  for (const [a, b, c] of flats()) {
    for (const side of [FLAT, FLAT_BACK]) {
      const first = balls.length / 4, at = (i, j) => first + i * (i + 1) / 2 + j;
      for (let i = 0; i <= PALM_STEPS; ++i) {
        for (let j = 0; j <= i; ++j) {
          position.push(1 - i / PALM_STEPS, (i - j) / PALM_STEPS, j / PALM_STEPS);
          balls.push(a, b, c, side);
        }
      }
      const face = (u, v, w) => (side === FLAT ? index.push(u, v, w) : index.push(u, w, v));
      for (let i = 0; i < PALM_STEPS; ++i) {
        for (let j = 0; j <= i; ++j) {
          face(at(i, j), at(i + 1, j), at(i + 1, j + 1));
          if (j < i) face(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
      }
    }
  }
  const first = balls.length / 4;
  for (let row = 0; row <= ARM_STEPS; ++row) {
    for (let k = 0; k <= 2 * AROUND; ++k) {
      const turn = Math.PI * k / AROUND, c = Math.cos(turn);
      position.push(c, Math.sin(turn), row / ARM_STEPS);
      balls.push(...(c < 0 ? [WRIST_THUMB, ARM_THUMB] : [WRIST_LITTLE, ARM_LITTLE]), 0, ARM);
    }
  }
  grid(first, ARM_STEPS + 1, 2 * AROUND + 1);
  return {position, balls, index};
}

export function handGeometry(parents) {
  const {position, balls, index} = surface(parents);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(position, 3));
  geometry.setAttribute('normal', new Float32BufferAttribute(position.map(() => 0), 3));
  geometry.setAttribute('balls', new Float32BufferAttribute(balls, 4));
  geometry.setIndex(index);
  return geometry;
}

// Where a vertex is. `hand_place` gives its place and normal in the world frame, with flesh flattened where it meets the glass: the method
// keeps the 24 points out of the glass, and what lies between two of them would still cut a corner.
export const HAND_SHADER = `
  attribute vec4 balls;
  uniform vec4 ball[${BALLS}];           // place and radius, world frame, m
  uniform vec3 skin[${BALLS}];           // normal of one of the palm's sides at its balls, world frame
  uniform mat4 to_glass, from_glass;     // between the world and the vessel that is nearest
  uniform float glass[GLASS_SAMPLES];    // its radius from the base to the rim
  uniform float glass_height;            // 0: there is none to look at
  varying float arm;                     // 0 at the wrist, 1 at the forearm's end

  float glass_radius(float y) {
    float at = clamp(y / glass_height, 0.0, 1.0) * float(GLASS_SAMPLES - 1);
    int k = int(min(at, float(GLASS_SAMPLES - 2)));
    return mix(glass[k], glass[k + 1], at - float(k));
  }

  // Distance of p to the glass, to first order, and which way is out.
  float glass_distance(vec3 p, out vec3 outwards) {
    float step_y = glass_height / float(GLASS_SAMPLES - 1), rho = max(length(p.xz), 1e-5);
    float slope = (glass_radius(p.y + step_y) - glass_radius(p.y - step_y)) / (2.0 * step_y);
    outwards = vec3(p.x / rho, -slope, p.z / rho) * inversesqrt(1.0 + slope * slope);
    return (rho - glass_radius(p.y)) * inversesqrt(1.0 + slope * slope);
  }

  void flatten(inout vec3 place, inout vec3 normal, vec3 center) {
    if (glass_height <= 0.0) return;
    vec3 p = (to_glass * vec4(place, 1.0)).xyz, c = (to_glass * vec4(center, 1.0)).xyz, way, center_way;
    if (p.y < 0.0 || p.y > glass_height) return;
    float from_center = glass_distance(c, center_way), distance = glass_distance(p, way);
    const float SKIN = 4e-4;
    if (distance > SKIN || from_center < 0.0) return;
    for (int k = 0; k < 2; ++k) {
      p += way * (SKIN - distance);
      distance = glass_distance(p, way);
    }
    place = (from_glass * vec4(p, 1.0)).xyz;
    normal = -normalize((from_glass * vec4(way, 0.0)).xyz);
  }

  void hand_place(out vec3 place, out vec3 normal) {
    vec4 a = ball[int(balls.x)], b = ball[int(balls.y)];
    vec3 center;
    if (balls.w < 1.5) {
      vec3 along = b.xyz - a.xyz;
      float far = max(length(along), 1e-5);
      along /= far;
      float lean = asin(clamp((a.w - b.w) / far, -1.0, 1.0));
      vec3 aside = normalize(cross(along, abs(along.y) < 0.8 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
      float over = balls.w < 0.5 ? mix(-1.5707963, lean, position.z) : mix(lean, 1.5707963, position.z);
      normal = cos(over) * (position.x * aside + position.y * cross(along, aside)) + sin(over) * along;
      vec4 end = balls.w < 0.5 ? a : b;
      center = end.xyz;
      place = end.xyz + end.w * normal;
    } else if (balls.w > 3.5) {
      vec3 along = normalize(b.xyz - a.xyz), aside = normalize(ball[${WRIST_LITTLE}].xyz - ball[${WRIST_THUMB}].xyz);
      aside = normalize(aside - dot(aside, along) * along);
      center = mix(a.xyz, b.xyz, position.z);
      normal = position.x * aside + position.y * cross(along, aside);
      place = center + mix(a.w, b.w, position.z) * normal;
    } else {
      vec4 c = ball[int(balls.z)];
      mat3 ways = mat3(skin[int(balls.x)], skin[int(balls.y)], skin[int(balls.z)]);
      float side = balls.w < 2.5 ? 1.0 : -1.0;
      normal = side * normalize(ways * position);
      center = position.x * a.xyz + position.y * b.xyz + position.z * c.xyz;
      place = center + side * (ways * (position * vec3(a.w, b.w, c.w)));
    }
    vec3 wrist = 0.5 * (ball[${WRIST_THUMB}].xyz + ball[${WRIST_LITTLE}].xyz), elbow = 0.5 * (ball[${ARM_THUMB}].xyz + ball[${ARM_LITTLE}].xyz);
    vec3 fore = elbow - wrist;
    arm = dot(place - wrist, fore) / max(dot(fore, fore), 1e-9);
    flatten(place, normal, center);
  }
`;
