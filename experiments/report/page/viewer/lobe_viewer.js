// Lobes in three dimensions: the target as wires over the achieved one as a surface.
import { BufferGeometry, CanvasTexture, DirectionalLight, DoubleSide, Float32BufferAttribute, Group, HemisphereLight,
  LineBasicMaterial, LineSegments, LinearFilter, Mesh, MeshLambertMaterial, SRGBColorSpace, Sprite,
  SpriteMaterial } from 'three';
import { h, segmented } from '../lib/dom.js';
import { values } from '../lib/arrays.js';
import { indexOf, table } from '../lib/colour.js';
import { plain, withUnit } from '../lib/number.js';
import { token } from '../lib/theme.js';
import { meetsDisc } from '../parts/disc.js';
import { panel } from '../parts/panel.js';
import { lobeGeometry, lobeWires } from './lobe_mesh.js';
import { Stage } from './stage.js';

const LIGHT_LENGTH = 1.05;

function load(map) {
  const loaded = { ...map, values: values(map.values) };
  loaded.inside = (k) => meetsDisc(loaded, k);
  loaded.peak = loaded.values.reduce((top, v, k) => (v > top && loaded.inside(k) ? v : top), 0);
  return loaded;
}

function lines(points, colour) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(points.flat(), 3));
  return new LineSegments(geometry, new LineBasicMaterial({ color: colour }));
}

function circle(radius) {
  const point = (k) => [radius * Math.cos(k * Math.PI / 60), radius * Math.sin(k * Math.PI / 60), 0];
  return Array.from({ length: 120 }, (_, k) => [point(k), point(k + 1)]).flat();
}

function label(text, position, colour) {
  const canvas = h('canvas', { width: 256, height: 64 });
  const context = canvas.getContext('2d');
  Object.assign(context, { font: '500 34px Inter, "Segoe UI", "DejaVu Sans", sans-serif', fillStyle: colour,
    textAlign: 'center', textBaseline: 'middle' });
  context.fillText(text, 128, 32);
  const texture = new CanvasTexture(canvas);
  Object.assign(texture, { colorSpace: SRGBColorSpace, minFilter: LinearFilter, generateMipmaps: false });
  const sprite = new Sprite(new SpriteMaterial({ map: texture, depthTest: false }));
  sprite.position.set(...position);
  sprite.scale.set(0.4, 0.1, 1);
  return sprite;
}

/// The plane z = 0 with its axes, and the direction toward the light.
function furniture(incidence) {
  const quiet = token('quiet'), line = token('line-strong');
  const group = new Group();
  group.add(lines([...circle(1), ...circle(0.5)], line),
    lines([[-1, 0, 0], [1.06, 0, 0], [0, -1, 0], [0, 1.06, 0], [0, 0, 0], [0, 0, 1.06]], line),
    label('x', [1.13, 0, 0], quiet), label('y', [0, 1.13, 0], quiet), label('z', [0, 0, 1.13], quiet));
  if (incidence) {
    const theta = incidence.theta_deg * Math.PI / 180, phi = incidence.phi_deg * Math.PI / 180;
    const d = [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
    const tip = d.map((x) => x * LIGHT_LENGTH);
    group.add(lines([[0, 0, 0], tip], token('accent')), label('light', d.map((x) => x * (LIGHT_LENGTH + 0.1)), token('accent')));
  }
  return group;
}

class LobeScene {
  constructor(data) {
    this.maps = data.maps.map(load);
    this.incidence = data.maps.find((map) => map.incidence)?.incidence;
    this.peak = Math.max(...this.maps.map((map) => map.peak)) || 1;
    this.unit = data.unit;
    this.radius = data.radius ?? 'cube_root';
    this.shown = this.maps.map(() => true);
  }

  build(stage) {
    this.stage = stage;
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(-1, -1.4, 2);
    const sky = new HemisphereLight(0xffffff, 0x999999, 1.7);
    sky.position.set(0, 0, 1);
    stage.scene.add(sky, sun);
    this.contents = new Group();
    stage.scene.add(this.contents);
    stage.themed = () => this.rebuild();
    this.rebuild();
  }

  // Shares of the peak; the colour follows the same measure as the radius.
  share(value) { return this.radius === 'linear' ? value / this.peak : Math.cbrt(value / this.peak); }

  colour(value) {
    const i = 3 * indexOf(this.share(value));
    return [0, 1, 2].map((j) => (table('value')[i + j] / 255) ** 2.2);
  }

  lobe(map) {
    const geometry = lobeGeometry(map, (v) => this.share(v), (v) => this.colour(v));
    if (map.target) return lobeWires(geometry, token('ink'));
    return new Mesh(geometry, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }));
  }

  rebuild() {
    if (!this.stage) return;
    this.contents.traverse((node) => {
      node.geometry?.dispose();
      node.material?.map?.dispose();
      node.material?.dispose();
    });
    this.contents.clear();
    this.contents.add(furniture(this.incidence));
    this.lobes = this.maps.map((map) => this.lobe(map));
    this.contents.add(...this.lobes);
    this.update();
  }

  update() {
    if (!this.lobes) return;
    this.lobes.forEach((lobe, k) => { lobe.visible = this.shown[k]; });
    const measure = this.radius === 'linear' ? 'radius ∝ BRDF' : 'radius ∝ cube root of the BRDF';
    this.stage.caption.textContent = `${measure} · outer circle ${withUnit(plain(this.peak, 3), this.unit)}`;
    this.stage.redraw();
  }
}

function lobeChoice(scene, map, k) {
  const input = h('input', { type: 'checkbox', checked: true,
    onchange: () => { scene.shown[k] = input.checked; scene.update(); } });
  return h('label', { class: map.target ? 'check wires' : 'check' }, input, h('span', {}, map.name));
}

export function lobeViewer(data) {
  const scene = new LobeScene(data);
  const stage = new Stage(data.alt || data.title || 'BRDF lobe', { azimuth: -1.15, elevation: 0.42, distance: 3.2,
    target: [0, 0, 0.3] }, (it) => scene.build(it));
  const radius = segmented('Radius', [['cube_root', 'Cube root'], ['linear', 'Linear']], scene.radius,
    (value) => { scene.radius = value; scene.rebuild(); });
  return { element: panel(data, 'viewer', { tools: [radius] }, stage.element,
    h('div', { class: 'viewer-controls' }, h('div', { class: 'checks', role: 'group', 'aria-label': 'Lobes' },
      scene.maps.map((map, k) => lobeChoice(scene, map, k))))), start: () => stage.watch() };
}
