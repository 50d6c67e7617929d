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

function showError(text) {
  const place = find('error'), said = text || noPicture;
  if (place.textContent !== said) place.textContent = said;
  place.hidden = !said;
}

function makeView(about) {
  try {
    return new View(find('view'), about);
  } catch (error) {
    noPicture = error.message;
    showError('');
    return null;
  }
}

function wireTools(view) {
  const buttons = {ghost: find('ghost'), points: find('points'), arrows: find('arrows'), follow: find('follow')};
  buttons.arrows.hidden = !view.about.strength;
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
  toggle(buttons.arrows, (isOn) => view.arrows.setVisible(isOn));
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

function setTitles(about) {
  document.title = `${about.title} · wholehand`;
  find('title').textContent = about.title;
  const mode = {live: 'live session', recording: 'recording', grips: 'grips'}[about.mode];
  find('subtitle').textContent = [mode, about.device, about.version].filter(Boolean).join(' · ');
}

// Answers what shows a frame, and the numbers of a grip where there is one. `parts.view` is null where there is no picture.
function makeShow(parts) {
  const {view, panels} = parts;
  const showNumbers = seldom(PANELS_EVERY, (frame, grip) => panels.show(frame, grip));
  let framed = false;
  return (frame, grip) => {
    window.wholehand.frame = frame;
    if (view) {
      view.grip = parts.grips ? parts.grips.chosen : undefined;
      view.show(frame);
      if (!framed || (parts.grips && view.homeOf !== frame.vessel)) view.frameHome();
      view.homeOf = frame.vessel;
      framed = true;
    }
    showNumbers(frame, grip);
    if (parts.control) parts.control.show(frame);
  };
}

function offerToTests(parts) {
  const {about, view, panels, charts} = parts;
  window.wholehand = {scene: about, frame: null, view, panels, charts,
    get playback() { return parts.playback; },
    get grips() { return parts.grips; },
    get control() { return parts.control; },
    project: (joint) => view.project(window.wholehand.frame.joints[joint]),
    camera: () => view.seenFrom(),
  };
}

// This and the two that follow start one mode each, and answer its keys.
function startLive(parts, show) {
  const {about, view, charts} = parts;
  const history = window.wholehand.history = new History();
  const drawCharts = seldom(CHARTS_EVERY, (frame) => charts.show(history.records, frame.t));
  charts.live = true;
  if (about.control && view) parts.control = new Control(about, view, showError);
  listen((frame) => {
    history.push(frame);
    show(frame);
    drawCharts(frame);
  }, (status, reason) => {
    find('link').dataset.status = status;
    find('link').textContent = {live: 'live', waiting: 'waiting', over: reason ? `over: ${reason}` : 'over'}[status];
  });
  return parts.control ? parts.control.keys() : [];
}

async function startRecording(parts, show) {
  const {about, charts} = parts;
  const drawCharts = seldom(CHARTS_EVERY, () => {
    const {t} = parts.playback;
    charts.show(recording.before(t, SPAN).map(record), t);
  });
  const recording = new Recording(about.duration, about.rate, () => parts.playback && drawCharts());
  parts.playback = new Playback(recording, (frame) => {
    showError('');
    show(frame);
    drawCharts();
  }, showError);
  const bindings = parts.playback.keys();
  await parts.playback.seek(0);
  return bindings;
}

function startGrips(parts, show) {
  const {about, charts} = parts;
  find('chart-title').textContent = 'Over the tilt';
  parts.grips = new Grips(about, (frame, grip) => {
    showError('');
    show(frame, grip);
  }, (records, tilt) => charts.show(records || [], tilt), showError);
  find('chart-panel').hidden = parts.grips.largestTilt === 0;
  const bindings = parts.grips.keys();
  parts.grips.choose(0);
  return bindings;
}

function countPictures(view, panels) {
  let before = 0;
  setInterval(() => {
    panels.loop.frames.textContent = `${view.stage.pictures - before} a second`;
    before = view.stage.pictures;
  }, COUNT_EVERY);
}

async function start() {
  const about = await loadScene();
  setTitles(about);
  const panels = new Panels(about), charts = new Charts(find('charts'), about.mode === 'grips', Boolean(about.strength));
  const view = makeView(about);
  const parts = {about, panels, charts, view, control: null, playback: null, grips: null};
  const show = makeShow(parts);
  offerToTests(parts);
  let bindings = [];
  if (about.mode === 'live') bindings = startLive(parts, show);
  else if (about.mode === 'recording') bindings = await startRecording(parts, show);
  else bindings = startGrips(parts, show);
  if (!view) return;
  const buttons = wireTools(view);
  listenToKeys([...viewKeys(view, buttons), ...bindings], view.stage.canvas);
  if (about.mode !== 'grips' && !stillMode.matches) buttons.follow.click();
  await view.load();
  countPictures(view, panels);
}

start().catch((error) => showError(error.message));
