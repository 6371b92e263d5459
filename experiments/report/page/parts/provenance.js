// How the result came to be, and the data behind the page.
import { h, fileName, saveAs } from '../lib/dom.js';

function copyByHand(text) {
  const area = h('textarea', { class: 'hidden' });
  area.value = text;
  document.body.append(area);
  area.select();
  const done = document.execCommand('copy');
  area.remove();
  if (!done) throw new Error('refused');
}

async function copy(text, button) {
  try {
    await navigator.clipboard.writeText(text).catch(() => copyByHand(text));
    button.textContent = 'Copied';
  } catch {
    button.textContent = 'Copying is not allowed here';
  }
  setTimeout(() => { button.textContent = 'Copy'; }, 2000);
}

function download() {
  const url = URL.createObjectURL(new Blob([document.getElementById('report-data').textContent],
    { type: 'application/json' }));
  saveAs(`${fileName(document.title)}.json`, url);
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

export function provenance(entries) {
  const pairs = Object.entries(entries ?? {});
  const text = pairs.map(([key, value]) => `${key}: ${value}`).join('\n');
  const copyButton = h('button', { type: 'button', onclick: () => copy(text, copyButton) }, 'Copy');
  return h('section', { class: 'section provenance', 'aria-label': 'Provenance' },
    h('details', {},
      h('summary', {}, h('h2', {}, 'Provenance'), h('span', { class: 'hint' }, `${pairs.length} entries`)),
      h('dl', {}, pairs.map(([key, value]) => [h('dt', {}, key), h('dd', {}, value)]))),
    h('div', { class: 'actions' }, copyButton,
      h('button', { type: 'button', onclick: download }, 'Download data (JSON)')));
}
