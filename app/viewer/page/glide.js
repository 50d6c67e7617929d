// SPDX-License-Identifier: MIT
// Held keys: what a key does goes on evenly while it is held, picture by picture, however the keyboard repeats; it ends with the key, or where the
// window loses the focus, whose keys are then let go unheard.

const LONGEST = 0.1;    // s that one picture may move: one that comes later is a page that stood still
const SHORTEST = 1 / 60;  // s that a tap is worth

export class Glide {
  constructor() {
    this.held = new Map();  // by key: what it does in dt, since when it has been done, for how long, s
    this.isRunning = false;
    addEventListener('blur', () => this.stop());
    document.addEventListener('visibilitychange', () => document.hidden && this.stop());
  }

  // `time` of an event or of a picture, ms, on the one clock that both have.
  press(key, act, time) {
    if (this.held.has(key)) return;
    this.held.set(key, {act, at: time, moved: 0});
    if (this.isRunning) return;
    this.isRunning = true;
    requestAnimationFrame((now) => this.step(now));
  }

  letGo(key, time) {
    const one = this.held.get(key);
    if (!one) return;
    this.advance(one, time);
    if (one.moved < SHORTEST) one.act(SHORTEST - one.moved);
    this.held.delete(key);
  }

  stop() {
    this.held.clear();
  }

  advance(one, time) {
    const dt = Math.max(0, Math.min(LONGEST, (time - one.at) / 1000));
    one.at = Math.max(one.at, time);
    one.moved += dt;
    if (dt > 0) one.act(dt);
  }

  step(now) {
    for (const one of this.held.values()) this.advance(one, now);
    this.isRunning = this.held.size > 0;
    if (this.isRunning) requestAnimationFrame((next) => this.step(next));
  }
}
