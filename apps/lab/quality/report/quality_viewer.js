'use strict';

// The pictures of one sequence: a stage with a divider, and a tile for each picture. All show the same frame, the same
// part, and mark the same pixel. Pictures are 8-bit sRGB; the exposure is applied in linear light.

const MAX_ZOOM = 32;
const PLAY_MS = 100;
const CACHE_BYTES = 96e6;

function linearOf(byte) {
  const value = byte / 255;
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

function byteOf(linear) {
  const value = Math.min(1, linear);
  return Math.round(255 * (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055));
}

function exposureTable(stops) {
  return Uint8Array.from({length: 256}, (_, byte) => byteOf(linearOf(byte) * 2 ** stops));
}

function colourTable(colours) {
  return colours.map(text => [1, 3, 5].map(at => parseInt(text.slice(at, at + 2), 16)));
}

// Decodes a data URI; resolves to RGBA bytes.
async function decodePicture(uri) {
  const image = new Image();
  image.src = uri;
  await image.decode();
  const canvas = element('canvas', {width: image.naturalWidth, height: image.naturalHeight});
  const context = canvas.getContext('2d', {willReadFrequently: true});
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, canvas.width, canvas.height).data;
}

// Decoded pictures by name; the longest unused go first.
class PictureCache {
  constructor(entries) {
    this.entries = entries;
    this.kept = new Map();
  }

  get(name, uri) {
    const found = this.kept.get(name) || decodePicture(uri);
    this.kept.delete(name);
    this.kept.set(name, found);
    if (this.kept.size > this.entries) this.kept.delete(this.kept.keys().next().value);
    return found;
  }
}

// A canvas that shows a part of one picture.
class Surface {
  constructor(width, height, attributes = {}) {
    this.canvas = element('canvas', {role: 'img', ...attributes});
    this.canvas.style.aspectRatio = `${width} / ${height}`;
    this.source = element('canvas', {width, height});
  }

  // `bytes`: RGBA. `tables`: of exposure, and of colours for error maps.
  fill(picture, bytes, tables) {
    const context = this.source.getContext('2d');
    const shown = context.createImageData(this.source.width, this.source.height);
    for (let i = 0; i < bytes.length; i += 4) {
      for (let c = 0; c < 3; ++c)
        shown.data[i + c] = picture.isError ? tables.colours[bytes[i]][c] : tables.exposure[bytes[i + c]];
      shown.data[i + 3] = 255;
    }
    context.putImageData(shown, 0, 0);
    this.canvas.setAttribute('aria-label', picture.name);
  }

  // `view`: left and top as shares of the picture, and zoom. `probe`: the marked pixel, or null.
  draw(view, probe) {
    const {canvas, source} = this;
    const width = Math.round(canvas.clientWidth * devicePixelRatio);
    if (width < 1) return;
    const height = Math.max(1, Math.round(width * source.height / source.width));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    const context = canvas.getContext('2d');
    const scale = width / source.width * view.zoom;
    context.imageSmoothingEnabled = scale < 1.6;  // enlarged pictures show their pixels as what they are
    context.imageSmoothingQuality = 'high';
    context.drawImage(source, view.left * source.width, view.top * source.height, source.width / view.zoom,
      source.height / view.zoom, 0, 0, width, height);
    if (probe) this.mark(context, (probe.x - view.left * source.width) * scale,
      (probe.y - view.top * source.height) * scale, scale);
  }

  mark(context, x, y, scale) {
    const size = Math.max(scale, 7 * devicePixelRatio), inset = (scale - size) / 2;
    for (const [colour, grow] of [['#000', 1.5], ['#fff', 0.5]]) {
      context.strokeStyle = colour;
      context.strokeRect(x + inset - grow, y + inset - grow, size + 2 * grow, size + 2 * grow);
    }
  }
}

function picturesOf(scene) {
  const pictures = scene.methods.map(method => ({name: method.method, uris: method.pictures, method}));
  pictures.push({name: 'reference', uris: scene.reference_pictures});
  for (const method of scene.methods)
    pictures.push({name: `error of ${method.method}`, uris: method.error_maps, method, isError: true});
  return pictures;
}

function chooser(label, pictures, chosen, onchange) {
  const select = element('select', {'aria-label': label, onchange});
  pictures.forEach((picture, index) => select.append(element('option', {value: index}, picture.name)));
  select.value = chosen;
  return select;
}

function button(text, title, onclick) {
  return element('button', {type: 'button', title, 'aria-label': title, onclick}, text);
}

function range(label, attributes, oninput) {
  return element('input', {type: 'range', 'aria-label': label, ...attributes, oninput});
}

const KEYS = [
  ['\u2190 \u2192', 'frame before, next frame'], ['P', 'play, stop; also the space bar on the two pictures'],
  ['1 to 9', 'picture on the right, as numbered below'], ['D', 'divider on, off'],
  ['+ \u2212 0', 'zoom in, out, whole picture'], ['Shift + arrows', 'move the marked pixel'],
  ['E, Shift + E', 'half a stop brighter, darker'],
];

class Viewer {
  constructor(data, scene) {
    this.data = data;
    this.scene = scene;
    this.pictures = picturesOf(scene);
    this.numbered = scene.methods.length + 1;
    this.kept = scene.reference_pictures.flatMap((uri, index) => uri === null ? [] : [index]);
    this.at = this.kept.length - 1;
    this.view = {zoom: 1, left: 0, top: 0};
    this.probe = null;
    this.exposure = 0;
    this.bytes = [];
    this.tables = {exposure: exposureTable(0), colours: colourTable(data.color_scale)};
    this.cache = new PictureCache(Math.max(2 * this.pictures.length,
      Math.floor(CACHE_BYTES / (4 * data.width * data.height))));
    this.request = 0;
    this.makeStage();
    this.makeControls();
    this.makeTiles();
    this.node = element('div', {class: 'viewer'}, ...this.controls, this.stage, this.readout, this.help());
    this.move(50);
    this.setZoom(1);
    this.tell();
    this.showWhenNear();
  }

  // ---------------------------------------------------------------- parts

  makeStage() {
    const {width, height} = this.data;
    const lowest = this.scene.methods.reduce((a, b) => b.flip.mean < a.flip.mean ? b : a);
    this.right = new Surface(width, height, {class: 'right'});
    this.left = new Surface(width, height, {class: 'left'});
    this.tags = [element('span', {class: 'tag first'}), element('span', {class: 'tag second'})];
    this.divider = element('div', {class: 'divider', role: 'slider', tabindex: '0', 'aria-label': 'Divider',
      'aria-valuemin': '0', 'aria-valuemax': '100'});
    this.stage = element('div', {class: 'compare', tabindex: '0', role: 'group',
      'aria-label': `Pictures of ${this.scene.name}: the left one and the right one`},
      this.right.canvas, this.left.canvas, ...this.tags, this.divider);
    this.stage.style.aspectRatio = `${width} / ${height}`;
    this.choosers = [chooser('Left picture', this.pictures, 0, () => this.show()),
      chooser('Right picture', this.pictures, this.scene.methods.indexOf(lowest), () => this.show())];
    this.readout = element('div', {class: 'readout'});
    this.stage.addEventListener('pointerdown', event => this.press(event));
    this.stage.addEventListener('pointermove', event => this.drag(event));
    this.stage.addEventListener('lostpointercapture', () => { this.grip = null; });
    this.stage.addEventListener('dblclick', event => this.zoomAround(event, 2));
    this.divider.addEventListener('keydown', event => this.dividerKey(event));
    this.watch(this.stage);
  }

  makeControls() {
    this.slider = range('Frame', {min: 0, max: Math.max(0, this.kept.length - 1), step: 1, class: 'frame'},
      () => this.choose(Number(this.slider.value)));
    this.frameText = element('output', {class: 'frame-number'});
    this.playButton = button('\u25b6', 'Play', () => this.play(!this.playing));
    this.exposureSlider = range('Exposure in stops', {min: -4, max: 4, step: 0.25, value: 0, class: 'exposure'},
      () => this.expose(Number(this.exposureSlider.value)));
    this.exposureText = element('output', {class: 'exposure-number'});
    this.zoomText = element('output', {class: 'zoom-number'});
    this.splitBox = element('input', {type: 'checkbox', onchange: () => this.tell()});
    this.splitBox.checked = true;
    const swap = button('\u21c4', 'Swap the two', () => {
      [this.choosers[0].value, this.choosers[1].value] = [this.choosers[1].value, this.choosers[0].value];
      this.show();
    });
    this.controls = [
      element('div', {class: 'bar'}, this.playButton, button('\u2039', 'Frame before', () => this.step(-1)), this.slider,
        button('\u203a', 'Next frame', () => this.step(1)), this.frameText),
      element('div', {class: 'bar'},
        element('span', {class: 'group'}, 'Exposure ', this.exposureSlider, this.exposureText),
        element('span', {class: 'group'}, 'Zoom ', button('\u2212', 'Zoom out', () => this.setZoom(this.view.zoom / 2)),
          button('+', 'Zoom in', () => this.setZoom(this.view.zoom * 2)), this.zoomText,
          button('Reset', 'Whole picture, exposure 0', () => { this.setZoom(1); this.expose(0); }))),
      element('div', {class: 'bar pair'}, this.choosers[0], swap, this.choosers[1],
        element('label', {class: 'group'}, this.splitBox, 'divider'))];
  }

  makeTiles() {
    this.tiles = this.pictures.map((picture, index) => {
      const surface = new Surface(this.data.width, this.data.height);
      const caption = element('span');
      const title = `Show ${picture.name} on the right`;
      const node = element('button', {type: 'button', title, onclick: () => {
        this.choosers[1].value = index;
        this.show();
        this.stage.scrollIntoView({block: 'nearest'});
      }}, surface.canvas, caption);
      this.watch(node);
      return {surface, caption, node};
    });
  }

  help() {
    const rows = KEYS.flatMap(([keys, effect]) => [element('dt', {}, keys), element('dd', {}, effect)]);
    return element('details', {}, element('summary', {}, 'Keys and mouse'), element('dl', {class: 'keys'}, ...rows),
      element('p', {class: 'soft'}, 'Ctrl and the wheel, or a double click, zoom. Drag to move an enlarged picture; drag ' +
        'its round handle to move the divider. Click a tile to see it on the right.'));
  }

  // Both the stage and the tiles mark pixels and zoom.
  watch(node) {
    node.addEventListener('pointermove', event => this.point(event));
    node.addEventListener('pointerdown', event => this.point(event));  // a finger that taps does not move
    node.addEventListener('wheel', event => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      this.zoomAround(event, 2 ** (-Math.sign(event.deltaY) / 2));
    }, {passive: false});
    new ResizeObserver(() => this.redraw()).observe(node);
  }

  // Pictures are decoded when the reader comes near them.
  showWhenNear() {
    const observer = new IntersectionObserver(entries => {
      if (!entries.some(entry => entry.isIntersecting)) return;
      observer.disconnect();
      this.show();
    }, {rootMargin: '400px'});
    observer.observe(this.stage);
  }

  // ---------------------------------------------------------------- frames

  get frame() { return this.scene.first_frame + this.kept[this.at]; }

  choose(at) {
    this.at = Math.min(this.kept.length - 1, Math.max(0, at));
    return this.show();
  }

  step(by) {
    this.play(false);
    return this.choose(this.at + by);
  }

  // Shows the nearest frame that the file has.
  chooseFrame(frame) {
    this.play(false);
    const distance = at => Math.abs(this.scene.first_frame + this.kept[at] - frame);
    return this.choose(this.kept.reduce((best, _, at) => distance(at) < distance(best) ? at : best, 0));
  }

  async play(on) {
    if (on === Boolean(this.playing)) return;
    const run = this.playing = on ? {} : null;
    this.playButton.textContent = on ? '\u25a0' : '\u25b6';
    this.playButton.title = on ? 'Stop' : 'Play';
    this.playButton.setAttribute('aria-label', this.playButton.title);
    while (run && this.playing === run) {
      const pause = new Promise(done => setTimeout(done, PLAY_MS));
      await this.choose((this.at + 1) % this.kept.length);
      await pause;
    }
  }

  // Decodes what is shown, then shows all of it at once.
  async show() {
    const request = ++this.request, at = this.at;
    const bytes = await Promise.all(this.pictures.map((picture, index) =>
      this.cache.get(`${index}:${at}`, picture.uris[this.kept[at]])));
    if (request !== this.request) return;
    this.bytes = bytes;
    this.fill();
    this.tell();
  }

  fill() {
    if (!this.bytes.length) return;
    this.tiles.forEach(({surface}, index) => surface.fill(this.pictures[index], this.bytes[index], this.tables));
    [this.left, this.right].forEach((surface, side) => {
      const index = Number(this.choosers[side].value);
      surface.fill(this.pictures[index], this.bytes[index], this.tables);
    });
    this.redraw();
  }

  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      for (const surface of [this.left, this.right, ...this.tiles.map(tile => tile.surface)])
        surface.draw(this.view, this.probe);
    });
  }

  // ---------------------------------------------------------------- texts

  // Brings all texts and states up to date.
  tell() {
    this.slider.value = this.at;
    this.slider.setAttribute('aria-valuetext', `frame ${this.frame}`);
    this.frameText.textContent = `frame ${this.frame}`;
    this.exposureText.textContent = `${number(this.exposure, 2, true)} stops`;
    this.zoomText.textContent = `${Number(this.view.zoom.toFixed(1))}\u00d7`;
    this.choosers.forEach((select, side) => { this.tags[side].textContent = this.pictures[select.value].name; });
    this.stage.classList.toggle('whole', !this.splitBox.checked);
    this.stage.classList.toggle('zoomed', this.view.zoom > 1);
    this.tiles.forEach((tile, index) => {
      tile.caption.replaceChildren(...this.captionOf(index));
      tile.node.setAttribute('aria-pressed', String(Number(this.choosers[1].value) === index));
    });
    this.tellPixel();
  }

  captionOf(index) {
    const {name, method, isError} = this.pictures[index];
    const key = index < Math.min(9, this.numbered) ? [element('kbd', {}, String(index + 1)), ' '] : [];
    if (!method) return [...key, name];
    const scores = method.frames[this.kept[this.at]];
    const flip = `FLIP ${number(scores.flip, 4)}`;
    const text = isError ? flip : `${number(scores.psnr, 1)} dB, ${flip}`;
    return [...key, isError ? method.method : name, element('small', {}, text)];
  }

  tellPixel() {
    if (!this.probe || !this.bytes.length) {
      this.readout.replaceChildren(element('p', {class: 'soft'}, 'Point at a picture to read its pixels.'));
      return;
    }
    const offset = 4 * (this.probe.y * this.data.width + this.probe.x);
    const rows = this.pictures.slice(0, this.numbered).map((picture, index) => {
      const rgb = [...this.bytes[index].slice(offset, offset + 3)];
      const error = this.bytes[this.numbered + index];
      const swatch = element('span', {class: 'swatch'});
      swatch.style.background = `rgb(${rgb.map(byte => this.tables.exposure[byte]).join(' ')})`;
      return element('tr', {}, element('td', {}, swatch, picture.name), cell(rgb.join(' ')),
        cell(rgb.map(byte => number(linearOf(byte), 3)).join(' ')), cell(error ? number(error[offset] / 255, 3) : '\u2013'));
    });
    this.readout.replaceChildren(table([`pixel ${this.probe.x}, ${this.probe.y}`, 'sRGB', 'linear', 'FLIP'], rows));
  }

  // ---------------------------------------------------------------- view

  expose(stops) {
    this.exposure = Math.min(4, Math.max(-4, stops));
    this.exposureSlider.value = this.exposure;
    this.tables.exposure = exposureTable(this.exposure);
    this.fill();
    this.tell();
  }

  // Zooms so that the point (x, y), as shares of the shown part, stays where it is.
  setZoom(zoom, x = 0.5, y = 0.5) {
    const {view} = this;
    const fixed = [view.left + x / view.zoom, view.top + y / view.zoom];
    view.zoom = Math.min(MAX_ZOOM, Math.max(1, zoom));
    this.pan(fixed[0] - x / view.zoom, fixed[1] - y / view.zoom);
    this.tell();
  }

  pan(left, top) {
    const most = 1 - 1 / this.view.zoom;
    this.view.left = Math.min(most, Math.max(0, left));
    this.view.top = Math.min(most, Math.max(0, top));
    this.redraw();
  }

  // Where an event is, as shares of the canvas in the event's box.
  placeOf(event) {
    const bounds = event.currentTarget.querySelector('canvas').getBoundingClientRect();
    return [(event.clientX - bounds.left) / bounds.width, (event.clientY - bounds.top) / bounds.height];
  }

  zoomAround(event, factor) {
    this.setZoom(this.view.zoom * factor, ...this.placeOf(event));
  }

  point(event) {
    const [x, y] = this.placeOf(event);
    if (x < 0 || x >= 1 || y < 0 || y >= 1) return;
    this.probeAt(Math.floor((this.view.left + x / this.view.zoom) * this.data.width),
      Math.floor((this.view.top + y / this.view.zoom) * this.data.height));
  }

  probeAt(x, y) {
    this.probe = {x: Math.min(this.data.width - 1, Math.max(0, x)), y: Math.min(this.data.height - 1, Math.max(0, y))};
    this.tellPixel();
    this.redraw();
  }

  // ---------------------------------------------------------------- divider, mouse and keys

  move(percent) {
    this.cut = Math.min(100, Math.max(0, percent));
    this.stage.style.setProperty('--cut', `${this.cut}%`);
    this.divider.setAttribute('aria-valuenow', this.cut.toFixed(0));
  }

  press(event) {
    if (event.button !== 0) return;
    const onDivider = event.target === this.divider;
    const cuts = onDivider || (this.view.zoom === 1 && this.splitBox.checked);
    this.grip = {cuts, x: event.clientX, y: event.clientY, left: this.view.left, top: this.view.top};
    this.stage.setPointerCapture(event.pointerId);
    (onDivider ? this.divider : this.stage).focus({preventScroll: true, focusVisible: false});
    this.drag(event);
    event.preventDefault();
  }

  drag(event) {
    if (!this.grip) return;
    const bounds = this.stage.getBoundingClientRect();
    if (this.grip.cuts) return this.move(100 * (event.clientX - bounds.left) / bounds.width);
    this.pan(this.grip.left - (event.clientX - this.grip.x) / (bounds.width * this.view.zoom),
      this.grip.top - (event.clientY - this.grip.y) / (bounds.height * this.view.zoom));
  }

  dividerKey(event) {
    const {cut} = this, step = event.shiftKey ? 10 : 1;
    const target = {ArrowLeft: cut - step, ArrowDown: cut - step, ArrowRight: cut + step, ArrowUp: cut + step,
      PageDown: cut - 10, PageUp: cut + 10, Home: 0, End: 100}[event.key];
    if (target === undefined) return;
    this.move(target);
    event.preventDefault();
  }

  movePixel(key) {
    const [x, y] = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[key];
    const from = this.probe || {x: this.data.width >> 1, y: this.data.height >> 1};
    this.probeAt(from.x + x, from.y + y);
  }

  // True if the key means something here.
  key(event) {
    const {key} = event;
    if (/^[1-9]$/.test(key) && Number(key) <= this.numbered) {
      this.choosers[1].value = Number(key) - 1;
      this.show();
      return true;
    }
    if (event.shiftKey && key.startsWith('Arrow')) {
      this.movePixel(key);
      return true;
    }
    if (key === ' ') {  // elsewhere it scrolls, or presses what has the focus
      if (event.target !== this.stage) return false;
      this.play(!this.playing);
      return true;
    }
    const actions = {
      ArrowLeft: () => this.step(-1), ArrowRight: () => this.step(1), p: () => this.play(!this.playing),
      d: () => { this.splitBox.checked = !this.splitBox.checked; this.tell(); },
      '+': () => this.setZoom(this.view.zoom * 2), '=': () => this.setZoom(this.view.zoom * 2),
      '-': () => this.setZoom(this.view.zoom / 2), 0: () => this.setZoom(1),
      e: () => this.expose(this.exposure + (event.shiftKey ? -0.5 : 0.5)),
    };
    const action = actions[key.length === 1 ? key.toLowerCase() : key];
    if (action) action();
    return Boolean(action);
  }
}

// Keys go to the viewer with the focus, else to the one nearest to the middle of the window.
function listenToKeys(viewers, sections) {
  const distance = viewer => {
    const bounds = viewer.stage.getBoundingClientRect();
    return Math.abs((bounds.top + bounds.bottom) / 2 - innerHeight / 2);
  };
  document.addEventListener('keydown', event => {
    if (event.defaultPrevented || event.ctrlKey || event.altKey || event.metaKey || !viewers.length) return;
    if (event.target.matches('select')) return;
    const moves = event.key.startsWith('Arrow');
    if (moves && event.target.matches('input[type=range], .scroll')) return;
    const focused = sections.findIndex(section => section.contains(document.activeElement));
    const viewer = focused >= 0 ? viewers[focused] : viewers.reduce((a, b) => distance(b) < distance(a) ? b : a);
    if (viewer.key(event)) event.preventDefault();
  });
}
