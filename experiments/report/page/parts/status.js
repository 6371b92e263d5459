// Met, missed, information: always an icon and a word, never a colour alone.
import { h, svg } from '../lib/dom.js';

const PATHS = {
  met: 'M3.5 8.6l3 3 6-7',
  missed: 'M4 4l8 8M12 4l-8 8',
  information: 'M8 7.4v3.8M8 4.7v.1M8 1a7 7 0 1 0 .01 0',
  warning: 'M8 6v3.6M8 12.2v.1M8 1.4L15 14.2H1z',
};
const WORDS = { met: 'Tolerance met', missed: 'Tolerance missed', information: 'Information' };
const SHORT = { met: 'met', missed: 'missed' };

export function icon(state) {
  return svg('svg', { class: 'icon', viewBox: '0 0 16 16', 'aria-hidden': 'true' },
    svg('path', { d: PATHS[state] ?? PATHS.information, fill: 'none', stroke: 'currentColor', 'stroke-width': 1.7,
      'stroke-linecap': 'round', 'stroke-linejoin': 'round' }));
}

export const verdictBadge = (state) =>
  h('span', { class: `badge ${state}` }, icon(state), h('span', {}, WORDS[state] ?? WORDS.information));

export const chip = (state) =>
  (SHORT[state] ? h('span', { class: `chip ${state}` }, icon(state), SHORT[state]) : null);
