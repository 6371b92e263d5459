// Numeric arrays: base64 of 32-bit little-endian floats, each stored once for the whole page.
let store = {};
const decoded = new Map();

export function useArrays(arrays) { store = arrays; }

function decode(base64) {
  const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  return new Float32Array(bytes.buffer);
}

/// The values behind {"array": id} or {"float32": base64}; undefined stays undefined.
export function values(reference) {
  if (!reference) return undefined;
  if (reference.float32 !== undefined) return decode(reference.float32);
  if (!(reference.array in store)) throw new Error(`array "${reference.array}" is missing`);
  if (!decoded.has(reference.array)) decoded.set(reference.array, decode(store[reference.array]));
  return decoded.get(reference.array);
}

/// The value below which a share of the finite values lies.
export function quantile(array, share) {
  const sorted = array.filter(Number.isFinite).sort();
  if (sorted.length === 0) return 0;
  return sorted[Math.min(sorted.length - 1, Math.max(0, Math.round(share * (sorted.length - 1))))];
}

/// A height grid reduced by block means until neither side exceeds `limit`; a block of gaps stays a gap.
export function reduced({ columns, rows, heights }, limit) {
  const block = Math.ceil(Math.max(columns, rows) / limit);
  if (block === 1) return { columns, rows, heights, block };
  const w = Math.floor(columns / block), d = Math.floor(rows / block);
  const out = new Float32Array(w * d);
  for (let r = 0; r < d; ++r) {
    for (let c = 0; c < w; ++c) out[r * w + c] = blockMean(heights, columns, c * block, r * block, block);
  }
  return { columns: w, rows: d, heights: out, block };
}

function blockMean(heights, columns, c0, r0, block) {
  let sum = 0, count = 0;
  for (let r = r0; r < r0 + block; ++r) {
    for (let c = c0; c < c0 + block; ++c) {
      const z = heights[r * columns + c];
      if (!Number.isNaN(z)) { sum += z; ++count; }
    }
  }
  return count > 0 ? sum / count : NaN;
}
