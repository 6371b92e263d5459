// A relief as a solid block: the surface, and walls down to a floor. Gaps are holes.
import { BufferAttribute, BufferGeometry } from 'three';

function surfaceTriangles({ columns, rows, heights }) {
  const index = [];
  const seen = (k) => !Number.isNaN(heights[k]);
  for (let r = 0; r + 1 < rows; ++r) {
    for (let c = 0; c + 1 < columns; ++c) {
      const a = r * columns + c, b = a + 1, d = a + columns, e = d + 1;
      if (seen(a) && seen(b) && seen(e)) index.push(a, b, e);
      if (seen(a) && seen(e) && seen(d)) index.push(a, e, d);
    }
  }
  return index;
}

/// Lengths are divided by `unit_um`, so that every relief fits the same stage; z starts at `low_um`.
export function reliefGeometry(relief, unit_um, low_um) {
  const { columns, rows, heights } = relief;
  const positions = new Float32Array(columns * rows * 3);
  for (let k = 0; k < columns * rows; ++k) {
    positions[3 * k] = ((k % columns) - (columns - 1) / 2) * relief.pitch_x_um / unit_um;
    positions[3 * k + 1] = (Math.floor(k / columns) - (rows - 1) / 2) * relief.pitch_y_um / unit_um;
    positions[3 * k + 2] = Number.isNaN(heights[k]) ? 0 : (heights[k] - low_um) / unit_um;
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(surfaceTriangles(relief));
  geometry.computeVertexNormals();
  return geometry;
}

function border({ columns, rows }) {
  const loop = [];
  for (let c = 0; c < columns; ++c) loop.push(c);
  for (let r = 1; r < rows; ++r) loop.push(r * columns + columns - 1);
  for (let c = columns - 2; c >= 0; --c) loop.push((rows - 1) * columns + c);
  for (let r = rows - 2; r >= 0; --r) loop.push(r * columns);
  return loop;
}

/// The four walls, from the surface down to `floor` (in the units of the surface's geometry).
export function wallGeometry(relief, surface, floor) {
  const top = surface.getAttribute('position');
  const loop = border(relief);
  const positions = [], index = [];
  loop.forEach((k, i) => {
    positions.push(top.getX(k), top.getY(k), top.getZ(k), top.getX(k), top.getY(k), floor);
    if (i === 0 || Number.isNaN(relief.heights[k]) || Number.isNaN(relief.heights[loop[i - 1]])) return;
    const a = 2 * (i - 1);
    index.push(a, a + 1, a + 3, a, a + 3, a + 2);
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3));
  geometry.setIndex(index);
  const flat = geometry.toNonIndexed();  // hard edges
  flat.computeVertexNormals();
  return flat;
}

/// One colour a vertex, by height.
export function heightColours(relief, scale, table, indexOf) {
  const colours = new Float32Array(relief.heights.length * 3);
  relief.heights.forEach((z, k) => {
    const i = 3 * indexOf(Number.isNaN(z) ? 0 : scale.fraction(z));
    for (let j = 0; j < 3; ++j) colours[3 * k + j] = (table[i + j] / 255) ** 2.2;  // three.js takes linear light
  });
  return new BufferAttribute(colours, 3);
}
