// The panel: sections with a row for each field, the search, and marks of what was changed.

import {byId, make, setText} from './dom.js';
import * as controls from './controls.js';
import {LightDesk} from './lights.js';

const firstSections = ['scene', 'camera', 'light', 'method', 'look', 'compare', 'inspect'];
const openAtFirst = ['scene', 'method', 'look'];
const onlyWithClip = ['playing', 'time', 'shutter', 'shutter_position'];
const onlyWithPass = ['image', 'view.channels', 'view.stops', 'view.false_color'];
// The page sets the first; the others belong to EXR files, which it does not have, and to buttons.
const hidden = ['viewport', 'layers', 'kept_settings', 'running'];

/// A word without the ending of its plural: "firefly" and "fireflies" are "firefl".
const stemOf = word => word.replace(/(?<=...)(ies|y|s)$/, '');

/// What is written in an element, and in its hints.
const textOfAll = element => [element.textContent, ...[...element.querySelectorAll('[title]')].map(e => e.title)]
    .join(' ').toLowerCase();

const idOf = key => 'field-' + key.replace(/[^a-z0-9]/gi, '-');

export class Panel {
  #rows = new Map();     // key -> {element, show, reset}
  #sections = new Map(); // name -> <details>
  #extras = [];          // buttons, lists and tables in sections that are no rows

  /// `actions` gives elements for the start and the end of a section: section name -> element.
  constructor(store, ask, actions) {
    this.store = store;
    this.ask = ask;
    this.actions = actions;
    this.main = byId('sections');
    this.others = byId('other-sections');
    store.addEventListener('fields', () => this.build());
    for (const name of ['state', 'facts']) store.addEventListener(name, () => this.show());
    byId('search').addEventListener('input', () => this.search());
    byId('descriptions').addEventListener('change', event => {
      document.body.classList.toggle('with-descriptions', event.target.checked);
    });
  }

  build() {
    this.openMatches(false); // not those that only a search has opened
    const open = new Set([...this.#sections].filter(([, details]) => details.open).map(([name]) => name));
    const again = this.#sections.size > 0;
    this.#rows.clear();
    this.#sections.clear();
    const names = [...firstSections, ...this.store.fields.map(field => field.section)];
    for (const name of new Set(names)) {
      const rows = this.store.fields.filter(f => f.section === name && !hidden.includes(f.key)).map(f => this.row(f));
      const details = make('details', {className: 'section', open: again ? open.has(name) : openAtFirst.includes(name)},
                           make('summary', {}, make('span', {textContent: name}), make('span', {className: 'count'})),
                           make('div', {className: 'body'}, this.actions.elements[name] ?? null, ...rows,
                                this.actions.endings[name] ?? null));
      details.dataset.section = name;
      this.#sections.set(name, details);
    }
    this.#extras = [...this.#sections.values()].flatMap(
        details => [...details.querySelectorAll('.body > :not([data-key])')]);
    this.main.replaceChildren(...firstSections.map(name => this.#sections.get(name)));
    this.others.replaceChildren();
    this.arrangement = null;
    this.show();
  }

  /// The label, the mark with the way back to the default, the description, and the control.
  row(field) {
    const id = idOf(field.key), control = this.control(field, id, id + '-help');
    const reset = make('button', {type: 'button', className: 'reset', textContent: '↺', hidden: true,
                                  title: `Back to ${this.textOf(field, field.default)}`,
                                  'aria-label': `${field.label}: back to the default`,
                                  click: () => this.store.reset(field.key)});
    const label = make('label', {htmlFor: id, title: field.help}, field.label.replaceAll('_', ' '));
    const help = field.help + (field.unit ? ` [${field.unit}]` : '');
    const head = make('div', {className: 'head'}, label,
                      field.unit ? make('span', {className: 'unit', textContent: field.unit}) : null, reset);
    const explained = make('p', {className: 'help', id: id + '-help', textContent: help});
    const element = make('div', {className: `field kind-${field.kind}`}, head, control.element, explained);
    element.dataset.key = field.key;
    this.#rows.set(field.key, {element, control, reset, field, help, explained,
                               text: `${field.key} ${field.section} ${field.label} ${field.help}`.toLowerCase()});
    return element;
  }

  textOf(field, value) {
    if (typeof value === 'boolean') return value ? 'on' : 'off';
    return Array.isArray(value) ? value.join(', ') : value === '' ? 'none' : `${value}`;
  }

  control(field, id, describedBy) {
    const whole = field.kind === 'int';
    const options = {id, describedBy, label: field.label, unit: field.unit, minimum: field.minimum,
                     maximum: field.maximum, span: field.slider, whole,
                     change: value => this.store.edit({[field.key]: value}),
                     hold: isHeld => this.store.hold(field.key, isHeld)};
    if (field.key === 'pass') return controls.select(options, [['', 'the picture']]);
    switch (field.kind) {
      case 'bool': return controls.checkbox(options);
      case 'int':
      case 'float': return controls.slider(options);
      case 'choice': {
        const help = field.choice_help ?? [];
        return controls.select(options, field.choices.map((name, i) => [name, name, help[i]]));
      }
      case 'index': return controls.select(options, []);
      case 'vector': return controls.vector(options);
      case 'lights': return new LightDesk(this.store, this.ask);
      case 'background': return controls.background(options);
      default: return controls.text(options);
    }
  }

  show() {
    if (!this.store.hasState() || !this.#rows.size) return;
    for (const [key, row] of this.#rows) this.showRow(key, row);
    for (const [name, details] of this.#sections) this.countChanges(name, details);
    this.arrange();
  }

  showRow(key, {element, control, reset, field, help, explained}) {
    const value = this.store.value(key), {facts} = this.store;
    const ofChoice = field.choice_help?.[field.choices.indexOf(value)];
    if (ofChoice) setText(explained, `${help}. ${value}: ${ofChoice}`);
    if (field.kind === 'index') control.setChoices((facts[field.choices[0]] ?? []).map((name, i) => [i, name]));
    if (key === 'pass') this.showPasses(control, value);
    if (value !== undefined) control.show(value);
    const differs = this.store.differs(key);
    element.classList.toggle('changed', differs);
    reset.hidden = !differs;
    if (onlyWithClip.includes(key)) element.classList.toggle('absent', !(facts.duration > 0));
    if (onlyWithPass.includes(key)) element.classList.toggle('absent', !this.store.value('pass'));
    if (field.denoisers) element.classList.toggle('absent', !field.denoisers.includes(this.store.value('denoiser')));
    if (key === 'time' && facts.duration > 0) field.slider.max = facts.duration;
  }

  showPasses(control, value) {
    const names = (this.store.facts.passes ?? []).map(pass => pass.name);
    if (value && !names.includes(value)) names.push(value);
    control.setChoices([['', 'the picture'], ...names.map(name => [name, name])]);
  }

  isShown(key) {
    return this.#rows.has(key) && !this.#rows.get(key).element.classList.contains('absent');
  }

  countChanges(name, details) {
    const count = this.store.fields
        .filter(({key, section}) => section === name && this.isShown(key) && this.store.differs(key)).length;
    const place = details.querySelector('.count');
    setText(place, count ? `${count} changed` : '');
    details.classList.toggle('changed', count > 0);
  }

  /// Parameter groups of the chosen method stand below the main sections, all others behind "other parameters".
  arrange() {
    const used = this.groupsInUse();
    const first = [], rest = [];
    for (const name of this.#sections.keys()) {
      if (!firstSections.includes(name)) (used.has(name) ? first : rest).push(name);
    }
    const arrangement = `${first};${rest}`;
    if (arrangement === this.arrangement) return;
    this.arrangement = arrangement;
    for (const name of first) this.main.append(this.#sections.get(name));
    for (const name of rest) this.others.append(this.#sections.get(name));
    this.search(); // the rows may be new ones
  }

  groupsInUse() {
    const {store} = this, integrator = store.value('integrator');
    return new Set(store.groups[`${integrator}+${store.value('denoiser')}`] ?? store.groups[integrator] ?? []);
  }

  search() {
    const words = byId('search').value.toLowerCase().split(/\s+/).filter(Boolean).map(stemOf);
    const searching = words.length > 0;
    const show = (element, text) =>
        element.classList.toggle('unmatched', searching && !words.every(word => text.includes(word)));
    for (const {element, text} of this.#rows.values()) show(element, text);
    for (const element of this.#extras) show(element, textOfAll(element));
    this.openMatches(searching);
    const found = [...this.#rows.values()].map(row => row.element).concat(this.#extras).filter(e => e.offsetParent);
    setText(byId('search-result'), searching ? `${found.length} found` : '');
  }

  /// While something is searched, sections with matches are open; afterwards they are as before.
  openMatches(searching) {
    if (searching) this.openBefore ??= [...document.querySelectorAll('#panel details.group, #panel details.section')]
        .map(details => [details, details.open]);
    for (const [details] of this.openBefore ?? []) {
      const matches = [...details.querySelectorAll('.body > *')].some(f => !f.classList.contains('unmatched'));
      details.classList.toggle('unmatched', searching && !matches);
      if (searching) details.open = matches;
    }
    if (searching || !this.openBefore) return;
    for (const [details, open] of this.openBefore) details.open = open;
    this.openBefore = null;
  }
}
