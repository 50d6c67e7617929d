// SPDX-License-Identifier: MIT
// Vessels: translucent glass with its wall, where they stand, and the shade under them.
import * as THREE from './three.module.js';
import {GLASS_SAMPLES, open, revolve, rounded, sample} from './profile.js';
import {creased} from './mesh.js';
import {request} from './stream.js';
import {onThemeChange, sceneColors} from './theme.js';

// What is see-through is drawn from the back to the front; within a vessel in this order, the liquid between.
export const ORDER = {outerBack: 0, innerFront: 1, liquid: 2, innerBack: 5, outerFront: 6};
const STEP = 10;  // orders that a vessel takes

const GLASS_VERTEX = `varying vec3 out_of, to_eye;
  void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    out_of = mat3(modelMatrix) * normal; to_eye = cameraPosition - world.xyz;
    gl_Position = projectionMatrix * viewMatrix * world;
  }`;
// A studio that glass can mirror: a bright window on the left, a soft one above right, a floor. It darkens where one looks along its wall.
const GLASS_FRAGMENT = `
  uniform vec3 tint, light; uniform float alpha, shine, is_inner; varying vec3 out_of, to_eye;
  float window(vec3 way, vec3 to, vec3 right, vec2 size) {
    float front = dot(way, to);
    vec2 at = abs(vec2(dot(way, right), dot(way, cross(to, right)))) / max(front, 1e-3);
    vec2 in_it = 1.0 - smoothstep(size * 0.72, size, at);
    return front > 0.0 ? in_it.x * in_it.y : 0.0;
  }
  void main() {
    vec3 eye = normalize(to_eye), n = normalize(out_of);
    n = dot(n, eye) < 0.0 ? -n : n;
    float along = 1.0 - abs(dot(n, eye)), edge = along * along * along;
    vec3 mirrored = reflect(-eye, n);
    float glint = window(mirrored, vec3(-0.736, 0.437, 0.517), vec3(0.575, 0.0, 0.818), vec2(0.20, 0.62)) +
      0.55 * window(mirrored, vec3(0.743, 0.557, 0.371), vec3(0.447, 0.0, -0.894), vec2(0.34, 0.34)) +
      0.16 * smoothstep(0.2, 1.0, mirrored.y);
    float fresnel = 0.06 + 0.94 * edge * along;
    float bright = shine * (1.0 - 0.55 * is_inner) * glint * (0.30 + 0.7 * fresnel);
    float cover = alpha * (0.055 + 0.945 * edge) * (1.0 - 0.35 * is_inner);
    gl_FragColor = vec4(tint * cover + light * bright, cover + bright);
  }`;

const SHADE_FRAGMENT = `varying vec2 at; uniform float dark;
  void main() {
    float r = length(at);
    gl_FragColor = vec4(0.0, 0.0, 0.0, dark * (1.0 - smoothstep(0.45, 1.0, r)) * (0.55 + 0.45 * smoothstep(0.1, 0.62, r)));
  }`;
const SHADE_VERTEX = 'varying vec2 at; void main() { at = position.xz; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }';

export function glassMaterial(side, isInner) {
  return new THREE.ShaderMaterial({
    vertexShader: GLASS_VERTEX, fragmentShader: GLASS_FRAGMENT, side, transparent: true, depthWrite: false,
    blending: THREE.CustomBlending, blendSrc: THREE.OneFactor, blendDst: THREE.OneMinusSrcAlphaFactor,
    uniforms: {tint: {value: new THREE.Color()}, light: {value: new THREE.Color()}, alpha: {value: 1}, shine: {value: 1},
      is_inner: {value: isInner ? 1 : 0}},
  });
}

// Outer wall with the rim's half round, and inner wall if there is one.
function walls(vessel) {
  const outer = open(vessel.outline), inner = vessel.inner && open(vessel.inner);
  if (!inner) return [revolve(rounded(vessel.outline))];
  const [R, top] = outer[outer.length - 1], r = inner[inner.length - 1][0], half = (R - r) / 2;
  const rim = [];
  for (let k = 1; k <= 8; ++k) rim.push([R - half + half * Math.cos(Math.PI * k / 8), top + half * Math.sin(Math.PI * k / 8)]);
  return [revolve([...rounded(outer), ...rim]), revolve(rounded(inner), true)];
}

async function meshGeometry(address) {
  const data = await request(address, (answer) => answer.arrayBuffer());
  const [vertices, triangles] = new Uint32Array(data, 0, 2);
  return creased(new Float32Array(data, 8, 3 * vertices), new Uint32Array(data, 8 + 12 * vertices, 3 * triangles));
}

export class Vessel {
  constructor(about, scene) {
    this.about = about;
    this.group = new THREE.Group();
    this.group.matrixAutoUpdate = false;
    this.profile = about.outline && !about.mesh ? sample(open(about.outline), GLASS_SAMPLES) : null;
    this.materials = [];
    this.parts = [];  // [mesh, order within the vessel]
    const outline = about.outline;
    if (outline) walls(about).forEach((geometry, isInner) => this.addWall(geometry, isInner));
    this.shade = new THREE.Mesh(new THREE.CircleBufferGeometry(1, 40).rotateX(-Math.PI / 2), new THREE.ShaderMaterial({
      vertexShader: SHADE_VERTEX, fragmentShader: SHADE_FRAGMENT, transparent: true, depthWrite: false, uniforms: {dark: {value: 0}}}));
    this.shade.renderOrder = -880;
    scene.add(this.group, this.shade);
    this.place(about.place, [0, 0, 0, 1], 0);
  }

  async load() {
    if (this.about.mesh) this.addWall(await meshGeometry(this.about.mesh), 0);
    this.paint();
  }

  addWall(geometry, isInner) {
    const orders = isInner ? [ORDER.innerBack, ORDER.innerFront] : [ORDER.outerBack, ORDER.outerFront];
    [THREE.BackSide, THREE.FrontSide].forEach((side, k) => {
      const material = glassMaterial(side, isInner);
      this.materials.push(material);
      this.addPart(new THREE.Mesh(geometry, material), orders[k]);
    });
  }

  addPart(mesh, order) {
    this.group.add(mesh);
    this.parts.push([mesh, order]);
  }

  paint() {
    const colors = sceneColors();
    for (const {uniforms} of this.materials) {
      uniforms.tint.value.set(colors.glass);
      uniforms.light.value.set(colors.glassLight);
      uniforms.alpha.value = colors.glassAlpha;
      uniforms.shine.value = colors.glassShine;
    }
  }

  // `state` of a frame; null: not drawn.
  show(state, tableY) {
    this.group.visible = this.shade.visible = state !== null;
    if (state) this.place(state.place, state.rotation, tableY);
  }

  // `tableY`: height of the table, which the shade lies on.
  place(place, rotation, tableY) {
    const {matrix} = this.group;
    matrix.compose(new THREE.Vector3(...place), new THREE.Quaternion(...rotation), new THREE.Vector3(1, 1, 1));
    this.group.matrixWorldNeedsUpdate = true;
    this.matrix = matrix;
    const radius = this.about.radius, height = this.about.height;
    const axis = new THREE.Vector3(matrix.elements[4], matrix.elements[5], matrix.elements[6]);
    const middle = this.middle = new THREE.Vector3(...place).addScaledVector(axis, height / 2);
    const flat = Math.hypot(axis.x, axis.z), reach = Math.abs(axis.y) * height / 2 + flat * radius;
    const gap = Math.max(0, middle.y - reach - tableY);
    const wide = radius * 1.45 + gap * 0.5, long = wide + flat * height * 0.4;
    this.shade.position.set(middle.x + gap * 0.3, tableY + 4e-4, middle.z - gap * 0.35);
    this.shade.rotation.y = Math.atan2(axis.x, axis.z);
    this.shade.scale.set(wide, 1, long);
    this.shade.material.uniforms.dark.value = sceneColors().shadow * 1.15 / (1 + gap * 14);
  }
}

export class Vessels {
  constructor(scene, vessels) {
    this.list = vessels.map((about) => new Vessel(about, scene));
    this.count = this.list.length;  // more may be drawn with them (the target)
    this.paint();
    onThemeChange(() => this.paint());
  }

  load() {
    return Promise.all(this.list.map((vessel) => vessel.load()));
  }

  paint() {
    for (const vessel of this.list) vessel.paint();
  }

  place(frame, tableY) {
    frame.vessels.forEach((state, k) => this.list[k].show(state, tableY));

  }

  // Far ones first.
  sort(camera) {
    const far = (vessel) => camera.position.distanceTo(vessel.middle);
    [...this.list].sort((a, b) => far(b) - far(a)).forEach((vessel, rank) => {
      for (const [mesh, order] of vessel.parts) mesh.renderOrder = STEP * (rank + 1) + order;
    });
  }

  // The one whose glass is nearest to the middle of the hand.
  nearest(joints) {
    const middle = joints.reduce((sum, p) => sum.add(new THREE.Vector3(...p)), new THREE.Vector3()).multiplyScalar(1 / joints.length);
    return this.list.slice(0, this.count).reduce((best, vessel) =>
      (!best || vessel.middle.distanceTo(middle) < best.middle.distanceTo(middle) ? vessel : best), null);
  }
}
