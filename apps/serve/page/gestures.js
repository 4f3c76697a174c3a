// What hands do on the picture: mouse, touch and keys become sums of movements, sent at most once a frame.

import {takesLetters} from './dom.js';

const radiansPerPixel = 0.005;
const zoomPerStep = 0.85; // of the distance to the target
const wheelStep = 100;    // pixels of the page
const doubleTap = {milliseconds: 350, pixels: 30};
const turnPerSecond = 1.2; // radians, by the arrow keys

const axes = {KeyD: ['fly', 0, 1], KeyA: ['fly', 0, -1], KeyE: ['fly', 1, 1], KeyQ: ['fly', 1, -1], KeyW: ['fly', 2, 1],
              KeyS: ['fly', 2, -1]};
const arrows = {ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowUp: [1, 1], ArrowDown: [1, -1]};

const nothing = () => ({orbit: [0, 0], look: [0, 0], pan: [0, 0], fly: [0, 0, 0], zoom: 0, speed: 0});
const isNothing = sum => Object.values(sum).flat().every(v => v === 0);

export class Gestures {
  #sum = nothing();
  #pointers = new Map(); // id -> {x, y, button}
  #keys = new Set();
  #shift = false;
  #tap = null;
  #scheduled = false;
  #last = 0;

  /// `steer` sends a sum and returns false where the connection is busy: then the sum grows until the next frame.
  constructor(stage, picture, {steer, focus, touchesPixels}) {
    Object.assign(this, {stage, picture, steer, focus, touchesPixels});
    const on = (name, run, options) => stage.addEventListener(name, run, options);
    on('pointerdown', event => this.down(event));
    on('pointermove', event => this.move(event));
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) on(end, event => this.up(event));
    on('wheel', event => this.wheel(event), {passive: false});
    on('contextmenu', event => event.preventDefault());
    on('dblclick', event => this.focus(picture.positionAt(event.clientX, event.clientY)));
    document.addEventListener('keydown', event => this.key(event, true));
    document.addEventListener('keyup', event => this.key(event, false));
    addEventListener('blur', () => this.#keys.clear());
  }

  down(event) {
    this.stage.focus({preventScroll: true});
    this.stage.setPointerCapture(event.pointerId);
    if (event.button === 1) event.preventDefault(); // no scrolling by the middle button
    this.#pointers.set(event.pointerId, {x: event.clientX, y: event.clientY, startX: event.clientX,
                                         startY: event.clientY, button: event.button, type: event.pointerType});
  }

  up(event) {
    const pointer = this.#pointers.get(event.pointerId);
    if (!pointer) return;
    const isTap = event.type === 'pointerup' && pointer.type === 'touch' && this.#pointers.size === 1;
    if (isTap) this.tapped(event, pointer);
    this.#pointers.delete(event.pointerId);
  }

  /// Browsers send no double click where touches scroll nothing.
  tapped(event, {startX, startY}) {
    const near = (x, y) => Math.hypot(event.clientX - x, event.clientY - y) < doubleTap.pixels;
    if (!near(startX, startY)) return void (this.#tap = null);
    const tap = this.#tap;
    this.#tap = {x: event.clientX, y: event.clientY, time: event.timeStamp};
    if (!tap || event.timeStamp - tap.time > doubleTap.milliseconds || !near(tap.x, tap.y)) return;
    this.#tap = null;
    this.focus(this.picture.positionAt(event.clientX, event.clientY));
  }

  move(event) {
    const pointer = this.#pointers.get(event.pointerId);
    if (!pointer) return;
    const dx = event.clientX - pointer.x, dy = event.clientY - pointer.y;
    const before = this.spread();
    pointer.x = event.clientX;
    pointer.y = event.clientY;
    const count = this.#pointers.size;
    if (count > 1) return this.pinch(before, this.spread(), dx / count, dy / count);
    // Pixels that are not enlarged cannot be moved: the camera is.
    if ((this.touchesPixels() && this.picture.zoom > 1) || event.ctrlKey) return this.picture.drag(dx, dy);
    if (pointer.button === 0) this.add('orbit', [radiansPerPixel * dx, -radiansPerPixel * dy]);
    if (pointer.button === 2) this.add('look', [radiansPerPixel * dx, -radiansPerPixel * dy]);
    if (pointer.button === 1) this.pan(dx, dy);
  }

  /// Two fingers: their distance and centre.
  spread() {
    const [a, b] = [...this.#pointers.values()];
    return b && {distance: Math.max(Math.hypot(a.x - b.x, a.y - b.y), 1), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2};
  }

  pinch(before, now, dx, dy) {
    const factor = now.distance / before.distance;
    if (this.touchesPixels()) {
      this.picture.zoomAt(factor, now.x, now.y);
      return this.picture.drag(dx, dy);
    }
    this.pan(dx, dy);
    this.add('zoom', Math.log(factor) / -Math.log(zoomPerStep));
  }

  pan(dx, dy) {
    const height = this.picture.shownHeight();
    this.add('pan', [dx / height, -dy / height]);
  }

  wheel(event) {
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === 1 ? wheelStep / 3 : event.deltaMode === 2 ? 3 * wheelStep : 1);
    // Touch pads say two fingers that pinch by a wheel with Ctrl.
    if (event.ctrlKey || this.touchesPixels()) {
      return this.picture.zoomAt(Math.exp(-0.25 * pixels / wheelStep), event.clientX, event.clientY);
    }
    const looks = [...this.#pointers.values()].some(pointer => pointer.button === 2);
    this.add(looks ? 'speed' : 'zoom', -pixels / wheelStep);
  }

  key(event, isDown) {
    this.#shift = event.shiftKey;
    // Letters fly wherever nothing is typed; arrows are those of the picture while it has the focus.
    const isOurs = (event.code in axes && !takesLetters(event.target)) ||
                   (event.code in arrows && event.target === this.stage);
    if (!isOurs || document.querySelector('dialog[open]')) return void this.#keys.delete(event.code);
    if (event.ctrlKey || event.metaKey || event.altKey) return void this.#keys.delete(event.code);
    event.preventDefault();
    if (!isDown) return void this.#keys.delete(event.code);
    if (!this.#keys.size) this.#last = performance.now();
    this.#keys.add(event.code);
    this.schedule();
  }

  /// The keys that are held, for as long as they were since the last frame.
  addKeys(now) {
    const seconds = Math.min((now - this.#last) / 1000, 0.1);
    this.#last = now;
    for (const code of this.#keys) {
      if (code in axes) {
        const [name, axis, sign] = axes[code];
        this.#sum[name][axis] += sign * seconds;
        continue;
      }
      const [axis, sign] = arrows[code], name = this.#shift ? 'pan' : 'orbit';
      this.#sum[name][axis] += sign * seconds * (this.#shift ? -0.5 : turnPerSecond);
    }
  }

  add(name, amount) {
    const sum = this.#sum;
    sum[name] = Array.isArray(amount) ? sum[name].map((v, i) => v + amount[i]) : sum[name] + amount;
    this.schedule();
  }

  schedule() {
    if (this.#scheduled) return;
    this.#scheduled = true;
    requestAnimationFrame(now => this.frame(now));
  }

  frame(now) {
    this.#scheduled = false;
    if (this.#keys.size) this.addKeys(now);
    if (!isNothing(this.#sum) && this.steer(this.#sum)) this.#sum = nothing();
    if (this.#keys.size || !isNothing(this.#sum)) this.schedule();
  }
}
