// SPDX-License-Identifier: MIT
// Liquid in a vessel. Its body is the cavity's wall, of which the shader leaves out what is above the level; its surface is a flat piece, of which the
// shader leaves out what is outside the cavity. So a tilt or a pour costs a few numbers a picture, never a new geometry.
import * as THREE from './three.module.js';
import {open, revolve, sample} from './profile.js';
import {liquidColor} from './theme.js';
import {ORDER} from './vessels.js';

const CAVITY_SAMPLES = 256;
export const LEAST_SEEN = 1e-8;  // m3 (of a stream: in a second): 0.01 mL and less is a film or a drop that nobody sees
const INSET = 1.2e-4;  // m: apart from the glass, so that neither flickers

const CAVITY = `
  uniform sampler2D cavity; uniform float low, high;
  float cavity_radius(float y) {
    float at = clamp((y - low) / (high - low), 0.0, 1.0) * ${(CAVITY_SAMPLES - 1).toFixed(1)}, k = floor(at);
    vec2 ends = vec2(texture2D(cavity, vec2((k + 0.5) / ${CAVITY_SAMPLES.toFixed(1)}, 0.5)).r,
      texture2D(cavity, vec2((min(k + 1.0, ${(CAVITY_SAMPLES - 1).toFixed(1)}) + 0.5) / ${CAVITY_SAMPLES.toFixed(1)}, 0.5)).r);
    return mix(ends.x, ends.y, at - k);
  }`;

const VERTEX = `varying vec3 at, out_of, to_eye;
  void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    at = (vessel_from_here * vec4(position, 1.0)).xyz; out_of = mat3(modelMatrix) * normal; to_eye = cameraPosition - world.xyz;
    gl_Position = projectionMatrix * viewMatrix * world;
  }`;

// Deep color where one looks through much of it, pale where it is thin.
const BODY_FRAGMENT = `
  uniform vec3 color, up; uniform float level, is_back; varying vec3 at, out_of, to_eye;
  void main() {
    float depth = level - dot(up, at);
    if (depth < 0.0) discard;
    float facing = abs(dot(normalize(out_of), normalize(to_eye)));
    float thick = mix(0.42, 0.74, facing) * (1.0 - 0.35 * is_back);
    vec3 deep = color * mix(1.06, 0.74, smoothstep(0.0, 0.09, depth));
    float line = 1.0 - smoothstep(0.0, 0.0016, depth);
    gl_FragColor = vec4(mix(deep, color * 0.62, line * 0.75), mix(thick, 0.9, line * 0.6));
  }`;

const SURFACE_FRAGMENT = `${CAVITY}
  uniform vec3 color, sky; varying vec3 at, out_of, to_eye;
  void main() {
    float wall = cavity_radius(at.y) - length(at.xz), soft = max(fwidth(wall), 1e-6);
    float in_it = smoothstep(-soft, soft, wall) * step(low - 1e-5, at.y) * step(at.y, high + 1e-5);
    if (in_it <= 0.0) discard;
    vec3 eye = normalize(to_eye);
    float graze = 1.0 - abs(dot(normalize(out_of), eye)), mirror = 0.05 + 0.8 * pow(graze, 4.0);
    float rim = 1.0 - smoothstep(0.0, 0.0024, wall);  // it climbs the glass a little
    vec3 hue = mix(color, vec3(1.0), 0.16);
    gl_FragColor = vec4(mix(mix(hue, sky, mirror), color * 0.7, rim * 0.55), in_it * mix(0.66, 0.92, max(mirror, rim)));
  }`;

export class Liquid {
  constructor(vessel) {
    const section = open(vessel.about.inner);
    const color = new THREE.Color(liquidColor(vessel.about.liquid));
    this.color = color;
    this.up = new THREE.Vector3(0, 1, 0);
    this.level = {value: 0};
    const shared = {color: {value: color}, up: {value: this.up}, level: this.level, sky: {value: new THREE.Color('#ffffff')}};
    const {samples, low, high} = sample(section, CAVITY_SAMPLES);
    const texels = new Float32Array(4 * CAVITY_SAMPLES);
    samples.forEach((r, k) => { texels[4 * k] = r; });
    const cavity = new THREE.DataTexture(texels, CAVITY_SAMPLES, 1, THREE.RGBAFormat, THREE.FloatType);
    const pressed = section.map(([r, y], k) => [Math.max(0, r - INSET), y + (k === 0 ? INSET : 0)]);
    this.parts = [];

    const body = revolve(pressed);
    for (const [k, side] of [THREE.BackSide, THREE.FrontSide].entries()) {
      const material = new THREE.ShaderMaterial({
        vertexShader: VERTEX.replace('vessel_from_here', 'mat4(1.0)'), fragmentShader: BODY_FRAGMENT, side, transparent: true,
        depthWrite: false, uniforms: {...shared, is_back: {value: 1 - k}}});
      this.add(vessel, new THREE.Mesh(body, material), ORDER.liquid + 2 * k);
    }
    const half = Math.hypot(high, Math.max(...samples)) * 1.3;
    const flat = new THREE.PlaneBufferGeometry(2 * half, 2 * half).rotateX(-Math.PI / 2);
    this.matrix = {value: new THREE.Matrix4()};
    this.surface = new THREE.Mesh(flat, new THREE.ShaderMaterial({
      vertexShader: `uniform mat4 vessel_from_here; ${VERTEX}`, fragmentShader: SURFACE_FRAGMENT, side: THREE.DoubleSide, transparent: true,
      depthWrite: false, extensions: {derivatives: true},
      uniforms: {...shared, cavity: {value: cavity}, low: {value: low}, high: {value: high}, vessel_from_here: this.matrix}}));
    this.surface.matrixAutoUpdate = false;
    this.add(vessel, this.surface, ORDER.liquid + 1);
    this.show(0, null, [0, 1, 0]);
  }

  add(vessel, mesh, order) {
    vessel.addPart(mesh, order);
    this.parts.push(mesh);
  }

  // `level`: points p of the vessel frame with up . p = level are on the surface; null: empty. A film is not drawn.
  show(volume, level, up) {
    const is = level !== null && volume > LEAST_SEEN;
    for (const mesh of this.parts) mesh.visible = is;
    if (!is) return;
    this.level.value = level;
    this.up.set(...up).normalize();
    const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 1, 0), this.up);
    this.surface.matrix.compose(this.up.clone().multiplyScalar(level), turn, new THREE.Vector3(1, 1, 1));
    this.surface.matrixWorldNeedsUpdate = true;
    this.matrix.value.copy(this.surface.matrix);
  }
}
