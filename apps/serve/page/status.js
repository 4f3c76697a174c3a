// What the program tells: the line below the picture, messages, the times of passes, values of pixels.

import {byId, make, numberText, setText} from './dom.js';

const units = ['bytes', 'KiB', 'MiB', 'GiB', 'TiB'];

function bytesText(bytes) {
  let unit = 0;
  for (; bytes >= 1024 && unit < units.length - 1; ++unit) bytes /= 1024;
  return `${Number(bytes.toPrecision(3))} ${units[unit]}`;
}

function millisecondsText(milliseconds) {
  if (milliseconds >= 1000) return `${(milliseconds / 1000).toFixed(1)} s`;
  return `${numberText(milliseconds.toPrecision(3))} ms`;
}

export class Status {
  #shownFault = '';
  #dismissed = '';

  constructor(store) {
    this.store = store;
    for (const name of ['facts', 'state']) store.addEventListener(name, () => this.show());
    byId('dismiss').addEventListener('click', () => {
      this.#dismissed = this.#shownFault;
      this.show();
    });
    this.passes = make('tbody');
    this.memory = make('p', {className: 'note'});
    this.table = make('div', {className: 'passes'}, make('table', {}, make('caption', {textContent: 'Times of passes'}),
        make('thead', {}, make('tr', {}, make('th', {scope: 'col', textContent: 'pass'}),
                               make('th', {scope: 'col', textContent: 'time'}))), this.passes), this.memory);
  }

  show() {
    const {facts} = this.store;
    if (!facts.device) return;
    setText(byId('scene-name'), facts.scene || 'no scene');
    setText(byId('device'), facts.device);
    setText(byId('activity'), this.activity(facts));
    setText(byId('fact-time'), `${millisecondsText(facts.frame_milliseconds ?? 0)} a frame`);
    setText(byId('fact-samples'), facts.samples > 0 ? `${facts.samples} samples` : `frame ${facts.frames}`);
    setText(byId('fact-size'), (facts.extent ?? []).join(' × '));
    byId('cancel').hidden = !facts.activity;
    this.showMessages(facts);
    this.showPasses(facts);
  }

  activity(facts) {
    if (facts.activity) return facts.activity;
    if (facts.computing) return 'rendering';
    return this.store.value('running') === false ? 'stopped' : 'finished';
  }

  showMessages(facts) {
    setText(byId('message'), facts.message ?? '');
    this.#shownFault = facts.fault ?? '';
    if (!this.#shownFault) this.#dismissed = '';
    const hidden = !this.#shownFault || this.#shownFault === this.#dismissed;
    setText(byId('fault'), hidden ? '' : this.#shownFault);
    byId('dismiss').hidden = hidden;
    setText(byId('values'), facts.values ?? '');
    byId('values').hidden = !facts.values;
    setText(byId('scores'), facts.scores ?? '');
  }

  showPasses(facts) {
    const passes = facts.passes ?? [];
    while (this.passes.rows.length > passes.length) this.passes.lastChild.remove();
    passes.forEach(({name, milliseconds}, i) => {
      const row = this.passes.rows[i] ?? this.passes.appendChild(make('tr', {}, make('td'), make('td')));
      setText(row.cells[0], name);
      setText(row.cells[1], millisecondsText(milliseconds));
    });
    if (facts.memory !== undefined) {
      const scene = bytesText(facts.scene_memory ?? 0);
      setText(this.memory, `${bytesText(facts.memory)} on the device, the scene's ${scene}`);
    }
  }
}

/// A message of the page itself, until the next.
export function say(text) {
  setText(byId('page-message'), text);
}
