// A Vega-Lite specification, drawn in the colours of the page, with a picture to take away.
import embed from 'vega-embed';
import { fileName, h, saveAs } from '../lib/dom.js';
import { isDark, onThemeChange, printing, token } from '../lib/theme.js';
import { panel } from './panel.js';

const FONT = 'Inter, "Source Sans 3", "Segoe UI", Roboto, "Helvetica Neue", Arial, "DejaVu Sans", sans-serif';

function configuration() {
  const ink = token('ink'), quiet = token('quiet'), line = token('line');
  const text = { labelColor: quiet, titleColor: ink, labelFont: FONT, titleFont: FONT, labelFontSize: 12,
    titleFontSize: 12, titleFontWeight: 500 };
  return {
    background: 'transparent',
    font: FONT,
    view: { stroke: null },
    axis: { ...text, domainColor: line, tickColor: line, gridColor: line, gridOpacity: 0.7, tickSize: 4,
      labelPadding: 6, labelSeparation: 12, titlePadding: 10 },
    axisX: { grid: false },
    axisY: { domain: false, ticks: false },
    legend: { ...text, title: null, orient: 'top', direction: 'horizontal', symbolStrokeWidth: 2.5, symbolSize: 140,
      padding: 0, offset: 14, columnPadding: 18 },
    header: text,
    title: { color: ink, subtitleColor: quiet, anchor: 'start', fontWeight: 600 },
    mark: { color: token('series-1') },
    line: { strokeWidth: 2, strokeCap: 'round' },
    rule: { color: quiet },
    bar: { cornerRadiusEnd: 2 },
    text: { color: ink, font: FONT, fontSize: 12 },
    range: { category: [1, 2, 3, 4, 5, 6].map((k) => token(`series-${k}`)), ramp: { scheme: 'viridis' },
      heatmap: { scheme: 'viridis' } },
  };
}

// "$ink", "$series-2" … in a specification stand for the page's colours in the theme of the moment.
function coloured(node) {
  if (typeof node === 'string' && node.startsWith('$')) return token(node.slice(1)) || node;
  if (Array.isArray(node)) return node.map(coloured);
  if (node === null || typeof node !== 'object') return node;
  return Object.fromEntries(Object.entries(node).map(([key, value]) => [key, key === 'data' ? value : coloured(value)]));
}

function saveButton(format, title, view) {
  const save = async () => saveAs(`${fileName(title)}.${format}`, await view().toImageURL(format, 2));
  return h('button', { type: 'button', onclick: save, 'aria-label': `Save ${title} as ${format.toUpperCase()}` },
    format.toUpperCase());
}

export function chart(data) {
  const host = h('div', { class: data.spec.height === 'container' ? 'chart fills' : 'chart', role: 'img', 'aria-label': data.alt || data.title || 'Chart' });
  let view = null;
  let turn = 0;
  const draw = async () => {
    const mine = ++turn;
    host.dataset.drawn = isDark() ? 'dark' : 'light';
    const target = h('div', {});
    host.replaceChildren(target);
    const result = await embed(target, coloured(data.spec), { mode: 'vega-lite', renderer: 'svg', actions: false,
      config: configuration(), tooltip: { theme: isDark() ? 'dark' : 'light' } });
    if (mine === turn) view = result.view; else result.finalize();
  };
  onThemeChange(() => { if (!printing() && host.dataset.drawn !== undefined) draw(); });
  const buttons = ['svg', 'png'].map((format) => saveButton(format, data.title ?? 'chart', () => view));
  return { element: panel(data, 'chart-panel', { tools: [h('div', { class: 'save', role: 'group', 'aria-label': 'Save as' }, buttons)] }, host),
    start: draw };
}
