// The frame that every component shares: title, tools at the right, body, caption.
import { h, uniqueId } from '../lib/dom.js';
import { inline } from '../lib/markup.js';

export function panel(data, kind, { tools = [] } = {}, ...body) {
  const id = uniqueId('panel');
  const heading = data.title || tools.length
    ? h('div', { class: 'panel-head' }, h('h3', { id }, data.title ?? ''), h('div', { class: 'tools' }, tools))
    : null;
  return h('figure', { class: `panel ${kind}`, 'data-component': data.type, 'data-span': data.span ?? 'full',
    'aria-labelledby': data.title ? id : undefined },
  heading, h('div', { class: 'panel-body' }, body),
  data.caption ? h('figcaption', {}, inline(data.caption)) : null);
}
