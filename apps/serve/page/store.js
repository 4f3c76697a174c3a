// What the page knows: the table of fields, the server's state, and edits that the server has not shown yet. An edit
// has an id of ours until the server acknowledges it with its number; states say up to which number they include
// messages.

import {same} from './dom.js';

const mergeMilliseconds = 800; // drags of a control that follow one another so soon are one step of undo
const mostSteps = 200;         // of undo, as in the window
const method = ['integrator', 'denoiser']; // the server changes the one that does not go with the other

export class Store extends EventTarget {
  fields = [];
  facts = {};
  #server = {};
  #pending = new Map(); // key -> {value, id, number}: shown until a state includes the message `number`
  #included = 0;
  #acknowledged = {id: 0, number: 0}; // our last message that the server has numbered
  #held = new Map();    // key -> {count, since}, of holders: the user's hand is on the control
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
    const edit = this.#pending.get(key);
    return edit ? edit.value : this.#server[key]; // null is a value, too
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
    const lights = this.#server.lights?.length;
    Object.assign(this.#server, state);
    // The server refuses lights of another number.
    if (lights !== undefined && lights !== this.#server.lights.length) this.#forgetSteps('lights');
    this.#included = included;
    this.#settle();
    this.#changed('state');
  }

  receiveFacts(facts) {
    const before = this.facts.scene;
    Object.assign(this.facts, facts);
    if (before && this.facts.scene !== before) this.#leaveScene();
    this.#changed('facts');
  }

  /// Its cameras and lights are not those of the next one.
  #leaveScene() {
    this.#forgetSteps();
    this.#changed('scene');
  }

  /// Steps of undo that change the field; all of them where none is named.
  #forgetSteps(key) {
    const stays = step => key !== undefined && !(key in step.after);
    this.#undo = this.#undo.filter(stays);
    this.#redo = this.#redo.filter(stays);
    this.#changed('history');
  }

  acknowledge(id, number) {
    this.#acknowledged = {id, number};
    for (const edit of this.#pending.values()) {
      if (edit.id === id) edit.number = number;
    }
    this.#settle();
  }

  /// Whether the state is one of after our message.
  includes(id) {
    return id <= this.#acknowledged.id && this.#acknowledged.number <= this.#included;
  }

  /// Edits that the state includes, or should if the server has taken them, are shown as the server has them.
  #settle() {
    for (const [key, edit] of this.#pending) {
      if (edit.number <= this.#included && !this.#held.has(key)) this.#pending.delete(key);
    }
  }

  /// After the connection was lost, the server's numbers start anew.
  forgetEdits() {
    this.#pending.clear();
    this.#held.clear();
    this.#server = {};
    this.#included = 0;
    this.#acknowledged = {id: 0, number: 0};
    this.#changed('lost');
  }

  /// While a control is held, it keeps what the user does with it, whatever states arrive.
  hold(key, isHeld) {
    const before = this.#held.get(key) ?? {count: 0, since: performance.now()};
    const count = before.count + (isHeld ? 1 : -1);
    if (count > 0) return void this.#held.set(key, {...before, count});
    this.#held.delete(key);
    this.#settle();
    this.#changed('state');
  }

  /// `name`: what undo calls it, if not the fields by their names.
  edit(changes, {remembers = true, name} = {}) {
    if (!this.hasState()) return; // the connection is lost: nobody would hear of it
    const before = this.#valuesOf(Object.keys(changes));
    if (same(before, changes)) return;
    if (method.some(key => key in changes)) Object.assign(before, this.#valuesOf(method));
    if (remembers) this.remember(before, changes, name);
    const id = this.send(changes);
    for (const [key, value] of Object.entries(changes)) this.#pending.set(key, {value, id, number: Infinity});
    this.#changed('state');
  }

  #valuesOf(keys) {
    return Object.fromEntries(keys.map(key => [key, this.value(key)]));
  }

  reset(key) {
    this.edit({[key]: this.field(key).default});
  }

  /// A step that undo() takes back: edit() remembers by itself; movements of the camera are remembered when they end.
  remember(before, after, name) {
    if (!this.hasState()) return;
    const last = this.#undo.at(-1), now = performance.now(), keys = Object.keys(after);
    if (last?.keys === keys.join() && this.#goesOn(last, keys, now)) {
      last.after = after;
      last.time = now;
    } else {
      this.#undo.push({before, after, keys: keys.join(), time: now, name: name ?? this.nameOf(after)});
    }
    if (this.#undo.length > mostSteps) this.#undo.shift();
    this.#redo.length = 0;
    this.#changed('history');
  }

  /// Whether the hand that made the step has not let go since, or not for long.
  #goesOn({time}, keys, now) {
    const holds = keys.map(key => this.#held.get(key)).filter(Boolean);
    return holds.some(({since}) => time >= since || now - time < mergeMilliseconds);
  }

  nameOf(changes) {
    return Object.keys(changes).map(key => this.field(key)?.label ?? key).join(', ').replaceAll('_', ' ');
  }

  /// What the next step changes; undefined: there is none.
  undoes() { return this.#undo.at(-1)?.name; }
  redoes() { return this.#redo.at(-1)?.name; }

  undo() {
    this.#changed('undoing'); // a movement that rests, but not for long enough, is a step now
    this.#step(this.#undo, this.#redo, 'before');
  }

  redo() {
    this.#step(this.#redo, this.#undo, 'after');
  }

  #step(from, to, side) {
    if (!from.length || !this.hasState()) return;
    const step = from.pop();
    to.push({...step, time: -Infinity});
    this.edit(step[side], {remembers: false});
    this.#changed('history');
  }

  #changed(what) {
    this.dispatchEvent(new Event(what));
  }
}
