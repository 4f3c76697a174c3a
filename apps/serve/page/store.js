// What the page knows: the table of fields, the server's state, and edits that the server has not shown yet. An edit
// has an id of ours until the server acknowledges it with its number; states say up to which number they include
// messages.

import {same} from './dom.js';

const mergeMilliseconds = 800; // edits by one drag that follow one another so soon are one step of undo

export class Store extends EventTarget {
  fields = [];
  facts = {};
  #server = {};
  #pending = new Map(); // key -> {value, id, number}: shown until a state includes the message `number`
  #included = 0;
  #held = new Map();    // key -> number of holders: the user's hand is on the control
  #undo = [];
  #redo = [];

  constructor(send) {
    super();
    this.send = send; // sends changes, returns the edit's id
  }

  /// `groups`: for each integrator and denoiser the parameter groups that take part.
  setFields(fields, groups) {
    this.fields = fields;
    this.groups = groups;
    this.byKey = new Map(fields.map(field => [field.key, field]));
    this.#pending.clear();
    this.#changed('fields');
  }

  field(key) {
    return this.byKey?.get(key);
  }

  /// The value that a control shows.
  value(key) {
    return this.#pending.get(key)?.value ?? this.#server[key];
  }

  hasState() {
    return Object.keys(this.#server).length > 0;
  }

  /// Whether the value is another than that at the start; false where the start depends on the scene.
  differs(key) {
    const initial = this.field(key)?.default;
    return initial !== null && initial !== undefined && this.value(key) !== undefined &&
           !same(this.value(key), initial);
  }

  /// A newer state, or those fields of it that changed; it includes all messages up to the number `included`.
  receiveState(state, included) {
    Object.assign(this.#server, state);
    this.#included = included;
    this.#settle();
    this.#changed('state');
  }

  receiveFacts(facts) {
    Object.assign(this.facts, facts);
    this.#changed('facts');
  }

  acknowledge(id, number) {
    for (const edit of this.#pending.values()) {
      if (edit.id === id) edit.number = number;
    }
    this.#settle();
  }

  /// Edits that the state includes, or should if the server has taken them, are shown as the server has them.
  #settle() {
    for (const [key, edit] of this.#pending) {
      if (edit.number <= this.#included && !this.#held.get(key)) this.#pending.delete(key);
    }
  }

  /// After the connection was lost, the server's numbers start anew.
  forgetEdits() {
    this.#pending.clear();
    this.#held.clear();
    this.#server = {};
    this.#included = 0;
  }

  /// While a control is held, it keeps what the user does with it, whatever states arrive.
  hold(key, isHeld) {
    const count = (this.#held.get(key) ?? 0) + (isHeld ? 1 : -1);
    if (count > 0) this.#held.set(key, count);
    else this.#held.delete(key);
    if (count > 0) return;
    this.#settle();
    this.#changed('state');
  }

  /// `name`: what undo calls it, if not the fields by their names.
  edit(changes, {remembers = true, name} = {}) {
    const before = Object.fromEntries(Object.keys(changes).map(key => [key, this.value(key)]));
    if (same(before, changes)) return;
    if (remembers) this.remember(before, changes, name);
    const id = this.send(changes);
    for (const [key, value] of Object.entries(changes)) this.#pending.set(key, {value, id, number: Infinity});
    this.#changed('state');
  }

  reset(key) {
    this.edit({[key]: this.field(key).default});
  }

  /// A step that undo() takes back: edit() remembers by itself; movements of the camera are remembered when they end.
  remember(before, after, name) {
    const last = this.#undo.at(-1), now = performance.now();
    const keys = Object.keys(after).join(), isHeld = Object.keys(after).some(key => this.#held.has(key));
    if (isHeld && last?.keys === keys && now - last.time < mergeMilliseconds) {
      last.after = after;
      last.time = now;
    } else {
      this.#undo.push({before, after, keys, time: now, name: name ?? this.nameOf(after)});
    }
    this.#redo.length = 0;
    this.#changed('history');
  }

  nameOf(changes) {
    return Object.keys(changes).map(key => this.field(key)?.label ?? key).join(', ').replaceAll('_', ' ');
  }

  /// What the next step changes; undefined: there is none.
  undoes() { return this.#undo.at(-1)?.name; }
  redoes() { return this.#redo.at(-1)?.name; }
  undo() { this.#step(this.#undo, this.#redo, 'before'); }
  redo() { this.#step(this.#redo, this.#undo, 'after'); }

  #step(from, to, side) {
    const step = from.pop();
    if (!step) return;
    to.push({...step, time: -Infinity});
    this.edit(step[side], {remembers: false});
    this.#changed('history');
  }

  #changed(what) {
    this.dispatchEvent(new Event(what));
  }
}
