// Turning, zooming and keys around a fixed target; z is up.
const CLOSEST = 0.35, FARTHEST = 3.5;  // of the initial distance
const LOWEST = -1.2, HIGHEST = 1.55;   // elevation in radians; short of the pole, where "up" is lost

export class Orbit {
  constructor(camera, element, { azimuth, elevation, distance, target, changed }) {
    Object.assign(this, { camera, element, azimuth, elevation, target, changed, base: distance, zoom: 1 });
    this.home = { azimuth, elevation };
    element.addEventListener('pointerdown', (event) => this.grab(event));
    element.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    element.addEventListener('keydown', (event) => this.key(event));
    element.addEventListener('dblclick', () => this.reset());
    this.place();
  }

  place() {
    const r = this.base * this.zoom, flat = Math.cos(this.elevation);
    this.camera.position.set(this.target.x + r * flat * Math.cos(this.azimuth),
      this.target.y + r * flat * Math.sin(this.azimuth), this.target.z + r * Math.sin(this.elevation));
    this.camera.lookAt(this.target);
    this.changed();
  }

  turn(dAzimuth, dElevation) {
    this.azimuth += dAzimuth;
    this.elevation = Math.min(HIGHEST, Math.max(LOWEST, this.elevation + dElevation));
    this.place();
  }

  scale(factor) {
    this.zoom = Math.min(FARTHEST, Math.max(CLOSEST, this.zoom * factor));
    this.place();
  }

  reset() {
    Object.assign(this, this.home, { zoom: 1 });
    this.place();
  }

  grab(down) {
    this.element.focus({ preventScroll: true });
    this.element.setPointerCapture(down.pointerId);
    let { clientX, clientY } = down;
    const move = (event) => {
      this.turn(-(event.clientX - clientX) * 0.008, (event.clientY - clientY) * 0.008);
      ({ clientX, clientY } = event);
    };
    const drop = () => this.element.removeEventListener('pointermove', move);
    this.element.addEventListener('pointermove', move);
    this.element.addEventListener('pointerup', drop, { once: true });
    this.element.addEventListener('pointercancel', drop, { once: true });
  }

  // The wheel scrolls the page until the viewer has been clicked: a page must not get stuck.
  wheel(event) {
    if (document.activeElement !== this.element) return;
    event.preventDefault();
    this.scale(Math.exp(event.deltaY * 0.001));
  }

  key(event) {
    const actions = {
      ArrowLeft: () => this.turn(-0.1, 0), ArrowRight: () => this.turn(0.1, 0),
      ArrowUp: () => this.turn(0, 0.1), ArrowDown: () => this.turn(0, -0.1),
      '+': () => this.scale(0.9), '-': () => this.scale(1 / 0.9), 0: () => this.reset(),
    };
    if (!actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  }
}
