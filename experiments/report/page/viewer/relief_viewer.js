// Reliefs in three dimensions: choose one, turn it, exaggerate its heights, colour it by height or as metal.
import { CanvasTexture, DirectionalLight, DoubleSide, Group, HemisphereLight, Mesh, MeshLambertMaterial,
  MeshMatcapMaterial, SRGBColorSpace } from 'three';
import { h, segmented } from '../lib/dom.js';
import { reduced } from '../lib/arrays.js';
import { indexOf, table } from '../lib/colour.js';
import { plain } from '../lib/number.js';
import { token } from '../lib/theme.js';
import { panel } from '../parts/panel.js';
import { heightScale, loadRelief } from '../parts/relief_maps.js';
import { heightColours, reliefGeometry, wallGeometry } from './relief_mesh.js';
import { Stage } from './stage.js';

const MESH_SIDE = 256;
const EXAGGERATIONS = [1, 1.5, 2, 3, 4, 5, 7, 10, 15, 20, 30, 50, 70, 100];

// Polished copper, as a picture of a lit sphere: cheap, and the same on every machine.
function copperTexture() {
  const canvas = h('canvas', { width: 256, height: 256 });
  const context = canvas.getContext('2d');
  const ball = (x, y, r, stops) => {
    const gradient = context.createRadialGradient(x, y, 0, x, y, r);
    stops.forEach(([at, colour]) => gradient.addColorStop(at, colour));
    context.fillStyle = gradient;
    context.fillRect(0, 0, 256, 256);
  };
  ball(105, 95, 190, [[0, '#e8b08a'], [0.35, '#c47a4d'], [0.7, '#7a4026'], [1, '#2b150c']]);
  ball(88, 70, 60, [[0, 'rgba(255,244,232,.95)'], [0.35, 'rgba(255,222,190,.5)'], [1, 'rgba(255,222,190,0)']]);
  ball(200, 205, 70, [[0, 'rgba(150,180,210,.45)'], [1, 'rgba(150,180,210,0)']]);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  return texture;
}

/// The step that makes the relief about a tenth as high as it is wide.
function startingExaggeration(span_um, unit_um) {
  const wanted = 0.1 * unit_um / span_um;
  return EXAGGERATIONS.reduce((best, x) => (Math.abs(Math.log(x / wanted)) < Math.abs(Math.log(best / wanted)) ? x : best));
}

/// Everything that the scene knows; the controls only set its fields and call `update`.
class ReliefScene {
  constructor(reliefs) {
    this.reliefs = reliefs.map((relief) => {
      const small = reduced(relief, MESH_SIDE);
      return { ...relief, ...small, pitch_x_um: relief.pitch_x_um * small.block, pitch_y_um: relief.pitch_y_um * small.block };
    });
    this.scale = heightScale(this.reliefs);
    this.unit_um = Math.max(...this.reliefs.map((r) => Math.max(r.width_um, r.depth_um)));
    this.selected = 0;
    this.finish = 'height';
    this.exaggeration = startingExaggeration(this.scale.high - this.scale.low, this.unit_um);
  }

  build(stage) {
    this.stage = stage;
    const sun = new DirectionalLight(0xffffff, 2.0);
    sun.position.set(-1.5, 1, 1.3);
    const fill = new DirectionalLight(0xffffff, 1.0);
    fill.position.set(1, -1.3, 0.7);
    const sky = new HemisphereLight(0xffffff, 0x8a8580, 1.1);
    sky.position.set(0, 0, 1);  // from above: z is up here
    stage.scene.add(sky, sun, fill);
    this.painted = new MeshLambertMaterial({ vertexColors: true, side: DoubleSide });
    this.metal = new MeshMatcapMaterial({ matcap: copperTexture(), side: DoubleSide });
    this.wall = new MeshLambertMaterial({ side: DoubleSide });
    const floor = -0.12 * (this.scale.high - this.scale.low) / this.unit_um;
    this.blocks = this.reliefs.map((relief) => {
      const surface = reliefGeometry(relief, this.unit_um, this.scale.low);
      const group = new Group();
      group.add(new Mesh(surface, this.painted), new Mesh(wallGeometry(relief, surface, floor), this.wall));
      stage.scene.add(group);
      return group;
    });
    stage.themed = () => this.recolour();
    this.recolour();
    this.update();
  }

  recolour() {
    this.wall.color.set(token('wall'));
    this.blocks.forEach((block, k) => block.children[0].geometry.setAttribute('color',
      heightColours(this.reliefs[k], this.scale, table('value'), indexOf)));
  }

  update() {
    if (!this.stage) return;
    this.blocks.forEach((block, k) => {
      block.visible = k === this.selected;
      block.scale.z = this.exaggeration;
      block.children[0].material = this.finish === 'metal' ? this.metal : this.painted;
    });
    const relief = this.reliefs[this.selected];
    this.stage.caption.textContent = `${plain(relief.width_um, 3)} × ${plain(relief.depth_um, 3)} µm · heights ×${plain(this.exaggeration)}`;
    this.stage.redraw();
  }
}

function exaggerationSlider(scene) {
  const output = h('output', {}, `×${scene.exaggeration}`);
  const input = h('input', { type: 'range', min: 0, max: EXAGGERATIONS.length - 1, step: 1,
    value: EXAGGERATIONS.indexOf(scene.exaggeration), 'aria-label': 'Vertical exaggeration',
    oninput: () => {
      scene.exaggeration = EXAGGERATIONS[Number(input.value)];
      output.textContent = `×${scene.exaggeration}`;
      input.setAttribute('aria-valuetext', `${scene.exaggeration} times`);
      scene.update();
    } });
  return h('label', { class: 'slider' }, h('span', {}, 'Heights'), input, output);
}

export function reliefViewer(data) {
  const scene = new ReliefScene(data.reliefs.map(loadRelief));
  const stage = new Stage(data.alt || data.title || 'Relief', { azimuth: -1.1, elevation: 0.62, distance: 2.25,
    target: [0, 0, 0.03] }, (it) => scene.build(it));
  const which = data.reliefs.length > 1 ? segmented('Relief', data.reliefs.map((r, k) => [String(k), r.name]), '0',
    (value) => { scene.selected = Number(value); scene.update(); }) : null;
  const finish = segmented('Finish', [['height', 'Height'], ['metal', 'Metal']], 'height',
    (value) => { scene.finish = value; scene.update(); });
  return { element: panel(data, 'viewer', { tools: [finish] }, stage.element,
    h('div', { class: 'viewer-controls' }, which, exaggerationSlider(scene))), start: () => stage.watch() };
}
