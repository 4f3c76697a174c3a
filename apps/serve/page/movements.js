// Movements of the camera as steps of undo: from where it was when a hand began, to where it is when it rests.

import {debounced, same} from './dom.js';

const keys = ['camera', 'eye', 'target', 'up', 'fov'];
const restMilliseconds = 700;

export function rememberMovements(store) {
  let before = null;
  const poseNow = () => Object.fromEntries(keys.map(key => [key, store.value(key)]));
  const end = debounced(restMilliseconds, () => {
    const after = poseNow(), start = before;
    before = null;
    if (same(start, after)) return;
    // A choice of another camera comes with its own place.
    const isFree = start.camera === after.camera;
    if (isFree) delete start.camera;
    delete after.camera;
    store.remember(isFree ? start : {camera: start.camera}, after);
  });
  const begin = () => {
    before ??= poseNow();
    end();
  };
  // The end waits until the server shows nothing newer.
  store.addEventListener('state', () => before && end());
  return {begin};
}
