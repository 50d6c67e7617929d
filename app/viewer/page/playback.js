// SPDX-License-Identifier: MIT
// Playing a recording: play, pause, scrub, speed, and a strip that shows its states.
import {clock} from './format.js';
import {cssColor, onThemeChange} from './theme.js';

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const NUDGE = 0.1, LEAP = 1;  // s, by keys

export class Playback {
  // `frame` is called with each frame to show.
  constructor(recording, frame, showError) {
    this.recording = recording;
    this.frame = frame;
    this.showError = showError;
    this.t = 0;
    this.isPlaying = false;
    this.runs = 0;  // times that it was played; a step of an earlier one is none any more
    this.speed = 1;
    const find = (id) => document.getElementById(id);
    [this.button, this.scrub, this.clock, this.timeline] = ['play', 'scrub', 'clock', 'timeline'].map(find);
    find('playback').hidden = false;
    this.scrub.max = recording.duration;
    this.scrub.step = Math.min(0.01, 1 / (recording.rate || 1000));
    this.button.addEventListener('click', () => this.toggle());
    this.scrub.addEventListener('input', () => this.seek(Number(this.scrub.value)));
    const speed = find('speed');
    for (const factor of SPEEDS) speed.add(new Option(`${factor} ×`, factor, factor === 1, factor === 1));
    speed.addEventListener('change', () => { this.speed = Number(speed.value); });
    new ResizeObserver(() => this.drawStates()).observe(this.timeline);
    onThemeChange(() => this.drawStates());
    this.recording.overview().then((frames) => {
      this.frames = frames;
      this.drawStates();
    }, () => {});  // without it the strip is empty; the stretches report errors
  }

  // Each state is a band with its own height and color.
  drawStates() {
    const {timeline, frames} = this, scale = devicePixelRatio || 1, width = timeline.clientWidth, height = timeline.clientHeight;
    if (!frames || !width) return;
    timeline.width = width * scale;
    timeline.height = height * scale;
    const pen = timeline.getContext('2d');
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    const tall = {free: 0.16, touching: 0.34, lift: 0.58, tilt: 1, maintain: 0.8, slipped: 0.24, 'let go': 0.24, released: 0.08};
    for (let k = 0, next; k < frames.length; k = next) {
      const {state} = frames[k];
      for (next = k + 1; next < frames.length && frames[next].state === state; ) ++next;
      const [from, to] = [frames[k].t, next < frames.length ? frames[next].t : this.recording.duration].map((t) => t / this.recording.duration * width);
      pen.fillStyle = cssColor(`--state-${state.replace(' ', '-')}`);
      const high = height * (tall[state] || 0.1);
      pen.fillRect(from, height - high, to - from, high);
    }
  }

  toggle() {
    if (this.isPlaying) return this.pause();
    if (this.t >= this.recording.duration - 1e-6) this.t = 0;
    this.isPlaying = true;
    this.showButton();
    this.runs += 1;
    this.goOn(this.runs);
    return undefined;
  }

  pause() {
    this.isPlaying = false;
    this.showButton();
  }

  showButton() {
    this.button.textContent = this.isPlaying ? '❚❚' : '▶';
    this.button.setAttribute('aria-label', this.isPlaying ? 'Pause' : 'Play');
  }

  goOn(run) {
    this.last = null;
    requestAnimationFrame((now) => this.step(now / 1000, run));
  }

  step(now, run) {
    if (!this.isPlaying || run !== this.runs) return;
    const t = Math.min(this.recording.duration, this.t + (this.last === null ? 0 : Math.min(0.25, now - this.last) * this.speed));
    this.last = now;
    const frame = this.recording.now(t);
    if (!frame) {  // time stops while a stretch is on its way
      this.recording.at(t).then(() => this.goOn(run), (error) => {
        if (run !== this.runs) return;
        this.pause();
        this.showError(error.message);
      });
      return;
    }
    this.t = t;
    this.showTime();
    this.frame(frame);
    if (t >= this.recording.duration) this.pause();
    requestAnimationFrame((next) => this.step(next / 1000, run));
  }

  // Answers when that frame is shown.
  async seek(t) {
    this.t = Math.max(0, Math.min(this.recording.duration, t));
    const asked = this.t;
    this.showTime();
    try {
      const frame = await this.recording.at(asked);
      if (asked === this.t) this.frame(frame);
      return frame;
    } catch (error) {
      this.showError(error.message);
      return null;
    }
  }

  showTime() {
    this.scrub.value = this.t;
    const text = `${clock(this.t)} / ${clock(this.recording.duration)}`;
    this.clock.textContent = text;
    this.scrub.setAttribute('aria-valuetext', `${this.t.toFixed(1)} seconds`);
  }

  keys() {
    return [
      {keys: [' '], shown: 'Space', what: 'play or pause', once: true, act: () => this.toggle()},
      {keys: [','], shown: ', .', what: 'a tenth of a second back, forward', act: () => this.seek(this.t - NUDGE)},
      {keys: ['.'], act: () => this.seek(this.t + NUDGE)},
      {keys: ['<'], shown: '< >', what: 'a second back, forward', act: () => this.seek(this.t - LEAP)},
      {keys: ['>'], act: () => this.seek(this.t + LEAP)},
    ];
  }
}
