// Direction maps side by side: one colour scale for the values, another for the differences.
import { h, segmented } from '../lib/dom.js';
import { values } from '../lib/arrays.js';
import { makeScale } from '../lib/scale.js';
import { onThemeChange } from '../lib/theme.js';
import { estimate, withUnit } from '../lib/number.js';
import { colourBar } from './colour_bar.js';
import { discOverlay, paintDisc, meetsDisc } from './disc.js';
import { panel } from './panel.js';

const SMALLEST_SHARE = 1e-4;  // of the peak: the bottom of a logarithmic bar

function load(map) {
  return { ...map, kind: map.kind ?? 'value', values: values(map.values), errors: values(map.standard_error) };
}

function extremes(maps) {
  let low = Infinity, high = -Infinity, positive = Infinity;
  for (const map of maps) {
    map.values.forEach((v, k) => {
      if (!Number.isFinite(v) || !meetsDisc(map, k)) return;
      low = Math.min(low, v);
      high = Math.max(high, v);
      if (v > 0) positive = Math.min(positive, v);
    });
  }
  return { low, high, positive };
}

function scaleOf(kind, maps, log) {
  const { low, high, positive } = extremes(maps);
  if (kind === 'difference') {
    const size = Math.max(Math.abs(low), Math.abs(high)) || 1;
    return makeScale({ low: -size, high: size });
  }
  if (!log || !(high > 0)) return makeScale({ low: Math.min(0, low), high });
  return makeScale({ low: Math.max(positive, high * SMALLEST_SHARE), high, log: true });
}

function valueAt(map, x, y) {
  const column = Math.min(Math.floor((x + 1) * map.width / 2), map.width - 1);
  const row = Math.min(Math.floor((y + 1) * map.height / 2), map.height - 1);
  const k = row * map.width + column;
  return [map.values[k], map.errors?.[k]];
}

const degrees = (radians) => (radians * 180 / Math.PI).toFixed(1);

/// The same probe in all maps of the panel: what does each say in this direction?
class Probe {
  constructor(tiles, unit, output) { Object.assign(this, { tiles, unit, output, x: 0, y: 0 }); }

  move(x, y) {
    const r = Math.hypot(x, y);
    if (r > 1) { x /= r; y /= r; }
    Object.assign(this, { x, y });
    const theta = degrees(Math.asin(Math.min(1, Math.hypot(x, y))));
    const phi = degrees((Math.atan2(y, x) + 2 * Math.PI) % (2 * Math.PI));
    this.output.textContent = `θ ${theta}°  φ ${phi}°`;
    for (const tile of this.tiles) {
      tile.overlay.probe(x, y);
      tile.readout.textContent = withUnit(estimate(...valueAt(tile.map, x, y)), this.unit);
    }
  }

  clear() {
    this.output.textContent = 'Point at a map to read it';
    for (const tile of this.tiles) { tile.overlay.probe(); tile.readout.textContent = tile.map.note ?? ''; }
  }
}

const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

function listen(tile, probe) {
  const frame = tile.frame;
  frame.addEventListener('pointermove', (event) => {
    const box = frame.getBoundingClientRect();
    const x = tile.overlay.extent * (2 * (event.clientX - box.left) / box.width - 1);
    const y = tile.overlay.extent * (1 - 2 * (event.clientY - box.top) / box.height);
    if (Math.hypot(x, y) <= 1) probe.move(x, y); else probe.clear();
  });
  frame.addEventListener('pointerleave', () => probe.clear());
  frame.addEventListener('blur', () => probe.clear());
  frame.addEventListener('keydown', (event) => {
    const step = STEPS[event.key];
    if (!step) return;
    event.preventDefault();
    probe.move(probe.x + step[0] * 2 / tile.map.width, probe.y + step[1] * 2 / tile.map.height);
  });
}

function makeTile(map) {
  const canvas = h('canvas', { 'aria-hidden': 'true' });
  const overlay = discOverlay(map.incidence);
  const frame = h('div', { class: 'disc', tabindex: '0', role: 'img',
    'aria-label': `Direction map: ${map.name}. Arrow keys move the probe.` }, canvas, overlay.element);
  const readout = h('div', { class: 'readout', 'aria-live': 'polite' }, map.note ?? '');
  const element = h('div', { class: 'tile' }, h('div', { class: 'tile-name' }, map.name), frame, readout);
  return { map, canvas, overlay, frame, readout, element };
}

function legend(tiles) {
  const lit = tiles.some((tile) => tile.map.incidence);
  return h('div', { class: 'legend' }, lit ? [h('span', { class: 'mark-light' }, 'light'),
    h('span', { class: 'mark-mirror' }, 'mirror direction')] : null,
  h('span', { class: 'mark-ring' }, 'θ = 30°, 60°; φ every 45°'));
}

export function directionMaps(data) {
  const tiles = data.maps.map(load).map(makeTile);
  const kinds = ['value', 'difference'].filter((kind) => tiles.some((tile) => tile.map.kind === kind));
  const bars = h('div', { class: 'bars' });
  const output = h('output', { class: 'probe' });
  const probe = new Probe(tiles, data.unit, output);
  let log = data.scale === 'log';
  const draw = () => {
    bars.replaceChildren(...kinds.map((kind) => {
      const group = tiles.filter((tile) => tile.map.kind === kind);
      const scale = scaleOf(kind, group.map((tile) => tile.map), log);
      for (const tile of group) paintDisc(tile.canvas, tile.map, scale);
      const label = kind === 'difference' ? data.difference_label ?? 'Difference' : data.label ?? 'BRDF';
      return colourBar(kind, scale, { label, unit: data.unit, clipped: { low: scale.log } });
    }));
  };
  const choice = segmented('Scale', [['linear', 'Linear'], ['log', 'Log']], log ? 'log' : 'linear',
    (value) => { log = value === 'log'; draw(); });
  for (const tile of tiles) listen(tile, probe);
  onThemeChange(draw);
  probe.clear();
  return { element: panel(data, 'maps', { tools: [output, kinds.includes('value') ? choice : null] },
    h('div', { class: 'tiles', 'data-count': tiles.length }, tiles.map((tile) => tile.element)),
    h('div', { class: 'maps-foot' }, bars, legend(tiles))), start: draw };
}
