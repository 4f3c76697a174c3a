// Keys that work everywhere but where something is typed.

import {byId, takesLetters, takesText} from './dom.js';

/// Controls that Space operates.
const takesSpace = element => takesLetters(element) || element.matches('input, button, summary, a');

/// What a key does with the steps of undo. On Macs, Y with the command key shows the browser's history.
function stepOf({key, ctrlKey, metaKey, shiftKey}) {
  if (!ctrlKey && !metaKey) return null; // also of browsers that fill in a form, which tell no key
  const letter = key.toLowerCase();
  if (letter === 'z') return shiftKey ? 'redo' : 'undo';
  return letter === 'y' && ctrlKey && !shiftKey ? 'redo' : null;
}

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
    const step = stepOf(event);
    if (step) {
      if (takesText(target)) return; // whose own undo it is
      event.preventDefault();
      return store[step]();
    }
    if (takesLetters(target) || (event.key === ' ' && takesSpace(target))) return;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const run = byCharacter[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!run) return;
    event.preventDefault();
    if (!event.repeat || repeats.includes(event.key)) run(); // a switch would flicker while its key is held
  });
}
