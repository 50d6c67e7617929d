// SPDX-License-Identifier: MIT
// The forces of the hand on the vessel: arrows whose heads lie at the contacts. The largest has a fixed length, the others are in
// proportion. What is behind something is pale.
import * as THREE from './three.module.js';
import {FORCE_COLOR, onThemeChange, schemeColor} from './theme.js';

const LONGEST = 0.045;                         // m, of the largest force
const SHAFT = 0.0009, HEAD = 0.0026;           // m, radii
const HEAD_LENGTH = 0.0075, HEAD_SHARE = 0.6;  // m; of an arrow at most
const AROUND = 12;
const UP = new THREE.Vector3(0, 1, 0);

export class Arrows {
  constructor(scene) {
    this.group = new THREE.Group();
    scene.add(this.group);
    // from 0 to 1 along y
    this.shaft = new THREE.CylinderBufferGeometry(1, 1, 1, AROUND).translate(0, 0.5, 0);
    this.head = new THREE.ConeBufferGeometry(1, 1, AROUND).translate(0, 0.5, 0);
    const material = (opacity, depthFunc) => new THREE.MeshBasicMaterial({transparent: true, opacity, depthFunc, depthWrite: false});
    this.materials = [material(0.95, THREE.LessEqualDepth), material(0.3, THREE.GreaterDepth)];
    this.list = [];
    this.paint();
    onThemeChange(() => this.paint());
  }

  paint() {
    for (const material of this.materials) material.color.set(schemeColor(FORCE_COLOR)).convertGammaToLinear(2.2);
  }

  setVisible(isVisible) {
    this.group.visible = isVisible;
  }

  // One more arrow: a shaft and a head, each as it is seen and as it is hidden.
  add() {
    const arrow = new THREE.Group(), parts = [this.shaft, this.head].map((geometry) => {
      const part = new THREE.Group();
      for (const material of this.materials) {
        const mesh = new THREE.Mesh(geometry, material);
        mesh.renderOrder = 1500;
        part.add(mesh);
      }
      arrow.add(part);
      return part;
    });
    this.group.add(arrow);
    this.list.push({arrow, parts});
  }

  // `contacts` of a frame: {place, force}, in the world, m and N.
  show(contacts) {
    while (this.list.length < contacts.length) this.add();
    const forces = contacts.map(({force}) => new THREE.Vector3(...force)), largest = Math.max(0, ...forces.map((force) => force.length()));
    this.list.forEach(({arrow, parts: [shaft, head]}, k) => {
      const size = k < contacts.length ? forces[k].length() : 0;
      arrow.visible = size > 0;
      if (!arrow.visible) return;
      const length = LONGEST * size / largest, point = Math.min(HEAD_LENGTH, HEAD_SHARE * length), wide = HEAD * point / HEAD_LENGTH;
      const along = forces[k].multiplyScalar(1 / size);
      arrow.position.set(...contacts[k].place).addScaledVector(along, -length);  // of its tail
      arrow.quaternion.setFromUnitVectors(UP, along);
      shaft.scale.set(Math.min(SHAFT, 0.5 * wide), length - point, Math.min(SHAFT, 0.5 * wide));
      head.position.set(0, length - point, 0);
      head.scale.set(wide, point, wide);
    });
  }
}
