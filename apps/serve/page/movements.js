// Movements of the camera as steps of undo: from where it was when a hand began, to where it is when it rests.

import {debounced, same} from './dom.js';

const keys = ['camera', 'eye', 'target', 'up', 'fov', 'half_height'];
const restMilliseconds = 700;

export function rememberMovements(store) {
  let before = null; // the pose when the hand began; null: the camera rests
  let message = 0;   // id of the last message that moves it
  let latest = null; // the last pose that the server has shown after that message
  const poseNow = () => Object.fromEntries(keys.map(key => [key, store.value(key)]));
  const end = () => {
    const after = poseNow(), start = before;
    before = null;
    if (same(start, after)) return;
    // A choice of another camera comes with its own place.
    const isFree = start.camera === after.camera;
    if (isFree) delete start.camera;
    delete after.camera;
    store.remember(isFree ? start : {camera: start.camera}, after);
  };
  const endLater = debounced(restMilliseconds, () => before && store.includes(message) && end());
  const forget = () => { before = null; };
  // Frames may take seconds: the camera does not rest before the server has shown what was sent last.
  store.addEventListener('state', () => {
    if (!before || !store.includes(message)) return;
    const pose = poseNow();
    if (same(pose, latest)) return; // states tell of other fields, too
    latest = pose;
    endLater();
  });
  store.addEventListener('undoing', () => before && !same(before, poseNow()) && end());
  store.addEventListener('scene', forget);
  /// `id`: of the message that moves the camera. More of them before it rests are the same movement.
  const begin = id => {
    if (!store.hasState()) return; // the connection is lost
    before ??= poseNow();
    message = id;
    latest = null;
  };
  return {begin, forget};
}
