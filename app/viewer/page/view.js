// SPDX-License-Identifier: MIT
// A frame as a picture: puts hand, marks, vessels, liquids and stream where a frame says, and aims the camera.
import * as THREE from './three.module.js';
import {Arrows} from './arrows.js';
import {Hand} from './hand.js';
import {Liquid} from './liquid.js';
import {Marks} from './marks.js';
import {Pour} from './pour.js';
import {Stage} from './stage.js';
import {stillMode} from './theme.js';
import {Vessels} from './vessels.js';

const FOLLOW = 0.7;  // s, time constant with which the picture's middle follows the hand
const FOLLOWED = 0.2;   // m about the hand that are seen while it is followed
const SHELF = 2.2;      // of a vessel's radius, of what it stands on above the table
const HEADROOM = 0.09;  // m over the vessels of a scene, for the hand
const BESIDE = 0.95;    // rad, from the forearm's side towards the index finger's
const THUMB_TIP = 3, INDEX_TIP = 8;

export class View {
  constructor(canvas, about) {
    this.about = about;
    this.stage = new Stage(canvas);
    this.orbit = this.stage.orbit;
    this.tableY = about.table_y;  // where vessels stand: in a scene the lowest of them, of a grip its own
    const {scene} = this.stage;
    this.vessels = new Vessels(scene, about.vessels);
    this.pour = new Pour(scene, about, this.vessels);
    this.liquids = this.vessels.list.slice(0, this.vessels.count).map((vessel) => (vessel.about.inner ? new Liquid(vessel) : null));
    this.hand = new Hand(scene, about.joints);
    this.marks = new Marks(scene, about.joints);
    this.arrows = new Arrows(scene);
    this.follows = false;
    this.isDragged = false;  // the hand is, which the picture then must not follow
    this.frame = null;
    this.stage.beforeDraw.push((time, dt) => this.prepare(time, dt));
    this.stage.beforeRender.push(() => {
      this.marks.shared.pixels.value = this.stage.renderer.getPixelRatio();
      this.marks.shared.size.value = Math.max(0.75, Math.min(1, this.stage.canvas.clientWidth / 900));
      this.vessels.sort(this.stage.camera);
    });
  }

  // Meshes of vessels that are no outlines.
  load() {
    return this.vessels.load().then(() => this.stage.invalidate());
  }

  size() {
    const grips = this.about.grips;
    return this.grip !== undefined && grips ? grips[this.grip].hand_scale || 1 : 1;
  }

  show(frame) {
    this.frame = frame;
    const size = this.size();
    this.vessels.place(frame, this.tableY);
    frame.vessels.forEach((state, k) => state && this.liquids[k] && this.liquids[k].show(state.volume, state.level, state.up));
    this.hand.pose(frame, size);
    const near = frame.vessel >= 0 ? this.vessels.list[frame.vessel] : this.vessels.nearest(frame.joints);
    this.hand.skin.press(near && near.matrix, near && near.profile);
    this.pour.show(frame);
    this.marks.shared.table.value = this.hand.skin.uniforms.table.value = this.tableY;
    this.marks.show(frame, size, this.guidancePlace(frame));
    this.arrows.show(frame.holding ? frame.holding.contacts : []);
    this.middle = frame.joints.reduce((sum, p) => sum.add(new THREE.Vector3(...p)), new THREE.Vector3()).multiplyScalar(1 / frame.joints.length);
    this.stage.lightAt(this.middle);
    this.stage.invalidate();
  }

  // The guided place on the vessel that is held, else on the nearest one.
  guidancePlace(frame) {
    if (frame.guidance < 0) return null;
    const near = frame.vessel >= 0 ? this.vessels.list[frame.vessel] : this.vessels.nearest(frame.joints);
    const points = near && near.about.guidance;
    if (!points || !points.length) return null;
    return new THREE.Vector3(...points[frame.guidance % points.length]).applyMatrix4(near.matrix).toArray();
  }

  prepare(time, dt) {
    const moving = !stillMode.matches;
    let goesOn = this.pour.step(moving ? time : 0) && moving;
    if (this.frame && this.frame.guidance >= 0 && moving) this.marks.shared.pulse.value = 0.6 + 0.4 * Math.sin(4 * time);
    else this.marks.shared.pulse.value = 1;
    if (this.follows && this.middle && !this.isDragged && this.orbit.pointers.size === 0) {
      const left = this.middle.distanceTo(new THREE.Vector3(this.orbit.aim.x, this.orbit.aim.y, this.orbit.aim.z));
      const share = moving && left > 1e-4 ? 1 - Math.exp(-dt / FOLLOW) : 1;
      for (const axis of ['x', 'y', 'z']) this.orbit.aim[axis] += (this.middle[axis] - this.orbit.aim[axis]) * share;
      goesOn = goesOn || left > 1e-9;  // the orbit goes there with the next picture
    }
    return goesOn;
  }

  // The home view shows all vessels and targets of a scene; of a grip the glass and the hand about the pivot, whatever the tilt.
  frameHome() {
    const {about, frame} = this, points = [];
    const ring = ([x, y, z], radius) => {
      for (let k = 0; k < 8; ++k) points.push([x + radius * Math.cos(k * Math.PI / 4), y, z + radius * Math.sin(k * Math.PI / 4)]);
    };
    if (about.mode === 'grips') {
      const vessel = about.vessels[frame.vessel];
      this.tableY = vessel.place[1] + vessel.base;
      const pivot = new THREE.Vector3(...frame.joints[THUMB_TIP]).add(new THREE.Vector3(...frame.joints[INDEX_TIP])).multiplyScalar(0.5);
      const far = Math.max(...frame.joints.map((p) => pivot.distanceTo(new THREE.Vector3(...p))), vessel.height * 0.6);
      for (const way of [[1, 0, 0], [0, 1, 0], [0, 0, 1]]) for (const sign of [-0.8, 0.8]) points.push(pivot.toArray().map((v, k) => v + sign * far * way[k]));
      const {place} = frame.vessels[frame.vessel];
      ring(place, vessel.radius);
      ring([place[0], place[1] + vessel.height, place[2]], vessel.radius);
      points.push(...frame.joints, frame.wrist);
      this.stage.setTable(vessel.place, this.tableY);
      this.orbit.setHome(points, this.besideAzimuth(pivot), 0.32);
    } else {
      for (const {place, radius, height} of about.vessels) {
        ring(place, radius);
        ring([place[0], place[1] + height, place[2]], radius);
        points.push([place[0], place[1] + height + HEADROOM, place[2]]);
      }
      if (about.target) ring(about.target.place, about.target.diameter / 2);
      if (about.destination) ring(about.destination, 0.04);
      const middle = points.reduce((sum, p) => sum.map((v, k) => v + p[k] / points.length), [0, 0, 0]);
      this.stage.setTable(middle, this.tableY);
      this.stage.setShelves(about.vessels.map(({place, base, radius}) => ({place, height: place[1] + base, radius: SHELF * radius}))
        .filter(({height}) => height > this.tableY + 1e-4));
      this.orbit.setHome(points, 0.24, 0.5);
    }
    this.orbit.reset();
    this.orbit.jump();
    this.show(frame);
  }

  // From beside the hand: where thumb, fingers and glass are all seen, whichever way the grip is turned and whichever hand it is.
  besideAzimuth(pivot) {
    const {joints, wrist} = this.frame, flat = (p) => new THREE.Vector3(p[0], 0, p[2]);
    const index = flat(joints[INDEX_TIP]).sub(flat(joints[THUMB_TIP])).normalize();
    const arm = flat(wrist).sub(new THREE.Vector3(pivot.x, 0, pivot.z));
    arm.addScaledVector(index, -arm.dot(index));
    const way = index.multiplyScalar(Math.sin(BESIDE)).addScaledVector(arm.normalize(), Math.cos(BESIDE));
    return Math.atan2(way.x, way.z);
  }

  // Keeps the hand in the middle, near enough to see its points; or shows all again.
  setFollow(isOn) {
    this.follows = isOn;
    if (!isOn) this.orbit.reset();
    else this.orbit.go({distance: this.orbit.distanceFor(FOLLOWED)});
  }

  setGhost(isShown) {
    this.hand.ghost.mesh.visible = isShown;
    if (this.frame) this.show(this.frame);
  }

  // Where a point of the world is in the window, CSS pixels.
  project(place) {
    const {camera, canvas} = this.stage, box = canvas.getBoundingClientRect();
    const ndc = new THREE.Vector3(...place).project(camera);
    return {x: box.left + (ndc.x + 1) / 2 * box.width, y: box.top + (1 - ndc.y) / 2 * box.height, depth: ndc.z};
  }

  // What the picture is seen with, and whether it has come to rest there.
  seenFrom() {
    const {camera, canvas} = this.stage, {now, aim} = this.orbit, {left, top, width, height} = canvas.getBoundingClientRect();
    return {
      position: camera.position.toArray(), target: [now.x, now.y, now.z], fov: camera.fov * Math.PI / 180, rectangle: {left, top, width, height},
      isStill: Object.keys(now).every((key) => Math.abs(now[key] - aim[key]) < 1e-6) && Math.abs(camera.aspect * height - width) < 1,
    };
  }
}
