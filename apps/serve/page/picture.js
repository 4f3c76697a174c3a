// The picture on its canvas: both sides of a comparison, enlarged pixels, and where a point of the page is in it.

import {drawArrows, strokeVisibly} from './arrows.js';
import {same} from './dom.js';

const largestZoom = 64;
const crossGap = 4, crossReach = 12; // pixels of the page, from the cross' middle
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

export class Picture extends EventTarget {
  #left = null;  // {image, width, height}: an ImageBitmap or VideoFrame, which is closed when another comes
  #right = null;
  #zoom = 1;
  #center = [0.5, 0.5]; // of the picture, at the stage's centre
  #split = 0.5;
  #extent = null; // the state's viewport: the picture is shown as large, also while fewer pixels are rendered
  #motion = null; // of arrows.js; null: none is shown
  #probe = null;  // where values were read, from 0 to 1 in the picture; null: no values are shown
  #waits = false;

  constructor(canvas) {
    super();
    this.canvas = canvas;
    this.context = canvas.getContext('2d', {alpha: false});
  }

  get zoom() { return this.#zoom; }
  get split() { return this.#split; }
  get isCompared() { return this.#right !== null; }
  get shown() { return this.#left; }

  /// Takes possession of the image. `side`: 'left' is the picture, 'right' what it is compared with; null removes it.
  show(side, image) {
    const now = image && {image, width: image.displayWidth ?? image.width, height: image.displayHeight ?? image.height};
    const before = side === 'left' ? this.#left : this.#right;
    if (side === 'left') this.#left = now;
    else this.#right = now;
    before?.image.close();
    this.redraw();
    if (side === 'right' && !before !== !now) this.dispatchEvent(new Event('compared'));
    this.dispatchEvent(new Event('shown'));
  }

  /// Arrows over the picture; null removes them.
  setMotion(motion) {
    if (motion === this.#motion) return;
    this.#motion = motion;
    this.redraw();
  }

  /// A cross where the values of a pixel were read; null removes it.
  setProbe(position) {
    if (same(position, this.#probe)) return;
    this.#probe = position;
    this.redraw();
  }

  resize(width, height) {
    if (this.canvas.width === width && this.canvas.height === height) return;
    this.canvas.width = width;
    this.canvas.height = height;
    this.draw(); // the canvas is empty now, and would be shown so until the next frame
  }

  setExtent(extent) {
    if (!extent || String(extent) === String(this.#extent)) return;
    this.#extent = extent;
    this.redraw();
  }

  setSplit(share) {
    this.#split = clamp(share, 0, 1);
    this.redraw();
  }

  /// The rectangle of the picture on the canvas, in the canvas' pixels. It keeps its shape, whatever the stage's is.
  place() {
    const {canvas} = this, [width, height] = this.#extent ?? [canvas.width, canvas.height];
    const fit = Math.min(canvas.width / width, canvas.height / height);
    // A picture as large as the stage up to a pixel is shown pixel by pixel.
    const scale = this.#zoom * (Math.abs(fit - 1) < 2 / Math.max(width, height) ? 1 : fit);
    return {x: Math.round(canvas.width / 2 - this.#center[0] * width * scale),
            y: Math.round(canvas.height / 2 - this.#center[1] * height * scale), width: width * scale,
            height: height * scale};
  }

  /// From 0 to 1 in the picture, of a point of the page.
  positionAt(clientX, clientY) {
    const box = this.canvas.getBoundingClientRect(), place = this.place();
    const x = (clientX - box.left) * this.canvas.width / box.width;
    const y = (clientY - box.top) * this.canvas.height / box.height;
    return [(x - place.x) / place.width, (y - place.y) / place.height];
  }

  /// Height of the whole picture in pixels of the page.
  shownHeight() {
    return this.place().height / this.#zoom * this.canvas.clientHeight / Math.max(this.canvas.height, 1);
  }

  /// Enlarges pixels; the point of the page stays where it is.
  zoomAt(factor, clientX, clientY) {
    const before = this.positionAt(clientX, clientY);
    this.#zoom = clamp(this.#zoom * factor, 1, largestZoom);
    const after = this.positionAt(clientX, clientY);
    this.moveTo(this.#center.map((c, i) => c + before[i] - after[i]));
  }

  zoomBy(factor) {
    const box = this.canvas.getBoundingClientRect();
    this.zoomAt(factor, box.left + box.width / 2, box.top + box.height / 2);
  }

  /// Moves enlarged pixels with the hand; pixels of the page.
  drag(dx, dy) {
    const {width, height} = this.place(), ratio = this.canvas.width / Math.max(this.canvas.clientWidth, 1);
    this.moveTo([this.#center[0] - dx * ratio / width, this.#center[1] - dy * ratio / height]);
  }

  moveTo(center) {
    const margin = 0.5 / this.#zoom;
    this.#center = center.map(c => clamp(c, margin, 1 - margin));
    this.redraw();
    this.dispatchEvent(new Event('zoomed'));
  }

  unzoom() {
    this.#zoom = 1;
    this.moveTo([0.5, 0.5]);
  }

  redraw() {
    if (this.#waits) return;
    this.#waits = true;
    requestAnimationFrame(() => {
      this.#waits = false;
      this.draw();
    });
  }

  draw() {
    const {context, canvas} = this;
    context.fillStyle = '#000';
    context.fillRect(0, 0, canvas.width, canvas.height);
    const place = this.place();
    context.imageSmoothingQuality = 'high';
    const draw = ({image, width}) => {
      context.imageSmoothingEnabled = this.#zoom === 1 && width !== place.width;
      context.drawImage(image, place.x, place.y, place.width, place.height);
    };
    if (this.#left) draw(this.#left);
    if (this.#right) this.drawRight(draw);
    const ratio = canvas.width / Math.max(canvas.clientWidth, 1);
    if (this.#probe) this.drawProbe(place, ratio);
    canvas.dataset.probe = this.#probe ?? '';
    canvas.dataset.arrows = this.#motion ? drawArrows(context, this.#motion, place, ratio) : 0;
  }

  drawProbe({x, y, width, height}, ratio) {
    const {context} = this, at = [x + this.#probe[0] * width, y + this.#probe[1] * height], path = new Path2D();
    for (const side of [-ratio, ratio]) {
      path.moveTo(at[0] + crossGap * side, at[1]);
      path.lineTo(at[0] + crossReach * side, at[1]);
      path.moveTo(at[0], at[1] + crossGap * side);
      path.lineTo(at[0], at[1] + crossReach * side);
    }
    strokeVisibly(context, path, ratio);
  }

  drawRight(draw) {
    const {context, canvas} = this;
    const cut = Math.round(this.#split * canvas.width);
    context.save();
    context.beginPath();
    context.rect(cut, 0, canvas.width - cut, canvas.height);
    context.clip();
    draw(this.#right);
    context.restore();
  }
}
