// Keys that work everywhere but where something is typed.

import {byId, takesLetters, takesText} from './dom.js';

/// Controls that Space operates.
const takesSpace = element => takesLetters(element) || element.matches('input, button, summary, a');

const repeats = ['+', '-'];

export function makeKeys({store, stage, picture, ask, toolbar}) {
  let pointer = [0.5, 0.5];
  stage.addEventListener('pointermove', event => { pointer = picture.positionAt(event.clientX, event.clientY); });
  const pointerInside = () => pointer.map(v => Math.min(Math.max(v, 0), 1));
  const byCharacter = {
    ' ': () => toolbar.toggle('running'),
    v: toolbar.togglePreview,
    p: () => ask('probe', {position: pointerInside()}),
    c: toolbar.togglePanel,
    '?': () => byId('keys').showModal(),
    '+': () => picture.zoomBy(2),
    '-': () => picture.zoomBy(0.5),
    0: () => picture.unzoom(),
    '/': () => {
      toolbar.showPanel();
      byId('search').focus();
    },
  };
  document.addEventListener('keydown', event => {
    if (byId('keys').open) return;
    const {target} = event;
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === 'z') {
      if (takesText(target)) return; // whose own undo it is
      event.preventDefault();
      return event.shiftKey ? store.redo() : store.undo();
    }
    if (takesLetters(target) || (event.key === ' ' && takesSpace(target))) return;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const run = byCharacter[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!run) return;
    event.preventDefault();
    if (!event.repeat || repeats.includes(event.key)) run(); // a switch would flicker while its key is held
  });
}
