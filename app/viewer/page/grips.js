// SPDX-License-Identifier: MIT
// The best grips of a sweep, or one grip: a list with the terms of the score, sliders for tilt and fill, and the forces over the tilt.
import {degrees, element, fixed, millimeters} from './format.js';
import {record} from './charts.js';
import {States} from './stream.js';

const CURVE = 31;           // points of the curve over the tilt
const NO_TILT = [0];

const slider = (id, label, max, step) => {
  const input = element('input', {type: 'range', id, min: '0', max: String(max), step: String(step), value: '0'});
  const value = element('output', {for: id});
  return {input, value, row: element('div', {class: 'slider'}, element('label', {for: id, text: label}), input, value)};
};

export class Grips {
  // `frame(frame, grip)` shows one; `curve(records, tilt)` draws the forces over the tilt.
  constructor(about, frame, curve, showError) {
    this.about = about;
    this.curve = curve;
    this.showError = showError;
    this.chosen = 0;
    this.curves = new Map();
    this.largestTilt = Math.max(...(about.tilts.length ? about.tilts : NO_TILT));
    this.states = new States((found, [grip]) => {
      frame(found, about.grips[grip]);
      this.showCurve();
    }, showError);
    this.makeSliders(document.getElementById('held'));
    if (about.grips.length > 1) this.makeList(document.getElementById('grips'));
    this.makeTerms(document.getElementById('score'));
  }

  makeSliders(place) {
    this.tilt = slider('tilt', 'Tilt', this.largestTilt * 180 / Math.PI, 1);
    this.fill = slider('fill', 'Fill', 1, 0.01);
    const fills = this.about.fills;
    this.fill.input.value = fills.length ? String(fills[Math.floor(fills.length / 2)]) : '0';
    this.tilt.row.hidden = this.largestTilt === 0;
    this.fill.row.hidden = !fills.some((fill) => fill > 0);
    for (const {input} of [this.tilt, this.fill]) input.addEventListener('input', () => this.ask());
    place.append(this.tilt.row, this.fill.row);
    place.hidden = false;
  }

  makeList(place) {
    const vessels = [...new Set(this.about.grips.map((grip) => grip.vessel))];
    this.which = element('select', {'aria-label': 'Vessel'});
    this.which.add(new Option('All vessels', ''));
    for (const k of vessels) this.which.add(new Option(this.about.vessels[k].name, k));
    this.which.hidden = vessels.length < 2;
    this.list = element('div', {class: 'grip-list', role: 'listbox', tabindex: '0', 'aria-label': 'Best grips'});
    this.options = this.about.grips.map((grip, k) => this.makeOption(grip, k));
    this.list.append(...this.options);
    this.which.addEventListener('change', () => this.filter());
    this.list.addEventListener('keydown', (event) => this.key(event));
    place.append(this.which, this.list);
    document.getElementById('grips-panel').hidden = false;
  }

  // Whether any grip of the list has one; checked once for each list.
  has(key) {
    if (this.lookedAt !== this.about) {
      this.lookedAt = this.about;
      this.varying = new Set(['azimuth_rad', 'offset_m'].filter((k) => this.about.grips.some((grip) => Math.abs(grip[k]) > 1e-9)));
    }
    return this.varying.has(key);
  }

  // Where a grip is taken; azimuth and offset where any grip of the list has one, or this grip, which may be a refined one.
  placeOf(grip) {
    return [`${millimeters(grip.height_m)} mm`, `roll ${degrees(grip.roll_rad)}°`, `obliquity ${degrees(grip.obliquity_rad)}°`,
      ...(this.has('azimuth_rad') || Math.abs(grip.azimuth_rad) > 1e-9 ? [`azimuth ${degrees(grip.azimuth_rad)}°`] : []),
      ...(this.has('offset_m') || Math.abs(grip.offset_m) > 1e-9 ? [`offset ${millimeters(grip.offset_m)} mm`] : [])].join(', ');
  }

  makeOption(grip, k) {
    const bar = element('span', {class: 'score-fill'});
    bar.style.width = `${100 * Math.max(0, Math.min(1, grip.score))}%`;  // by weights of a list it may be more than 1
    const option = element('div', {class: 'grip', role: 'option', id: `grip-${k}`, 'aria-selected': 'false'},
      element('b', {text: grip.label}), element('span', {class: 'score'}, element('span', {class: 'score-bar', 'aria-hidden': 'true'}, bar), fixed(grip.score, 3)),
      element('span', {class: 'more'}, element('small', {text: this.placeOf(grip),
        title: 'height of the thumb-index line, roll of the hand about it, the line’s angle to the horizontal, its azimuth and its offset from the axis'}),
      element('small', {text: `${grip.points} points`, title: `of ${grip.fingers} fingers`})));
    option.addEventListener('click', () => this.choose(k));
    return option;
  }

  makeTerms(place) {
    this.terms = element('dl', {class: 'terms', 'aria-label': 'Terms of the score'});
    this.facts = element('dl', {class: 'facts', 'aria-label': 'Over all states'});
    place.append(this.terms, this.facts);
    document.getElementById('score-panel').hidden = false;
  }

  showTerms(grip) {
    this.terms.replaceChildren(...Object.entries(grip.terms).map(([name, value]) => {
      const fill = element('span', {class: 'fill'});
      fill.style.width = `${100 * Math.max(0, Math.min(1, value))}%`;
      return element('div', {}, element('dt', {text: name}), element('dd', {}, element('span', {class: 'bar', 'aria-hidden': 'true'}, fill), fixed(value, 2)));
    }));
    this.facts.replaceChildren(...[
      ['Largest force', `${fixed(grip.peak_force_N, 2)} N`], [this.about.strength ? 'Largest pinch N‑hold' : 'Largest N‑hold', `${fixed(grip.hold_force_N, 1)} N`], ['Safe up to', `${degrees(grip.safe_tilt_rad)}°${grip.safe_to_end ? ' or more' : ''}`],
      ['Deepest point', `${millimeters(grip.depth_m)} mm`], ['Fingers', `${grip.fingers} of 5`], ['Pinch', grip.antipodal ? 'antipodal' : 'not antipodal'],
      ...(grip.refined ? [['Refined score', fixed(grip.refined.score, 3)], ['Refined grip', this.placeOf(grip.refined)]] : []),
      ...(grip.robust ? [['Robust mean', fixed(grip.robust.mean, 3)], ['Robust low', fixed(grip.robust.low, 3)]] : []),
    ].map(([name, value]) => element('div', {}, element('dt', {text: name}), element('dd', {text: value}))));
  }

  filter() {
    this.about.grips.forEach((grip, k) => { this.options[k].hidden = this.which.value !== '' && Number(this.which.value) !== grip.vessel; });
    const first = this.options.findIndex((option) => !option.hidden);
    if (this.options[this.chosen].hidden && first >= 0) this.choose(first);
  }

  key(event) {
    const seen = this.options.map((_, k) => k).filter((k) => !this.options[k].hidden), at = seen.indexOf(this.chosen);
    const to = {ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: seen.length - 1}[event.key];
    if (to === undefined) return;
    event.preventDefault();
    this.choose(seen[Math.max(0, Math.min(seen.length - 1, to))]);
  }

  choose(k) {
    this.chosen = k;
    if (this.options) {
      this.options.forEach((option, i) => option.setAttribute('aria-selected', String(i === k)));
      this.list.setAttribute('aria-activedescendant', `grip-${k}`);
      this.options[k].scrollIntoView({block: 'nearest'});
    }
    this.showTerms(this.about.grips[k]);
    this.ask();
  }

  ask() {
    const tilt = Number(this.tilt.input.value), fill = Number(this.fill.input.value);
    this.tilt.value.textContent = `${fixed(tilt, 0)}°`;
    this.fill.value.textContent = `${fixed(100 * fill, 0)} %`;
    this.states.ask(this.chosen, fill, tilt * Math.PI / 180);
    this.wantCurve(this.chosen, fill);
  }

  // The curve of this grip and fill, asked for once the slider rests.
  wantCurve(grip, fill) {
    clearTimeout(this.rest);
    if (this.largestTilt === 0) return;
    const key = `${grip} ${fill}`;
    if (this.curves.has(key)) return;
    this.rest = setTimeout(async () => {
      const records = [];
      this.curves.set(key, records);
      try {
        for (let k = 0; k < CURVE; ++k) {
          const tilt = this.largestTilt * k / (CURVE - 1);
          records.push({...record(await States.fetch(grip, fill, tilt)), x: tilt * 180 / Math.PI});
          if (key !== `${this.chosen} ${Number(this.fill.input.value)}`) {
            this.curves.delete(key);
            return;
          }
        }
        this.showCurve();
      } catch (error) {
        this.curves.delete(key);
        this.showError(error.message);
      }
    }, 150);
  }

  showCurve() {
    const records = this.curves.get(`${this.chosen} ${Number(this.fill.input.value)}`);
    this.curve(records && records.length === CURVE ? records : null, Number(this.tilt.input.value));
  }

  keys() {
    const move = (slider_, by) => () => {
      slider_.input.value = String(Number(slider_.input.value) + by);
      this.ask();
    };
    const next = (by) => () => this.options && this.key({key: by > 0 ? 'ArrowDown' : 'ArrowUp', preventDefault() {}});
    return [
      {keys: ['n'], shown: 'N P', what: 'next, previous grip', act: next(1)},
      {keys: ['p'], act: next(-1)},
      {keys: ['t'], shown: 'T R', what: 'tilt more, less', act: move(this.tilt, 5)},
      {keys: ['r'], act: move(this.tilt, -5)},
      {keys: ['l'], shown: 'L K', what: 'fill more, less', act: move(this.fill, 0.05)},
      {keys: ['k'], act: move(this.fill, -0.05)},
    ];
  }
}
