// The image of a pass instead of the picture: what it is, the values under the pointer, why the denoiser kept or rejected
// the history there, and the way back.

import {byId, numberText, setText} from './dom.js';

const betweenReads = 80; // milliseconds

const hint = 'point at a pixel for its values';

const valueText = value => typeof value === 'number' ? numberText(value) : value;

/// `read(position)` asks for the values, which showValues() gets.
export function makeInspection(store, picture, stage, read) {
  const box = byId('inspected');
  let position = null, last = 0, timer = 0;
  const isOn = () => Boolean(store.value('pass'));
  const ask = () => {
    if (!isOn() || !position || timer) return;
    const wait = last + betweenReads - performance.now();
    timer = setTimeout(() => {
      timer = 0;
      last = performance.now();
      if (isOn()) read(position);
    }, Math.max(wait, 0));
  };
  const point = event => {
    const at = picture.positionAt(event.clientX, event.clientY);
    if (at.some(v => v < 0 || v > 1)) return;
    position = at;
    ask();
  };
  for (const name of ['pointerdown', 'pointermove']) {
    stage.addEventListener(name, point);
    box.addEventListener(name, event => event.stopPropagation());
  }
  box.addEventListener('dblclick', event => event.stopPropagation()); // it turns no camera
  byId('show-picture').addEventListener('click', () => store.edit({pass: ''}));
  const showValues = ({pixel, values, history}) => {
    setText(byId('inspected-values'), values ? `(${pixel.join(', ')}): ${values.map(valueText).join(', ')}` : hint);
    setText(byId('inspected-history'), values && history || '');
  };
  const show = () => {
    box.hidden = !isOn();
    if (!isOn()) return showValues({});
    const image = store.facts.images?.[store.value('image')];
    setText(byId('inspected-name'), image && image !== store.value('pass') ? `${store.value('pass')}: ${image}`
                                                                         : store.value('pass'));
  };
  for (const name of ['state', 'facts']) store.addEventListener(name, show);
  return {showValues, imageChanged: ask};
}
