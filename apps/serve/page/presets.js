// What papers, courses and tutorials describe, as a list that sets method and parameters by one edit.

import {make, same, setText} from './dom.js';

const pipelineOf = store => `${store.value('integrator')}+${store.value('denoiser')}`;

/// What differs from the state; without integrator and denoiser where the preset is for the chosen ones.
function changesOf({pipelines, changes}, store) {
  const {integrator, denoiser, ...others} = changes;
  const all = pipelines.includes(pipelineOf(store)) ? others : {integrator, denoiser, ...others};
  return Object.fromEntries(Object.entries(all).filter(([key, value]) => !same(store.value(key), value)));
}

const isInForce = (preset, store) => Object.keys(changesOf(preset, store)).length === 0;
const sentence = text => text && text[0].toUpperCase() + text.slice(1);

export function makePresets(store) {
  let presets = [];
  const help = make('p', {className: 'note', id: 'preset-help'});
  const select = make('select', {id: 'preset', 'aria-describedby': 'preset-help', change: () => {
    const preset = presets[select.selectedIndex - 1];
    if (preset) store.edit(changesOf(preset, store), {name: `preset ${preset.name}`});
    else show();
  }});
  const element = make('div', {className: 'field', hidden: true},
      make('div', {className: 'head'}, make('label', {htmlFor: 'preset', textContent: 'preset'})), select, help);
  const show = () => {
    if (!presets.length || !store.hasState()) return;
    const index = presets.findIndex(preset => isInForce(preset, store));
    const isChoosing = document.activeElement === select && select.selectedIndex <= 0;
    // Setting it moves the mark in an open list.
    if (!isChoosing && select.selectedIndex !== index + 1) select.selectedIndex = index + 1;
    setText(help, sentence(presets[index]?.help ?? ''));
  };
  store.addEventListener('state', show);
  const setPresets = list => {
    presets = list;
    select.replaceChildren(make('option', {textContent: 'none'}),
                           ...list.map(({name, help: title}) => make('option', {textContent: name, title})));
    element.hidden = list.length === 0;
    show();
  };
  return {element, setPresets};
}
