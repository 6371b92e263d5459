// Reliefs as pictures, all on one colour scale in µm, with a scale bar and a read-out. Other values over the plane
// (an autocorrelation) are drawn alike: they have a label, and may have an outline; places then count from the middle.
import { h, segmented, svg } from '../lib/dom.js';
import { quantile, values } from '../lib/arrays.js';
import { indexOf, table } from '../lib/colour.js';
import { plain, withUnit } from '../lib/number.js';
import { makeScale, niceStep } from '../lib/scale.js';
import { onThemeChange } from '../lib/theme.js';
import { colourBar } from './colour_bar.js';
import { panel } from './panel.js';

const OUTLIERS = 0.002;  // share at each end that may saturate, so that one spike does not flatten a scan

export function loadRelief(data) {
  const relief = { ...data, heights: values(data.heights) };
  relief.width_um = relief.columns * relief.pitch_x_um;
  relief.depth_um = relief.rows * relief.pitch_y_um;
  return relief;
}

export function heightScale(reliefs, outliers = OUTLIERS) {
  const low = Math.min(...reliefs.map((r) => quantile(r.heights, outliers)));
  const high = Math.max(...reliefs.map((r) => quantile(r.heights, 1 - outliers)));
  return makeScale({ low, high });
}

// Light from the upper left, as maps have it; slopes are exaggerated until the steep tenth shows.
function shadeOf(relief) {
  const { columns, rows, heights } = relief;
  const dx = (c, r) => (heights[r * columns + Math.min(c + 1, columns - 1)] - heights[r * columns + Math.max(c - 1, 0)])
    / (2 * relief.pitch_x_um);
  const dy = (c, r) => (heights[Math.min(r + 1, rows - 1) * columns + c] - heights[Math.max(r - 1, 0) * columns + c])
    / (2 * relief.pitch_y_um);
  const slopes = new Float32Array(heights.length);
  for (let k = 0; k < heights.length; ++k) {
    const c = k % columns, r = Math.floor(k / columns);
    slopes[k] = Math.hypot(dx(c, r), dy(c, r));
  }
  const gain = 0.9 / (quantile(slopes, 0.9) || 1);
  return (c, r) => {
    const p = -gain * dx(c, r), q = -gain * dy(c, r);
    const shade = (-0.5 * p + 0.5 * q + 0.707) / Math.hypot(p, q, 1);
    return Number.isNaN(shade) ? 0.707 : Math.max(0, shade);  // beside a gap: as if flat
  };
}

function paint(canvas, relief, scale, shaded) {
  const { columns, rows, heights } = relief;
  const image = new ImageData(columns, rows);
  const colours = table('value');
  const shade = shaded ? shadeOf(relief) : null;
  for (let k = 0; k < heights.length; ++k) {
    if (Number.isNaN(heights[k])) continue;  // transparent: the hatching shows through
    const c = k % columns, r = Math.floor(k / columns);
    const at = 4 * ((rows - 1 - r) * columns + c);  // row 0 is y = 0, at the bottom
    if (shade) {
      const gray = Math.round(255 * Math.min(1, shade(c, r)));
      image.data.set([gray, gray, gray, 255], at);
    } else {
      const i = 3 * indexOf(scale.fraction(heights[k]));
      image.data.set([colours[i], colours[i + 1], colours[i + 2], 255], at);
    }
  }
  Object.assign(canvas, { width: columns, height: rows });
  canvas.getContext('2d').putImageData(image, 0, 0);
}

const inUnit = (size, unit) => (unit === 'um' && size >= 1000 ? `${plain(size / 1000, 3)} mm` : withUnit(plain(size, 3), unit));

/// A bar of a round length, near a quarter of the width.
function scaleBar(relief, unit) {
  const length = niceStep(relief.width_um / 2, 2.6);
  const share = 100 * length / relief.width_um;
  const text = inUnit(length, unit);
  return h('div', { class: 'scale-bar', style: `width:${share.toFixed(2)}%` }, h('span', {}, text));
}

function describe(relief, unit) {
  const parts = [`${inUnit(relief.width_um, unit)} × ${inUnit(relief.depth_um, unit)}`];
  if (relief.block > 1) parts.push(`shown as means of ${relief.block} × ${relief.block} samples`);
  if (relief.missing_share > 0) parts.push(`${plain(100 * relief.missing_share, 2)} % not seen`);
  return parts.join(' · ');
}

/// A closed line, µm from the middle, y upward.
function outline({ outline: points, width_um: w, depth_um: d }) {
  if (!points) return null;
  const path = points.map(([x, y], k) => `${k === 0 ? 'M' : 'L'}${(x + w / 2).toFixed(3)} ${(d / 2 - y).toFixed(3)}`).join('');
  return svg('svg', { viewBox: `0 0 ${w} ${d}`, preserveAspectRatio: 'none', 'aria-hidden': 'true' },
    svg('path', { class: 'halo', d: `${path}Z` }), svg('path', { d: `${path}Z` }));
}

function listen(tile) {
  const { frame, relief, readout, hair, quantity } = tile;
  const show = (u, v) => {
    Object.assign(tile, { u, v });
    const c = Math.min(relief.columns - 1, Math.floor(u * relief.columns));
    const r = Math.min(relief.rows - 1, Math.floor(v * relief.rows));
    const z = relief.heights[r * relief.columns + c];
    hair.setAttribute('style', `left:${100 * u}%;bottom:${100 * v}%`);
    frame.classList.add('probed');
    const x = (u - (quantity.centred ? 0.5 : 0)) * relief.width_um, y = (v - (quantity.centred ? 0.5 : 0)) * relief.depth_um;
    readout.textContent = `x ${plain(x, 4)}  y ${plain(y, 4)}  ${quantity.symbol} ${
      Number.isNaN(z) ? 'not seen' : withUnit(plain(z, 4), quantity.unit)}`;
  };
  const clear = () => { readout.textContent = describe(relief, quantity.step_unit); frame.classList.remove('probed'); };
  frame.addEventListener('pointermove', (event) => {
    const box = frame.getBoundingClientRect();
    const clamp = (x) => Math.min(0.9999, Math.max(0, x));
    show(clamp((event.clientX - box.left) / box.width), clamp(1 - (event.clientY - box.top) / box.height));
  });
  frame.addEventListener('pointerleave', clear);
  frame.addEventListener('blur', clear);
  frame.addEventListener('keydown', (event) => {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!step) return;
    event.preventDefault();
    const move = (x, d) => Math.min(0.9999, Math.max(0, x + d * 0.02));
    show(move(tile.u ?? 0.5, step[0]), move(tile.v ?? 0.5, step[1]));
  });
  clear();
}

function makeTile(relief, quantity) {
  const canvas = h('canvas', { 'aria-hidden': 'true' });
  const hair = h('span', { class: 'hair' });
  const frame = h('div', { class: 'relief', tabindex: '0', role: 'img',
    style: `aspect-ratio:${relief.width_um} / ${relief.depth_um}`,
    'aria-label': `${quantity.label} map: ${relief.name}, ${describe(relief, quantity.step_unit)}. Arrow keys move the probe.` },
  canvas, outline(relief), scaleBar(relief, quantity.step_unit), hair);
  const readout = h('div', { class: 'readout', 'aria-live': 'polite' });
  const element = h('div', { class: 'tile' }, h('div', { class: 'tile-name' }, relief.name), frame, readout);
  const tile = { relief, quantity, canvas, frame, hair, readout, element };
  listen(tile);
  return tile;
}

export function reliefMaps(data) {
  const reliefs = data.reliefs.map(loadRelief);
  const quantity = { label: 'Height', unit: 'um', symbol: 'z', step_unit: 'um', centred: false, ...data.quantity };
  const tiles = reliefs.map((relief) => makeTile(relief, quantity));
  const scale = quantity.centred ? heightScale(reliefs, 0) : heightScale(reliefs);
  const bars = h('div', { class: 'bars' });
  let shaded = false;
  const draw = () => {
    for (const tile of tiles) paint(tile.canvas, tile.relief, scale, shaded);
    bars.replaceChildren(...(shaded ? [] : [colourBar('value', scale, quantity)]));
  };
  const choice = quantity.centred ? null : segmented('Drawing', [['height', 'Height'], ['shaded', 'Shaded']], 'height',
    (value) => { shaded = value === 'shaded'; draw(); });
  onThemeChange(draw);
  const gaps = reliefs.some((relief) => relief.missing_share > 0);
  return { element: panel(data, 'maps', { tools: choice ? [choice] : [] },
    h('div', { class: 'tiles', 'data-count': tiles.length }, tiles.map((tile) => tile.element)),
    h('div', { class: 'maps-foot' }, bars,
      gaps ? h('div', { class: 'legend' }, h('span', { class: 'mark-missing' }, 'not seen by the instrument')) : null,
      quantity.outline ? h('div', { class: 'legend' }, h('span', { class: 'mark-outline' }, quantity.outline)) : null)),
  start: draw };
}
