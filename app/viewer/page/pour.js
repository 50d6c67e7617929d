// SPDX-License-Identifier: MIT
// What pours: the stream through the air, the target container that fills, and the place where a vessel is to be carried.
import * as THREE from './three.module.js';
import {LEAST_SEEN, Liquid} from './liquid.js';
import {liquidColor, onThemeChange, schemeColor, GUIDANCE_COLOR} from './theme.js';
import {Vessel} from './vessels.js';

const FLOOR = 2e-4;
const LEAST_HEIGHT = 0.03;   // m: a target whose mouth lies lower is drawn as a dish
const START_SPEED = 0.25;    // m/s over the lip, for the stream's width
const GRAVITY = 9.80665;

// A falling stream: sideways it goes evenly, downwards ever faster, and so it gets thinner; its section is what the flow needs at its speed.
const STREAM_VERTEX = `
  uniform vec3 from, to; uniform float flow, time; varying vec3 out_of, to_eye;
  void main() {
    float t = position.z, drop = max(from.y - to.y, 1e-3);
    vec3 at = vec3(mix(from.xz, to.xz, t), 0.0).xzy;
    at.y = from.y - drop * t * t;
    float speed = sqrt(${(START_SPEED * START_SPEED).toFixed(4)} + ${(2 * GRAVITY).toFixed(4)} * drop * t * t);
    float radius = max(sqrt(flow / (3.14159 * speed)), 0.0009) * (1.0 + 0.10 * sin(34.0 * t - 26.0 * time) * t);
    vec3 along = normalize(vec3(to.x - from.x, -2.0 * drop * t - 1e-3, to.z - from.z));
    vec3 aside = normalize(cross(along, abs(along.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 0.0, 1.0)));
    out_of = position.x * aside + position.y * cross(along, aside);
    vec3 world = at + radius * out_of;
    to_eye = cameraPosition - world;
    gl_Position = projectionMatrix * viewMatrix * vec4(world, 1.0);
  }`;
const STREAM_FRAGMENT = `
  uniform vec3 color; varying vec3 out_of, to_eye;
  void main() {
    vec3 n = normalize(out_of), eye = normalize(to_eye);
    float glint = pow(max(dot(reflect(-eye, n), normalize(vec3(-0.5, 0.7, 0.5))), 0.0), 18.0);
    gl_FragColor = vec4(mix(color * 0.9, vec3(1.0), 0.75 * glint), 0.86);
  }`;
const RING_VERTEX = 'varying vec2 at; void main() { at = position.xz; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }';
const RING_FRAGMENT = `
  uniform vec3 color; varying vec2 at;
  void main() {
    float r = length(at), soft = fwidth(r), turn = atan(at.y, at.x) / 6.2831853 * 24.0;
    float ring = smoothstep(0.88 - soft, 0.88 + soft, r) * (1.0 - smoothstep(0.98 - soft, 0.98 + soft, r));
    float dash = smoothstep(0.16, 0.2, abs(fract(turn) - 0.5));
    gl_FragColor = vec4(color, ring * dash * 0.9 + 0.10 * (1.0 - smoothstep(0.86, 0.88, r)));
  }`;

function streamGeometry() {
  const position = [], index = [], around = 12, along = 24;
  for (let k = 0; k <= along; ++k) {
    for (let i = 0; i <= around; ++i) position.push(Math.cos(2 * Math.PI * i / around), Math.sin(2 * Math.PI * i / around), k / along);
  }
  for (let k = 0; k < along; ++k) {
    for (let i = 0; i < around; ++i) {
      const a = k * (around + 1) + i, b = a + around + 1;
      index.push(a, a + 1, b, a + 1, b + 1, b);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
  geometry.setIndex(index);
  return geometry;
}

// The target as a vessel of its own: what the scene says of it is its mouth; it is drawn down to the table.
function targetVessel(target, tableY, scene) {
  const [x, y, z] = target.place, radius = target.diameter / 2;
  const height = Math.max(LEAST_HEIGHT, y - tableY), base = y - height;
  const about = {
    name: 'target', place: [x, base, z], height, radius, liquid: null,
    outline: [[0, 0], [radius + target.wall, 0], [radius + target.wall, height]],
    inner: [[0, FLOOR], [radius, FLOOR], [radius, height]],
  };
  return new Vessel(about, scene);
}

export class Pour {
  constructor(scene, about, vessels) {
    this.about = about;
    this.vessels = vessels;
    this.stream = new THREE.Mesh(streamGeometry(), new THREE.ShaderMaterial({
      vertexShader: STREAM_VERTEX, fragmentShader: STREAM_FRAGMENT, transparent: true, side: THREE.DoubleSide,
      uniforms: {from: {value: new THREE.Vector3()}, to: {value: new THREE.Vector3()}, flow: {value: 0}, time: {value: 0},
        color: {value: new THREE.Color()}}}));
    this.stream.frustumCulled = false;
    this.stream.visible = false;
    this.stream.renderOrder = 5;
    scene.add(this.stream);
    if (about.target) {
      this.target = targetVessel(about.target, about.table_y, scene);
      this.filling = new Liquid(this.target);
      vessels.list.push(this.target);  // so that it is painted and sorted with them
    }
    if (about.destination) this.addDestination(scene, about);
  }

  addDestination(scene, about) {
    this.ring = new THREE.Mesh(new THREE.CircleBufferGeometry(1, 64).rotateX(-Math.PI / 2), new THREE.ShaderMaterial({
      vertexShader: RING_VERTEX, fragmentShader: RING_FRAGMENT, transparent: true, depthWrite: false, extensions: {derivatives: true},
      uniforms: {color: {value: new THREE.Color()}}}));
    const radius = Math.max(...about.vessels.map((vessel) => vessel.radius)) * 1.15;
    this.ring.scale.set(radius, 1, radius);
    this.ring.position.set(about.destination[0], Math.max(about.destination[1], about.table_y) + 8e-4, about.destination[2]);
    this.ring.renderOrder = -870;
    scene.add(this.ring);
    const paint = () => this.ring.material.uniforms.color.value.set(schemeColor(GUIDANCE_COLOR));
    paint();
    onThemeChange(paint);
  }

  show(frame) {
    const {stream} = frame, flows = Boolean(stream) && stream.flow > LEAST_SEEN;
    this.stream.visible = flows;
    if (flows) {
      const uniforms = this.stream.material.uniforms;
      uniforms.from.value.set(...stream.from);
      uniforms.to.value.set(...stream.to);
      uniforms.flow.value = stream.flow;
      const poured = this.about.vessels[frame.vessel];
      uniforms.color.value.set(liquidColor(poured && poured.liquid));
    }
    if (this.target) this.fill(frame);
  }

  // The target's liquids, mixed, upright.
  fill(frame) {
    const area = Math.PI * (this.about.target.diameter / 2) ** 2, volume = frame.target_volume;
    const above = this.about.table_y - this.target.about.place[1] + volume / area;  // as high as the stream comes down to
    this.filling.show(volume, Math.min(above, this.target.about.height), [0, 1, 0]);
    const mixed = new THREE.Color(0, 0, 0), hue = new THREE.Color();
    const total = frame.amounts.reduce((sum, amount) => sum + amount.arrived, 0);
    if (total <= 0) return;
    frame.amounts.forEach((amount, k) => mixed.add(hue.set(liquidColor(this.about.amounts[k].liquid)).multiplyScalar(amount.arrived / total)));
    this.filling.color.copy(mixed);
  }

  // Ripples run down while it flows.
  step(time) {
    this.stream.material.uniforms.time.value = time;
    return this.stream.visible;
  }
}
