// What the reader must know before believing the numbers.
import { h } from '../lib/dom.js';
import { inline } from '../lib/markup.js';
import { icon } from './status.js';

const ICONS = { error: 'missed', warning: 'warning', note: 'information' };
const WORDS = { error: 'Error', warning: 'Warning', note: 'Note' };

export function messageList(messages) {
  if (!messages?.length) return null;
  return h('ul', { class: 'messages', 'aria-label': 'Messages' }, messages.map(({ level, text }) =>
    h('li', { class: level }, icon(ICONS[level] ?? 'information'),
      h('p', {}, h('strong', {}, `${WORDS[level] ?? 'Note'}. `), inline(text)))));
}
