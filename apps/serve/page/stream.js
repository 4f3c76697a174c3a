// Pictures as they arrive: VP9 by the browser's decoder, or single JPEG and PNG pictures, in the order in which they
// were sent.

const kinds = {1: 'vp9', 2: 'jpeg', 3: 'png', 4: 'motion'};
const headerBytes = 32;
const isKey = 1, isCompared = 2, isLossless = 4, isInspected = 8;

const config = {
  codec: 'vp09.00.41.08',
  optimizeForLatency: true,
  // Values are encoded as sRGB: only the matrix and the range are a video's.
  colorSpace: {primaries: 'bt709', transfer: 'iec61966-2-1', matrix: 'bt709', fullRange: false},
};

export function parseHeader(buffer) {
  const view = new DataView(buffer), flags = view.getUint8(1);
  return {kind: kinds[view.getUint8(0)], key: Boolean(flags & isKey), lossless: Boolean(flags & isLossless),
          inspected: Boolean(flags & isInspected),
          side: flags & isCompared ? 'right' : 'left', width: view.getUint16(4, true), height: view.getUint16(6, true),
          frame: view.getUint32(8, true), included: Number(view.getBigUint64(16, true)),
          data: new Uint8Array(buffer, headerBytes)};
}

/// The kinds that this browser shows, the best first.
export async function codecsHere() {
  try {
    const {supported} = await VideoDecoder.isConfigSupported(config);
    return supported ? ['vp9', 'jpeg'] : ['jpeg'];
  } catch {
    return ['jpeg']; // there are no WebCodecs, or only on secure pages
  }
}

/// One side: the picture, or what it is compared with.
class Side {
  #decoder = null;
  #order = Promise.resolve();
  #headers = new Map(); // frame -> header, of what the decoder has
  #decodes = 0;         // counts connections: pictures of an earlier one are not shown

  constructor(show, fail) {
    this.show = show;
    this.fail = fail;
  }

  take(header) {
    return header.kind === 'vp9' ? this.decode(header) : this.decodeStill(header);
  }

  decode(header) {
    if (!this.#decoder || this.#decoder.state === 'closed') {
      if (!header.key) return Promise.resolve();
      this.#decoder = this.makeDecoder();
    }
    const decoder = this.#decoder;
    this.#headers.set(header.frame, header);
    const type = header.key ? 'key' : 'delta';
    decoder.decode(new EncodedVideoChunk({type, timestamp: header.frame, data: header.data}));
    if (decoder.decodeQueueSize < 2) return Promise.resolve();
    return new Promise(done => decoder.addEventListener('dequeue', done, {once: true}));
  }

  makeDecoder() {
    const decoder = new VideoDecoder({
      output: frame => {
        const header = this.#headers.get(frame.timestamp);
        this.#headers.delete(frame.timestamp);
        if (header) this.inOrder(header, Promise.resolve(frame));
        else frame.close();
      },
      error: error => this.fail(error),
    });
    decoder.configure(config);
    return decoder;
  }

  decodeStill(header) {
    const type = `image/${header.kind}`;
    return this.inOrder(header, createImageBitmap(new Blob([header.data], {type}),
                                                  {colorSpaceConversion: 'none', premultiplyAlpha: 'none'}));
  }

  /// Pictures are shown in the order in which their decoding began.
  inOrder(header, decoding) {
    const connection = this.#decodes;
    this.#order = this.#order.then(() => decoding).then(image => {
      if (connection === this.#decodes) this.show(header, image);
      else image.close();
    }, this.fail);
    return this.#order;
  }

  reset() {
    ++this.#decodes;
    if (this.#decoder && this.#decoder.state !== 'closed') this.#decoder.close();
    this.#decoder = null;
    this.#headers.clear();
  }
}

export class Stream {
  /// `received` acknowledges a frame; `show(header, image)` owns the image; `move(header)` gets the motion;
  /// `fail` hears of what cannot be decoded.
  constructor({show, move, received, fail}) {
    this.received = received;
    this.move = move;
    this.sides = {left: new Side(show, fail), right: new Side(show, fail)};
  }

  async take(buffer) {
    const header = parseHeader(buffer);
    try {
      if (header.kind === 'motion') this.move(header);
      else await this.sides[header.side].take(header);
    } finally {
      this.received(header.frame);
    }
  }

  reset() {
    for (const side of Object.values(this.sides)) side.reset();
  }
}
