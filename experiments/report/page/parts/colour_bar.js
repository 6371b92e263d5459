// The common colour bar of a group of maps.
import { h } from '../lib/dom.js';
import { cssGradient } from '../lib/colour.js';
import { plain, unitText } from '../lib/number.js';

/// @param clipped  {low, high}: whether values lie beyond that end; its label then says so.
export function colourBar(kind, scale, { label, unit, clipped = {} }) {
  const ticks = scale.ticks.map((value) => {
    const position = 100 * scale.fraction(value);
    const edge = position < 4 ? ' first' : position > 96 ? ' last' : '';
    const beyond = (clipped.low && position < 0.5 ? '≤\u2009' : '') + (clipped.high && position > 99.5 ? '≥\u2009' : '');
    return h('span', { class: `tick${edge}`, style: `left:${position.toFixed(2)}%` }, beyond + plain(value, 3));
  });
  const shown = unitText(unit);
  return h('div', { class: 'colour-bar', role: 'img',
    'aria-label': `Colour bar, ${label}, from ${plain(scale.low, 3)} to ${plain(scale.high, 3)} ${shown}` },
  h('div', { class: 'bar-label' }, label, shown ? h('span', { class: 'unit' }, shown) : null),
  h('div', { class: 'bar-body' },
    h('div', { class: 'ramp', style: `background-image:${cssGradient(kind)}` }),
    h('div', { class: 'ticks' }, ticks)));
}
