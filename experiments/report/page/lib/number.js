// Numbers as people write them. The standard error decides the digits: two significant ones.
const MINUS = '\u2212';
const THIN = '\u202f';
const SUPER = { '-': '⁻', 0: '⁰', 1: '¹', 2: '²', 3: '³', 4: '⁴', 5: '⁵', 6: '⁶', 7: '⁷', 8: '⁸', 9: '⁹' };
const UNITS = { 1: '', deg: '°', um: 'µm', um2: 'µm²', '1/sr': 'sr⁻¹', '1/um': 'µm⁻¹' };
const UNKNOWN = '—';

export const unitText = (unit) => UNITS[unit] ?? unit ?? '';
export const withUnit = (text, unit) => {
  const shown = unitText(unit);
  if (!shown) return text;
  return shown === '°' ? text + shown : `${text}\u00a0${shown}`;
};

const isNumber = (value) => typeof value === 'number' && Number.isFinite(value);
const power = (exponent) => `×\u200910${[...String(exponent)].map((c) => SUPER[c]).join('')}`;

/// Position of the last digit that is kept: 10^result. Rounding may carry (0.0996 → 0.10), hence the second look.
function lastDigit(size, digits) {
  const exponent = Math.floor(Math.log10(size));
  const rounded = Number(size.toPrecision(digits));
  return Math.max(exponent, Math.floor(Math.log10(rounded) + 1e-12)) - digits + 1;
}

function grouped(text) {
  const [whole, part] = text.split('.');
  const spaced = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, THIN) : whole;
  return part === undefined ? spaced : `${spaced}.${part}`;
}

function fixed(value, last) {
  const decimals = Math.min(Math.max(-last, 0), 20);
  const step = 10 ** Math.max(last, 0);
  const text = (Math.round(Math.abs(value) / step) * step).toFixed(0);
  const shown = decimals > 0 ? Math.abs(value).toFixed(decimals) : text;
  return (value < 0 && Number(shown) !== 0 ? MINUS : '') + grouped(shown);
}

const awkward = (size) => size !== 0 && (size >= 1e6 || size < 1e-3);

/// A number without a standard error: `digits` significant ones, an integer in full.
export function plain(value, digits = 4) {
  if (!isNumber(value)) return UNKNOWN;
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (Number.isInteger(value) && size < 1e7) return fixed(value, 0);
  if (awkward(size)) {
    const exponent = Math.floor(Math.log10(size));
    const mantissa = Number((value / 10 ** exponent).toPrecision(digits));
    return `${String(mantissa).replace('-', MINUS)}\u2009${power(exponent)}`;
  }
  const trimmed = Number(size.toPrecision(digits));
  const decimals = (String(trimmed).split('.')[1] ?? '').length;
  return fixed(Math.sign(value) * trimmed, -decimals);
}

/// "0.2503 ± 0.0012", or with a common power of ten "(1.234 ± 0.012) × 10⁻⁵".
export function estimate(value, error) {
  if (!isNumber(value)) return UNKNOWN;
  if (!isNumber(error) || error <= 0) return plain(value);
  const largest = Math.max(Math.abs(value), error);
  const exponent = awkward(largest) ? Math.floor(Math.log10(largest)) : 0;
  const scale = 10 ** exponent;
  const last = lastDigit(error / scale, 2);
  const pair = `${fixed(value / scale, last)}\u00a0±\u00a0${fixed(error / scale, last)}`;
  return exponent === 0 ? pair : `(${pair})\u2009${power(exponent)}`;
}

export const quantityText = (q) => (isNumber(q.value) ? withUnit(estimate(q.value, q.standard_error), q.unit) : UNKNOWN);
export const isQuantity = (cell) => typeof cell === 'object' && cell !== null && 'value' in cell;
