// The page of a run: reads the inline data, draws header, messages, sections and provenance.
import { h } from './lib/dom.js';
import { useArrays } from './lib/arrays.js';
import { startTheme } from './lib/theme.js';
import { topBar, reportHeader } from './parts/header.js';
import { messageList } from './parts/messages.js';
import { section } from './parts/section.js';
import { provenance } from './parts/provenance.js';

function readReport() {
  const element = document.getElementById('report-data');
  if (!element) throw new Error('this file holds no report data');
  const report = JSON.parse(element.textContent);
  if (report.format !== 'mezzotint-report' || report.version !== 1) {
    throw new Error(`the data are not a Mezzotint report of version 1 (found "${report.format}", version ${report.version})`);
  }
  return report;
}

async function draw(root) {
  const report = readReport();
  document.title = report.title;
  useArrays(report.arrays ?? {});
  const drawing = [];
  const sections = (report.sections ?? []).map((data, index) => section(data, index, drawing));
  root.append(
    topBar(report),
    h('main', { class: 'page' },
      reportHeader(report), messageList(report.messages), sections, provenance(report.provenance)),
    h('footer', { class: 'foot' }, 'Written by Mezzotint. This file is complete: it loads nothing from the network.'),
  );
  // Parts draw when they are in the document, where they have a size.
  await Promise.all(drawing.map((start) => start()));
}

startTheme();
const root = document.getElementById('report');
draw(root)
  .catch((error) => {
    root.replaceChildren(h('p', { class: 'noscript', role: 'alert' }, `This report cannot be drawn: ${error.message}.`));
    console.error(error);
  })
  .finally(() => { document.documentElement.dataset.ready = 'true'; });
