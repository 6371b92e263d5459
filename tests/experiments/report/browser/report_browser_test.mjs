// Opens the demo report from disk in Chromium and looks at what it drew, in light and in dark.
//   node report_browser_test.mjs DEMO.html NODE_MODULES CHROMIUM
// Exit status: 0 passed, 1 failed, 77 skipped.
import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';
import { coloursOf, decode, hover, started } from './probe.mjs';
import { checkNumbers } from './numbers.mjs';

const [demo, modules, chromiumPath] = process.argv.slice(2);
const FLAGS = ['--headless', '--no-sandbox', '--disable-gpu', '--enable-unsafe-swiftshader',
  '--disable-background-networking', '--no-first-run'];

if (!chromiumPath || !existsSync(chromiumPath)) {
  console.log('skipped: chromium is not installed (Debian package "chromium")');
  process.exit(77);
}
const { chromium } = createRequire(`${modules}/`)('playwright-core');

async function open(browser, { colorScheme, width = 1400, prepare }) {
  const page = await browser.newPage({ colorScheme, viewport: { width, height: 900 } });
  const problems = [];
  page.on('console', (message) => { if (message.type() === 'error') problems.push(message.text()); });
  page.on('pageerror', (error) => problems.push(error.message));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) problems.push(`asked the network for ${request.url()}`);
  });
  if (prepare) await page.addInitScript(prepare);
  await page.goto(pathToFileURL(demo).href);
  await page.waitForSelector('html[data-ready]', { timeout: 60000 });
  return { page, problems };
}

const reportData = (page) => page.evaluate(() => JSON.parse(document.getElementById('report-data').textContent));

async function everyComponentIsThere(page) {
  const data = await reportData(page);
  const wanted = data.sections.flatMap((section) => section.components.map((part) => part.type));
  const drawn = await page.$$eval('[data-component]', (all) => all.map((one) => one.dataset.component));
  assert.deepEqual(drawn, wanted);
  assert.equal(await page.$$eval('.panel.failed', (all) => all.length), 0, 'a component failed to draw');
}

async function everyCanvasHasAPicture(page) {
  for (const stage of await page.$$('.stage')) {
    await stage.scrollIntoViewIfNeeded();
    await started(page, stage);
  }
  const canvases = await page.$$('.panel canvas');
  assert.ok(canvases.length >= 8, `8 canvases (6 maps, 2 viewers), found ${canvases.length}`);
  // A blank canvas has one colour; a map without its scale, two or three.
  for (const canvas of canvases) assert.ok(await coloursOf(canvas) > 20, 'a canvas is blank');
}

async function everyChartHasMarksAndText(page) {
  const charts = await page.$$eval('.chart', (all) => all.map((chart) => ({
    marks: chart.querySelectorAll('svg path').length,
    labels: [...chart.querySelectorAll('svg text')].filter((text) => text.textContent).length,
    outlined: [...chart.querySelectorAll('svg text')].some((text) => getComputedStyle(text).stroke !== 'none'),
  })));
  assert.equal(charts.length, 5);
  for (const chart of charts) {
    assert.ok(chart.marks > 3 && chart.labels > 3, `a chart is empty: ${JSON.stringify(chart)}`);
    assert.ok(!chart.outlined, 'a style of the page leaks into the text of a chart');
  }
}

async function nothingSticksOut(page) {
  const [wide, seen] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  assert.ok(wide <= seen, `the page is ${wide} px wide in a window of ${seen} px`);
}

async function hostileTextIsText(page) {
  assert.equal(await page.$('#broken-out'), null);
  assert.ok((await page.textContent('table')).includes('</script><b id="broken-out">'));
}

// y is up: a bright bin above the middle is bright above the middle of the picture.
async function mapsStandUpright(page) {
  const map = (await reportData(page)).sections[0].components[0].maps[0];
  const values = decode((await reportData(page)).arrays[map.values.array]);
  const at = (column, row) => values[row * map.width + column];
  let best = { lead: 0 };
  for (let row = map.height / 2; row < map.height; ++row) {
    for (let column = 0; column < map.width; ++column) {
      const lead = at(column, row) - at(column, map.height - 1 - row);
      if (lead > best.lead) best = { lead, x: (2 * column + 1) / map.width - 1, y: (2 * row + 1) / map.height - 1, value: at(column, row) };
    }
  }
  assert.ok(best.lead > 0.3, 'the demo lobe must not be symmetric in y');
  const read = await hover(page, best.x, best.y);
  const theta = Math.asin(Math.hypot(best.x, best.y)) * 180 / Math.PI;
  assert.ok(Math.abs(parseFloat(read.angles.match(/θ ([\d.]+)/)[1]) - theta) < 1, read.angles);  // a screen pixel is 0.3°
  assert.ok(Math.abs(parseFloat(read.value) - best.value) < 1e-3 * best.value, `read ${read.value}, the bin holds ${best.value}`);
  assert.ok(read.green.here > read.green.mirrored + 15, 'the picture is upside down');  // Viridis: more is greener
}

// The highest sample is the brightest pixel, and row 0 (y = 0) is at the bottom.
async function reliefsStandUpright(page) {
  const data = await reportData(page);
  const relief = data.sections[1].components[0].reliefs[0];
  const heights = decode(data.arrays[relief.heights.array]);
  const top = heights.indexOf(Math.max(...heights));
  const column = top % relief.columns, row = Math.floor(top / relief.columns);
  const green = await page.$eval('.relief canvas', (canvas, [c, r]) =>
    canvas.getContext('2d').getImageData(c, r, 1, 1).data[1], [column, relief.rows - 1 - row]);
  assert.ok(green > 220, `Viridis ends at a green of 231; the highest sample has ${green}`);
}

async function togglesWork(page) {
  const canvas = await page.$('.disc canvas');
  const picture = () => canvas.evaluate((element) => element.toDataURL());
  const linear = await picture();
  await page.click('[data-component=direction_maps] label[data-choice=log]');
  assert.notEqual(await picture(), linear, 'the logarithmic scale changes nothing');
  await page.selectOption('.palette select', 'magma');
  const magma = await picture();
  await page.selectOption('.palette select', 'viridis');
  assert.notEqual(await picture(), magma, 'the colour map changes nothing');
  const stage = await page.$('[data-component=relief_viewer] .stage canvas');
  const before = await stage.evaluate((element) => element.toDataURL());
  await page.click('[data-component=relief_viewer] label[data-choice=metal]');
  await page.waitForTimeout(400);
  assert.notEqual(await stage.evaluate((element) => element.toDataURL()), before, 'the finish changes nothing');
}

const theme = (page) => page.evaluate(() => [document.documentElement.dataset.theme, getComputedStyle(document.body).backgroundColor,
  document.querySelector('.chart svg text').getAttribute('fill')]);

async function themeFollowsTheSystemAndTheToggle(page, system) {
  const first = await theme(page);
  assert.equal(first[0], system);
  const other = system === 'dark' ? 'light' : 'dark';
  await page.click(`#theme label[data-choice=${other}]`);
  await page.waitForFunction((fill) => {
    const text = document.querySelector('.chart svg text');
    return text && text.getAttribute('fill') !== fill;
  }, first[2]);
  const second = await theme(page);
  assert.equal(second[0], other);
  assert.notEqual(second[1], first[1], 'the paper keeps its colour');
  await page.focus(`#theme label[data-choice=${other}] input`);
  await page.keyboard.press(other === 'dark' ? 'ArrowLeft' : 'ArrowRight');
  assert.equal((await theme(page))[0], system, 'the arrow keys do not work the theme');
}

async function inBothThemes(browser) {
  for (const colorScheme of ['light', 'dark']) {
    const { page, problems } = await open(browser, { colorScheme });
    await everyComponentIsThere(page);
    await everyCanvasHasAPicture(page);
    await everyChartHasMarksAndText(page);
    await hostileTextIsText(page);
    await mapsStandUpright(page);
    await reliefsStandUpright(page);
    await togglesWork(page);
    await themeFollowsTheSystemAndTheToggle(page, colorScheme);
    assert.deepEqual(problems, [], 'the page complained');
    await page.close();
  }
}

async function fitsHalfAScreen(browser) {
  for (const width of [1400, 800, 420]) {
    const { page, problems } = await open(browser, { colorScheme: 'light', width });
    await nothingSticksOut(page);
    assert.deepEqual(problems, []);
    await page.close();
  }
}

async function saysSoWithoutWebGl(browser) {
  const prepare = () => {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function getContext(kind, ...rest) {
      return String(kind).startsWith('webgl') ? null : original.call(this, kind, ...rest);
    };
  };
  const { page } = await open(browser, { colorScheme: 'light', prepare });
  const stage = await page.$('.stage');
  await stage.scrollIntoViewIfNeeded();
  await started(page, stage);
  assert.match(await stage.textContent(), /offers no WebGL/);
  await page.close();
}

checkNumbers();
const browser = await chromium.launch({ executablePath: chromiumPath, args: FLAGS });
try {
  for (const check of [inBothThemes, fitsHalfAScreen, saysSoWithoutWebGl]) {
    await check(browser);
    console.log(`passed: ${check.name}`);
  }
} finally {
  await browser.close();
}
