// One direction map: its pixels inside the unit disc, and the drawing over them.
import { svg } from '../lib/dom.js';
import { indexOf, table } from '../lib/colour.js';

const EXTENT = 1.13;   // half the side of the picture, in units of the disc's radius
const PIXELS = 640;    // of the canvas; enough for a sharp rim on a dense screen

/// Whether a bin's pixel meets the disc: its corner nearest to the centre lies inside.
export function meetsDisc({ width, height }, index) {
  const near = (i, n) => {
    const a = 2 * i / n - 1, b = 2 * (i + 1) / n - 1;
    return a > 0 ? a : b < 0 ? b : 0;
  };
  return Math.hypot(near(index % width, width), near(Math.floor(index / width), height)) < 1;
}

function pixels(map, scale) {
  const image = new ImageData(map.width, map.height);
  const colours = table(map.kind);
  map.values.forEach((value, k) => {
    if (!Number.isFinite(value)) return;  // stays transparent: the hatching shows through
    const column = k % map.width, row = Math.floor(k / map.width);
    const at = 4 * ((map.height - 1 - row) * map.width + column);  // row 0 is y = −1; the picture's top is y = +1
    const colour = 3 * indexOf(scale.fraction(value));
    image.data.set([colours[colour], colours[colour + 1], colours[colour + 2], 255], at);
  });
  return image;
}

export function paintDisc(canvas, map, scale) {
  const source = document.createElement('canvas');
  Object.assign(source, { width: map.width, height: map.height });
  source.getContext('2d').putImageData(pixels(map, scale), 0, 0);
  Object.assign(canvas, { width: PIXELS, height: PIXELS });
  const context = canvas.getContext('2d');
  const radius = PIXELS / (2 * EXTENT), left = PIXELS / 2 - radius;
  context.beginPath();
  context.arc(PIXELS / 2, PIXELS / 2, radius, 0, 2 * Math.PI);
  context.clip();
  context.imageSmoothingEnabled = false;
  context.drawImage(source, left, left, 2 * radius, 2 * radius);
}

function axes() {
  return svg('g', { class: 'axes' },
    svg('line', { x1: 1, y1: 0, x2: 1.04, y2: 0 }), svg('line', { x1: 0, y1: -1, x2: 0, y2: -1.04 }),
    svg('text', { x: 1.085, y: 0.025 }, 'x'), svg('text', { x: 0, y: -1.065 }, 'y'));
}

// Rings of θ = 30° and 60°, and spokes of φ every 45°. The spokes leave the middle free: the lobe may be there.
const RINGS = [0.5, Math.sqrt(0.75)];

function grid() {
  const spokes = Array.from({ length: 8 }, (_, k) => [Math.cos(k * Math.PI / 4), Math.sin(k * Math.PI / 4)]);
  return [RINGS.map((r) => svg('circle', { class: 'ring', r })),
    spokes.map(([x, y]) => svg('line', { class: 'ring', x1: RINGS[0] * x, y1: RINGS[0] * y, x2: x, y2: y }))];
}

function incidenceMarks({ theta_deg, phi_deg }) {
  const r = Math.sin(theta_deg * Math.PI / 180), phi = phi_deg * Math.PI / 180;
  const x = r * Math.cos(phi), y = -r * Math.sin(phi);
  const cross = `M${-x - 0.05} ${-y}h.1M${-x} ${-y - 0.05}v.1`;
  return svg('g', { class: 'light' },
    svg('circle', { class: 'halo', cx: x, cy: y, r: 0.045 }), svg('path', { class: 'halo', d: cross }),
    svg('circle', { cx: x, cy: y, r: 0.045 }), svg('circle', { class: 'dot', cx: x, cy: y, r: 0.014 }),
    svg('path', { d: cross }));
}

/// Rim, rings, axes, light; and `probe(x, y)` moves a cross hair (without arguments it goes away).
export function discOverlay(incidence) {
  const hair = svg('g', { class: 'hair', visibility: 'hidden' },
    svg('circle', { class: 'halo', r: 0.035 }), svg('circle', { r: 0.035 }));
  const element = svg('svg', { viewBox: `${-EXTENT} ${-EXTENT} ${2 * EXTENT} ${2 * EXTENT}`, 'aria-hidden': 'true' },
    grid(),
    svg('circle', { class: 'rim', r: 1 }), axes(), incidence ? incidenceMarks(incidence) : null, hair);
  const probe = (x, y) => {
    hair.setAttribute('visibility', x === undefined ? 'hidden' : 'visible');
    if (x !== undefined) hair.setAttribute('transform', `translate(${x} ${-y})`);
  };
  return { element, probe, extent: EXTENT };
}
