// SPDX-License-Identifier: MIT
// Lines over time, or over the tilt: forces, the force that holding needs, the tilt. Each row has its own scale; each line its name at its end.
import {element, feltForce, isNumber} from './format.js';
import {cssColor, onThemeChange} from './theme.js';

export const SPAN = 10;  // s
const ROWS = [
  {title: 'Force, N', share: 0.56, least: 4, lines: [
    {key: 'normal', name: 'Fₙ', color: '--line-normal', width: 1.6, dash: []},
    {key: 'user', name: 'grip', color: '--line-user', width: 1.6, dash: [5, 3]},
    {key: 'feedback', name: 'F', color: '--line-force', width: 2.4, dash: []}]},
  {title: 'Hold force, N', share: 0.25, least: 10, lines: [
    {key: 'tips', name: 'two tips', color: '--line-hold', width: 1.4, dash: [5, 3]},
    {key: 'hold', name: 'N‑hold', color: '--line-hold', width: 1.8, dash: []}]},
  {title: 'Tilt, °', share: 0.19, least: 90, lines: [{key: 'tilt', name: 'tilt', color: '--line-tilt', width: 1.6, dash: []}]},
];
const TOP = 16, BOTTOM = 20, BETWEEN = 24, TICK = 6, NAME = 5;  // px: the last two beside the lines, to a number and to a name

// What a chart keeps of a frame.
export const record = (frame) => ({x: frame.t, normal: frame.forces.normal, user: frame.forces.user, feedback: feltForce(frame.forces),
  hold: frame.forces.hold, tips: frame.holding ? frame.holding.tips_hold : null, tilt: isNumber(frame.tilt) ? frame.tilt * 180 / Math.PI : null});

// A step of 1, 2 or 5 times a power of ten of which `count` or fewer fit.
function niceStep(range, count) {
  const rough = range / count, power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((k) => k * power).find((step) => step >= rough * 0.999);
}

const tickText = (y) => String(Math.round(y * 1000) / 1000);

export class Charts {
  // `overTilt`: x is the tilt in degrees, and the row of the tilt is left out. `hasTips`: what two tips need is a line of its own.
  constructor(place, overTilt, hasTips) {
    const rows = ROWS.map((row) => ({...row, lines: row.lines.filter((line) => hasTips || line.key !== 'tips')}));
    this.rows = overTilt ? [{...rows[0], lines: rows[0].lines.slice(-1)}, rows[1]] : rows;  // there F is F_n, and the grip stays
    this.overTilt = overTilt;
    this.canvas = element('canvas', {role: 'img', 'aria-label': overTilt ? 'Forces over the tilt' : 'Forces, hold force and tilt over the last ten seconds'});
    place.append(this.canvas);
    this.records = [];
    this.tops = this.rows.map((row) => row.least);
    new ResizeObserver(() => this.draw()).observe(place);
    onThemeChange(() => this.draw());
  }

  // Lines through the records, which are in order of x; `now`: the right end of time, or where the mark stands on the tilt.
  show(records, now) {
    this.records = records;
    this.now = now;
    this.draw();
  }

  draw() {
    const {canvas} = this, scale = devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width || !height) return;
    if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
      canvas.width = Math.round(width * scale);
      canvas.height = Math.round(height * scale);
    }
    const pen = canvas.getContext('2d');
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = `11px ${getComputedStyle(canvas).fontFamily}`;
    this.texts = [];
    const inner = height - TOP - BOTTOM - BETWEEN * (this.rows.length - 1), whole = this.rows.reduce((sum, row) => sum + row.share, 0);
    const x0 = this.overTilt ? 0 : (this.now ?? 0) - SPAN, x1 = this.overTilt ? Math.max(1, ...this.records.map((r) => r.x)) : this.now ?? 0;
    const seen = this.records.filter((r) => r.x >= x0 - 0.1 && r.x <= x1 + 1e-9);
    const scales = this.rows.map((row) => this.scaleOf(row, seen, inner * row.share / whole));
    const wide = (texts) => Math.ceil(Math.max(...texts.map((text) => pen.measureText(text).width)));
    // the numbers' room on the left; the names' on the right, and half of what is under the right end
    const left = Math.max(wide(scales.flatMap(({ticks}) => ticks.map(tickText))) + TICK, wide(['−10']) / 2) + 1;
    const right = width - 1 - Math.max(wide(this.rows.flatMap((row) => row.lines.map((line) => line.name))) + NAME, wide([this.footText(0, x1)]) / 2);
    const toX = (x) => left + (x - x0) / (x1 - x0 || 1) * (right - left);
    let top = TOP;
    for (const [k, row] of this.rows.entries()) {
      const tall = inner * row.share / whole;
      this.tops[k] = scales[k].most;
      this.drawRow(pen, row, seen, scales[k], {top, bottom: top + tall, left, right, toX});
      top += tall + BETWEEN;
    }
    this.drawFoot(pen, {bottom: height - BOTTOM, top: TOP, left, right, toX, x0, x1});
  }

  // Up to where a row reaches that is so tall (px), and its numbers.
  scaleOf(row, seen, tall) {
    let most = row.least;
    for (const line of row.lines) for (const r of seen) if (isNumber(r[line.key])) most = Math.max(most, r[line.key] * 1.05);
    let step = niceStep(most, Math.max(2, Math.floor(tall / 24)));
    if (row.least === 90 && step > 20) step = most > 90 ? 90 : 45;
    const count = Math.ceil(most / step - 1e-9);
    return {most: count * step, ticks: Array.from({length: count + 1}, (_, k) => k * step)};
  }

  // A text, and where it is: what a test looks for in the picture.
  write(pen, text, x, y) {
    pen.fillText(text, x, y);
    const {actualBoundingBoxLeft, actualBoundingBoxRight, actualBoundingBoxAscent, actualBoundingBoxDescent} = pen.measureText(text);
    this.texts.push({text, left: x - actualBoundingBoxLeft, right: x + actualBoundingBoxRight, top: y - actualBoundingBoxAscent, bottom: y + actualBoundingBoxDescent});
  }

  drawRow(pen, row, seen, {most, ticks}, box) {
    const toY = (y) => box.bottom - Math.max(-0.03, Math.min(1.03, y / most)) * (box.bottom - box.top);
    pen.fillStyle = cssColor('--soft');
    pen.textAlign = 'left';
    pen.textBaseline = 'alphabetic';
    this.write(pen, row.title, box.left, box.top - 5);
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    pen.strokeStyle = cssColor('--grid');
    pen.lineWidth = 1;
    for (const y of ticks) {
      const at = Math.round(toY(y)) + 0.5;
      pen.beginPath();
      pen.moveTo(box.left, at);
      pen.lineTo(box.right, at);
      pen.stroke();
      this.write(pen, tickText(y), box.left - TICK, at);
    }
    const names = row.lines.map((line) => this.drawLine(pen, line, seen, box, toY)).filter(Boolean);
    this.drawNames(pen, names, box);
  }

  drawLine(pen, line, records, box, toY) {
    pen.strokeStyle = cssColor(line.color);
    pen.lineWidth = line.width;
    pen.lineJoin = 'round';
    pen.setLineDash(line.dash);
    pen.beginPath();
    let isOn = false, last = null;
    for (const r of records) {
      const y = r[line.key];
      if (!isNumber(y)) {
        isOn = false;
        continue;
      }
      if (isOn) pen.lineTo(box.toX(r.x), toY(y));
      else pen.moveTo(box.toX(r.x), toY(y));
      isOn = true;
      last = r;
    }
    pen.stroke();
    pen.setLineDash([]);
    return last && {line, y: toY(last[line.key]), at: last.x};
  }

  // At the lines' ends, moved apart where they would lie on each other.
  drawNames(pen, names, box) {
    names.sort((a, b) => a.y - b.y);
    for (let k = 1; k < names.length; ++k) names[k].y = Math.max(names[k].y, names[k - 1].y + 12);
    for (let k = names.length - 1, least = box.bottom + 4; k >= 0; --k, least = names[k + 1].y - 12) names[k].y = Math.min(names[k].y, least);
    pen.textAlign = 'left';
    for (const {line, y} of names) {
      pen.fillStyle = cssColor(line.color);
      this.write(pen, line.name, box.right + NAME, y);
    }
  }

  // The label under a line that is `k` from the end: seconds before it, or degrees.
  footText(k, end) {
    if (this.overTilt) return `${k}°`;
    return k > 0 ? `−${k}` : this.live ? 'now' : `${end.toFixed(1)} s`;
  }

  drawFoot(pen, box) {
    pen.fillStyle = cssColor('--soft');
    pen.textBaseline = 'top';
    const step = this.overTilt ? 30 : 2;
    for (let k = 0; ; k += step) {
      const x = this.overTilt ? k : box.x1 - k;
      if (this.overTilt ? x > box.x1 + 1e-9 : x < box.x0 - 1e-9) break;
      pen.textAlign = 'center';
      this.write(pen, this.footText(k, box.x1), box.toX(x), box.bottom + 6);
    }
    if (!this.overTilt || !isNumber(this.now)) return;
    pen.strokeStyle = cssColor('--ink');
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.moveTo(box.toX(this.now), box.top);
    pen.lineTo(box.toX(this.now), box.bottom);
    pen.stroke();
  }
}
