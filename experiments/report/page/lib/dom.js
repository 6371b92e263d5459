// Elements from plain calls. Text always enters as text nodes, so that no data can become markup.
const SVG = 'http://www.w3.org/2000/svg';

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children.flat(Infinity).filter((child) => child !== undefined && child !== null && child !== false));
  return element;
}

export const h = (tag, attributes, ...children) => fill(document.createElement(tag), attributes, children);
export const svg = (tag, attributes, ...children) => fill(document.createElementNS(SVG, tag), attributes, children);

let counter = 0;
export const uniqueId = (stem) => `${stem}-${++counter}`;

/// A group of radio buttons that looks like one control; arrow keys work as in any radio group.
export function segmented(label, options, selected, onchange) {
  const name = uniqueId('choice');
  const buttons = options.map(([value, text]) => {
    const input = h('input', { type: 'radio', name, value, checked: value === selected,
      onchange: () => onchange(value) });
    return h('label', { 'data-choice': value }, input, h('span', {}, text));
  });
  return h('div', { class: 'segmented', role: 'radiogroup', 'aria-label': label }, buttons);
}

export function saveAs(name, url) {
  const link = h('a', { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
}

export const fileName = (title) => (title || 'mezzotint').toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-|-$/g, '') || 'mezzotint';
