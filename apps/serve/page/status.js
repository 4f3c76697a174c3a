// What the program tells: the line below the picture, messages, the times of passes, values of pixels.

import {byId, debounced, make, numberText, setText} from './dom.js';
import {PassPreview} from './pass_preview.js';

const mostNotes = 8;
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
  #dismissed = {fault: null, message: null}; // texts that are not shown any more
  #frame = null; // the one that is being computed: its number, and since when

  constructor(store) {
    this.store = store;
    for (const name of ['facts', 'state']) store.addEventListener(name, () => this.show());
    setInterval(() => this.show(), 1000); // of a long frame nothing is heard until it ends
    byId('dismiss').addEventListener('click', () => {
      for (const id of Object.keys(this.#dismissed)) this.#dismissed[id] = byId(id).textContent;
      say('');
      this.show();
    });
    // What the keyboard reaches is not to hide behind what sticks to the panel's ends.
    const panel = byId('panel'), ends = {top: byId('panel-head'), bottom: byId('messages')};
    const observer = new ResizeObserver(() => {
      panel.style.scrollPaddingBlock = `${ends.top.offsetHeight}px ${ends.bottom.offsetHeight}px`;
    });
    for (const end of Object.values(ends)) observer.observe(end);
    this.preview = new PassPreview(store);
    this.passes = make('tbody', {pointerleave: () => this.preview.leave()});
    this.memory = make('p', {className: 'note'});
    this.table = make('div', {className: 'passes'}, make('table', {}, make('caption', {textContent: 'Passes: point at one to see its images, click to keep them'}),
        make('thead', {}, make('tr', {}, make('th', {scope: 'col', textContent: 'pass'}),
                               make('th', {scope: 'col', textContent: 'time'}))), this.passes), this.memory);
  }

  show() {
    const {facts} = this.store;
    if (!facts.device) return;
    setText(byId('scene-name'), facts.scene || 'no scene');
    setText(byId('device'), facts.device);
    setText(byId('activity'), this.activity(facts));
    setText(byId('activity-time'), this.secondsText(facts));
    setText(byId('fact-time'), facts.frame_milliseconds > 0 ? `${millisecondsText(facts.frame_milliseconds)} a frame` : '');
    setText(byId('fact-samples'), facts.samples > 0 ? `${facts.samples} ${facts.samples === 1 ? 'sample' : 'samples'}` : `frame ${facts.frames}`);
    const size = facts.picture_extent ?? [0, 0];
    setText(byId('fact-size'), size[0] > 0 ? size.join(' × ') : '');
    byId('cancel').hidden = !facts.activity;
    this.showNotes(facts.notes ?? []);
    this.showMessages(facts);
    this.showPasses(facts);
  }

  /// What was added to the scene, or left out.
  showNotes(notes) {
    const rest = notes.length > mostNotes ? [`and ${notes.length - mostNotes} more`] : [];
    setText(byId('scene-notes'), [...notes.slice(0, mostNotes), ...rest].join('\n'));
    byId('scene-notes').hidden = notes.length === 0;
  }

  activity(facts) {
    if (facts.activity) return facts.activity;
    if (facts.compiling) return 'compiling shaders';
    if (facts.computing) return this.frameText(facts);
    return this.store.value('running') === false ? 'stopped' : 'finished';
  }

  /// "rendering", with the frame's size where the picture that is shown has fewer pixels.
  frameText({extent, picture_extent: shown}) {
    return extent && shown && extent[0] > shown[0] ? `rendering ${extent.join(' × ')}` : 'rendering';
  }

  /// For how long a frame is computed already; not for screen readers, which would speak each second.
  secondsText({computing, activity, frames, frames_begun: begun}) {
    const now = performance.now(), number = `${frames} ${begun}`;
    if (!computing || activity) {
      this.#frame = null;
      return '';
    }
    if (this.#frame?.number !== number) this.#frame = {number, since: now};
    const seconds = Math.round((now - this.#frame.since) / 1000);
    return seconds > 1 ? `for ${seconds} s` : '';
  }

  showMessages(facts) {
    // The command line has a place of its own.
    const said = {fault: facts.fault ?? '', message: facts.message === facts.command ? '' : facts.message ?? ''};
    for (const [id, text] of Object.entries(said)) {
      if (text !== this.#dismissed[id]) this.#dismissed[id] = null;
      setText(byId(id), this.#dismissed[id] === null ? text : '');
    }
    setText(byId('values'), facts.values ?? '');
    byId('values').hidden = !facts.values;
    setText(byId('scores'), facts.scores ?? '');
  }

  passRow() {
    const name = make('button', {type: 'button', title: 'Shows the images of this pass',
                                 click: () => this.preview.click(name.textContent)});
    const row = make('tr', {}, make('td', {}, name), make('td'));
    row.addEventListener('pointerenter', event => {
      if (event.pointerType === 'mouse') this.preview.enter(name.textContent);
    });
    return row;
  }

  showPasses(facts) {
    const passes = facts.passes ?? [];
    while (this.passes.rows.length > passes.length) this.passes.lastChild.remove();
    passes.forEach(({name, milliseconds}, i) => {
      const row = this.passes.rows[i] ?? this.passes.appendChild(this.passRow());
      setText(row.cells[0].firstChild, name);
      row.cells[0].firstChild.setAttribute('aria-pressed', name === this.preview.chosen());
      setText(row.cells[1], millisecondsText(milliseconds));
    });
    if (facts.memory !== undefined) {
      const scene = bytesText(facts.scene_memory ?? 0);
      setText(this.memory, `${bytesText(facts.memory)} on the device, the scene's ${scene}`);
    }
  }
}

const saySeconds = 10;
const hush = debounced(1000 * saySeconds, () => say(''));

/// A message of the page itself, until the next, or for a while.
export function say(text) {
  setText(byId('page-message'), text);
  if (text) hush();
}
