// Shows the images of the pass under the mouse while it rests there.

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
    const chosen = pass === this.chosen() ? '' : pass;
    this.#usually = null;
    this.store.edit({pass: chosen});
  }

  enter(pass) {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => {
      this.#usually ??= this.store.value('pass');
      this.store.edit({pass});
    }, delay);
  }

  leave() {
    clearTimeout(this.#timer);
    if (this.#usually === null) return;
    this.store.edit({pass: this.#usually});
    this.#usually = null;
  }
}
