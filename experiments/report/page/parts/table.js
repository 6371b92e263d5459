// Tables of text and quantities. Numbers stand right, with the digits that their standard errors allow.
import { h } from '../lib/dom.js';
import { inline } from '../lib/markup.js';
import { estimate, isQuantity, plain, quantityText, unitText } from '../lib/number.js';
import { panel } from './panel.js';
import { chip } from './status.js';

const isNumeric = (cell) => typeof cell === 'number' || cell === null || isQuantity(cell);

/// The unit that all quantities of a column share; it then stands in the heading only.
function commonUnit(rows, column) {
  const units = new Set(rows.map((row) => row.cells[column]).filter(isQuantity).map((q) => q.unit ?? '1'));
  return units.size === 1 ? [...units][0] : undefined;
}

function cellText(cell, unit) {
  if (isQuantity(cell)) return unit === undefined ? quantityText(cell) : estimate(cell.value, cell.standard_error);
  return isNumeric(cell) ? plain(cell ?? undefined) : inline(String(cell));
}

function heading(name, numeric, unit) {
  const shown = unitText(unit);
  return h('th', { scope: 'col', class: numeric ? 'number' : undefined }, name,
    shown ? h('span', { class: 'unit' }, shown) : null);
}

export function dataTable(data) {
  const numeric = data.columns.map((_, c) => data.rows.some((row) => isNumeric(row.cells[c])));
  const units = data.columns.map((_, c) => commonUnit(data.rows, c));
  const judged = data.rows.some((row) => row.state);
  const row = ({ cells, state }) => h('tr', { 'data-state': state },
    cells.map((cell, c) => h(c === 0 ? 'th' : 'td', { scope: c === 0 ? 'row' : undefined,
      class: numeric[c] ? 'number' : undefined }, cellText(cell, units[c]))),
    judged ? h('td', { class: 'state' }, chip(state)) : null);
  const element = panel(data, 'table-panel', {}, h('div', { class: 'scroll', tabindex: '0', role: 'region',
    'aria-label': data.title ?? 'Table' }, h('table', {},
    h('thead', {}, h('tr', {}, data.columns.map((name, c) => heading(name, numeric[c], units[c])),
      judged ? h('th', { scope: 'col', class: 'state' }, h('span', { class: 'hidden' }, 'Verdict')) : null)),
    h('tbody', {}, data.rows.map(row)))));
  return { element };
}
