// SPDX-License-Identifier: MIT
// Where frames come from: the server's stream of a live session, stretches of a recording, states of a grip.
import {isNumber} from './format.js';

// What `read` makes of the answer. A connection can end before the answer and within its body: fetch and body fail the same way.
export async function request(address, read) {
  try {
    const answer = await fetch(address, {cache: 'no-store'});
    if (answer.ok) return await read(answer);
    throw new Error((await answer.text()).trim().split('\n')[0] || `${address}: ${answer.status}`);
  } catch (error) {
    if (error instanceof TypeError) throw new Error('wholehand does not answer any more.');
    throw error;
  }
}

const json = (address) => request(address, (answer) => answer.json());

export const loadScene = () => json('scene.json');

// Live: calls `frame` with each, `status` with 'live', 'waiting' or 'over' and a reason.
export function listen(frame, status) {
  const source = new EventSource('frames');
  let newest = null;
  const next = () => {  // what the screen cannot show is passed over
    if (newest) frame(newest);
    newest = null;
  };
  let wasOpen = false;
  source.onopen = () => {
    wasOpen = true;
    status('live');
  };
  source.onerror = () => {
    status(source.readyState === EventSource.CLOSED ? 'over' : 'waiting', wasOpen ? 'the connection is lost' : 'too many viewers are connected');
  };
  source.onmessage = (event) => {
    const isFirst = newest === null;
    newest = JSON.parse(event.data);
    if (isFirst) requestAnimationFrame(next);
  };
  source.addEventListener('end', (event) => {
    source.close();
    let reason = '';
    try {
      reason = JSON.parse(event.data).reason;
    } catch (error) {
      reason = event.data;
    }
    next();
    status('over', reason);
  });
  return source;
}

const STRETCH = 5;         // s of a recording that are fetched at once
const KEPT = 24;           // stretches
const FRAMES_AT_MOST = 600;

// A recording, fetched as it is needed.
export class Recording {
  // `arrived` is called when more of it is here.
  constructor(duration, rate, arrived) {
    this.duration = duration;
    this.rate = rate;
    this.arrived = arrived;
    this.stretches = new Map();  // by number: a promise of frames
    this.ready = new Map();      // by number: frames
  }

  fetch(from, to, rate) {
    return json(`recording?from=${from.toFixed(6)}&to=${to.toFixed(6)}&rate=${rate}`).then((answer) => answer.frames);
  }

  // All of it, coarsely; by one frame less than the most, as `to` is rounded on its way.
  overview() {
    const rate = Math.min(this.rate || 1000, (FRAMES_AT_MOST - 2) / Math.max(this.duration, 1e-3));
    return this.fetch(0, this.duration, rate);
  }

  stretch(number) {
    if (!this.stretches.has(number)) {
      const from = number * STRETCH, promise = this.fetch(from, Math.min(from + STRETCH, this.duration), Math.min(60, this.rate || 60));
      this.stretches.set(number, promise);
      promise.then((frames) => {
        this.ready.set(number, frames);
        this.arrived();
      }, () => this.stretches.delete(number));
      if (this.stretches.size > KEPT) {
        const far = [...this.stretches.keys()].sort((a, b) => Math.abs(b - number) - Math.abs(a - number))[0];
        this.stretches.delete(far);
        this.ready.delete(far);
      }
    }
    return this.stretches.get(number);
  }

  // The last frame up to t; waited for.
  async at(t) {
    const number = this.number(t), frames = await this.stretch(number);
    this.ahead(number);
    return this.pick(frames, t);
  }

  // The same if it is here, else null.
  now(t) {
    const number = this.number(t), frames = this.ready.get(number);
    if (!frames) return null;
    this.ahead(number);
    return this.pick(frames, t);
  }

  number(t) {
    return Math.floor(Math.max(0, Math.min(t, this.duration - 1e-9)) / STRETCH);
  }

  // Once for each stretch: an error is reported when it is that stretch's turn.
  ahead(number) {
    if (this.aheadOf === number) return;
    this.aheadOf = number;
    if ((number + 1) * STRETCH < this.duration) this.stretch(number + 1).catch(() => {});
  }

  pick(frames, t) {
    let low = 0, high = frames.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (frames[middle].t <= t + 1e-9) low = middle;
      else high = middle - 1;
    }
    return frames[low];
  }

  // What is here of the seconds before t.
  before(t, span) {
    const found = [];
    for (let number = this.number(t - span); number <= this.number(t); ++number) {
      const frames = this.ready.get(number);
      if (frames) found.push(...frames.filter((frame) => frame.t >= t - span && frame.t <= t + 1e-9));
      else this.stretch(number).catch(() => {});
    }
    return found;
  }
}

// The frame of a grip; asked for one at a time, the newest request first.
export class States {
  constructor(frame, showError) {
    this.frame = frame;
    this.showError = showError;
    this.request = null;
    this.isAsking = false;
  }

  static fetch(grip, fill, tilt) {
    const numbers = [fill, tilt].map((value) => (isNumber(value) ? value : 0));
    return json(`state?grip=${grip}&fill=${numbers[0]}&tilt=${numbers[1]}`);
  }

  ask(grip, fill, tilt) {
    this.request = [grip, fill, tilt];
    if (!this.isAsking) this.go();
  }

  async go() {
    this.isAsking = true;
    while (this.request) {
      const request = this.request;
      this.request = null;
      try {
        this.frame(await States.fetch(...request), request);
      } catch (error) {
        this.showError(error.message);
      }
    }
    this.isAsking = false;
  }
}
