// Bundles the page into one HTML file: dist/template.html. The program puts the data where the marker is.
import { build } from 'esbuild';
import { mkdir, readFile, writeFile } from 'node:fs/promises';

const MARKER = '<!--MEZZOTINT_REPORT_DATA-->';
const root = new URL('.', import.meta.url);

async function bundle(entry) {
  const result = await build({
    absWorkingDir: root.pathname,
    entryPoints: [entry],
    bundle: true,
    minify: true,
    write: false,
    format: 'iife',
    target: 'es2022',
    charset: 'utf8',
    legalComments: 'none',
    logLevel: 'warning',
  });
  return result.outputFiles[0].text.trim();
}

// Inside <script> these two would end the script, or change how its end is found.
function requireInert(script) {
  if (/<\/script|<!--/i.test(script)) throw new Error('the bundle holds "</script" or "<!--"; it cannot be put inline');
  return script;
}

// A function as replacement: a string would have its dollar signs read as patterns.
const put = (html, marker, text) => {
  if (html.split(marker).length !== 2) throw new Error(`page/index.html must hold ${marker} exactly once`);
  return html.replace(marker, () => text);
};

const [script, style, skeleton] = await Promise.all([
  bundle('page/main.js').then((text) => requireInert(text.replaceAll('<!--', '\\x3c!--'))),
  bundle('page/style/main.css'),
  readFile(new URL('page/index.html', root), 'utf8'),
]);
let html = put(skeleton, '/*STYLE*/', style);
html = put(html, '/*SCRIPT*/', script);
if (html.split(MARKER).length !== 2) throw new Error(`the page must hold ${MARKER} exactly once`);
await mkdir(new URL('dist/', root), { recursive: true });
await writeFile(new URL('dist/template.html', root), html);
console.log(`dist/template.html: ${(Buffer.byteLength(html) / 1e6).toFixed(2)} MB`);
