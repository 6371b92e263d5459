// From a value to 0…1 along a colour bar, and the ticks of that bar.

/// A linear or logarithmic scale between two ends.
export function makeScale({ low, high, log = false }) {
  if (!(high > low)) high = low + (Math.abs(low) || 1);
  const fraction = log
    ? (v) => (v > 0 ? Math.log(v / low) / Math.log(high / low) : -1)
    : (v) => (v - low) / (high - low);
  return { low, high, log, fraction, ticks: log ? logTicks(low, high) : linearTicks(low, high) };
}

export function niceStep(span, count) {
  const raw = span / count;
  const base = 10 ** Math.floor(Math.log10(raw));
  return [1, 2, 5, 10].map((m) => m * base).find((step) => step >= raw * 0.999);
}

function linearTicks(low, high) {
  const step = niceStep(high - low, 5);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + step * 1e-9; ++k) ticks.push(k === 0 ? 0 : k * step);
  return ticks;
}

function logTicks(low, high) {
  const ticks = [];
  const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9);
  for (let k = first; k <= last; ++k) ticks.push(10 ** k);
  return ticks.length >= 2 ? ticks : [low, Math.sqrt(low * high), high];
}
