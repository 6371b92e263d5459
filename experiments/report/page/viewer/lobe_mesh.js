// A direction map as a surface: the distance from the origin is the BRDF in that direction.
import { BufferAttribute, BufferGeometry, LineSegments, LineBasicMaterial } from 'three';

const RINGS = 90, SPOKES = 180;           // 1° × 2°, finer than a 64² map anywhere but at the pole
const WIRE_RINGS = 5, WIRE_SPOKES = 10;   // every 5th ring and every 10th spoke become wires

/// Bilinear between bin centres; bins outside of the disc or without a value do not take part.
export function sample(map, x, y) {
  const u = (x + 1) * map.width / 2 - 0.5, v = (y + 1) * map.height / 2 - 0.5;
  const c0 = Math.floor(u), r0 = Math.floor(v);
  let sum = 0, weight = 0;
  for (const [c, r] of [[c0, r0], [c0 + 1, r0], [c0, r0 + 1], [c0 + 1, r0 + 1]]) {
    if (c < 0 || r < 0 || c >= map.width || r >= map.height || !map.inside(r * map.width + c)) continue;
    const value = map.values[r * map.width + c];
    const w = (1 - Math.abs(u - c)) * (1 - Math.abs(v - r));
    if (Number.isFinite(value) && w > 0) { sum += w * value; weight += w; }
  }
  return weight > 0 ? Math.max(0, sum / weight) : 0;
}

const directionOf = (ring, spoke) => {
  const theta = ring / RINGS * Math.PI / 2, phi = spoke / SPOKES * 2 * Math.PI;
  return [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
};

/// @param radius  from a value to a length
/// @param colour  from a value to three linear colour components
export function lobeGeometry(map, radius, colour) {
  const positions = [], colours = [], index = [];
  for (let ring = 0; ring <= RINGS; ++ring) {
    for (let spoke = 0; spoke <= SPOKES; ++spoke) {
      const [x, y, z] = directionOf(ring, spoke);
      const value = sample(map, x, y), r = radius(value);
      positions.push(r * x, r * y, r * z);
      colours.push(...colour(value));
      if (ring < RINGS && spoke < SPOKES) {
        const a = ring * (SPOKES + 1) + spoke, b = a + 1, c = a + SPOKES + 1, d = c + 1;
        index.push(a, c, d, a, d, b);
      }
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute('color', new BufferAttribute(new Float32Array(colours), 3));
  geometry.setIndex(index);
  geometry.computeVertexNormals();
  return geometry;
}

/// Rings and spokes of a lobe as lines, so that another lobe can be seen through it.
export function lobeWires(geometry, colour) {
  const index = [];
  const at = (ring, spoke) => ring * (SPOKES + 1) + spoke;
  for (let ring = 0; ring <= RINGS; ++ring) {
    for (let spoke = 0; spoke < SPOKES; ++spoke) {
      if (ring % WIRE_RINGS === 0) index.push(at(ring, spoke), at(ring, spoke + 1));
      if (spoke % WIRE_SPOKES === 0 && ring < RINGS) index.push(at(ring, spoke), at(ring + 1, spoke));
    }
  }
  const lines = new BufferGeometry();
  lines.setAttribute('position', geometry.getAttribute('position'));
  lines.setIndex(index);
  return new LineSegments(lines, new LineBasicMaterial({ color: colour, transparent: true, opacity: 0.75 }));
}
