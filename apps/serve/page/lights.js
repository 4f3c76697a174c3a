// Every light of the scene: a switch, and behind its name colour, brightness and place.

import {make} from './dom.js';
import {brightnessSpan, checkbox, color, slider, vector} from './controls.js';

const turnSpan = {min: -180, max: 180, scale: 'linear'};

function row(label, id, control) {
  return make('div', {className: 'field'},
              make('div', {className: 'head'}, make('label', {htmlFor: id, textContent: label})), control.element);
}

/// Which of a light's values have controls. `lamp` is unknown to servers that do not send it: then all are shown.
function placesOf(light) {
  if (light.kind === 'environment') return ['turn'];
  if (light.kind !== 'lamp') return [];
  return ['position', 'direction'].filter(name => light.lamp === undefined ||
    (name === 'position' ? light.lamp !== 'directional' : light.lamp !== 'point'));
}

/// Lamps that were added by hand can be removed; servers that do not say which have these names for them.
const isAdded = light => light.added ?? (light.kind === 'lamp' && light.name.startsWith('own light'));

class LightView {
  constructor(desk, number, light) {
    this.shows = [];
    const id = `light-${number}`;
    const change = name => value => desk.set(number, name, value);
    const hold = isHeld => desk.store.hold('lights', isHeld);
    const on = checkbox({id: `${id}-on`, change: change('on')});
    on.element.setAttribute('aria-label', `${light.name}: on`);
    this.shows.push(now => on.show(now.on));
    const body = make('div', {className: 'light-body'});
    const add = (name, label, control) => {
      body.append(row(label, `${id}-${name}`, control));
      this.shows.push(now => control.show(now[name]));
    };
    add('color', 'colour', color({id: `${id}-color`, label: `${light.name}: colour`, withBrightness: false,
                                  change: change('color'), hold}));
    add('brightness', 'brightness', slider({id: `${id}-brightness`, label: `${light.name}: brightness`,
        span: brightnessSpan, minimum: 0, maximum: 1e9, change: change('brightness'), hold}));
    for (const name of placesOf(light)) {
      const options = {id: `${id}-${name}`, label: `${light.name}: ${name}`, change: change(name), hold};
      add(name, name, name !== 'turn' ? vector(options)
          : slider({...options, span: turnSpan, minimum: -360, maximum: 360, unit: 'degrees'}));
    }
    if (isAdded(light)) {
      body.append(make('button', {type: 'button', textContent: 'remove', 'aria-label': `remove ${light.name}`,
                                  click: () => desk.remove(number)}));
    }
    this.details = make('details', {}, make('summary', {textContent: light.name}), body);
    this.element = make('div', {className: 'light'}, on.element, this.details);
  }

  show(light) {
    this.values = JSON.stringify(light);
    for (const show of this.shows) show(light);
  }
}

/// The lights as one control.
export class LightDesk {
  #views = [];
  #shape = '';

  constructor(store, ask) {
    this.store = store;
    this.ask = ask;
    this.element = make('div', {className: 'lights', role: 'group', 'aria-label': 'lights'});
  }

  show(lights) {
    const shape = JSON.stringify(lights.map(({name, kind, lamp, added}) => [name, kind, lamp, added]));
    if (shape !== this.#shape) {
      this.#shape = shape;
      // When one is added or removed, others get new numbers, but keep their values. Names are not unique.
      const open = new Set(this.#views.filter(view => view.details.open).map(view => view.values));
      this.#views = lights.map((light, number) => new LightView(this, number, light));
      this.#views.forEach((view, number) => { view.details.open = open.has(JSON.stringify(lights[number])); });
      this.element.replaceChildren(...this.#views.map(view => view.element));
      if (!lights.length) this.element.textContent = 'The scene has no lights of its own.';
    }
    this.#views.forEach((view, number) => view.show(lights[number]));
  }

  set(number, name, value) {
    const lights = this.store.value('lights').map((light, i) => i === number ? {...light, [name]: value} : light);
    this.store.edit({lights});
  }

  /// Lamps are counted from 0.
  remove(number) {
    const before = this.store.value('lights').slice(0, number);
    this.ask('remove_lamp', {index: before.filter(light => light.kind === 'lamp').length});
  }
}
