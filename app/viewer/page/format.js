// SPDX-License-Identifier: MIT
// Numbers as people read them, and elements from a few words. A number that does not exist is a dash.

const DASH = '–';
export const isNumber = (value) => typeof value === 'number' && Number.isFinite(value);

// With as many digits behind the point, and a real minus.
export function fixed(value, digits = 1) {
  if (!isNumber(value)) return DASH;
  const text = value.toFixed(digits);
  return (Number(text) === 0 ? text.replace('-', '') : text.replace('-', '−'));
}
export const millimeters = (value, digits = 1) => fixed(isNumber(value) ? value * 1e3 : null, digits);
export const degrees = (value, digits = 0) => fixed(isNumber(value) ? value * 180 / Math.PI : null, digits);
export const percent = (value, digits = 0) => fixed(isNumber(value) ? value * 100 : null, digits);
export const milliliters = (value, digits = 0) => fixed(isNumber(value) ? value * 1e6 : null, digits);
export const whole = (value) => (isNumber(value) ? Math.round(value).toLocaleString('en') : DASH);

export function clock(seconds) {
  const tenths = Math.round(10 * seconds), minutes = Math.floor(tenths / 600);
  return `${minutes}:${((tenths - 600 * minutes) / 10).toFixed(1).padStart(4, '0')}`;
}

// What the fingers feel: what was written to the gripper; where there is none, what the method asks for. And what it asks for before any limit.
export const feltForce = (forces) => (isNumber(forces.written) ? forces.written : forces.feedback);
export const askedForce = (forces) => Math.max(forces.feedback, (forces.normal || 0) + (forces.opening || 0));

// element('p', {class: 'x', text: 'y'}, child, ...)
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === 'text') made.textContent = value;
    else if (key in made && typeof value !== 'string') made[key] = value;
    else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

export function setText(target, text) {
  if (target.textContent !== text) target.textContent = text;
}

// At most every `interval` ms, the last call always done.
export function seldom(interval, callback) {
  let last = -Infinity, waiting = 0, latest;
  return (...args) => {
    latest = args;
    const now = performance.now();
    if (now - last >= interval) {
      last = now;
      callback(...latest);
    } else if (!waiting) {
      waiting = setTimeout(() => {
        waiting = 0;
        last = performance.now();
        callback(...latest);
      }, interval - (now - last));
    }
  };
}
