// SPDX-License-Identifier: MIT
// Marks that stay as large as they are on the screen: the 24 contact points by state, in shape and color, and the guidance point. Those behind
// something, or under the table, are pale.
import * as THREE from './three.module.js';
import {JOINTS} from './hand_shape.js';
import {CONTACTS, GUIDANCE_COLOR, onThemeChange, schemeColor, darkMode} from './theme.js';

const KINDS = CONTACTS.map((contact) => contact.key);
const GUIDANCE = KINDS.length;

const VERTEX = `
  attribute float kind, lift; uniform float pixels, size, table; varying float shape, clear;
  void main() {
    shape = kind;
    clear = position.y < table && cameraPosition.y > table ? 0.4 : 1.0;
    vec4 view = modelViewMatrix * vec4(position, 1.0);
    view.xyz *= max(0.2, 1.0 - lift / length(view.xyz));  // in front of the flesh that is about it, at the same place of the picture
    gl_Position = projectionMatrix * view;
    gl_PointSize = (kind < 0.5 ? 9.0 : kind > ${GUIDANCE}.0 - 0.5 ? 26.0 : 13.0) * size * pixels;
  }`;
const FRAGMENT = `
  uniform vec3 colors[${GUIDANCE + 1}]; uniform vec3 edge; uniform float opacity, pulse; varying float shape, clear;
  void main() {
    vec2 p = (gl_PointCoord - 0.5) * 2.0;
    int kind = int(shape + 0.5);
    float disc = length(p), square = max(abs(p.x), abs(p.y)) * 1.18, diamond = abs(p.x) + abs(p.y);
    float d = kind == 2 ? diamond : kind == 3 || kind == 4 ? square : disc;
    vec3 color = colors[0];
    for (int k = 1; k < ${GUIDANCE + 1}; ++k) if (k == kind) color = colors[k];
    float soft = fwidth(d) * 0.9 + 1e-4, outer = 1.0 - smoothstep(0.98 - soft, 0.98, d);
    float fill = 1.0 - smoothstep(0.74 - soft, 0.74 + soft, d), hole = 1.0 - smoothstep(0.36 - soft, 0.36 + soft, d);
    if (kind == ${GUIDANCE}) {
      float ring = smoothstep(0.62, 0.66, d) * (1.0 - smoothstep(0.92, 0.96, d)), dot_ = 1.0 - smoothstep(0.26, 0.32, d);
      float alpha = max(dot_, ring * pulse) * opacity * clear;
      if (alpha < 0.01) discard;
      gl_FragColor = vec4(color, alpha);
      return;
    }
    // hollow: nothing touches there
    float is_hollow = kind == 0 || kind == 3 ? 1.0 : 0.0;
    vec3 ink = mix(edge, color, fill);
    ink = mix(ink, edge, is_hollow * hole);
    if (outer < 0.01) discard;
    gl_FragColor = vec4(ink, outer * opacity * clear);
  }`;

export class Marks {
  constructor(scene, joints) {
    this.radii = joints.map((joint) => joint.radius);
    this.geometry = new THREE.BufferGeometry();
    const dynamic = (name, size) => {
      const attribute = new THREE.Float32BufferAttribute(new Float32Array((JOINTS + 1) * size), size).setUsage(THREE.DynamicDrawUsage);
      this.geometry.setAttribute(name, attribute);
      return attribute;
    };
    this.places = dynamic('position', 3);
    this.kinds = dynamic('kind', 1);
    this.lifts = dynamic('lift', 1);
    this.shared = {pixels: {value: 1}, size: {value: 1}, colors: {value: Array.from({length: GUIDANCE + 1}, () => new THREE.Color())},
      edge: {value: new THREE.Color()}, pulse: {value: 1}, table: {value: 0}};
    const make = (opacity, depthFunc) => {
      const points = new THREE.Points(this.geometry, new THREE.ShaderMaterial({
        vertexShader: VERTEX, fragmentShader: FRAGMENT, transparent: true, depthWrite: false, depthFunc,
        extensions: {derivatives: true}, uniforms: {...this.shared, opacity: {value: opacity}}}));
      points.frustumCulled = false;
      points.renderOrder = 2000;
      scene.add(points);
      return points;
    };
    this.seen = make(1, THREE.LessEqualDepth);
    this.hidden = make(0.24, THREE.GreaterDepth);
    this.paint();
    onThemeChange(() => this.paint());
  }

  paint() {
    const {colors, edge} = this.shared;
    [...CONTACTS.map((contact) => contact.color), GUIDANCE_COLOR].forEach((pair, k) => colors.value[k].set(schemeColor(pair)));
    edge.value.set(darkMode.matches ? '#10151b' : '#ffffff');
  }

  setVisible(isVisible) {
    this.seen.visible = this.hidden.visible = isVisible;
  }

  // `guidance`: a place in the world, or null.
  show(frame, size, guidance) {
    for (let k = 0; k < JOINTS; ++k) {
      this.places.setXYZ(k, ...frame.joints[k]);
      this.kinds.setX(k, Math.max(0, KINDS.indexOf(frame.contacts[k])));
      this.lifts.setX(k, this.radii[k] * size * 2.2 + 0.002);
    }
    this.places.setXYZ(JOINTS, ...(guidance || [0, 0, 0]));
    this.kinds.setX(JOINTS, GUIDANCE);
    this.lifts.setX(JOINTS, 0.006);
    this.geometry.setDrawRange(0, guidance ? JOINTS + 1 : JOINTS);
    for (const attribute of [this.places, this.kinds, this.lifts]) attribute.needsUpdate = true;
  }
}
