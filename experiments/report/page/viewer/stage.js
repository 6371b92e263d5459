// The common part of both viewers: a canvas that starts when it comes into sight, draws only when
// something has changed, and says so in words where there is no WebGL.
import { PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { h } from '../lib/dom.js';
import { onThemeChange } from '../lib/theme.js';
import { Orbit } from './orbit.js';

const NO_WEBGL = 'This browser offers no WebGL, so the three-dimensional view is missing here; the maps show the same data.';

export class Stage {
  /// @param build  called once with the stage, when it starts: fills `stage.scene`
  /// @param view   {azimuth, elevation, distance, target: [x, y, z]}
  constructor(label, view, build) {
    Object.assign(this, { view, build, pending: false });
    this.hint = h('div', { class: 'stage-hint' }, 'Drag to turn · click, then scroll to zoom · double-click to reset');
    this.caption = h('div', { class: 'stage-caption' });
    this.element = h('div', { class: 'stage', tabindex: '0', role: 'img',
      'aria-label': `${label}. Arrow keys turn, plus and minus zoom, 0 resets.` }, this.caption, this.hint);
  }

  /// Starts when the element is near the window (or about to be printed).
  watch() {
    const observer = new IntersectionObserver((entries) => {
      if (entries.some((entry) => entry.isIntersecting)) { observer.disconnect(); this.start(); }
    }, { rootMargin: '200px' });
    observer.observe(this.element);
    window.addEventListener('beforeprint', () => this.start());
  }

  start() {
    if (this.renderer || this.failed) return;
    try {
      this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    } catch {
      this.failed = true;
      this.element.replaceChildren(h('p', { class: 'stage-missing' }, NO_WEBGL));
      this.element.dataset.started = 'without';
      return;
    }
    this.setUp();
    this.element.dataset.started = 'true';
  }

  setUp() {
    const { azimuth, elevation, distance, target } = this.view;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(32, 1, distance / 50, distance * 10);
    this.camera.up.set(0, 0, 1);
    this.element.prepend(this.renderer.domElement);
    this.build(this);
    this.orbit = new Orbit(this.camera, this.element,
      { azimuth, elevation, distance, target: new Vector3(...target), changed: () => this.redraw() });
    new ResizeObserver(() => this.resize()).observe(this.element);
    onThemeChange(() => { this.themed?.(); this.redraw(); });
    this.resize();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // A narrow window shows as much from left to right as a wide one.
    this.camera.fov = this.camera.aspect < 1.5 ? 2 * Math.atan(Math.tan(16 * Math.PI / 180) * 1.5 / this.camera.aspect) * 180 / Math.PI : 32;
    this.camera.updateProjectionMatrix();
    this.paint();
  }

  redraw() {
    if (this.pending || !this.renderer) return;
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.paint(); });
  }

  paint() { this.renderer.render(this.scene, this.camera); }
}
