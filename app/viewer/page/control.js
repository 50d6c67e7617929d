// SPDX-License-Identifier: MIT
// The page as the gripper: drag the hand, close it, tilt it. What it sends is where the hand is to be in the world (docs/view.md).
import {Matrix4, Quaternion, Vector3} from './three.module.js';
import {degrees, element, millimeters} from './format.js';

const HAND = 0.1, NEAR = 48;           // m about the hand's middle in which a drag takes it, and px at least
const INTERVAL = 1000 / 60;            // ms between two states that are sent
const KEY_SPEED = 0.15, KEY_TURN = 0.8;  // m/s and rad/s while a key is held
const CLOSING = 0.5, OPENING = 1.2;    // of the gap's range, in a second
const SQUEEZE = 0.004;                 // m, that a grasp goes on closing beyond where it held
const HELD = ['lift', 'tilt', 'maintain'];
const THUMB_TIP = 3, INDEX_TIP = 8;
const LARGEST_TILT = 150, LARGEST_TURN = 180;  // degrees

// Tilt and turn of the gripper's axes, [x, y, z, w], as Control.state() composes them, rad. Any other rotation is left out.
function angles(rotation) {
  const turned = (x, y, z) => new Vector3(x, y, z).applyQuaternion(new Quaternion(...rotation));
  const across = turned(1, 0, 0), up = turned(0, 1, 0), back = turned(0, 0, 1);
  return {tilt: Math.atan2(back.y, up.y), turn: Math.atan2(-across.z, across.x)};
}

export class Control {
  constructor(about, view, showError) {
    this.limits = about.control_limits;
    this.view = view;
    this.showError = showError;
    const {start} = this.limits;
    this.place({...start, tilt: 0, turn: 0, ...this.kept()});
    this.sequence = 0;
    this.motion = 0;  // of the assistant: -1 closing, 1 opening
    this.make(document.getElementById('control'));
    view.orbit.claim = (event) => this.take(event);
    const canvas = view.stage.canvas;
    canvas.addEventListener('pointermove', (event) => this.drag(event));
    for (const kind of ['pointerup', 'pointercancel']) canvas.addEventListener(kind, (event) => this.drop(event));
    this.showValues();
  }

  make(place) {
    place.hidden = false;
    const [closed, opened] = this.limits.gap, reach = this.limits.reach;
    this.sliders = {};
    const add = (name, label, min, max, step, read, write, text) => {
      const input = element('input', {type: 'range', id: `control-${name}`, min: String(min), max: String(max), step: String(step)});
      const value = element('output', {for: `control-${name}`});
      input.addEventListener('input', () => {
        this.motion = 0;
        write(Number(input.value));
        this.changed();
      });
      this.sliders[name] = {input, value, read, text};
      return element('div', {class: 'slider'}, element('label', {for: `control-${name}`, text: label}), input, value);
    };
    this.grasp = element('button', {type: 'button', class: 'grasp', text: 'Grasp', title: 'Close the hand until it holds, or let go (Space)'});
    this.grasp.addEventListener('click', () => this.toggle());
    const axis = (k) => [() => this.position.getComponent(k) * 1e3, (mm) => this.moveTo(k, mm / 1e3), () => millimeters(this.position.getComponent(k), 0) + ' mm'];
    const range = (k) => [-reach, reach].map((way) => Math.round((this.limits.center[k] + way) * 1e3));
    place.append(
      element('p', {class: 'hint', text: 'Drag the hand to move it. Hold Shift to move it over the table. Drag beside it to look around.'}), this.grasp,
      add('close', 'Close', 0, 100, 0.5, () => 100 * (opened - this.gap) / (opened - closed), (v) => { this.gap = opened - (opened - closed) * v / 100; },
        () => `${Math.round(100 * (opened - this.gap) / (opened - closed))} %`),
      add('tilt', 'Tilt', -30, LARGEST_TILT, 1, () => this.tilt * 180 / Math.PI, (v) => { this.tilt = v * Math.PI / 180; }, () => `${degrees(this.tilt)}°`),
      add('turn', 'Turn', -LARGEST_TURN, LARGEST_TURN, 1, () => this.turn * 180 / Math.PI, (v) => { this.turn = v * Math.PI / 180; }, () => `${degrees(this.turn)}°`),
      add('height', 'Height', ...range(1), 1, ...axis(1)), add('depth', 'Depth', ...range(2), 1, ...axis(2)), add('across', 'Across', ...range(0), 1, ...axis(0)));
  }

  place({position, gap, tilt, turn}) {
    Object.assign(this, {position: new Vector3(...position), gap, tilt, turn});
  }
  // Where this page left the hand before it was loaded again. The address is another one for each session.
  kept() {
    try {
      return JSON.parse(sessionStorage.getItem(location.pathname));
    } catch (error) {
      return null;
    }
  }
  keep() {
    try {
      sessionStorage.setItem(location.pathname, JSON.stringify({position: this.position.toArray(), gap: this.gap, tilt: this.tilt, turn: this.turn}));
    } catch (error) {
      // a browser that keeps nothing: a page that is loaded again begins at the hand, untilted
    }
  }

  // Kept within reach.
  moveBy(way) {
    const center = new Vector3(...this.limits.center);
    this.position.add(way).sub(center).clampLength(0, this.limits.reach).add(center);
  }
  moveTo(k, value) {
    const way = new Vector3();
    way.setComponent(k, value - this.position.getComponent(k));
    this.moveBy(way);
  }

  // ---- pointer: in the plane of the picture through the hand; with Shift, over the table ----
  take(event) {
    if (!this.view.middle || event.button !== 0) return false;
    const at = this.view.project(this.view.middle.toArray());
    const near = Math.max(NEAR, HAND / this.view.orbit.pixel());
    if (Math.hypot(event.clientX - at.x, event.clientY - at.y) > near) return false;
    this.pointer = event.pointerId;
    this.view.isDragged = true;
    this.last = [event.clientX, event.clientY];
    this.view.stage.canvas.setPointerCapture(event.pointerId);
    this.view.stage.canvas.classList.add('holding');
    return true;
  }
  drag(event) {
    if (event.pointerId !== this.pointer) return;
    const [right, up] = this.view.orbit.axes(), far = this.view.stage.camera.position.distanceTo(this.view.middle), size = this.view.orbit.pixel(far);
    const over = event.shiftKey ? new Vector3(-right.z, 0, right.x).normalize().negate() : up;  // over the table: away from the eye
    this.moveBy(new Vector3().addScaledVector(right, (event.clientX - this.last[0]) * size).addScaledVector(over, -(event.clientY - this.last[1]) * size));
    this.last = [event.clientX, event.clientY];
    this.changed();
  }
  drop(event) {
    if (event.pointerId !== this.pointer) return;
    this.pointer = undefined;
    this.view.isDragged = false;
    this.view.stage.invalidate();
    this.view.stage.canvas.classList.remove('holding');
  }

  // ---- the assistant: closes until the session says that it holds, and a little further; or opens ----
  toggle() {
    const opens = this.motion < 0 || (this.motion === 0 && this.isHeld);
    this.motion = opens ? 1 : -1;
    this.before = performance.now();
    this.step();
  }
  step() {
    if (!this.motion) return;
    const now = performance.now(), dt = Math.min(0.1, (now - this.before) / 1e3), [closed, opened] = this.limits.gap, range = opened - closed;
    this.before = now;
    const way = (this.motion > 0 ? OPENING : -CLOSING) * dt * range;
    this.gap = Math.max(closed, Math.min(opened, this.gap + way));
    if (this.gap === (this.motion > 0 ? opened : closed)) this.motion = 0;
    this.changed();
    requestAnimationFrame(() => this.step());
  }

  // Updates the controls from a frame.
  show(frame) {
    if (!this.isAtHand) {  // another page may have moved it
      this.isAtHand = true;
      const [thumb, index] = [THUMB_TIP, INDEX_TIP].map((joint) => new Vector3(...frame.rigged[joint]));
      if (!this.kept()) this.place({position: thumb.add(index).multiplyScalar(0.5).toArray(), gap: frame.gap, ...angles(frame.rotation)});
      this.showValues();
    }
    this.isHeld = HELD.includes(frame.state);
    if (this.isHeld && this.motion < 0) {
      this.motion = 0;
      const stiffness = this.limits.opening_N_m;  // it has closed on since it held, by what follows from the force that opens it
      const way = stiffness > 0 ? Math.max(0, frame.forces.opening) / stiffness : 0;
      this.gap = Math.max(this.limits.gap[0], frame.gap + way - SQUEEZE);
      this.changed();
    }
    const word = this.motion < 0 || this.isHeld ? 'Let go' : 'Grasp';
    if (this.grasp.textContent !== word) this.grasp.textContent = word;
  }

  showValues() {
    for (const {input, value, read, text} of Object.values(this.sliders)) {
      if (document.activeElement !== input || this.motion || this.pointer !== undefined) input.value = String(read());
      value.textContent = text();
    }
  }

  // ---- sending: at most 60 a second, one on its way ----
  changed() {
    this.showValues();
    this.keep();
    this.isStale = true;
    if (!this.isSending) this.send();
  }
  async send() {
    this.isSending = true;
    while (this.isStale) {
      this.isStale = false;
      const began = performance.now();
      try {
        const answer = await fetch('control', {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(this.state())});
        this.showError(answer.ok ? '' : (await answer.text()).trim());
      } catch (error) {
        this.showError('wholehand does not answer any more.');
        break;
      }
      await new Promise((done) => setTimeout(done, Math.max(0, INTERVAL - (performance.now() - began))));
    }
    this.isSending = false;
  }
  // The gripper's axes: turned about the vertical, then tilted about its closing line; a positive tilt pours away from the palm. Numbers go up, above
  // those of a page that was here before.
  state() {
    const turn = new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), this.turn), tilt = new Quaternion().setFromAxisAngle(new Vector3(1, 0, 0), -this.tilt);
    const e = new Matrix4().makeRotationFromQuaternion(turn.multiply(tilt)).elements;
    this.sequence = Math.max(this.sequence + 1, Date.now());
    return {position: this.position.toArray(), rotation: [e[0], e[4], e[8], e[1], e[5], e[9], e[2], e[6], e[10]], gap: this.gap, buttons: 0, sequence: this.sequence};
  }

  // What held keys do in `dt` s.
  keys() {
    const by = (x, y, z) => (dt) => { this.moveBy(new Vector3(x, y, z).multiplyScalar(KEY_SPEED * dt)); this.changed(); };
    const turn = (name, way) => (dt) => {
      const most = (name === 'tilt' ? LARGEST_TILT : LARGEST_TURN) * Math.PI / 180;
      this[name] = Math.max(name === 'tilt' ? -Math.PI / 6 : -most, Math.min(most, this[name] + way * KEY_TURN * dt));
      this.changed();
    };
    const close = (way) => (dt) => {
      const [closed, opened] = this.limits.gap;
      this.motion = 0;
      this.gap = Math.max(closed, Math.min(opened, this.gap - way * CLOSING * dt * (opened - closed)));
      this.changed();
    };
    return [
      {keys: [' '], shown: 'Space', what: 'grasp, let go', once: true, act: () => this.toggle()},
      {keys: ['d'], shown: 'A D', what: 'move left, right', glide: by(1, 0, 0)}, {keys: ['a'], glide: by(-1, 0, 0)},
      {keys: ['w'], shown: 'W S', what: 'move away, towards you', glide: by(0, 0, -1)}, {keys: ['s'], glide: by(0, 0, 1)},
      {keys: ['e'], shown: 'E Q', what: 'move up, down', glide: by(0, 1, 0)}, {keys: ['q'], glide: by(0, -1, 0)},
      {keys: ['x'], shown: 'X Y', what: 'close, open', glide: close(1)}, {keys: ['y'], glide: close(-1)},
      {keys: ['t'], shown: 'T R', what: 'tilt, tilt back', glide: turn('tilt', 1)}, {keys: ['r'], glide: turn('tilt', -1)},
      {keys: ['v'], shown: 'V B', what: 'turn left, right', glide: turn('turn', 1)}, {keys: ['b'], glide: turn('turn', -1)},
    ];
  }
}
