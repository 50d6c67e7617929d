// SPDX-License-Identifier: MIT
// The numbers beside the picture: state, hand, forces, amounts, loop; and the legend of the contact points.
import {askedForce, degrees, element, feltForce, fixed, isNumber, milliliters, millimeters, percent, setText, whole} from './format.js';
import {CONTACTS, liquidColor} from './theme.js';

const WAY = 5;  // states that a session goes through until the vessel is let go
const SVG = 'http://www.w3.org/2000/svg';
const SHAPES = {
  ring: 'M8 2.6a5.4 5.4 0 1 0 0 10.8a5.4 5.4 0 1 0 0-10.8z', disc: 'M8 2a6 6 0 1 0 0 12a6 6 0 1 0 0-12z',
  diamond: 'M8 1l7 7-7 7-7-7z', square: 'M3.4 3.4h9.2v9.2H3.4z', 'filled square': 'M2.4 2.4h11.2v11.2H2.4z',
};

export function mark(contact) {
  const svg = document.createElementNS(SVG, 'svg'), path = document.createElementNS(SVG, 'path');
  svg.setAttribute('viewBox', '0 0 16 16');
  svg.setAttribute('aria-hidden', 'true');
  svg.setAttribute('class', `mark ${contact.shape === 'ring' || contact.shape === 'square' ? 'hollow' : 'full'} contact-${CONTACTS.indexOf(contact)}`);
  path.setAttribute('d', SHAPES[contact.shape]);
  svg.append(path);
  return svg;
}

// A bar from 0 to `most`; CSS styles its parts.
function meter(label, most, unit) {
  const fill = element('span', {class: 'fill'}), value = element('output', {});
  const row = element('div', {class: 'meter'}, element('span', {class: 'name', text: label}),
    element('span', {class: 'bar', 'aria-hidden': 'true'}, fill), element('span', {class: 'value'}, value, element('span', {class: 'unit', text: ` ${unit}`})));
  return {row, set: (share, text) => {
    fill.style.width = `${100 * Math.max(0, Math.min(1, share / most)) || 0}%`;
    setText(value, text);
  }};
}

export class Panels {
  constructor(about) {
    this.about = about;
    this.said = '';
    const find = (id) => document.getElementById(id);
    this.advicePanel = find('advice-panel');
    this.advice = find('advice');
    this.makeState(find('state'));
    this.makeForce(find('force'));
    this.makeLegend(find('legend'));
    this.makeLoop(find('loop'));
    if (about.amounts.length) this.makeAmounts(find('amounts'));
    find('amounts-panel').hidden = !about.amounts.length;
    find('loop-panel').hidden = about.mode === 'grips';
    find('state-panel').querySelector('h2').textContent = about.mode === 'grips' ? 'Held' : 'State';
    if (about.mode === 'grips') find('score-panel').before(find('state-panel'));  // what the sliders change comes first
  }

  makeState(place) {
    this.stateName = element('strong', {class: 'state-name'});
    this.stateVessel = element('span', {class: 'state-vessel'});
    this.steps = this.about.states.slice(0, WAY).map((name) => element('li', {text: name, 'data-state': name}));
    this.meters = {closure: meter('Closure', 1, ''), gap: meter('Gap', 0.13, 'mm'), tilt: meter('Tilt', Math.PI, '°')};
    if (this.about.mode !== 'grips') place.append(element('p', {class: 'state-line'}, this.stateName, this.stateVessel), element('ol', {class: 'steps', 'aria-hidden': 'true'}, ...this.steps));
    else place.append(element('p', {class: 'state-line'}, this.stateVessel));
    place.append(...Object.values(this.meters).map((made) => made.row));
  }

  makeForce(place) {
    this.force = element('output', {class: 'force-value'});
    this.forceParts = ['base', 'torque', 'opening', 'other', 'less', 'asked'].map((name) => element('span', {class: `part ${name}`}));
    this.clamp = element('output', {class: 'clamp'});
    const bar = element('div', {class: 'force-bar', 'aria-hidden': 'true'}, ...this.forceParts);
    this.forceRows = {};
    const rows = element('dl', {class: 'forces'}), {strength, slides} = this.about;
    for (const [key, symbol, sub, what, kind, unit = 'N'] of [
      ['base', 'F', 'base', 'from the grasp on', 'base'], ['normal', 'F', 'n', 'with the torque', 'torque'],
      ['opening', 'F', 'o', 'from squeezing further', 'opening'], ['user', 'Grip', '', 'the user’s own', 'user'],
      ['hold', 'N', 'hold', strength ? 'of the whole hand' : 'needed to hold', 'hold'],
      // whose unit is in its text, which may be words
      ...(strength ? [['tipsHold', 'N', 'tips', 'of two tips alone', 'tips'], ['effort', 'Effort', '', 'of the whole hand', 'effort', ''],
        ['tipsEffort', 'Effort', '', 'of two tips alone', 'effort', ''], ['arrow', 'Arrow', '', 'the longest', 'arrow']] : []),
      ...(slides ? [['margin', 'Margin', '', 'of the grip over holding', 'hold'], ['slip', 'Slip', '', 'in the fingers', 'effort', ''], ['slipTurn', 'Turn', '', 'in the fingers', 'effort', '']] : [])]) {
      const value = element('output', {});
      this.forceRows[key] = value;
      rows.append(element('div', {class: `force-row ${kind}`}, element('dt', {}, element('i', {class: 'swatch', 'aria-hidden': 'true'}), symbol, element('sub', {text: sub}), element('small', {text: what})),
        element('dd', {}, value, unit && ` ${unit}`)));
    }
    place.append(element('p', {class: 'force-line'}, element('span', {text: 'F'}), this.force, element('span', {class: 'unit', text: 'N'}),
      element('small', {text: `of ${fixed(this.about.force.most, 1)} N at most`})), bar, element('p', {class: 'clamp-line'}, this.clamp), rows);
  }

  makeLegend(place) {
    this.counts = CONTACTS.map((contact) => {
      const count = element('b', {});
      place.append(element('li', {}, mark(contact), element('span', {text: contact.name}), count));
      return count;
    });
  }

  makeAmounts(place) {
    this.amounts = this.about.amounts.map(({liquid, target_m3}) => {
      const most = target_m3 * 1.6 || 1e-4, tolerance = this.about.tolerance_m3 || 0;
      const fill = element('span', {class: 'fill'}), band = element('span', {class: 'band'}), wanted = element('span', {class: 'wanted'});
      fill.style.background = liquidColor(liquid);
      band.style.left = `${100 * Math.max(0, (target_m3 - tolerance) / most)}%`;
      band.style.width = `${100 * 2 * tolerance / most}%`;
      wanted.style.left = `${100 * target_m3 / most}%`;
      const value = element('output', {}), done = element('span', {class: 'done'});
      place.append(element('div', {class: 'amount'}, element('span', {class: 'name', text: liquid}),
        element('span', {class: 'bar', 'aria-hidden': 'true'}, band, fill, wanted), element('span', {class: 'value'}, value, ` of ${milliliters(target_m3)} mL `, done)));
      return {fill, value, done, most, tolerance, target: target_m3};
    });
    this.spilled = element('output', {});
    this.allDone = element('span', {class: 'all-done'});
    place.append(element('p', {class: 'spilled'}, 'Spilled ', this.spilled, ' mL', this.allDone));
  }

  makeLoop(place) {
    this.loop = {};
    for (const [key, name] of [['rate', 'Rate'], ['step', 'Latest step'], ['missed', 'Missed ticks'], ['tick', 'Tick'], ['frames', 'Picture']]) {
      this.loop[key] = element('dd', {});
      place.append(element('div', {}, element('dt', {text: name}), this.loop[key]));
    }
  }

  show(frame, grip) {
    this.showState(frame, grip);
    this.showForce(frame.forces);
    if (this.about.strength) this.showHolding(frame.holding);
    if (this.about.slides) this.showSlip(frame.slip);
    CONTACTS.forEach((contact, k) => setText(this.counts[k], String([...frame.contacts].filter((c) => c === contact.key).length)));
    if (this.amounts) this.showAmounts(frame);
    const {timing} = frame;
    setText(this.loop.rate, isNumber(timing.rate) ? `${whole(timing.rate)} Hz` : '–');
    setText(this.loop.step, isNumber(timing.step) ? `${fixed(timing.step * 1e6, 1)} µs` : '–');
    setText(this.loop.missed, whole(timing.missed));
    setText(this.loop.tick, whole(frame.tick));
    this.showAdvice(frame.advice);
    this.say(frame);
  }

  // Once there was advice its place stays, so that what is below does not jump.
  showAdvice(advice) {
    if (!advice && this.advicePanel.hidden) return;
    this.advicePanel.hidden = false;
    setText(this.advice, advice ? advice.words : '–');
  }

  showState(frame, grip) {
    const vessel = this.about.vessels[frame.vessel];
    setText(this.stateName, frame.state);
    this.stateName.classList.toggle('bad', frame.state === 'slipped' || frame.state === 'released');
    setText(this.stateVessel, grip ? grip.label : vessel ? vessel.name : '');
    for (const step of this.steps) step.classList.toggle('now', step.dataset.state === frame.state);
    this.meters.closure.set(frame.closure, fixed(frame.closure, 2));
    this.meters.gap.set(frame.gap, millimeters(frame.gap));
    this.meters.tilt.set(frame.tilt, degrees(frame.tilt));
  }

  // The bar ends where F does: what it is made of, one after the other, then what is none of it (a surface before the grasp). A part that takes away
  // is hatched over the end; what was asked for and not written is an outline behind it.
  showForce(forces) {
    const {base, normal, opening} = forces, {most} = this.about.force, felt = feltForce(forces) || 0, asked = askedForce(forces) || 0;
    const isClamped = asked > felt && fixed(asked, 2) !== fixed(felt, 2);
    const torque = isNumber(normal) ? normal - base : 0, more = isNumber(opening) ? opening : 0, sum = (normal || 0) + Math.max(0, more);
    const parts = [[0, base], [base, base + Math.max(0, torque)], [normal || 0, sum], [sum, felt]].map((ends) => ends.map((end) => Math.min(end, felt)));
    parts.push([Math.max(felt, 0), Math.min(sum, more < 0 ? normal : 0)], [felt, isClamped ? asked : felt]);
    parts.forEach(([from, to], k) => {
      const low = Math.max(0, Math.min(1, from / most)), high = Math.max(0, Math.min(1, to / most));
      this.forceParts[k].hidden = !(high > low);
      this.forceParts[k].style.left = `${100 * low}%`;
      this.forceParts[k].style.width = `${100 * Math.max(0, high - low) || 0}%`;
    });
    setText(this.force, fixed(feltForce(forces), 2));
    // at the gripper's limit or the method's own maximum; below both it is the ramp or the slew
    const atLimit = felt >= Math.min(most, forces.feedback) - 0.005;
    const what = atLimit ? `clamped to ${fixed(felt, 2)} N` : `${fixed(felt, 2)} N so far`;
    setText(this.clamp, isClamped ? `${what}, ${fixed(asked, 2)} N asked for` : '');
    for (const [key, digits] of [['base', 2], ['normal', 2], ['opening', 2], ['user', 2], ['hold', 1]]) {
      setText(this.forceRows[key], key === 'hold' && forces.hold_infinite ? '∞' : fixed(forces[key], digits));
    }
  }

  // Shares of the strength. What is null there is infinite; without `holding` nothing is held.
  showHolding(holding) {
    const share = (effort) => (effort === null ? 'no force holds it' : `${percent(effort, effort < 0.1 ? 1 : 0)} %`);
    const longest = holding && holding.contacts.length ? Math.max(...holding.contacts.map(({force}) => Math.hypot(...force))) : null;
    setText(this.forceRows.tipsHold, holding && holding.tips_hold === null ? '∞' : fixed(holding && holding.tips_hold, 1));
    setText(this.forceRows.effort, holding ? share(holding.effort) : fixed(null));
    setText(this.forceRows.tipsEffort, holding ? share(holding.tips_effort) : fixed(null));
    setText(this.forceRows.arrow, fixed(longest, 2));
  }

  // Without `slip` nothing is held; a margin that is null there is minus infinity.
  showSlip(slip) {
    setText(this.forceRows.margin, slip && slip.margin === null ? '−∞' : fixed(slip && slip.margin, 2));
    setText(this.forceRows.slip, slip ? `${fixed(slip.distance * 1e3, 1)} mm${slip.speed > 0 ? ', slips' : ''}` : fixed(null));
    setText(this.forceRows.slipTurn, slip ? `${fixed(slip.angle * 180 / Math.PI, 1)}°` : fixed(null));
  }

  showAmounts(frame) {
    this.amounts.forEach((row, k) => {
      const {arrived} = frame.amounts[k], isThere = Math.abs(arrived - row.target) <= row.tolerance;
      row.fill.style.width = `${100 * Math.min(1, arrived / row.most)}%`;
      setText(row.value, milliliters(arrived));
      setText(row.done, isThere ? '✓' : arrived > row.target ? 'too much' : '');
    });
    setText(this.spilled, milliliters(frame.spilled));
    setText(this.allDone, frame.done ? 'Task done' : '');
  }

  // For readers of the screen: what changed, in words.
  say(frame) {
    const vessel = this.about.vessels[frame.vessel];
    const words = `${frame.state}${vessel ? `, ${vessel.name}` : ''}`;
    if (words === this.said) return;
    this.said = words;
    document.getElementById('said').textContent = words;
  }
}
