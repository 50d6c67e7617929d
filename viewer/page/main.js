// SPDX-License-Identifier: MIT
// Brings the parts together: loads the scene, makes the picture and the numbers, and feeds them with frames. What a test may ask for is
// window.wholehand (docs/view.md).
import {Charts, record, SPAN} from './charts.js';
import {Control} from './control.js';
import {seldom} from './format.js';
import {Grips} from './grips.js';
import {listenToKeys, viewKeys} from './keys.js';
import {Panels} from './panels.js';
import {Playback} from './playback.js';
import {listen, loadScene, Recording} from './stream.js';
import {stillMode} from './theme.js';
import {View} from './view.js';

const PANELS_EVERY = 66, CHARTS_EVERY = 50, COUNT_EVERY = 1000;  // ms
const find = (id) => document.getElementById(id);

let noPicture = '';  // why there is none: that stays

function trouble(text) {
  const place = find('trouble'), said = text || noPicture;
  if (place.textContent !== said) place.textContent = said;
  place.hidden = !said;
}

function makeView(about) {
  try {
    return new View(find('view'), about);
  } catch (error) {
    noPicture = error.message;
    trouble('');
    return null;
  }
}

function wireTools(view) {
  const buttons = {ghost: find('ghost'), points: find('points'), follow: find('follow')};
  for (const button of document.querySelectorAll('[data-view]')) {
    const name = button.dataset.view;
    buttons[name] = button;
    button.addEventListener('click', () => {
      if (name === 'home' && view.follows) buttons.follow.click();
      else if (name === 'home') view.orbit.reset();
      else view.orbit.view(name);
    });
  }
  for (const button of document.querySelectorAll('[data-zoom]')) button.addEventListener('click', () => view.orbit.zoom(Number(button.dataset.zoom)));
  const toggle = (button, act) => button.addEventListener('click', () => {
    const isOn = button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', String(isOn));
    act(isOn);
    view.stage.invalidate();
  });
  toggle(buttons.ghost, (isOn) => view.setGhost(isOn));
  toggle(buttons.points, (isOn) => view.marks.setVisible(isOn));
  toggle(buttons.follow, (isOn) => view.setFollow(isOn));
  return buttons;
}

// The last seconds of a live session.
class History {
  constructor() {
    this.records = [];
  }
  push(frame) {
    const last = this.records[this.records.length - 1];
    if (last && frame.t < last.x) this.records = [];  // another session has begun
    if (!last || frame.t > last.x) this.records.push(record(frame));
    while (this.records.length && this.records[0].x < frame.t - SPAN - 0.5) this.records.shift();
    return this.records;
  }
}

async function start() {
  const about = await loadScene();
  document.title = `${about.title} · wholehand`;
  find('title').textContent = about.title;
  find('subtitle').textContent = [{live: 'live session', recording: 'recording', grips: 'grips'}[about.mode], about.device, about.version].filter(Boolean).join(' · ');
  const panels = new Panels(about), charts = new Charts(find('charts'), about.mode === 'grips');
  const view = makeView(about);
  let bindings = [], framed = false, control = null, playback = null, grips = null;

  const showNumbers = seldom(PANELS_EVERY, (frame, grip) => panels.show(frame, grip));
  const show = (frame, grip) => {
    window.wholehand.frame = frame;
    if (view) {
      view.grip = grips ? grips.chosen : undefined;
      view.show(frame);
      if (!framed || (grips && view.homeOf !== frame.vessel)) view.frameHome();
      view.homeOf = frame.vessel;
      framed = true;
    }
    showNumbers(frame, grip);
    if (control) control.show(frame);
  };

  window.wholehand = {scene: about, frame: null, view, panels, charts, get playback() { return playback; }, get grips() { return grips; }, get control() { return control; },
    project: (joint) => view.project(window.wholehand.frame.joints[joint]),
    camera: () => view.seenFrom(),
  };

  if (about.mode === 'live') {
    const history = window.wholehand.history = new History(), drawCharts = seldom(CHARTS_EVERY, (frame) => charts.show(history.records, frame.t));
    charts.live = true;
    if (about.control && view) control = new Control(about, view, trouble);
    listen((frame) => {
      history.push(frame);
      show(frame);
      drawCharts(frame);
    }, (status, reason) => {
      find('link').dataset.status = status;
      find('link').textContent = {live: 'live', waiting: 'waiting', over: reason ? `over: ${reason}` : 'over'}[status];
    });
    if (control) bindings = control.keys();
  } else if (about.mode === 'recording') {
    const drawCharts = seldom(CHARTS_EVERY, () => charts.show(recording.before(playback.t, SPAN).map(record), playback.t));
    const recording = new Recording(about.duration, about.rate, () => playback && drawCharts());
    playback = new Playback(recording, (frame) => {
      trouble('');
      show(frame);
      drawCharts();
    }, trouble);
    bindings = playback.keys();
    await playback.seek(0);
  } else {
    find('chart-title').textContent = 'Over the tilt';
    grips = new Grips(about, (frame, grip) => {
      trouble('');
      show(frame, grip);
    }, (records, tilt) => charts.show(records || [], tilt), trouble);
    find('chart-panel').hidden = grips.largestTilt === 0;
    bindings = grips.keys();
    grips.choose(0);
  }
  if (view) {
    const buttons = wireTools(view);
    listenToKeys([...viewKeys(view, buttons), ...bindings], view.stage.canvas);
    if (about.mode !== 'grips' && !stillMode.matches) buttons.follow.click();
    await view.load();
    let before = 0;
    setInterval(() => {
      panels.loop.frames.textContent = `${view.stage.pictures - before} a second`;
      before = view.stage.pictures;
    }, COUNT_EVERY);
  }
}

start().catch((error) => trouble(error.message));
