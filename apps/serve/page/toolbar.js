// Buttons below the picture: running, playing, undo, enlarging pixels, what hands move, help, the panel.

import {byId} from './dom.js';

const zoomStep = 2;

/// The preview, and the method before it, whoever has chosen the preview.
function makePreview(store) {
  let before = {integrator: 'path', denoiser: 'none'};
  const isOn = () => store.value('integrator') === 'preview';
  store.addEventListener('state', () => {
    if (!store.hasState() || isOn()) return;
    before = {integrator: store.value('integrator'), denoiser: store.value('denoiser')};
  });
  return {isOn, toggle: () => store.edit(isOn() ? before : {integrator: 'preview'})};
}

export function makeToolbar(store, picture, ask) {
  const on = (id, run) => byId(id).addEventListener('click', run);
  const toggle = key => store.edit({[key]: !store.value(key)});
  const pixels = byId('pixels'), preview = makePreview(store);
  const showPressed = (id, pressed) => byId(id).setAttribute('aria-pressed', pressed);
  const showStep = (id, name, what, shortcut) => {
    byId(id).disabled = !what;
    byId(id).title = what ? `${name}: ${what} (${shortcut})` : `${name} (${shortcut})`;
  };
  const togglePanel = () => {
    const hidden = document.body.classList.toggle('without-panel');
    byId('toggle-panel').setAttribute('aria-expanded', !hidden);
  };
  on('run', () => toggle('running'));
  on('play', () => toggle('playing'));
  on('preview', preview.toggle);
  on('undo', () => store.undo());
  on('redo', () => store.redo());
  on('zoom-in', () => picture.zoomBy(zoomStep));
  on('zoom-out', () => picture.zoomBy(1 / zoomStep));
  on('unzoom', () => picture.unzoom());
  on('pixels', () => showPressed('pixels', pixels.getAttribute('aria-pressed') !== 'true'));
  on('help', () => byId('keys').showModal());
  on('toggle-panel', togglePanel);
  on('cancel', () => ask('cancel_loading'));
  const show = () => {
    byId('run').textContent = store.value('running') ? 'Stop' : 'Run';
    byId('play').hidden = !(store.facts.duration > 0);
    byId('play').textContent = store.value('playing') ? 'Pause clip' : 'Play clip';
    showPressed('preview', preview.isOn());
    showStep('undo', 'Undo', store.undoes(), 'Ctrl+Z');
    showStep('redo', 'Redo', store.redoes(), 'Ctrl+Shift+Z, Ctrl+Y');
  };
  for (const name of ['state', 'facts', 'history']) store.addEventListener(name, show);
  picture.addEventListener('zoomed', () => {
    byId('unzoom').textContent = `${Number(picture.zoom.toPrecision(2))}×`;
    byId('unzoom').disabled = picture.zoom === 1;
    byId('zoom-out').disabled = picture.zoom === 1;
  });
  const showPanel = () => document.body.classList.contains('without-panel') && togglePanel();
  return {togglePreview: preview.toggle, togglePanel, showPanel, toggle,
          touchesPixels: () => pixels.getAttribute('aria-pressed') === 'true'};
}
