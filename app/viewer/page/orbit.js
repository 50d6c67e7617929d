// SPDX-License-Identifier: MIT
// The camera: turns about a point, comes closer, moves aside; by pointer, touch, wheel and keys. Angles in rad, lengths in m.
import {PerspectiveCamera, Vector3} from './three.module.js';
import {stillMode} from './theme.js';

const FIELD_OF_VIEW = 30;  // degrees, vertical
const LOWEST = -0.35, HIGHEST = Math.PI / 2 - 1e-3;
const NEAREST = 0.08, FARTHEST = 6;
const FILLED = 0.92;  // share of the room below the tools
const GLIDE = 0.12;  // s, time constant of the way to where the reader wants to be

export class Orbit {
  // `changed` is called when the picture is out of date.
  constructor(element, changed) {
    this.element = element;
    this.changed = changed;
    this.camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 20);
    this.now = {azimuth: 0, elevation: 0.4, distance: 1, x: 0, y: 0, z: 0};
    this.aim = {...this.now};
    this.home = null;
    this.room = {above: 0, below: 0};  // px at the picture's edges that others cover
    this.isHome = false;
    this.claim = () => false;  // another's hand on a pointer: given the event, true if it takes it
    this.pointers = new Map();
    element.addEventListener('pointerdown', (event) => this.press(event));
    element.addEventListener('pointermove', (event) => this.move(event));
    for (const kind of ['pointerup', 'pointercancel']) element.addEventListener(kind, (event) => this.pointers.delete(event.pointerId));
    element.addEventListener('contextmenu', (event) => event.preventDefault());
    element.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.zoom(Math.exp(Math.max(-0.3, Math.min(0.3, event.deltaY * (event.deltaMode ? 0.05 : 0.0014)))));
    }, {passive: false});
  }

  press(event) {
    if (this.pointers.size === 0 && this.claim(event)) return;
    this.element.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  move(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const dx = event.clientX - last[0], dy = event.clientY - last[1];
    if (this.pointers.size === 1) {
      if (event.shiftKey || event.button === 2 || event.buttons & 6) this.pan(dx, dy);
      else this.turn(-dx * 0.0075, dy * 0.0075);
    } else {
      const other = [...this.pointers].find(([id]) => id !== event.pointerId)[1];
      const before = Math.hypot(last[0] - other[0], last[1] - other[1]);
      const after = Math.hypot(event.clientX - other[0], event.clientY - other[1]);
      if (before > 4 && after > 4) this.zoom(before / after);
      this.pan(dx / 2, dy / 2);
    }
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  turn(azimuth, elevation) {
    this.isHome = false;
    this.aim.azimuth += azimuth;
    this.aim.elevation = Math.max(LOWEST, Math.min(HIGHEST, this.aim.elevation + elevation));
    this.changed();
  }

  zoom(factor) {
    this.isHome = false;
    this.aim.distance = Math.max(NEAREST, Math.min(FARTHEST, this.aim.distance * factor));
    this.changed();
  }

  // Moves the view by pixels of the screen.
  pan(dx, dy) {
    const [right, up] = this.axes(), size = this.pixel();
    this.isHome = false;
    for (const [k, axis] of ['x', 'y', 'z'].entries()) {
      this.aim[axis] += (-dx * right.getComponent(k) + dy * up.getComponent(k)) * size;
    }
    this.changed();
  }

  // Right and up of the picture, world frame.
  axes() {
    const e = this.camera.matrixWorld.elements;
    return [new Vector3(e[0], e[1], e[2]), new Vector3(e[4], e[5], e[6])];
  }

  // Length of a pixel at the point of view's target, or at a distance from the eye, m.
  pixel(distance = this.now.distance) {
    return 2 * distance * Math.tan(this.camera.fov * Math.PI / 360) / Math.max(1, this.element.clientHeight);
  }

  // Home is the view from a direction that shows these points of the world, as near as the room that the tools leave allows.
  setHome(points, azimuth, elevation) {
    this.home = {points: points.map((p) => new Vector3(...p)), azimuth, elevation};
  }

  // From which a ball of that radius is seen whole.
  distanceFor(radius) {
    const half = this.camera.fov * Math.PI / 360;
    return radius / Math.sin(Math.min(half, Math.atan(Math.tan(half) * this.camera.aspect)));
  }

  reset() {
    if (!this.home) return;  // nothing has been seen yet
    const {points, azimuth, elevation} = this.home, middle = points.reduce((sum, p) => sum.addScaledVector(p, 1 / points.length), new Vector3());
    const back = new Vector3(Math.sin(azimuth) * Math.cos(elevation), Math.sin(elevation), Math.cos(azimuth) * Math.cos(elevation));
    const right = new Vector3(Math.cos(azimuth), 0, -Math.sin(azimuth)), up = back.clone().cross(right);
    const tall = Math.tan(this.camera.fov * Math.PI / 360), wide = tall * this.camera.aspect, {clientHeight} = this.element;
    const top = 1 - 2 * this.room.above / clientHeight, bottom = -1 + 2 * this.room.below / clientHeight;  // of the picture, -1 to 1
    let distance = 1;
    for (let k = 0; k < 12; ++k) {  // the middle of what is seen to the middle of the room, and the distance at which it fits
      const seen = points.map((p) => {
        const way = p.clone().sub(middle), depth = distance - way.dot(back);
        return [way.dot(right) / depth / wide, way.dot(up) / depth / tall];
      });
      const [left, low] = [0, 1].map((i) => Math.min(...seen.map((at) => at[i]))), [far, high] = [0, 1].map((i) => Math.max(...seen.map((at) => at[i])));
      middle.addScaledVector(right, (left + far) / 2 * distance * wide).addScaledVector(up, ((low + high) / 2 - (top + bottom) / 2) * distance * tall);
      distance *= Math.max((far - left) / (2 * FILLED), (high - low) / ((top - bottom) * FILLED));
    }
    this.go({azimuth, elevation, distance, x: middle.x, y: middle.y, z: middle.z});
    this.isHome = true;
  }

  // One of the fixed views: the directions from which a drawing shows a thing.
  view(name) {
    const [azimuth, elevation] = {front: [0, 0], side: [Math.PI / 2, 0], top: [0, HIGHEST]}[name];
    this.go({azimuth, elevation});
  }

  go(where) {
    const turns = Math.round((this.now.azimuth - (where.azimuth ?? this.aim.azimuth)) / (2 * Math.PI));
    Object.assign(this.aim, where);
    this.isHome = false;
    this.now.azimuth -= turns * 2 * Math.PI;  // the short way round
    this.changed();
  }

  jump() {
    Object.assign(this.now, this.aim);
    this.place();
  }

  // A step of `dt` towards the aim; true while there is some way left.
  step(dt) {
    const share = stillMode.matches ? 1 : 1 - Math.exp(-dt / GLIDE);
    let left = 0;
    for (const key of ['azimuth', 'elevation', 'distance', 'x', 'y', 'z']) {
      const way = this.aim[key] - this.now[key];
      this.now[key] += Math.abs(way) < 1e-5 ? way : way * share;
      left = Math.max(left, Math.abs(this.aim[key] - this.now[key]));
    }
    this.place();
    return left > 0;
  }

  place() {
    const {azimuth, elevation, distance, x, y, z} = this.now;
    const flat = Math.cos(elevation) * distance;
    this.camera.position.set(x + Math.sin(azimuth) * flat, y + Math.sin(elevation) * distance, z + Math.cos(azimuth) * flat);
    this.camera.near = Math.max(0.005, distance * 0.05);
    this.camera.far = distance + 8;
    this.camera.lookAt(x, y, z);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld(true);
  }

  resize(width, height) {
    this.camera.aspect = width / height;
    this.place();
    if (this.isHome) {
      this.reset();
      this.jump();
    }
  }
}
