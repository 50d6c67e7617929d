// SPDX-License-Identifier: MIT
// Keys, and the help that lists them. A key acts wherever the focus is, but in fields that need it themselves. A binding has `act`, for each press and,
// unless `once`, each repeat; or `glide`, for as long as the key is held.
import {element} from './format.js';
import {Glide} from './glide.js';

const TURN = 0.09, PAN = 24;  // rad, px for each press

export function viewKeys(view, buttons) {
  const {orbit} = view;
  const arrows = (plain, shifted) => (event) => (event.shiftKey ? orbit.pan(...shifted) : orbit.turn(...plain));
  return [
    {keys: ['ArrowLeft'], shown: '← → ↑ ↓', what: 'turn the view (Shift: move it)', act: arrows([-TURN, 0], [PAN, 0]), atPicture: true},
    {keys: ['ArrowRight'], act: arrows([TURN, 0], [-PAN, 0]), atPicture: true},
    {keys: ['ArrowUp'], act: arrows([0, TURN], [0, PAN]), atPicture: true},
    {keys: ['ArrowDown'], act: arrows([0, -TURN], [0, -PAN]), atPicture: true},
    {keys: ['+', '='], shown: '+ −', what: 'closer, farther', act: () => orbit.zoom(0.87)},
    {keys: ['-', '−'], act: () => orbit.zoom(1.15)},
    {keys: ['0'], once: true, shown: '0', what: 'the whole scene', act: () => buttons.home.click()},
    {keys: ['1'], once: true, shown: '1 2 3', what: 'from the front, the side, above', act: () => buttons.front.click()},
    {keys: ['2'], once: true, act: () => buttons.side.click()},
    {keys: ['3'], once: true, act: () => buttons.top.click()},
    {keys: ['g'], once: true, shown: 'G', what: 'ghost of the hand before it came to rest on the glass', act: () => buttons.ghost.click()},
    {keys: ['c'], once: true, shown: 'C', what: 'contact points', act: () => buttons.points.click()},
    ...(buttons.arrows.hidden ? [] : [{keys: ['h'], once: true, shown: 'H', what: 'forces of the hand on the vessel', act: () => buttons.arrows.click()}]),
    {keys: ['f'], once: true, shown: 'F', what: 'keep the hand in the middle', act: () => buttons.follow.click()},
  ];
}

// Native behavior of what has the focus comes first: arrows in a slider, letters in a list, space on a button.
function isOwn(target, key) {
  if (target.closest('dialog')) return true;
  if (target.matches('select, [role=listbox]')) return key.length === 1 || key.startsWith('Arrow') || key === 'Home' || key === 'End';
  if (target.matches('input')) return key.startsWith('Arrow') || key === 'Home' || key === 'End';
  return key === ' ' && target.matches('button, a, summary');
}

export function listenToKeys(bindings, canvas) {
  const help = document.getElementById('help');
  const all = [...bindings, {keys: ['?'], shown: '?', what: 'this help', act: () => help.showModal()}];
  const glide = new Glide(), keyOf = (event) => (event.key.length === 1 ? event.key.toLowerCase() : event.key);
  document.addEventListener('keyup', (event) => glide.letGo(keyOf(event), event.timeStamp));
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || isOwn(event.target, event.key)) return;
    const key = keyOf(event);
    const found = all.find((binding) => binding.keys.includes(key));
    const isAtPicture = event.target === canvas || event.target === document.body || event.target.closest('#tools');
    if (!found || (found.atPicture && !isAtPicture)) return;
    event.preventDefault();
    if (event.repeat && (found.once || found.glide)) return;
    if (found.glide) glide.press(key, found.glide, event.timeStamp);
    else found.act(event);
  });
  document.getElementById('help-keys').append(...all.filter((binding) => binding.shown).map((binding) =>
    element('div', {}, element('dt', {}, ...binding.shown.split(' ').map((key) => element('kbd', {text: key}))), element('dd', {text: binding.what}))));
  document.getElementById('help-open').addEventListener('click', () => help.showModal());
}
