// The line between the picture and what it is compared with: dragged, or moved by keys.

import {byId} from './dom.js';

const steps = {ArrowLeft: -0.01, ArrowRight: 0.01, ArrowDown: -0.01, ArrowUp: 0.01, PageDown: -0.1, PageUp: 0.1,
               Home: -1, End: 1};

export function makeDivider(picture, names) {
  const line = byId('divider'), stage = byId('stage');
  const show = () => {
    const percent = Math.round(100 * picture.split);
    line.hidden = !picture.isCompared;
    line.style.left = `${100 * picture.split}%`;
    line.setAttribute('aria-valuenow', percent);
    line.setAttribute('aria-valuetext', `${percent} % ${names().left}, the rest ${names().right}`);
    for (const side of ['left', 'right']) {
      byId(`name-${side}`).textContent = names()[side];
      byId(`name-${side}`).hidden = !picture.isCompared;
    }
  };
  const move = share => {
    picture.setSplit(share);
    show();
  };
  line.addEventListener('pointerdown', event => {
    line.setPointerCapture(event.pointerId);
    event.stopPropagation();
  });
  line.addEventListener('dblclick', event => event.stopPropagation()); // it turns no camera
  line.addEventListener('pointermove', event => {
    if (!line.hasPointerCapture(event.pointerId)) return;
    const box = stage.getBoundingClientRect();
    move((event.clientX - box.left) / box.width);
  });
  line.addEventListener('keydown', event => {
    if (!(event.key in steps)) return;
    event.preventDefault();
    event.stopPropagation();
    move(picture.split + steps[event.key]);
  });
  picture.addEventListener('compared', show);
  return show;
}
