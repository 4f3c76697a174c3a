// Shows the images of the pass under the mouse while it rests there. Only what a click keeps is a step of undo.

const delay = 150; // milliseconds; a mouse that only passes by shows nothing

export class PassPreview {
  #timer = 0;
  #usually = null; // the field `pass` of before; null: nothing is shown for the mouse

  constructor(store) {
    this.store = store;
  }

  /// The pass that a click has chosen; empty: the picture.
  chosen() {
    return this.#usually ?? this.store.value('pass');
  }

  /// A click on a pass keeps its images, another one shows the picture, although the mouse is there.
  click(pass) {
    clearTimeout(this.#timer);
    const before = this.chosen(), chosen = pass === before ? '' : pass;
    this.#usually = null;
    this.#show(chosen);
    this.store.remember({pass: before}, {pass: chosen});
  }

  enter(pass) {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => {
      if (!this.store.hasState()) return; // the connection is lost
      this.#usually ??= this.store.value('pass');
      this.#show(pass);
    }, delay);
  }

  leave() {
    clearTimeout(this.#timer);
    if (this.#usually === null) return;
    this.#show(this.#usually);
    this.#usually = null;
  }

  #show(pass) {
    this.store.edit({pass}, {remembers: false});
  }
}
