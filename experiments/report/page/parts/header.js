// Top bar (sections, colour map, theme), title block, verdict, key figures.
import { h, segmented } from '../lib/dom.js';
import { inline } from '../lib/markup.js';
import { estimate, plain, unitText, withUnit } from '../lib/number.js';
import { PALETTES } from '../lib/colour.js';
import { palette, setPalette, setTheme, theme } from '../lib/theme.js';
import { chip, verdictBadge } from './status.js';
import { sectionId } from './section.js';

const THEMES = [['auto', 'Auto'], ['light', 'Light'], ['dark', 'Dark']];

function paletteChoice() {
  const select = h('select', { 'aria-label': 'Colour map', onchange: (event) => setPalette(event.target.value) },
    PALETTES.map(([value, text]) => h('option', { value, selected: value === palette() }, text)));
  return h('label', { class: 'palette' }, h('span', {}, 'Colours'), select);
}

export function topBar(report) {
  const links = (report.sections ?? []).map((part, index) => h('a', { href: `#${sectionId(index)}` }, part.title));
  const themes = segmented('Theme', THEMES, theme(), setTheme);
  themes.id = 'theme';
  return h('header', { class: 'topbar' },
    h('div', { class: 'topbar-inner' },
      h('a', { class: 'wordmark', href: '#top' }, 'Mezzotint'),
      h('nav', { 'aria-label': 'Sections' }, links),
      h('div', { class: 'settings' }, paletteChoice(), themes)));
}

function keyFigure(figure) {
  const [value, error] = estimate(figure.value, figure.standard_error).split('\u00a0±\u00a0');
  const shown = unitText(figure.unit);
  const sign = shown === '°' ? shown : '';  // stands close; any other unit stands apart
  const scaled = value.startsWith('(');  // "(1.2 ± 0.1) × 10⁻⁵" does not come apart
  const number = scaled ? estimate(figure.value, figure.standard_error) : value;
  return h('div', { class: 'key', 'data-state': figure.state },
    h('dt', {}, figure.name),
    h('dd', {},
      h('div', { class: 'key-number' }, h('span', { class: scaled ? 'value scaled' : 'value' }, error ? number : number + sign),
        error && !scaled ? h('span', { class: 'error' }, `±\u2009${error}${sign}`) : null,
        shown && !sign ? h('span', { class: 'unit' }, shown) : null),
      h('div', { class: 'key-note' }, chip(figure.state),
        typeof figure.at_most === 'number' ? h('span', {}, `at most ${withUnit(plain(figure.at_most), figure.unit)}`) : null,
        figure.note ? h('span', {}, figure.note) : null)));
}

export function reportHeader(report) {
  const verdict = report.verdict;
  return h('div', { class: 'title-block', id: 'top' },
    h('h1', {}, report.title),
    report.subtitle ? h('p', { class: 'subtitle' }, inline(report.subtitle)) : null,
    verdict ? h('div', { class: `verdict ${verdict.state}` },
      verdictBadge(verdict.state), h('p', {}, inline(verdict.sentence))) : null,
    report.key_figures?.length ? h('dl', { class: 'keys' }, report.key_figures.map(keyFigure)) : null);
}
