// What colors mean that stand for numbers: bands with their values below.

import {make, numberText, setText} from './dom.js';

/// `each`: every band has a value; otherwise the first and the last.
function makeLegend(title, each) {
  const bands = make('div', {className: 'bands'}), values = make('div', {className: each ? 'values each' : 'values'});
  const element = make('div', {className: 'legend', title, hidden: true}, bands, values);
  const setColors = colors => bands.replaceChildren(...colors.map(color => {
    const band = make('span');
    band.style.background = color;
    return band;
  }));
  const setValues = texts => {
    while (values.children.length > texts.length) values.lastChild.remove();
    texts.forEach((text, i) => setText(values.children[i] ?? values.appendChild(make('span')), text));
  };
  return {element, setColors, setValues};
}

/// The stops of the tone curve "false-color", and the values of a pass in false colors.
export function makeLegends(store) {
  const stops = makeLegend('Stops from middle grey (0.18), with the exposure', true);
  const map = makeLegend('Luminance of the channels shown; magenta: infinite, or no number', false);
  const show = () => {
    stops.element.hidden = store.value('tone_curve') !== 'false-color';
    map.element.hidden = !store.value('pass') || store.value('view.false_color') !== true;
    const last = 2 ** -(store.value('view.stops') ?? 0);
    map.setValues(['0', `${numberText(last.toPrecision(3))} and more`]);
  };
  store.addEventListener('state', show);
  const setColors = ({stops: colors = [], values = []}) => {
    stops.setColors(colors);
    const middle = (colors.length - 1) / 2;
    stops.setValues(colors.map((_, i) => String(i - middle)));
    map.setColors(values);
  };
  return {stops: stops.element, values: map.element, setColors};
}
