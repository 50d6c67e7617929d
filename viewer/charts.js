// Lines over time, or over the tilt: forces, the force that holding needs, the tilt. Each row has its own scale; each line its name at its end.
import {element, isNumber} from './format.js';
import {cssColor, onThemeChange} from './theme.js';

export const SPAN = 10;  // s
const ROWS = [
  {title: 'Force, N', share: 0.56, least: 4, lines: [
    {key: 'normal', name: 'Fₙ', color: '--line-normal', width: 1.6, dash: []},
    {key: 'user', name: 'grip', color: '--line-user', width: 1.6, dash: [5, 3]},
    {key: 'feedback', name: 'F', color: '--line-force', width: 2.4, dash: []}]},
  {title: 'Force that holding needs, N', share: 0.25, least: 10, lines: [{key: 'hold', name: 'N‑hold', color: '--line-hold', width: 1.8, dash: []}]},
  {title: 'Tilt, °', share: 0.19, least: 90, lines: [{key: 'tilt', name: 'tilt', color: '--line-tilt', width: 1.6, dash: []}]},
];
const LEFT = 30, RIGHT = 46, TOP = 16, BOTTOM = 20, BETWEEN = 24;  // px

// What a chart keeps of a frame.
export const record = (frame) => ({x: frame.t, normal: frame.forces.normal, user: frame.forces.user, feedback: frame.forces.feedback,
  hold: frame.forces.hold, tilt: isNumber(frame.tilt) ? frame.tilt * 180 / Math.PI : null});

// A step of 1, 2 or 5 times a power of ten of which `count` or fewer fit.
function niceStep(range, count) {
  const rough = range / count, power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((k) => k * power).find((step) => step >= rough * 0.999);
}

export class Charts {
  // `overTilt`: x is the tilt in degrees, and the row of the tilt is left out.
  constructor(place, overTilt) {
    this.rows = overTilt ? ROWS.slice(0, 2).map((row) => ({...row, lines: row.lines.slice(-1)})) : ROWS;  // there F is F_n, and the grip stays
    this.overTilt = overTilt;
    this.canvas = element('canvas', {role: 'img', 'aria-label': overTilt ? 'Forces over the tilt' : 'Forces, force that holding needs and tilt over the last ten seconds'});
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
    const inner = height - TOP - BOTTOM - BETWEEN * (this.rows.length - 1), whole = this.rows.reduce((sum, row) => sum + row.share, 0);
    const x0 = this.overTilt ? 0 : (this.now ?? 0) - SPAN, x1 = this.overTilt ? Math.max(1, ...this.records.map((r) => r.x)) : this.now ?? 0;
    const toX = (x) => LEFT + (x - x0) / (x1 - x0 || 1) * (width - LEFT - RIGHT);
    let top = TOP;
    for (const [k, row] of this.rows.entries()) {
      const tall = inner * row.share / whole;
      this.drawRow(pen, row, k, {top, bottom: top + tall, left: LEFT, right: width - RIGHT, toX, x0, x1});
      top += tall + BETWEEN;
    }
    this.drawFoot(pen, {bottom: height - BOTTOM, top: TOP, left: LEFT, right: width - RIGHT, toX, x0, x1});
  }

  drawRow(pen, row, number, box) {
    const seen = this.records.filter((r) => r.x >= box.x0 - 0.1 && r.x <= box.x1 + 1e-9);
    let most = row.least;
    for (const line of row.lines) for (const r of seen) if (isNumber(r[line.key])) most = Math.max(most, r[line.key] * 1.05);
    let step = niceStep(most, Math.max(2, Math.floor((box.bottom - box.top) / 24)));
    if (row.least === 90 && step > 20) step = most > 90 ? 90 : 45;
    most = Math.ceil(most / step - 1e-9) * step;
    this.tops[number] = most;
    const toY = (y) => box.bottom - Math.max(-0.03, Math.min(1.03, y / most)) * (box.bottom - box.top);
    pen.fillStyle = cssColor('--soft');
    pen.textAlign = 'left';
    pen.textBaseline = 'alphabetic';
    pen.fillText(row.title, box.left, box.top - 5);
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    pen.strokeStyle = cssColor('--grid');
    pen.lineWidth = 1;
    for (let y = 0; y <= most + 1e-9; y += step) {
      const at = Math.round(toY(y)) + 0.5;
      pen.beginPath();
      pen.moveTo(box.left, at);
      pen.lineTo(box.right, at);
      pen.stroke();
      pen.fillText(String(Math.round(y * 1000) / 1000), box.left - 6, at);
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
      pen.fillText(line.name, box.right + 5, y);
    }
  }

  drawFoot(pen, box) {
    pen.fillStyle = cssColor('--soft');
    pen.textBaseline = 'top';
    const step = this.overTilt ? 30 : 2;
    for (let k = 0; ; k += step) {
      const x = this.overTilt ? k : box.x1 - k;
      if (this.overTilt ? x > box.x1 + 1e-9 : x < box.x0 - 1e-9) break;
      pen.textAlign = 'center';
      const name = this.overTilt ? `${k}°` : k === 0 ? (this.live ? 'now' : `${box.x1.toFixed(1)} s`) : `−${k}`;
      pen.fillText(name, box.toX(x), box.bottom + 6);
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
