// The size of the picture's area, in pixels of the screen: that many are rendered.

import {debounced, same} from './dom.js';

const largest = 16384;      // along an axis
const mostPixels = 1 << 24; // a larger picture is rendered with fewer, and enlarged
const evenFrom = pixels => Math.min(Math.max(2 * Math.floor(pixels / 2), 2), largest);

export function watchViewport(stage, picture, store) {
  let size = null; // of the stage
  const send = () => {
    if (!size || !store.hasState() || same(size, store.value('viewport'))) return;
    store.edit({viewport: size}, {remembers: false});
  };
  const sendLater = debounced(150, send);
  const measure = ([entry]) => {
    const exact = entry?.devicePixelContentBoxSize?.[0], box = stage.getBoundingClientRect();
    const pixels = (measured, length) => {
      const about = length * devicePixelRatio;
      // Where the ratio is emulated, as in developers' tools, what is measured does not know of it.
      return Math.abs(measured - about) < 2 ? measured : about;
    };
    const width = pixels(exact?.inlineSize, box.width), height = pixels(exact?.blockSize, box.height);
    picture.resize(Math.max(Math.round(width), 1), Math.max(Math.round(height), 1));
    const share = Math.min(1, Math.sqrt(mostPixels / (width * height)));
    size = [evenFrom(share * width), evenFrom(share * height)];
    sendLater();
  };
  const observer = new ResizeObserver(measure);
  try {
    observer.observe(stage, {box: 'device-pixel-content-box'});
  } catch {
    observer.observe(stage); // Safari measures pixels of the page only
  }
  // Several pages share one picture: it has the size of the one that was used last.
  addEventListener('focus', send);
  return {send};
}
