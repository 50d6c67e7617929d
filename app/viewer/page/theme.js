// SPDX-License-Identifier: MIT
// What the reader's system asks for, and every color. Contact states and lines differ in hue and lightness as Okabe and Ito chose
// them for all kinds of color vision, and by a shape or a dash beside it.

export const darkMode = matchMedia('(prefers-color-scheme: dark)');
export const stillMode = matchMedia('(prefers-reduced-motion: reduce)');

export function onThemeChange(callback) {
  for (const query of [darkMode, stillMode]) query.addEventListener('change', callback);
}

// Colors of the three-dimensional scene, sRGB.
const LIGHT = {
  sky: '#f4f6f9', horizon: '#dfe5ec', table: '#eef0f2', line: '#b9c2cc', shadow: 0.20,
  skin: '#dcb094', ghost: '#31506b', advised: '#8a3fa0', glass: '#3f5f6b', glassLight: '#ffffff', glassAlpha: 0.55, glassShine: 0.8,
  hemisphereSky: '#ffffff', hemisphereGround: '#c9bdb2', hemisphere: 0.62, sun: '#fff6ea', sunPower: 0.62, fill: '#dfeaff', fillPower: 0.28,
};
const DARK = {
  sky: '#1d242d', horizon: '#0d1116', table: '#1a2028', line: '#3d4957', shadow: 0.5,
  skin: '#c99c80', ghost: '#a9cdf0', advised: '#e3a8f5', glass: '#9fc6d6', glassLight: '#f2fbff', glassAlpha: 0.36, glassShine: 0.75,
  hemisphereSky: '#b9cbe0', hemisphereGround: '#3a3230', hemisphere: 0.5, sun: '#fff1df', sunPower: 0.72, fill: '#7fa8ff', fillPower: 0.3,
};
export const sceneColors = () => (darkMode.matches ? DARK : LIGHT);

// The 24 contact points: what a state is called, its color and the shape of its mark (device/session/hand_view).
export const CONTACTS = [
  {key: '.', name: 'free', color: ['#7b848f', '#98a3b0'], shape: 'ring'},
  {key: 't', name: 'touching', color: ['#d55e00', '#f08a3c'], shape: 'disc'},
  {key: 'p', name: 'projected', color: ['#0072b2', '#56b4e9'], shape: 'diamond'},
  {key: 'k', name: 'tracked', color: ['#00785a', '#2fc79a'], shape: 'square'},
  {key: 'K', name: 'tracked, touching', color: ['#00785a', '#2fc79a'], shape: 'filled square'},
];
export const GUIDANCE_COLOR = ['#b5478f', '#e58cc4'];
export const FORCE_COLOR = ['#009e73', '#3fdcae'];  // of the arrows, as `grip --svg` draws them
export const schemeColor = (pair) => pair[darkMode.matches ? 1 : 0];

const WATER = '#4a9fd8';
const LIQUIDS = {red: '#d8343f', blue: '#2f6fd6', yellow: '#eebd1a', green: '#2e9e5b', orange: '#e8822a', purple: '#8a4fc4', white: '#eef0f2'};

// Color of a liquid by its name: a name of a color means that color, softened for the common ones; anything else looks like water.
export function liquidColor(name) {
  if (!name) return WATER;
  const plain = name.trim().toLowerCase();
  if (LIQUIDS[plain]) return LIQUIDS[plain];
  if (!/^[a-z]+$/.test(plain) || !CSS.supports('color', plain)) return WATER;
  const probe = document.createElement('canvas').getContext('2d');
  probe.fillStyle = WATER;
  probe.fillStyle = plain;  // stays as it was for `inherit` and the like
  return probe.fillStyle;
}

export const cssColor = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
