// SPDX-License-Identifier: MIT
// Runs in a copy of a report, at its end, and leaves what it finds as lines in an attribute: an empty one where all is well.
(() => {
  const page = document.documentElement;
  const wrong = [];
  const expect = (what, isTrue) => { if (!isTrue) wrong.push(what); };
  const name = (element) => `${element.tagName}.${element.getAttribute('class') || element.id || ''}`;

  expect(`the page scrolls sideways: ${page.scrollWidth} of ${innerWidth}`, page.scrollWidth <= innerWidth);
  // but for what lies in a frame that scrolls by itself
  for (const element of document.body.querySelectorAll('*')) {
    const box = element.getBoundingClientRect();
    if (element.closest('.wide, pre, head') && !element.matches('.wide, pre')) continue;
    if (box.width > 0) expect(`${name(element)} reaches out: ${box.left} to ${box.right}`, box.left >= -1 && box.right <= innerWidth + 1);
  }
  for (const image of document.images) {
    expect('a drawing without a picture', image.complete && image.naturalWidth > 0);
    expect('a drawing too small to see', image.clientWidth >= 200);
  }
  let charts = 0;
  for (const svg of document.querySelectorAll('svg')) {
    ++charts;
    const scale = svg.clientWidth / svg.viewBox.baseVal.width;
    expect(`${svg.getAttribute('aria-labelledby')}: letters of ${11 * scale} px`, 11 * scale >= 8.5 && 11 * scale <= 20);
    expect(`${svg.getAttribute('aria-labelledby')}: letters have no ink`, getComputedStyle(svg.querySelector('text')).fill !== 'none');
  }
  expect('no chart', charts > 0);
  for (const entry of performance.getEntriesByType('resource')) expect(`fetched ${entry.name.slice(0, 80)}`, entry.name.startsWith('data:'));

  // WCAG's contrast of text with the page
  const light = (color) => {
    const parts = color.match(/[\d.]+/g).slice(0, 3).map((part) => part / 255);
    const [r, g, b] = parts.map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const ground = light(getComputedStyle(document.body).backgroundColor);
  const inks = { body: 'color', a: 'color', dt: 'color', figcaption: 'color', summary: 'color', 'svg text': 'fill' };
  for (const [selector, property] of Object.entries(inks)) {
    const ink = light(getComputedStyle(document.querySelector(selector))[property]);
    const contrast = (Math.max(ink, ground) + 0.05) / (Math.min(ink, ground) + 0.05);
    expect(`${selector}: contrast ${contrast.toFixed(2)}`, contrast >= 4.5);
  }
  page.dataset.ground = ground < 0.2 ? 'dark' : 'light';
  page.dataset.width = innerWidth;
  page.dataset.headings = [...document.querySelectorAll('h1, h2, h3')].map((heading) => heading.textContent).join('|');
  page.dataset.wrong = wrong.join('\n');
})();
