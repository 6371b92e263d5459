// Perceptually uniform colour tables: 256 × RGB bytes, for values and (diverging) for differences.
import { scheme } from 'vega';
import { isDark, palette } from './theme.js';

export const PALETTES = [['viridis', 'Viridis'], ['magma', 'Magma'], ['cividis', 'Cividis']];

const tables = new Map();

function tableOf(colourAt) {
  const table = new Uint8Array(256 * 3);
  for (let i = 0; i < 256; ++i) table.set(colourAt(i / 255), i * 3);
  return table;
}

function schemeColour(name) {
  const interpolate = scheme(name);
  return (t) => {
    const text = interpolate(t);
    if (text.startsWith('#')) return [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16));
    return text.match(/[\d.]+/g).slice(0, 3).map((x) => Math.round(Number(x)));
  };
}

// OKLab (Ottosson 2020): equal steps look equal, so the lightness of both arms falls alike.
function okLabToRgb(L, a, b) {
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const linear = [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
  return linear.map((x) => {
    const c = Math.min(Math.max(x, 0), 1);
    return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
  });
}

// Blue, neutral, copper. On a dark page zero is dark, so that "no difference" does not glare.
const DIVERGING = {
  light: [[0.4, -0.03, -0.13], [0.965, 0.0, 0.005], [0.44, 0.12, 0.085]],
  dark: [[0.78, -0.05, -0.11], [0.25, 0.0, 0.003], [0.78, 0.085, 0.085]],
};

const divergingColour = ([negative, neutral, positive]) => (t) => {
  const arm = t < 0.5 ? negative : positive;
  const weight = Math.abs(2 * t - 1);
  return okLabToRgb(...arm.map((x, k) => neutral[k] + (x - neutral[k]) * weight));
};

/// The table of a kind of map: "difference", or "value" in the palette that the reader chose.
export function table(kind) {
  const name = kind === 'difference' ? (isDark() ? 'dark' : 'light') : palette();
  if (!tables.has(name)) tables.set(name, tableOf(kind === 'difference' ? divergingColour(DIVERGING[name]) : schemeColour(name)));
  return tables.get(name);
}

export const indexOf = (t) => Math.min(255, Math.max(0, Math.round(t * 255)));

export function cssGradient(kind) {
  const colours = table(kind);
  const stops = Array.from({ length: 33 }, (_, k) => {
    const i = indexOf(k / 32) * 3;
    return `rgb(${colours[i]} ${colours[i + 1]} ${colours[i + 2]})`;
  });
  return `linear-gradient(to right, ${stops.join(', ')})`;
}
