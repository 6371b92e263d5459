// The little markup of running text: blank lines make paragraphs; `code`, *emphasis*, **strong**.
import { h } from './dom.js';

const PIECE = /`([^`]+)`|\*\*([^*]+)\*\*|\*([^*\s][^*]*)\*/g;

export function inline(text) {
  const nodes = [];
  let end = 0;
  for (const match of String(text ?? '').matchAll(PIECE)) {
    nodes.push(text.slice(end, match.index));
    if (match[1] !== undefined) nodes.push(h('code', {}, match[1]));
    else if (match[2] !== undefined) nodes.push(h('strong', {}, match[2]));
    else nodes.push(h('em', {}, match[3]));
    end = match.index + match[0].length;
  }
  return [...nodes, String(text ?? '').slice(end)];
}

export function paragraphs(text, attributes = {}) {
  return String(text ?? '').split(/\n\s*\n/).filter((part) => part.trim())
    .map((part) => h('p', attributes, inline(part.trim())));
}
