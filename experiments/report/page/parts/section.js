// One section: heading, lead paragraphs, components on a grid.
import { h } from '../lib/dom.js';
import { paragraphs } from '../lib/markup.js';
import { panel } from './panel.js';
import { chart } from './chart.js';
import { directionMaps } from './direction_maps.js';
import { reliefMaps } from './relief_maps.js';
import { dataTable } from './table.js';
import { messageList } from './messages.js';
import { reliefViewer } from '../viewer/relief_viewer.js';
import { lobeViewer } from '../viewer/lobe_viewer.js';

// Each takes a component's data and gives its element, with `start` where it draws once it has a size.
const COMPONENTS = {
  chart,
  table: dataTable,
  direction_maps: directionMaps,
  relief_maps: reliefMaps,
  relief_viewer: reliefViewer,
  lobe_viewer: lobeViewer,
  messages: (data) => ({ element: panel(data, 'plain', {}, messageList(data.messages)) }),
};

function failure(data, error) {
  console.error(error);
  return panel({ ...data, caption: undefined }, 'failed', {},
    h('p', { role: 'alert' }, `This part cannot be drawn: ${error.message}.`));
}

// One broken part must not take the page with it.
function component(data, drawing) {
  try {
    if (!(data.type in COMPONENTS)) throw new Error(`"${data.type}" is no component that this page knows`);
    const part = COMPONENTS[data.type](data);
    if (part.start) {
      drawing.push(async () => {
        try { await part.start(); } catch (error) { part.element.replaceWith(failure(data, error)); }
      });
    }
    return part.element;
  } catch (error) {
    return failure(data, error);
  }
}

export const sectionId = (index) => `section-${index + 1}`;

export function section(data, index, drawing) {
  return h('section', { class: 'section', id: sectionId(index), 'aria-labelledby': `${sectionId(index)}-title` },
    h('div', { class: 'section-head' },
      h('h2', { id: `${sectionId(index)}-title` }, data.title),
      h('div', { class: 'lead' }, paragraphs(data.text))),
    h('div', { class: 'grid' }, (data.components ?? []).map((part) => component(part, drawing))));
}
